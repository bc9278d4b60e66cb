//! Simulates a shader's look-up on the CPU, for contestants that have matrices but no pictures. Rays along
//! the light find the depths that the maps would hold.
//!
//! The depth of a texel is the depth of the first triangle on a ray through its centre. The simulation leaves out the
//! errors of rasterising and of rounding 32-bit depths, and normals are the normals of triangles.

use std::collections::HashMap;
use std::f64::consts::SQRT_2;

use glam::{DMat4, DVec2, DVec3};
use shadowfit::selection::MapOrder;
use shadowfit_truth::{MapReading, MeasuredMap, Tracer, Truth, TruthPoint};

use super::LightMaps;

/// Greatest number of texels that a filter reads along an axis.
const MAX_TAPS: usize = 6;

/// A map, with depth 1 nearest to the light and depth 0 farthest from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LookupMap {
    /// Clip space from world space.
    pub clip_from_world: DMat4,
    /// Width of a texel, in metres.
    pub texel: f64,
    /// View depth at which the map ends, in metres.
    pub bound: f64,
}

/// Maps and the rules for reading them in a shader.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowLookup {
    /// Maps in the order of their bounds.
    pub maps: Vec<LookupMap>,
    /// Texels across and down each map.
    pub size: u32,
    /// Rule for selecting the map of a point and blending it into the next one.
    pub blend: LookupBlend,
    /// Offset of a point toward the light, in metres.
    pub depth_bias: f64,
    /// Offset of a point along its normal, in diagonals of a texel.
    pub normal_bias: f64,
    /// Offset of a point toward the light by slope.
    pub slope_bias: SlopeBias,
    /// Unit direction toward the light, world axes.
    pub to_light: DVec3,
    /// Filter of the look-up.
    pub filter: LookupFilter,
}

/// An offset toward the light in proportion to the tangent of the angle between the light and a surface's normal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SlopeBias {
    /// Offset at a tangent of 1, in texels.
    pub texels: f64,
    /// Greatest tangent that is used.
    pub max_tangent: f64,
}

impl ShadowLookup {
    /// Returns the share of the light that reaches each pixel, 0..=1; 1 at pixels that are not judged. `extent` is the size
    /// of the scene, in metres.
    pub fn factors(&self, tracer: &Tracer, truth: &Truth, extent: f64) -> Vec<f32> {
        self.factors_at(tracer, truth, extent, |point| point.view_depth)
    }

    /// Returns the same factors. `view_depth` returns the view depth that selects a point's map, in metres.
    pub(super) fn factors_at(
        &self,
        tracer: &Tracer,
        truth: &Truth,
        extent: f64,
        view_depth: impl Fn(&TruthPoint) -> f64,
    ) -> Vec<f32> {
        let mut simulation = Simulation::new(tracer, self, extent);
        let judged = truth.points.iter().map(|point| point.as_ref().filter(|point| point.is_judged));
        let mut factor = |point: &TruthPoint| simulation.factor(point, view_depth(point)) as f32;
        judged.map(|point| point.map_or(1.0, &mut factor)).collect()
    }

    /// Describes the maps as the look-up reads them. They also hold casters before their near plane.
    pub fn light_maps(&self) -> LightMaps {
        let size = DVec2::splat(self.size.into());
        let mut blend_near = f64::INFINITY;
        let measured = self.maps.iter().map(|map| {
            let measured = MeasuredMap::new(&map.clip_from_world, size, map.bound, self.to_light);
            let measured = measured.with_blend_near(blend_near);
            if let LookupBlend::ViewDepth { overlap } = self.blend {
                blend_near = (1.0 - overlap) * map.bound;
            }
            measured
        });
        let maps: Vec<MeasuredMap> = measured.collect();
        let reading = match self.blend {
            LookupBlend::ViewDepth { .. } => MapReading::ViewDepth,
            LookupBlend::Coverage { blend, .. } => {
                // Equal areas keep the order of the maps.
                let order = MapOrder::by_area(maps.iter().map(|_| Some(1.0)));
                MapReading::Coverage { order, blend: blend as f32 }
            }
        };
        LightMaps {
            maps,
            reading,
            filter_radius: self.filter.filter_radius(),
            depth_clamp: true,
            reads_later_maps: false,
        }
    }
}

/// How a point selects among maps, and where two maps are blended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LookupBlend {
    /// By view depth. The last share `overlap` of a bound's view depth is blended into the next map.
    ViewDepth {
        /// Share of the view depth of a bound, 0..=1.
        overlap: f64,
    },
    /// By the finest map that holds the point and the filter around it.
    Coverage {
        /// Radius of the filter, in texels.
        reach: f64,
        /// Texels over which a map is blended into the next one.
        blend: f64,
    },
}

/// A filter with the same weights along both axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LookupFilter {
    /// The four nearest texels, weighted by the hardware.
    Hardware2x2,
    /// 36 texels by nine hardware look-ups: I. Castaño, "Shadow Mapping Summary - Part 1" (2013).
    Castano13,
}

