//! The scene from the light's direction: the texel size that the picture needs, cell by cell, and the maps
//! over it.

use glam::{DVec3, Vec2, Vec3, Vec4};
use shadowfit::demand::{DemandGrid, LEVELS, SIDE};
use shadowfit::{Aabb, DepthConvention, LightProjection, PerspectiveCamera};
use shadowfit_params::figures::{linear_color, linear_map_tints, pixels_per_texel_color};
use shadowfit_render::{Line, Quad, box_lines};

use super::fitted::Fitted;

/// Field of view of the camera in the light's place, in radians: so narrow that its rays are nearly parallel,
/// like the light.
const FOV_Y: f32 = 0.01;
/// Size of the visible area relative to the map that fills the picture.
const ROOM: f32 = 1.25;
/// Strength of the colour over a cell.
const FILL: f32 = 0.8;
/// Darkening of the scene under the cells.
const SHADE: f32 = 0.6;
/// Least share of all counted points in a cell that is shown.
const LEAST_SHARE: f32 = 2e-4;

/// A camera in the light's direction, so far away that its rays are nearly parallel.
#[derive(Clone, Copy, Debug)]
pub(super) struct FromLight {
    pub(super) camera: PerspectiveCamera,
    size: [f32; 2],
}

impl FromLight {
    /// Makes a camera for a map and its surroundings: the map of index `shown`, or the last one for 0. `None`
    /// if nothing was fitted.
    pub(super) fn new(fitted: &Fitted, shown: usize, bounds: Aabb, size: [u32; 2]) -> Option<Self> {
        let map = if shown == 0 { fitted.maps.len().checked_sub(1)? } else { shown };
        let fit = fitted.maps.get(map)?.projection;
        let corners = fit.corners();
        let middle = fit.origin + (corners.iter().sum::<Vec3>() / 8.0).as_dvec3();
        let rows = fit.light_from_world.transpose();
        let [right, up] = [rows.x_axis, rows.y_axis].map(Vec4::truncate);
        let reach = |axis: Vec3| {
            let along = |corner: &Vec3| (*corner - (middle - fit.origin).as_vec3()).dot(axis).abs();
            corners.iter().map(along).fold(f32::MIN_POSITIVE, f32::max)
        };
        let aspect = size[0] as f32 / size[1] as f32;
        let half = reach(up).max(reach(right) / aspect) * ROOM;
        let distance = half / (FOV_Y * 0.5).tan();
        // The whole scene lies between the planes.
        let depth = (bounds.max - bounds.min).length() + corners.iter().map(|c| c.length()).fold(0.0, f32::max) * 2.0;
        let camera = PerspectiveCamera {
            eye: middle - (fit.direction * distance).as_dvec3(),
            forward: fit.direction,
            up,
            fov_y: FOV_Y,
            aspect,
            near: (distance - depth).max(distance * 0.01),
            far: distance + depth,
        };
        Some(Self { camera, size: size.map(|side| side as f32) })
    }

    /// Returns the pixel position of a world position in the picture.
    fn pixel(&self, point: DVec3) -> Vec2 {
        let clip = self.camera.clip_from_world(DepthConvention::Reversed);
        let at = clip * (point - self.camera.eye).as_vec3().extend(1.0);
        let [x, y] = [at.x / at.w, at.y / at.w];
        Vec2::new((x * 0.5 + 0.5) * self.size[0], (0.5 - y * 0.5) * self.size[1])
    }
}

/// Returns the cells of the grid, coarse ones first, in the colour of the pixels per texel there with the
/// finest map that covers the cell.
pub(super) fn quads(from_light: &FromLight, fitted: &Fitted, demand: Option<DemandGrid<'_>>) -> Vec<Quad> {
    let Some(demand) = demand else { return Vec::new() };
    let space = demand.space;
    let total: u32 = demand.counts.iter().sum();
    let least = (total as f32 * LEAST_SHARE).max(1.0);
    let up = space.y / space.y.length_squared();
    let [width, height] = from_light.size;
    let mut quads = vec![Quad::rectangle([0.0, 0.0, width, height], Vec4::new(0.0, 0.0, 0.0, SHADE))];
    for level in (0..LEVELS).rev() {
        let side = space.cell * (1_u32 << level) as f32;
        let texel = space.texel * (1_u32 << level) as f32 * core::f32::consts::SQRT_2;
        for cell in 0..SIDE * SIDE {
            if (demand.counts[level * SIDE * SIDE + cell] as f32) < least {
                continue;
            }
            let corner = |x: usize, y: usize| {
                let [x, y] = [cell % SIDE + x, cell / SIDE + y].map(|at| (at as f32 - (SIDE / 2) as f32) * side);
                space.origin + (space.x * x + up * y).as_dvec3()
            };
            let corners = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
            let middle = corners.iter().sum::<DVec3>() / 4.0;
            let Some(map) = finest(fitted, middle) else { continue };
            let color = linear_color(pixels_per_texel_color(map.texel_size.max_element() / texel));
            quads.push(Quad { corners: corners.map(|corner| from_light.pixel(corner)), color: color.extend(FILL) });
        }
    }
    quads
}

/// Returns the map with the smallest texels that covers a place across the light.
fn finest(fitted: &Fitted, place: DVec3) -> Option<&LightProjection> {
    let holds = |fit: &&LightProjection| {
        let uv = fit.uv_from_world.transform_point3((place - fit.origin).as_vec3());
        (0.0..=1.0).contains(&uv.x) && (0.0..=1.0).contains(&uv.y)
    };
    let area = |fit: &LightProjection| fit.texel_size.x * fit.texel_size.y;
    fitted.maps.iter().map(|map| &map.projection).filter(holds).min_by(|a, b| area(a).total_cmp(&area(b)))
}

/// Returns the boxes of the maps in their tints, and the camera's frustum in white.
pub(super) fn lines(fitted: &Fitted) -> Vec<Line> {
    let tinted = fitted.maps.iter().zip(linear_map_tints());
    let mut lines: Vec<Line> = tinted
        .flat_map(|(map, tint)| box_lines(map.projection.origin, &map.projection.corners(), tint.extend(1.0)))
        .collect();
    if let Some(frustum) = fitted.frustum() {
        lines.extend(box_lines(frustum.origin, &frustum.corners, Vec4::ONE));
    }
    lines
}
