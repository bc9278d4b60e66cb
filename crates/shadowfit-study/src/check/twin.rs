//! CPU twin of `shadowfit-wgpu`'s look-up, in f64, from texels that were read back. It uses the same
//! projection, biases, map selection, comparisons and filters as the WGSL.
//!
//! If rounding could flip a comparison of two depths, both results are allowed, so that a look-up returns a
//! range of factors. A GPU's factor lies in this range, apart from the rounding of the weights.

use core::ops::Range;

use glam::{DVec2, DVec3, Vec3};
use shadowfit::bias::MIN_COSINE;
use shadowfit::selection::{MapOrder, by_coverage};
use shadowfit::settings::FilterKind;
use shadowfit::{DepthConvention, FittedMap};
use shadowfit_wgpu::ShadowMapDescriptor;

use super::numbers::Point;
use super::texels::Texels;

/// Error of texture coordinates and depths, 0..=1. A term of the projection is at most |position| / extent,
/// about 3. The longest chain is 12 operations in f32 (2⁻²⁴ each), and a square root and a division of 2.5
/// ULP by WGSL's rules.
const PROJECTION: f64 = 16.0 * 3.0 / 16_777_216.0;

/// Relative error of a slope's tangent at cosines above [`LEAST_COSINE`]: four roundings of 2⁻²⁴ of the
/// cosine.
const TANGENT: f64 = 4.0 / 16_777_216.0 / LEAST_COSINE;

/// Greatest error of a sine that is computed from an f32 cosine near 1: the root of four roundings of 2⁻²⁴.
const SINE: f64 = 5e-4;

/// Cosine between normal and light below which points are skipped, because their biases magnify rounding.
pub(super) const LEAST_COSINE: f64 = 0.05;

/// Steps in which samplers place a look-up between texels. Direct3D guarantees 8 bits, and drivers for Vulkan
/// and Metal provide them.
const SAMPLER: f64 = 1.0 / 256.0;

/// Distance from the border of a map's reach within which points are skipped, in texels. Rounding decides
/// there which maps they read.
const BORDER: f64 = 0.01;

/// The maps of a frame, as input of the look-up.
pub(super) struct Twin<'a> {
    pub(super) descriptor: &'a ShadowMapDescriptor,
    /// Maps relative to the origin of the points.
    pub(super) maps: &'a [FittedMap],
    /// The depths of each map.
    pub(super) texels: &'a [Texels],
    /// Greatest difference in the rounding of a stored depth between these texels and the GPU's look-up.
    pub(super) precision: f64,
}

/// A point in a map.
struct Projected<'a> {
    texels: &'a Texels,
    size: DVec2,
    /// Position in texels from the left and from the top, and its error.
    at: DVec2,
    at_error: f64,
    /// Depth with its bias, and its error.
    depth: f64,
    depth_error: f64,
    /// Change of the plane's depth per texel along each axis.
    gradient: DVec2,
}

/// One look-up of a filter: its position in texels, and its weight.
type LookUp = (DVec2, f64);

