//! CPU version of the compute pass over a depth buffer, in plain Rust and f64. Positions come from the
//! inverse of the matrix, the surface's plane from differences of depths, and cells and bins from the core.
//! Device checks compare the pass with it. It can also count for devices without compute shaders.

use shadowfit::demand::{PIXELS, VisibleDemand, needed_texel};
use shadowfit::glam::{DMat4, DVec3, DVec4};

use super::error::DemandPassError;
use super::view::DemandView;
use crate::pixels::check_rectangle;

/// Share of a pixel's width over which derivatives are measured.
const SHARE: f64 = 1e-3;

/// Values of a depth texture with one sample per pixel, read back from the GPU.
#[derive(Clone, Debug, PartialEq)]
pub struct Depths {
    /// Width of the texture, in pixels.
    pub width: u32,
    /// Depth of each pixel, rows from the top.
    pub values: Vec<f32>,
}

/// A view whose pixels are converted to points.
struct Picture<'a> {
    view: &'a DemandView,
    depths: &'a Depths,
    world_from_clip: DMat4,
}

/// Counts the visible points of a depth buffer on the CPU, as [`DemandPass`](super::DemandPass) does on the
/// GPU. The results differ only for points that rounding moves into a neighbouring cell or bin.
///
/// # Errors
///
/// [`DemandPassError::DepthBuffer`] for a rectangle outside the depths, and [`DemandPassError::Fit`] for an
/// invalid view or light.
pub fn count_on_cpu(view: &DemandView, depths: &Depths) -> Result<VisibleDemand, DemandPassError> {
    let texture = [depths.width, (depths.values.len() as u32).checked_div(depths.width).unwrap_or(0)];
    check_rectangle(view.rectangle, texture)?;
    let picture = Picture { view, depths, world_from_clip: view.clip_from_world.as_dmat4().inverse() };
    let mut seen = VisibleDemand::new(view.space()?);
    let [_, _, width, height] = view.rectangle;
    let step = view.step();
    for y in (step / 2..height).step_by(step as usize) {
        for x in (step / 2..width).step_by(step as usize) {
            picture.count(x.cast_signed(), y.cast_signed(), &mut seen);
        }
    }
    Ok(seen)
}

impl Picture<'_> {
    fn count(&self, x: i32, y: i32, seen: &mut VisibleDemand) {
        let Some([position, right, down]) = self.point(x, y) else { return };
        let (frustum, far) = (&self.view.frustum, self.view.frustum.far.min(self.view.max_distance));
        let forward = frustum.forward.as_dvec3();
        let depth = forward.dot(position - frustum.corners[0].as_dvec3()) + f64::from(frustum.near);
        if depth >= f64::from(far) {
            return;
        }
        let normal = right.cross(down).normalize();
        let normal = if normal.dot(self.ray(x, y)) > 0.0 { -normal } else { normal };
        let space = seen.space().demand;
        if normal.dot(space.direction.as_dvec3()) < 0.0 {
            let texel = needed_texel(right.as_vec3(), down.as_vec3(), space.direction);
            let class = (self.pixel_width(x, y, depth) / f64::from(texel)).log2() as f32;
            // Views that begin behind the eye have no histogram.
            seen.count_depth(depth as f32, class);
        }
        if let Some(index) = space.index(position.as_vec3(), normal.as_vec3(), right.as_vec3(), down.as_vec3()) {
            seen.count_cell(index);
        }
    }

    /// Returns the position of a pixel's point relative to the eye, and the movement of that point along its
    /// surface for one pixel right and one pixel down, in metres. Pixels have the size that they would have
    /// if the frustum were [`PIXELS`] high, so that the counts do not depend on the resolution.
    fn point(&self, x: i32, y: i32) -> Option<[DVec3; 3]> {
        let depth = self.depth(x, y)?;
        let [across, along] = [(1, 0), (0, 1)].map(|(i, j)| {
            let next = self.depth(x + i, y + j).map(|next| next - depth);
            let previous = self.depth(x - i, y - j).map(|previous| depth - previous);
            [next, previous].into_iter().flatten().min_by(|a, b| a.abs().total_cmp(&b.abs()))
        });
        let (x, y) = (f64::from(x), f64::from(y));
        let shown = f64::from(self.view.frustum.height_in_picture(&self.view.clip_from_world));
        let scale = f64::from(self.view.rectangle[3]) * shown / f64::from(PIXELS) / (2.0 * SHARE);
        let moved = |i: f64, j: f64, change: f64| {
            let at = |share: f64| self.unproject(x + share * i, y + share * j, depth + share * change);
            (at(SHARE) - at(-SHARE)) * scale
        };
        Some([self.unproject(x, y, depth), moved(1.0, 0.0, across?), moved(0.0, 1.0, along?)])
    }

    /// Returns the depth of a pixel, or `None` where nothing is drawn and outside the view.
    fn depth(&self, x: i32, y: i32) -> Option<f64> {
        let [left, top, width, height] = self.view.rectangle;
        let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y)) else { return None };
        let is_inside = x < width && y < height;
        let depth = is_inside.then(|| self.depths.values[((top + y) * self.depths.width + left + x) as usize])?;
        (depth != self.view.depth.far()).then_some(f64::from(depth))
    }

    fn unproject(&self, x: f64, y: f64, depth: f64) -> DVec3 {
        let [_, _, width, height] = self.view.rectangle.map(f64::from);
        self.world_from_clip.project_point3(DVec3::new(
            (x + 0.5) / width * 2.0 - 1.0,
            1.0 - (y + 0.5) / height * 2.0,
            depth,
        ))
    }

    /// Returns the viewing direction through a pixel, away from the eye.
    fn ray(&self, x: i32, y: i32) -> DVec3 {
        let at = |depth: f64| self.unproject(f64::from(x), f64::from(y), depth);
        let ray = at(0.6) - at(0.4);
        if ray.dot(self.view.frustum.forward.as_dvec3()) < 0.0 { -ray } else { ray }
    }

    /// Returns the width of a pixel on a surface that faces the eye at a view depth, in metres. The pixel has
    /// the size that it would have if the frustum were [`PIXELS`] high.
    fn pixel_width(&self, x: i32, y: i32, depth: f64) -> f64 {
        let frustum = &self.view.frustum;
        let forward = frustum.forward.as_dvec3();
        let offset = f64::from(frustum.near) - forward.dot(frustum.corners[0].as_dvec3());
        let [_, _, width, height] = self.view.rectangle.map(f64::from);
        let at = |row: f64| {
            let (x, y) = ((f64::from(x) + 0.5) / width * 2.0 - 1.0, 1.0 - row / height * 2.0);
            let [a, b] = [0.0, 1.0].map(|z| self.world_from_clip * DVec4::new(x, y, z, 1.0));
            // Along the ray w · view depth is linear, like all homogeneous coordinates.
            let [of_a, of_b] = [a, b].map(|p| forward.dot(p.truncate()) + (offset - depth) * p.w);
            (a.truncate() * of_b - b.truncate() * of_a) / (a.w * of_b - b.w * of_a)
        };
        let shown = f64::from(self.view.frustum.height_in_picture(&self.view.clip_from_world));
        at(f64::from(y)).distance(at(f64::from(y) + 1.0)) * height * shown / f64::from(PIXELS)
    }
}
