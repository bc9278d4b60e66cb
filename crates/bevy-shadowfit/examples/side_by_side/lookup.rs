//! What Bevy's shader finds at a point, simulated on the CPU: rays along the light in place of the depths in its maps.
//!
//! It follows `shadows.wesl` and `shadow_sampling.wesl` of `bevy_pbr` 0.20: the cascade by view depth, the offset along
//! the normal and toward the light, the blend over the overlap of two cascades, and the filter, which is that of
//! I. Castaño, "Shadow Mapping Summary - Part 1" (2013). The depth in a texel is that of the first triangle on a ray
//! through its centre. What rasterising and the rounding of 32-bit depths change is not simulated, and normals are those
//! of triangles: the example `report` measures the pictures that Bevy draws.

use std::collections::HashMap;

use shadowfit::glam::{DMat4, DVec2, DVec3};
use shadowfit_truth::{Tracer, TruthPoint};

/// Texels across and down that the filter reads.
const FILTER_TEXELS: usize = 6;
/// Texels before the one that holds the point's corner, from which on the filter reads.
const FILTER_BEFORE: i64 = 3;
/// Greatest distance from a point to the centre of a texel that is read, along an axis, in texels.
pub(crate) const REACH: f64 = 3.0;
/// Texels over which a window is blended into the next one.
pub(crate) const BLEND: f64 = 8.0;
/// Sum of the filter's weights along an axis.
const FILTER_SUM: f64 = 12.0;
/// Bevy's normal bias is a number of texels' diagonals.
const NORMAL_BIAS_UNIT: f64 = std::f64::consts::SQRT_2;

/// A cascade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShadowMap {
    /// Depth 1 is nearest to the light, 0 farthest from it.
    pub(crate) clip_from_world: DMat4,
    /// Width of a texel, in metres.
    pub(crate) texel: f64,
    /// View depth at which it ends, in metres.
    pub(crate) bound: f64,
}

/// The maps of a light in a view, and how they are read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LightMaps {
    /// In the order of their bounds.
    pub(crate) maps: Vec<ShadowMap>,
    /// Texels across and down each map.
    pub(crate) size: u32,
    /// Share of the view depth of a bound over which a cascade is blended into the next one.
    pub(crate) overlap: f64,
    /// Toward the light, in metres.
    pub(crate) depth_bias: f64,
    /// Along the normal, in diagonals of a texel.
    pub(crate) normal_bias: f64,
    /// Unit direction toward the light, world axes.
    pub(crate) to_light: DVec3,
}

impl LightMaps {
    /// Whether they are windows, which all end where shadows do.
    pub(crate) fn has_windows(&self) -> bool {
        self.maps.len() > 1 && self.maps.iter().all(|map| map.bound == self.maps[0].bound)
    }
}

/// Finds the light that arrives at points, and remembers the texels that it has traced.
pub(crate) struct Lookup<'a> {
    tracer: &'a Tracer,
    light: &'a LightMaps,
    /// Distance by which rays start before the maps, in metres: maps also hold what lies before their near plane.
    before: f64,
    /// World from clip and the depths of texels, of each map.
    texels: Vec<(DMat4, HashMap<[i64; 2], f64>)>,
}

impl<'a> Lookup<'a> {
    /// `extent` is the size of the scene, in metres.
    pub(crate) fn new(tracer: &'a Tracer, light: &'a LightMaps, extent: f64) -> Self {
        let texels = light.maps.iter().map(|map| (map.clip_from_world.inverse(), HashMap::new())).collect();
        Self { tracer, light, before: 2.0 * extent, texels }
    }

    /// Share of the light that arrives, 0..=1: `fetch_directional_shadow`.
    pub(crate) fn factor(&mut self, point: &TruthPoint) -> f64 {
        if self.light.has_windows() {
            return self.by_coverage(point);
        }
        let maps = &self.light.maps;
        let Some(index) = maps.iter().position(|map| point.view_depth < map.bound) else { return 1.0 };
        let here = self.cascade(index, point);
        let bound = maps[index].bound;
        let blend_from = (1.0 - self.light.overlap) * bound;
        if index + 1 == maps.len() || point.view_depth < blend_from {
            return here;
        }
        let weight = (point.view_depth - blend_from) / (bound - blend_from);
        here + (self.cascade(index + 1, point) - here) * weight
    }