/// Weights of the texels that a filter reads along an axis.
struct AxisTaps {
    /// First of the texels.
    first: i64,
    /// Weights of this texel and the following ones, of sum 1.
    weights: [f64; MAX_TAPS],
}

impl LookupFilter {
    /// Returns the greatest distance per axis, in texels, from the sample point to the centre of a texel of non-zero weight.
    pub fn filter_radius(self) -> f32 {
        match self {
            Self::Hardware2x2 => 1.0,
            Self::Castano13 => 3.0,
        }
    }

    /// Returns the weights of texels around a position, in texels.
    fn taps(self, position: f64) -> AxisTaps {
        match self {
            Self::Hardware2x2 => hardware_2x2(position),
            Self::Castano13 => castano_13(position),
        }
    }
}

fn hardware_2x2(position: f64) -> AxisTaps {
    let (first, share) = ((position - 0.5).floor(), (position - 0.5).rem_euclid(1.0));
    AxisTaps { first: first as i64, weights: [1.0 - share, share, 0.0, 0.0, 0.0, 0.0] }
}

/// Three look-ups along an axis read two texels each.
fn castano_13(position: f64) -> AxisTaps {
    /// Texels between the first one that is read and the corner nearest to the position.
    const BEFORE: f64 = 3.0;
    /// Sum of the weights of the look-ups.
    const SUM: f64 = 12.0;
    let corner = (position + 0.5).floor();
    let s = position + 0.5 - corner;
    let look_ups = [4.0 - 3.0 * s, 7.0, 1.0 + 3.0 * s];
    let offsets = [(3.0 - 2.0 * s) / look_ups[0] - 2.0, (3.0 + s) / look_ups[1], s / look_ups[2] + 2.0];
    let mut weights = [0.0; MAX_TAPS];
    for (weight, offset) in look_ups.into_iter().zip(offsets) {
        // Distance from the centre of the first texel.
        let at = offset - 1.0 + BEFORE;
        let (before, share) = (at.floor() as usize, at.fract());
        weights[before] += weight * (1.0 - share) / SUM;
        weights[before + 1] += weight * share / SUM;
    }
    AxisTaps { first: (corner - BEFORE) as i64, weights }
}

/// Computes the light that reaches points. It caches the traced texels.
struct Simulation<'a> {
    tracer: &'a Tracer,
    lookup: &'a ShadowLookup,
    /// Distance of the ray starts before the maps, in metres: maps also hold casters before their near plane.
    before: f64,
    texels: Vec<MapTexels>,
}

/// The texels of a map that were traced so far.
struct MapTexels {
    world_from_clip: DMat4,
    depths: HashMap<[i64; 2], f64>,
}

impl<'a> Simulation<'a> {
    /// `extent` is the size of the scene, in metres.
    fn new(tracer: &'a Tracer, lookup: &'a ShadowLookup, extent: f64) -> Self {
        let texels =
            |map: &LookupMap| MapTexels { world_from_clip: map.clip_from_world.inverse(), depths: HashMap::new() };
        Self { tracer, lookup, before: 2.0 * extent, texels: lookup.maps.iter().map(texels).collect() }
    }

    /// Returns the share of the light that reaches a point, 0..=1. `view_depth` selects the map, in metres.
    fn factor(&mut self, point: &TruthPoint, view_depth: f64) -> f64 {
        match self.lookup.blend {
            LookupBlend::ViewDepth { overlap } => self.by_view_depth(point, view_depth, overlap),
            LookupBlend::Coverage { reach, blend } => self.by_coverage(point, view_depth, reach, blend),
        }
    }

    fn by_view_depth(&mut self, point: &TruthPoint, view_depth: f64, overlap: f64) -> f64 {
        let maps = &self.lookup.maps;
        let Some(index) = maps.iter().position(|map| view_depth < map.bound) else { return 1.0 };
        let (bound, is_last) = (maps[index].bound, index + 1 == maps.len());
        let here = self.in_map(index, point);
        let blend_from = (1.0 - overlap) * bound;
        if is_last || view_depth < blend_from {
            return here;
        }
        let weight = (view_depth - blend_from) / (bound - blend_from);
        here + (self.in_map(index + 1, point) - here) * weight
    }

    fn by_coverage(&mut self, point: &TruthPoint, view_depth: f64, reach: f64, blend: f64) -> f64 {
        let count = self.lookup.maps.len();
        if self.lookup.maps.first().is_none_or(|map| view_depth >= map.bound) {
            return 1.0;
        }
        let (mut factor, mut rest) = (0.0, 1.0);
        for index in 0..count {
            let Some(ndc) = self.position(index, point) else { continue };
            let room = (1.0 - ndc.truncate().abs().max_element()) * 0.5 * f64::from(self.lookup.size) - reach;
            if room < 0.0 || rest == 0.0 {
                continue;
            }
            let weight = if index + 1 == count { rest } else { rest * (room / blend).min(1.0) };
            factor += weight * self.in_map(index, point);
            rest -= weight;
        }
        factor + rest
    }

