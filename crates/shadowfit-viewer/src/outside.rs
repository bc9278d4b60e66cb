//! The view from outside: the camera's frustum, the maps' boxes and the sun's direction drawn as
//! lines, seen by a second camera that keeps all of them in its picture.

use glam::{DVec3, Vec3, Vec4};
use shadowfit::{LightFit, PerspectiveCamera, ViewFrustum};
use shadowfit_render::{Line, box_lines};
use shadowfit_wgpu::MapFit;

/// Colour of the camera's frustum: a warm yellow.
const FRUSTUM_COLOR: Vec4 = Vec4::new(1.0, 0.62, 0.05, 1.0);
/// Colour of the maps' boxes: a clear blue.
const BOX_COLOR: Vec4 = Vec4::new(0.05, 0.45, 1.0, 1.0);
/// Colour of the box's face toward the light, its near plane, and of the sun's rays.
const NEAR_COLOR: Vec4 = Vec4::new(1.0, 0.12, 0.25, 1.0);

/// Vertical field of view of the outside camera, in radians.
const FOV_Y: f32 = 0.8;

/// The frustum that is shadowed, the boxes of the maps that were fitted to it, and an arrow along the
/// light's direction of travel into each box.
pub(crate) fn lines(frustum: Option<&ViewFrustum>, maps: &[MapFit]) -> Vec<Line> {
    let mut lines = Vec::new();
    for MapFit { fit, .. } in maps {
        let corners = fit.corners();
        lines.extend(box_lines(fit.origin, &corners, BOX_COLOR));
        lines.extend(near_face(fit, &corners));
    }
    if let Some(frustum) = frustum {
        lines.extend(box_lines(frustum.origin, &frustum.corners, FRUSTUM_COLOR));
    }
    lines
}

/// The face of the box toward the light, with an arrow from its middle into the box.
fn near_face(fit: &LightFit, corners: &[Vec3; 8]) -> Vec<Line> {
    let mut order: Vec<usize> = (0..8).collect();
    order.sort_by(|a, b| corners[*a].dot(fit.direction).total_cmp(&corners[*b].dot(fit.direction)));
    let is_near = |index: usize| order[..4].contains(&index);
    let mut lines: Vec<Line> = box_lines(fit.origin, corners, NEAR_COLOR)
        .into_iter()
        .zip(EDGE_ENDS)
        .filter(|(_, [a, b])| is_near(*a) && is_near(*b))
        .map(|(line, _)| line)
        .collect();
    let middle = order[..4].iter().map(|index| corners[*index]).sum::<Vec3>() / 4.0;
    let size = (corners[order[0]] - middle).length() * 0.4;
    let tip = middle + fit.direction * size;
    let side = fit.direction.any_orthonormal_vector() * size * 0.15;
    let back = tip - fit.direction * size * 0.3;
    let world = |point: Vec3| fit.origin + point.as_dvec3();
    for [from, to] in [[middle, tip], [back + side, tip], [back - side, tip]] {
        lines.push(Line { ends: [world(from), world(to)], color: NEAR_COLOR });
    }
    lines
}

/// Corners at the ends of each edge, in the order of [`box_lines`].
const EDGE_ENDS: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

/// A camera that sees all of the frustum and the boxes from behind and above the inner camera.
pub(crate) fn camera(inner: &PerspectiveCamera, frustum: Option<&ViewFrustum>, maps: &[MapFit]) -> PerspectiveCamera {
    let mut points: Vec<DVec3> = vec![inner.eye];
    points.extend(frustum.iter().flat_map(|f| f.corners.map(|corner| f.origin + corner.as_dvec3())));
    points
        .extend(maps.iter().flat_map(|MapFit { fit, .. }| fit.corners().map(|corner| fit.origin + corner.as_dvec3())));
    let low = points.iter().copied().reduce(DVec3::min).unwrap_or(inner.eye);
    let high = points.iter().copied().reduce(DVec3::max).unwrap_or(inner.eye);
    let center = (low + high) * 0.5;
    let radius = points.iter().map(|point| point.distance(center)).fold(1e-3, f64::max) as f32;
    let level = Vec3::new(inner.forward.x, 0.0, inner.forward.z).normalize_or(Vec3::NEG_Z);
    let right = level.cross(Vec3::Y);
    let away = (right * 0.75 - level * 0.45 + Vec3::Y * 0.55).normalize();
    let distance = radius / (FOV_Y * 0.5).sin();
    PerspectiveCamera {
        eye: center + (away * distance).as_dvec3(),
        forward: -away,
        up: Vec3::Y,
        fov_y: FOV_Y,
        aspect: inner.aspect,
        near: distance * 0.01,
        far: distance + radius * 20.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shadowfit::fit;
    use shadowfit::settings::FitSettings;

    #[test]
    fn every_corner_is_in_the_outside_picture() {
        let inner = PerspectiveCamera {
            eye: DVec3::new(1e5, 3.0, -2e4),
            forward: Vec3::new(0.3, -0.2, -0.9),
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 1.6,
            near: 0.1,
            far: 100.0,
        };
        let frustum = inner.frustum().expect("a frustum");
        let fitted = fit(&frustum, Vec3::new(0.4, -0.7, 0.3).normalize(), &FitSettings::default()).expect("a fit");
        let outside = camera(&inner, Some(&frustum), &[fitted.into()]);
        let clip = outside.clip_from_world(shadowfit::DepthConvention::Reversed);
        for corner in fitted.corners().map(|corner| fitted.origin + corner.as_dvec3()) {
            let point = clip * (corner - outside.eye).as_vec3().extend(1.0);
            let ndc = point.truncate() / point.w;
            assert!(point.w > 0.0 && ndc.x.abs() < 1.0 && ndc.y.abs() < 1.0, "{ndc}");
        }
    }

    #[test]
    fn the_near_face_has_four_edges_toward_the_light_and_an_arrow() {
        let inner = PerspectiveCamera {
            eye: DVec3::ZERO,
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 1.0,
            near: 0.1,
            far: 10.0,
        };
        let direction = Vec3::new(0.4, -0.7, 0.3).normalize();
        let fitted = fit(&inner.frustum().expect("a frustum"), direction, &FitSettings::default()).expect("a fit");
        let lines = near_face(&fitted, &fitted.corners());
        assert_eq!(lines.len(), 4 + 3);
        let depth = |line: &Line| line.ends.map(|end| end.as_vec3().dot(direction));
        let [a, b] = depth(&lines[0]);
        assert!((a - b).abs() < 1e-3, "an edge of the near face lies across the light: {a} {b}");
    }
}