    /// The same of windows: `shadowfit_fetch`, which the plugin adds to Bevy's shader.
    fn by_coverage(&mut self, point: &TruthPoint) -> f64 {
        let maps = &self.light.maps;
        let count = maps.len();
        if point.view_depth >= maps[0].bound {
            return 1.0;
        }
        let (mut factor, mut rest) = (0.0, 1.0);
        for index in 0..count {
            let Some(ndc) = self.position(index, point) else { continue };
            let room = (1.0 - ndc.truncate().abs().max_element()) * 0.5 * f64::from(self.light.size) - REACH;
            if room < 0.0 || rest == 0.0 {
                continue;
            }
            let weight = if index + 1 == count { rest } else { rest * (room / BLEND).min(1.0) };
            factor += weight * self.cascade(index, point);
            rest -= weight;
        }
        factor + rest
    }

    /// Where one of the cascades is read for a point, in its clip space; `None` outside.
    fn position(&self, index: usize, point: &TruthPoint) -> Option<DVec3> {
        let (light, map) = (self.light, &self.light.maps[index]);
        let normal_offset = point.normal * (light.normal_bias * NORMAL_BIAS_UNIT * map.texel);
        let at = point.position + normal_offset + light.to_light * light.depth_bias;
        let ndc = map.clip_from_world.project_point3(at);
        let is_inside = ndc.truncate().abs().max_element() <= 1.0 && (0.0..=1.0).contains(&ndc.z);
        is_inside.then_some(ndc)
    }

    /// The same by one of the cascades: `sample_directional_cascade`.
    fn cascade(&mut self, index: usize, point: &TruthPoint) -> f64 {
        let light = self.light;
        let Some(ndc) = self.position(index, point) else { return 1.0 };
        let texel = (ndc.truncate() * DVec2::new(0.5, -0.5) + 0.5) * f64::from(light.size);
        let [across, down] = [texel.x, texel.y].map(filter);
        let mut sum = 0.0;
        for (y, by_row) in (down.0..).zip(down.1) {
            for (x, by_column) in (across.0..).zip(across.1) {
                let weight = by_row * by_column;
                if weight > 0.0 && ndc.z >= self.depth(index, [x, y]) {
                    sum += weight;
                }
            }
        }
        sum / (FILTER_SUM * FILTER_SUM)
    }

    /// The depth in a texel of a map; that of the nearest texel for one beside it.
    fn depth(&mut self, index: usize, texel: [i64; 2]) -> f64 {
        let last = i64::from(self.light.size) - 1;
        let texel = texel.map(|number| number.clamp(0, last));
        let (light, tracer, before) = (self.light, self.tracer, self.before);
        let (world_from_clip, depths) = &mut self.texels[index];
        *depths.entry(texel).or_insert_with(|| {
            let [x, y] = texel.map(|number| (number as f64 + 0.5) / f64::from(light.size) * 2.0 - 1.0);
            let start = world_from_clip.project_point3(DVec3::new(x, -y, 1.0)) + light.to_light * before;
            let hit = tracer.first_hit(start.as_vec3(), -light.to_light.as_vec3());
            let depth_of = |distance: f32| {
                let met = start - light.to_light * f64::from(distance);
                light.maps[index].clip_from_world.project_point3(met).z.clamp(0.0, 1.0)
            };
            hit.map_or(0.0, |hit| depth_of(hit.distance))
        })
    }
}

/// The first of the texels that the filter reads along an axis for a position, in texels, and their weights:
/// `sample_shadow_map_castano_thirteen`. Each of three look-ups reads two texels.
fn filter(position: f64) -> (i64, [f64; FILTER_TEXELS]) {
    let corner = (position + 0.5).floor();
    let s = position + 0.5 - corner;
    let weights = [4.0 - 3.0 * s, 7.0, 1.0 + 3.0 * s];
    let offsets = [(3.0 - 2.0 * s) / weights[0] - 2.0, (3.0 + s) / weights[1], s / weights[2] + 2.0];
    let first = corner as i64 - FILTER_BEFORE;
    let mut texels = [0.0; FILTER_TEXELS];
    for (weight, offset) in weights.into_iter().zip(offsets) {
        // Distance from the centre of the first texel.
        let at = offset - 1.0 + FILTER_BEFORE as f64;
        let (before, share) = (at.floor() as usize, at.fract());
        texels[before] += weight * (1.0 - share);
        texels[before + 1] += weight * share;
    }
    (first, texels)
}