    /// Returns the position of a point in the clip space of a map, with its biases; `None` outside.
    fn position(&self, index: usize, point: &TruthPoint) -> Option<DVec3> {
        let (lookup, map) = (self.lookup, &self.lookup.maps[index]);
        let normal_offset = point.normal * (lookup.normal_bias * SQRT_2 * map.texel);
        let tangent = (point.facing.powi(-2) - 1.0).max(0.0).sqrt().min(lookup.slope_bias.max_tangent);
        let by_slope = lookup.slope_bias.texels * tangent * map.texel;
        let at = point.position + normal_offset + lookup.to_light * (lookup.depth_bias + by_slope);
        let ndc = map.clip_from_world.project_point3(at);
        let is_inside = ndc.truncate().abs().max_element() <= 1.0 && (0.0..=1.0).contains(&ndc.z);
        is_inside.then_some(ndc)
    }

    /// Returns the filtered factor of one map; 1 outside.
    fn in_map(&mut self, index: usize, point: &TruthPoint) -> f64 {
        let Some(ndc) = self.position(index, point) else { return 1.0 };
        let texel = (ndc.truncate() * DVec2::new(0.5, -0.5) + 0.5) * f64::from(self.lookup.size);
        let [across, down] = [texel.x, texel.y].map(|position| self.lookup.filter.taps(position));
        let mut sum = 0.0;
        for (y, by_row) in (down.first..).zip(down.weights) {
            for (x, by_column) in (across.first..).zip(across.weights) {
                let weight = by_row * by_column;
                if weight > 0.0 && ndc.z >= self.depth(index, [x, y]) {
                    sum += weight;
                }
            }
        }
        sum
    }

    /// Returns the depth in a texel of a map. A texel outside has the depth of the nearest one.
    fn depth(&mut self, index: usize, texel: [i64; 2]) -> f64 {
        let last = i64::from(self.lookup.size) - 1;
        let texel = texel.map(|number| number.clamp(0, last));
        let (lookup, tracer, before) = (self.lookup, self.tracer, self.before);
        let MapTexels { world_from_clip, depths } = &mut self.texels[index];
        *depths.entry(texel).or_insert_with(|| {
            let [x, y] = texel.map(|number| (number as f64 + 0.5) / f64::from(lookup.size) * 2.0 - 1.0);
            let start = world_from_clip.project_point3(DVec3::new(x, -y, 1.0)) + lookup.to_light * before;
            let hit = tracer.first_hit(start.as_vec3(), -lookup.to_light.as_vec3());
            let depth_of = |distance: f32| {
                let met = start - lookup.to_light * f64::from(distance);
                lookup.maps[index].clip_from_world.project_point3(met).z.clamp(0.0, 1.0)
            };
            hit.map_or(0.0, |hit| depth_of(hit.distance))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_of_a_filter_have_sum_1_and_their_centre_at_the_position() {
        for filter in [LookupFilter::Hardware2x2, LookupFilter::Castano13] {
            for position in [3.0, 3.2, 3.5, 3.75, 3.999, -0.25] {
                let AxisTaps { first, weights } = filter.taps(position);
                let sum: f64 = weights.iter().sum();
                let centre: f64 =
                    weights.iter().zip(first..).map(|(weight, texel)| weight * (texel as f64 + 0.5)).sum();
                assert!((sum - 1.0).abs() < 1e-12 && (centre - position).abs() < 0.26, "{position}: {sum} {centre}");
                let distances = weights.iter().zip(first..).filter(|(weight, _)| **weight > 0.0);
                let farthest = distances.map(|(_, texel)| (texel as f64 + 0.5 - position).abs()).fold(0.0, f64::max);
                assert!(farthest <= f64::from(filter.filter_radius()) + 1e-12, "{filter:?} at {position}: {farthest}");
            }
        }
    }

    #[test]
    fn maps_are_described_as_the_look_up_reads_them() {
        let clip_from_world = DMat4::from_scale(DVec3::splat(0.01));
        let map = |bound: f64| LookupMap { clip_from_world, texel: 0.1, bound };
        let lookup = ShadowLookup {
            maps: vec![map(10.0), map(20.0)],
            size: 512,
            blend: LookupBlend::ViewDepth { overlap: 0.25 },
            depth_bias: 0.0,
            normal_bias: 0.0,
            slope_bias: SlopeBias::default(),
            to_light: DVec3::Z,
            filter: LookupFilter::Castano13,
        };
        let described = lookup.light_maps();
        let depths: Vec<_> = described.maps.iter().map(|map| [map.split_far, map.blend_near]).collect();
        assert_eq!(depths, [[10.0, f64::INFINITY], [20.0, 7.5]]);
        assert_eq!((described.reading, described.filter_radius), (MapReading::ViewDepth, 3.0));
        let blend = LookupBlend::Coverage { reach: 3.0, blend: 8.0 };
        let described = ShadowLookup { blend, ..lookup }.light_maps();
        assert!(matches!(described.reading, MapReading::Coverage { blend: 8.0, .. }), "{:?}", described.reading);
        assert!(described.maps.iter().all(|map| map.blend_near.is_infinite()));
    }
}