impl Twin<'_> {
    /// Returns the greatest rounding of a factor's weights: a sampler rounds the position of each look-up
    /// along both axes. Point filters have no weights.
    pub(super) fn weight_error(&self) -> f64 {
        if self.descriptor.filter == FilterKind::Point { 1e-6 } else { 2.0 * SAMPLER }
    }

    /// Returns the allowed range of the factor at a point. `None` if rounding decides which maps the point
    /// reads.
    pub(super) fn factor(&self, point: &Point) -> Option<Range<f64>> {
        let position = Vec3::from(point.position).as_dvec3();
        let normal = Vec3::from(point.normal).as_dvec3();
        let reach = f64::from(self.descriptor.softness.filter_radius(self.descriptor.filter));
        let width = self.descriptor.selection.blend();
        let order = MapOrder::new(self.descriptor.selection, self.maps.iter().map(|map| &map.projection));
        let free = |map: usize| {
            let projection = &self.maps[map].projection;
            projection.texels_to_edge(projection.origin + position)
        };
        let is_unsure = |map: usize| {
            let uv = uv(&self.maps[map], position);
            let size = self.maps[map].projection.resolution.as_dvec2();
            let sides = (uv.truncate() * size).min((1.0 - uv.truncate()) * size).min_element();
            let ends = uv.z.abs().min((1.0 - uv.z).abs());
            (sides - reach).abs() < BORDER || sides.abs() < BORDER || ends < PROJECTION
        };
        if order.iter().any(is_unsure) {
            return None;
        }
        let Some(read) = by_coverage(order.iter(), reach, f64::from(width), free) else { return Some(1.0..1.0) };
        let first = self.read(read.map, position, normal);
        let Some(blend) = read.blend else { return Some(first) };
        let second = self.read(blend.map, position, normal);
        // The weight depends on the texels to the border, which are as exact as the position in the map.
        let size = self.maps[read.map].projection.resolution.as_dvec2().max_element();
        let error = PROJECTION * size / f64::from(width);
        let mix = |first: f64, second: f64| first + (second - first) * blend.weight;
        Some(mix(first.start, second.start) - error..mix(first.end, second.end) + error)
    }

    /// Returns the range of a map's factor at a point.
    fn read(&self, map: usize, position: DVec3, normal: DVec3) -> Range<f64> {
        let point = self.project(map, position, normal);
        let FittedMap { projection, .. } = &self.maps[map];
        let mut range = 0.0..0.0;
        for (at, weight) in look_ups(self.descriptor, point.at, projection) {
            let at = at.clamp(DVec2::splat(0.5), point.size - 0.5);
            let depth = (point.depth + point.gradient.dot(at - point.at)).clamp(0.0, 1.0);
            let lit = self.look_up(&point, at, depth);
            range.start += weight * lit.start;
            range.end += weight * lit.end;
        }
        range
    }

    /// Projects a point into a map.
    fn project(&self, map: usize, position: DVec3, normal: DVec3) -> Projected<'_> {
        let FittedMap { projection, bias, .. } = &self.maps[map];
        let size = projection.resolution.as_dvec2();
        let cosine = normal.dot(-projection.direction.as_dvec3()).clamp(f64::from(MIN_COSINE), 1.0);
        let sine = (1.0 - cosine * cosine).sqrt();
        let uv = uv(&self.maps[map], position + normal * f64::from(bias.normal_offset) * sine);
        let range = f64::from(projection.depth_range);
        let is_reversed = projection.depth == DepthConvention::Reversed;
        let away = if is_reversed { -1.0 } else { 1.0 };
        let along = |row: usize| projection.light_from_world.row(row).truncate().as_dvec3().dot(normal);
        let texel = projection.texel_size.as_dvec2();
        let slope = DVec2::new(along(0) * texel.x, -along(1) * texel.y) * (away / (cosine * range));
        let gradient = if bias.receiver_plane == 0.0 { DVec2::ZERO } else { slope };
        let rise = f64::from(bias.receiver_plane) * (gradient.x.abs() + gradient.y.abs());
        let toward_light = f64::from(bias.constant_depth) + f64::from(bias.slope_depth) * sine / cosine + rise;
        let at_error = PROJECTION * size.max_element() + SAMPLER;
        let depth_error = PROJECTION
            + toward_light.abs() * TANGENT
            + f64::from(bias.normal_offset) * SINE / range
            + (gradient.x.abs() + gradient.y.abs()) * at_error
            + self.precision;
        let depth = uv.z - away * toward_light;
        Projected { texels: &self.texels[map], size, at: uv.truncate() * size, at_error, depth, depth_error, gradient }
    }

    /// Returns the range of one look-up: the nearest texel, or the four nearest weighted bilinearly.
    fn look_up(&self, point: &Projected<'_>, at: DVec2, depth: f64) -> Range<f64> {
        if self.descriptor.filter != FilterKind::Point {
            let corner = (at - 0.5).floor();
            let weight = at - 0.5 - corner;
            let mut range = 0.0..0.0;
            for (x, y) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
                let lit = self.compare(point, corner + DVec2::new(x, y), depth);
                let across = if x > 0.0 { weight.x } else { 1.0 - weight.x };
                let share = across * if y > 0.0 { weight.y } else { 1.0 - weight.y };
                range.start += share * lit.start;
                range.end += share * lit.end;
            }
            return range;
        }
        let mut range = 1.0..0.0;
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            let lit = self.compare(point, (at + DVec2::new(x, y) * point.at_error).floor(), depth);
            range = f64::min(range.start, lit.start)..f64::max(range.end, lit.end);
        }
        range
    }

    /// Returns the range of a comparison with a texel. Beyond the border, the border texel repeats.
    fn compare(&self, point: &Projected<'_>, texel: DVec2, depth: f64) -> Range<f64> {
        let [x, y] = texel.clamp(DVec2::ZERO, point.size - 1.0).to_array().map(|side| side as u32);
        let stored = f64::from(point.texels.depths[(y * point.texels.width + x) as usize]);
        let is_reversed = self.descriptor.depth == DepthConvention::Reversed;
        let nearer = if is_reversed { depth - stored } else { stored - depth };
        let is_empty = stored == if is_reversed { 0.0 } else { 1.0 };
        // Depths are clamped to 0..=1, so no point lies behind an empty texel.
        if is_empty || nearer > point.depth_error {
            1.0..1.0
        } else if nearer < -point.depth_error {
            0.0..0.0
        } else {
            0.0..1.0
        }
    }
}

