//! The maps' estimates for the area of a pixel, or for a sun with a radius: the arithmetic of
//! `estimate_area.wgsl`, `estimate_sun.wgsl` and their look-ups, on the texels of the maps.

use shadowfit::glam::{Vec2, Vec3};
use shadowfit::settings::FilterKind;
use shadowfit_wgpu::uniforms::MapUniform;

use super::{Projected, Surface, Twin, texture_place};

// Constants of the WGSL.
const AREA: u32 = 4;
const DISC: u32 = 32;
const SEARCH: u32 = 20;
const SEARCH_START: f32 = 0.5;
const SEARCH_BESIDE: f32 = 0.5;
/// Cosine and sine of the golden angle.
const GOLDEN: Vec2 = Vec2::new(-0.737_368_9, 0.675_490_3);

/// A map that is read for the rays of a pixel.
pub(super) struct Estimate<'a> {
    map: &'a MapUniform,
    projected: Projected,
    /// Texels per step across and down: per pixel, or per sun radius at the casters.
    steps: [Vec2; 2],
    is_sun: bool,
}

impl Twin {
    /// Returns the map's estimate, or `None` if the factor comes from rays alone. `across` contains
    /// directions across the light, rotated for the pixel, for suns with a radius.
    pub(super) fn estimate_of(&self, surface: &Surface, across: [Vec3; 2], turn: f32) -> Option<Estimate<'_>> {
        let first = usize::try_from(self.choose(surface.position).first).ok()?;
        let map = &self.receiver.maps[first];
        let projected = self.project(map, surface.position, surface.normal);
        if !self.descriptor.filter.is_soft() {
            let steps = self.texels_per_pixel(map, surface);
            return (self.points.len() > 1).then_some(Estimate { map, projected, steps, is_sun: false });
        }
        let distance = self.mean_caster(map, &projected, turn)?;
        let toward_light = texture_place(map, Vec3::from(self.receiver.to_light).extend(0.0)).z;
        let radius = -distance / toward_light * self.sun_tangent();
        let steps =
            across.map(|axis| texture_place(map, (axis * radius).extend(0.0)).truncate() * Vec2::from(map.size));
        Some(Estimate { map, projected, steps, is_sun: true })
    }

    /// Returns the estimate for the ray from a position in the pixel, in pixels from its first sample, to a
    /// position in the sun, in radii.
    pub(super) fn estimate_at(&self, Estimate { map, projected, steps, is_sun }: &Estimate<'_>, ray: [Vec2; 2]) -> f32 {
        let place = ray[usize::from(*is_sun)];
        self.look_up(map, projected, projected.texel + steps[0] * place.x + steps[1] * place.y)
    }

    /// Returns the estimate for the whole pixel, or the whole sun.
    pub(super) fn estimate_whole(&self, estimate: &Estimate<'_>) -> f32 {
        let in_pixel = |index: u32| {
            let place = (Vec2::new((index % AREA) as f32, (index / AREA) as f32) + 0.5) / AREA as f32 - 0.5;
            [place - self.place(0), Vec2::ZERO]
        };
        let in_sun = |index: u32| [Vec2::ZERO, super::rays::in_disc(index, DISC)];
        let rays: Vec<[Vec2; 2]> =
            if estimate.is_sun { (0..DISC).map(in_sun).collect() } else { (0..AREA * AREA).map(in_pixel).collect() };
        rays.iter().map(|ray| self.estimate_at(estimate, *ray)).sum::<f32>() / rays.len() as f32
    }

    /// Returns the mean distance to the casters between a point and the sun's disc, in units of the stored
    /// depth and with its sign.
    fn mean_caster(&self, map: &MapUniform, p: &Projected, turn: f32) -> Option<f32> {
        let disc = Vec2::from(map.disc);
        let start = (SEARCH_START / disc.max_element()).min(1.0);
        let growth = (1.0 / start).powf(1.0 / SEARCH as f32);
        let mut radius = start * growth.sqrt();
        let mut direction = Vec2::new(turn.cos(), turn.sin());
        let (mut sum, mut count) = (0.0, 0.0);
        for _ in 0..SEARCH {
            let at = (p.texel + disc * radius * direction).floor();
            let texel = at.clamp(Vec2::ZERO, Vec2::from(map.size) - 1.0);
            let offset = texel + 0.5 - p.texel;
            let stored = self.stored_at(map, texel);
            let distance = p.surface - stored;
            let cone = (distance * Vec2::from(map.penumbra)).max(Vec2::splat(self.receiver.least_disc));
            let is_within = (offset / (cone + SEARCH_BESIDE)).length_squared() <= 1.0;
            let depth = p.depth + (p.gradient.x * offset.x + p.gradient.y * offset.y);
            if is_within && !self.is_nearer(depth.clamp(0.0, 1.0), stored) {
                (sum, count) = (sum + distance, count + 1.0);
            }
            radius *= growth;
            direction = GOLDEN.rotate(direction);
        }
        (count > 0.0).then(|| sum / count)
    }

    /// Compares the four texels around a position in a map, and weights them bilinearly. With
    /// [`FilterKind::Point`] it compares the nearest texel.
    fn look_up(&self, map: &MapUniform, p: &Projected, at: Vec2) -> f32 {
        let last = Vec2::from(map.size) - 1.0;
        let inside = at.clamp(Vec2::splat(0.5), last + 0.5);
        let along = p.gradient * (inside - p.texel);
        let depth = (p.depth + along.x + along.y).clamp(0.0, 1.0);
        let is_lit = |texel: Vec2| f32::from(u8::from(self.is_nearer(depth, self.stored_at(map, texel.min(last)))));
        if self.descriptor.filter == FilterKind::Point {
            return is_lit(inside.floor());
        }
        let corner = (inside - 0.5).floor();
        let weight = inside - 0.5 - corner;
        let row = |y: f32| {
            let [left, right] = [0.0, 1.0].map(|x| is_lit(corner + Vec2::new(x, y)));
            left * (1.0 - weight.x) + right * weight.x
        };
        row(0.0) * (1.0 - weight.y) + row(1.0) * weight.y
    }
}
