//! The view from outside: the slices of the camera's frustum that the maps serve, the maps' boxes in their
//! tints, and the sun's direction, drawn as lines for a second camera that has all of them in its picture.

use glam::{DVec3, Vec3, Vec4};
use shadowfit::culling::{Reader, caster_volumes};
use shadowfit::settings::MAX_MAPS;
use shadowfit::{Camera, CasterVolume, FittedMap, LightProjection, PerspectiveCamera};
use shadowfit_params::figures::linear_map_tints;
use shadowfit_render::{Line, box_lines};
use shadowfit_wgpu::ShadowMapDescriptor;

use super::fitted::Fitted;

/// Colour of the camera's frustum and its slices: white, which is no map's tint.
const FRUSTUM_COLOR: Vec4 = Vec4::ONE;

/// Vertical field of view of the outside camera, in radians.
const FOV_Y: f32 = 1.0;

/// Distance of the outside camera, relative to the distance at which all lines just fill its picture.
const ROOM: f32 = 1.1;

/// Length of the arrow along the light, as a share of half the diagonal of the box's face.
const ARROW: f32 = 0.4;

/// Brightness of a culling volume's edges, as a share of the tint.
const VOLUME_SHARE: f32 = 0.45;

/// Returns the slices of the view, and for each map that is read: its box, an arrow into it along the light's
/// direction of travel, and its caster volume, in the map's tint. The view is drawn as far as the maps reach.
pub(crate) fn lines(fitted: &Fitted, maps: &[FittedMap], descriptor: &ShadowMapDescriptor) -> Vec<Line> {
    let mut lines = boxes(fitted);
    let (Some(camera), Some(frustum)) = (fitted.camera, fitted.frustum()) else { return lines };
    let mut volumes = [CasterVolume::nowhere(camera.eye); MAX_MAPS];
    let reader = Reader::from_eye(camera.eye, camera.forward.normalize());
    if caster_volumes(maps, &descriptor.reading(), &reader, &[frustum], &mut volumes).is_ok() {
        for ((map, volume), tint) in maps.iter().zip(&volumes).zip(linear_map_tints()) {
            let color = (tint * VOLUME_SHARE).extend(1.0);
            // A volume is unbounded toward the light.
            let end = map.projection.corners().map(|corner| corner.dot(map.projection.direction));
            let end = end.into_iter().fold(f32::MAX, f32::min);
            lines.extend(volume_edges(
                &volume.relative_to(map.projection.origin),
                map.projection.direction,
                end,
                color,
            ));
        }
    }
    lines
}

/// Returns the edges of a volume, cut off nearer to the light than `end`, in metres along it from the
/// volume's origin.
fn volume_edges(volume: &CasterVolume, direction: Vec3, end: f32, color: Vec4) -> Vec<Line> {
    let mut planes = volume.active_planes().to_vec();
    planes.push(direction.extend(-end));
    let mut edges = Vec::new();
    for (first, a) in planes.iter().enumerate() {
        for b in &planes[first + 1..] {
            let along = a.truncate().cross(b.truncate());
            if along.length_squared() < 1e-8 {
                continue;
            }
            // A point on both planes.
            let at = (a.truncate() * b.w - b.truncate() * a.w).cross(along) / along.length_squared();
            let (mut from, mut to) = (f32::NEG_INFINITY, f32::INFINITY);
            for plane in &planes {
                let (slope, height) = (plane.truncate().dot(along), plane.truncate().dot(at) + plane.w);
                if slope.abs() < 1e-6 * along.length() {
                    // Planes that contain the edge keep all of it, within rounding.
                    if height < -1e-3 * (1.0 + at.length()) {
                        to = f32::NEG_INFINITY;
                    }
                } else if slope > 0.0 {
                    from = from.max(-height / slope);
                } else {
                    to = to.min(-height / slope);
                }
            }
            if from < to && from.is_finite() && to.is_finite() {
                let ends = [from, to].map(|share| volume.origin + (at + along * share).as_dvec3());
                edges.push(Line { ends, color });
            }
        }
    }
    edges
}

/// Returns the slices of the view, and the boxes of the maps with an arrow each.
fn boxes(fitted: &Fitted) -> Vec<Line> {
    let mut lines = Vec::new();
    let reach = reach(fitted);
    for (index, (map, tint)) in fitted.maps.iter().zip(linear_map_tints()).enumerate() {
        let Some(slice) = fitted.slice(index) else { continue };
        let color = tint.extend(1.0);
        let slice = slice.slice(slice.near, reach).unwrap_or(slice);
        lines.extend(box_lines(slice.origin, &slice.corners, FRUSTUM_COLOR));
        lines.extend(box_lines(map.projection.origin, &map.projection.corners(), color));
        lines.extend(arrow(&map.projection, color));
    }
    lines
}

/// Returns the greatest view depth of a corner of a map's box, in metres.
fn reach(fitted: &Fitted) -> f32 {
    let Some(camera) = fitted.camera else { return 0.0 };
    let depth = |corner: DVec3| (corner - camera.eye).dot(camera.forward.as_dvec3().normalize()) as f32;
    box_corners(fitted).map(depth).fold(0.0, f32::max)
}