/// Returns texture coordinates and depth of a position relative to the map's origin.
fn uv(map: &FittedMap, position: DVec3) -> DVec3 {
    map.projection.uv_from_world.as_dmat4().transform_point3(position)
}

/// Returns the look-ups of a filter around a position.
fn look_ups(descriptor: &ShadowMapDescriptor, at: DVec2, projection: &shadowfit::LightProjection) -> Vec<LookUp> {
    let taps = match descriptor.filter {
        FilterKind::Point => return vec![(at, 1.0)],
        // A tent's radius in texels is its number of pairs. A tent of one pair is a single look-up.
        tent if !tent.is_soft() => return self::tent(at, tent.filter_radius() as u32),
        FilterKind::Vogel8 => 8,
        FilterKind::Vogel32 => 32,
        _ => 16,
    };
    let radii = descriptor.softness.texels(descriptor.filter, projection).as_dvec2();
    (0..taps).map(|index| (at + radii * in_disc(index, taps), 1.0 / f64::from(taps))).collect()
}

/// Returns a point in the unit disc (H. Vogel, "A better way to construct the sunflower head", 1979).
fn in_disc(index: u32, count: u32) -> DVec2 {
    let golden = core::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    DVec2::from_angle(f64::from(index) * golden) * ((f64::from(index) + 0.5) / f64::from(count)).sqrt()
}

/// Returns the look-ups of a tent filter of `pairs` × `pairs` look-ups. Each lies between two pairs of
/// texels, and its bilinear weights form the tent (after I. Castano, "Shadow mapping summary", 2013).
fn tent(at: DVec2, pairs: u32) -> Vec<LookUp> {
    let [columns, rows] = [0, 1].map(|axis| tent_along(at[axis], pairs));
    let row = |(y, b): (f64, f64)| columns.iter().map(move |(x, a)| (DVec2::new(*x, y), a * b)).collect::<Vec<_>>();
    rows.into_iter().flat_map(row).collect()
}

/// Returns positions and weights of a tent's look-ups along an axis, from its definition: texel i has the sum
/// of the bilinear weights of 2 · pairs - 1 look-ups one texel apart, weighted 1, 2, ..., pairs, ..., 2, 1,
/// and each pair of texels is one look-up.
fn tent_along(at: f64, pairs: u32) -> Vec<(f64, f64)> {
    let base = (at - 0.5).floor();
    let t = at - 0.5 - base;
    let weight = |step: i64| f64::from(pairs) - (step.abs() as f64).min(f64::from(pairs));
    let texel = |step: i64| (1.0 - t) * weight(step) + t * weight(step - 1);
    let first = 1 - i64::from(pairs);
    let sum = f64::from(pairs * pairs);
    (0..i64::from(pairs))
        .map(|pair| {
            let left = first + 2 * pair;
            let [a, b] = [texel(left), texel(left + 1)];
            (base + left as f64 + 0.5 + b / (a + b), (a + b) / sum)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tents_have_the_places_and_weights_of_the_shaders() {
        // As in filter_tent_5x5.wgsl.
        for t in [0.0, 0.25, 0.7] {
            let found = tent_along(7.5 + t, 3);
            let (w0, w2) = (3.0 - 2.0 * t, 1.0 + 2.0 * t);
            let expected =
                [(5.5 + (2.0 - t) / w0, w0 / 9.0), (7.5 + (2.0 + t) / 5.0, 5.0 / 9.0), (9.5 + t / w2, w2 / 9.0)];
            for ((place, weight), (at, share)) in found.iter().zip(expected) {
                assert!((place - at).abs() < 1e-12 && (weight - share).abs() < 1e-12, "{t}: {found:?}");
            }
        }
    }
}