/// Returns the corners of the boxes of all maps that are read, in world space, in metres.
fn box_corners(fitted: &Fitted) -> impl Iterator<Item = DVec3> {
    let read = fitted.maps.iter().enumerate().filter(|(index, _)| fitted.slice(*index).is_some());
    read.flat_map(|(_, map)| map.projection.corners().map(|corner| map.projection.origin + corner.as_dvec3()))
}

/// Returns an arrow along the light from the middle of the box's near face, toward the light.
fn arrow(fit: &LightProjection, color: Vec4) -> [Line; 3] {
    let mut corners = fit.corners();
    corners.sort_by(|a, b| a.dot(fit.direction).total_cmp(&b.dot(fit.direction)));
    let middle = corners[..4].iter().sum::<Vec3>() / 4.0;
    let size = (corners[0] - middle).length() * ARROW;
    let tip = middle + fit.direction * size;
    let side = fit.direction.any_orthonormal_vector() * size * 0.15;
    let back = tip - fit.direction * size * 0.3;
    let world = |point: Vec3| fit.origin + point.as_dvec3();
    [[middle, tip], [back + side, tip], [back - side, tip]]
        .map(|[from, to]| Line { ends: [world(from), world(to)], color })
}

/// Returns a camera that shows all of the frustum and the boxes from behind and above the inner camera.
pub(crate) fn camera(inner: &Camera, fitted: &Fitted) -> PerspectiveCamera {
    let mut points: Vec<DVec3> = vec![inner.eye];
    let frustum = fitted.frustum().and_then(|frustum| frustum.slice(frustum.near, reach(fitted)).ok());
    points.extend(frustum.iter().flat_map(|f| f.corners.map(|corner| f.origin + corner.as_dvec3())));
    points.extend(box_corners(fitted));
    let low = points.iter().copied().reduce(DVec3::min).unwrap_or(inner.eye);
    let high = points.iter().copied().reduce(DVec3::max).unwrap_or(inner.eye);
    let center = (low + high) * 0.5;
    let level = Vec3::new(inner.forward.x, 0.0, inner.forward.z).normalize_or(Vec3::NEG_Z);
    // From behind, where the small boxes are near, and from the left, so that they lie right of the inset.
    let away = (level.cross(Vec3::Y) * -0.5 - level * 0.75 + Vec3::Y * 0.5).normalize();
    let right = Vec3::Y.cross(away).normalize();
    let up = away.cross(right);
    let tangent = (FOV_Y * 0.5).tan();
    let offsets = || points.iter().map(|point| (point - center).as_vec3());
    let needed = |offset: Vec3| {
        let [across, along] = [offset.dot(right) / inner.aspect, offset.dot(up)].map(|side| side.abs() / tangent);
        across.max(along) + offset.dot(away)
    };
    let distance = offsets().map(needed).fold(f32::MIN_POSITIVE, f32::max) * ROOM;
    let radius = offsets().map(Vec3::length).fold(0.0, f32::max);
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
    use glam::DVec2;
    use shadowfit::{FitInput, FitState, Scratch, Technique};

    use super::*;

    /// Returns four maps far from the world's origin.
    fn fitted() -> Fitted {
        let camera = PerspectiveCamera {
            eye: DVec3::new(1e5, 3.0, -2e4),
            forward: Vec3::new(0.3, -0.2, -0.9),
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 1.6,
            near: 0.1,
            far: 100.0,
        };
        let views = [camera.frustum().expect("a frustum")];
        let mut storage = vec![DVec2::ZERO; Scratch::required(0, 3)];
        let technique = Technique::default();
        let input = FitInput::new(&views, Vec3::new(0.4, -0.7, 0.3).normalize());
        let maps = FitState::new().fit(&input, &technique, &mut Scratch::new(&mut storage)).expect("maps");
        Fitted::new(camera, &technique, &maps)
    }

    #[test]
    fn every_corner_of_every_map_is_in_the_outside_picture() {
        let fitted = fitted();
        assert_eq!(fitted.maps.len(), 4);
        let outside = camera(&fitted.camera.expect("a camera"), &fitted);
        let clip = outside.clip_from_world(shadowfit::DepthConvention::Reversed);
        let ends: Vec<DVec3> = boxes(&fitted).iter().flat_map(|line| line.ends).collect();
        assert_eq!(ends.len(), 4 * 2 * (12 + 12 + 3), "a slice, a box and an arrow for each map");
        for end in ends {
            let point = clip * (end - outside.eye).as_vec3().extend(1.0);
            let ndc = point.truncate() / point.w;
            assert!(point.w > 0.0 && ndc.x.abs() < 1.0 && ndc.y.abs() < 1.0, "{ndc}");
        }
    }

    #[test]
    fn arrows_begin_at_the_face_toward_the_light_and_point_along_it() {
        let fit = fitted().maps[2].projection;
        let depth = |end: DVec3| (end - fit.origin).as_vec3().dot(fit.direction);
        let nearest = fit.corners().iter().map(|corner| corner.dot(fit.direction)).fold(f32::MAX, f32::min);
        let [from, to] = arrow(&fit, Vec4::ONE)[0].ends.map(depth);
        assert!((from - nearest).abs() < 1e-3 && to > from, "{from} to {to}, the face is at {nearest}");
    }
}
