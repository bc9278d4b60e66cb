//! The look-up of a point in its map: its position, the compared depth, and the depths that rays find in the
//! texels around it.
//!
//! ```text
//!   near plane ──────┬───────┬───────┬─────  depths are metres from here, along the light
//!                    │       │       │
//!                    │ tap   │   ░░░░░░░░░  stored: what a ray through the texel's centre meets first
//!                    ▼       ▼
//!   compared  · · · · · · ·╳· · · · · · · ·  the point's depth less the bias
//!   surface  ───────────────●──────────────
//! ```

use glam::{DVec2, DVec3};
use shadowfit::bias::MIN_COSINE;
use shadowfit::{DepthConvention, FittedMap, LightProjection};
use shadowfit_truth::{MeasuredMap, Tracer, TruthPoint};
use shadowfit_wgpu::ShadowMapDescriptor;

use super::StoredTexels;

/// Distance before the near plane at which rays start to look for casters with clamped depth, in metres.
/// Scenes with exact rays are never larger.
const BEFORE_NEAR: f64 = 1e4;
/// Greatest reach of the filter that is followed, in texels along each axis.
const MOST_TEXELS: f64 = 32.0;

/// A point's look-up in a map. Positions are relative to the origin of the rays, in metres. Depths are in
/// metres from the near plane along the light.
pub(super) struct LookUp<'a> {
    pub(super) fit: &'a LightProjection,
    /// Position of the look-up, in texels from the left and from the top.
    pub(super) texel: DVec2,
    /// Depth of the point itself.
    pub(super) surface: f64,
    /// Compared depth.
    pub(super) compared: f64,
    /// Offset of the look-up along the normal.
    pub(super) offset: f64,
    /// Change of the compared depth for a texel to the right and for a texel down.
    slope: DVec2,
    /// Position of the look-up on the near plane, and the steps from there for a texel to the right and for a
    /// texel down.
    near: DVec3,
    steps: [DVec3; 2],
    /// Reach of the filter, in texels along each axis.
    reach: f64,
    depth_clamp: bool,
}

/// A texel that the filter reads.
#[derive(Clone, Copy)]
pub(super) struct Tap {
    /// Offset of the texel's centre from the look-up, in texels to the right and down.
    pub(super) away: DVec2,
    /// Stored depth; `None` if the texel is empty.
    pub(super) stored: Option<f64>,
    /// Triangle stored in the texel, if rays find it.
    pub(super) triangle: Option<u32>,
    /// Depth that is compared with the stored one.
    pub(super) compared: f64,
}

impl Tap {
    /// Returns whether the comparison results in shadow.
    pub(super) fn is_dark(&self) -> bool {
        self.stored.is_some_and(|stored| stored < self.compared)
    }
}

impl<'a> LookUp<'a> {
    /// Computes the look-up. `None` if the bias is invalid on the point's plane.
    pub(super) fn new(
        map: &'a FittedMap,
        measured: &MeasuredMap,
        descriptor: &ShadowMapDescriptor,
        point: &TruthPoint,
    ) -> Option<Self> {
        let fit = &map.projection;
        let plane = map.bias.on_plane(fit, point.normal.as_vec3()).ok()?;
        let (offset, range) = (f64::from(plane.offset), f64::from(fit.depth_range));
        let looked_up = measured.project(point.position + point.normal * offset);
        let [x, y, z] = [0, 1, 2].map(|row| fit.light_from_world.row(row).truncate().as_dvec3());
        let steps = [x * f64::from(fit.texel_size.x), -y * f64::from(fit.texel_size.y)];
        let depth = looked_up.depth * range;
        let cosine = point.normal.dot(z).max(f64::from(MIN_COSINE));
        let has_slope = map.bias.receiver_plane != 0.0;
        let slope = DVec2::new(point.normal.dot(steps[0]), point.normal.dot(steps[1])) / cosine;
        Some(Self {
            fit,
            texel: looked_up.texel,
            surface: measured.project(point.position).depth * range,
            compared: depth - f64::from(plane.depth) * range,
            offset,
            slope: if has_slope { slope } else { DVec2::ZERO },
            near: point.position + point.normal * offset + z * depth,
            steps,
            reach: f64::from(descriptor.softness.filter_radius_in(descriptor.filter, fit).per_axis()).min(MOST_TEXELS),
            depth_clamp: descriptor.depth_clamp,
        })
    }

    /// Returns the distance by which the bias moves the comparison toward the light, in metres.
    pub(super) fn bias(&self) -> f64 {
        self.surface - self.compared
    }

    /// Returns the longer side of a texel, in metres.
    pub(super) fn texel_width(&self) -> f64 {
        f64::from(self.fit.texel_size.max_element())
    }

    /// Returns the texel that contains the look-up, with its depth, read back or found by rays.
    pub(super) fn centre(&self, tracer: &Tracer, stored: Option<&StoredTexels>) -> Tap {
        self.tap(tracer, stored, self.texel.floor())
    }

    /// Returns all texels whose centres lie within the filter's reach.
    pub(super) fn taps(&self, tracer: &Tracer, stored: Option<&StoredTexels>) -> Vec<Tap> {
        let first = (self.texel - self.reach - 0.5).ceil().max(DVec2::ZERO);
        let last = (self.texel + self.reach - 0.5).floor().min(self.fit.resolution.as_dvec2() - 1.0);
        let [width, height] = (last - first + 1.0).max(DVec2::ZERO).to_array().map(|side| side as u32);
        let texel = |index: u32| first + DVec2::new(f64::from(index % width), f64::from(index / width));
        (0..width * height).map(|index| self.tap(tracer, stored, texel(index))).collect()
    }

    fn tap(&self, tracer: &Tracer, stored: Option<&StoredTexels>, texel: DVec2) -> Tap {
        let away = texel + 0.5 - self.texel;
        let found = self.met(tracer, away);
        let read = stored.and_then(|stored| stored.depth(texel)).map(|depth| self.metres(depth));
        // A depth at the far plane means an empty texel.
        let is_something = |metres: &f64| *metres < f64::from(self.fit.depth_range) * (1.0 - f64::from(f32::EPSILON));
        Tap {
            away,
            stored: read.map_or(found.map(|found| found.0), |read| Some(read).filter(is_something)),
            triangle: found.map(|found| found.1),
            compared: self.compared + self.slope.dot(away),
        }
    }

    /// Returns depth and triangle of the first hit of a ray along the light.
    fn met(&self, tracer: &Tracer, away: DVec2) -> Option<(f64, u32)> {
        let before = if self.depth_clamp { BEFORE_NEAR } else { 0.0 };
        let direction = self.fit.direction.as_dvec3();
        let origin = self.near + self.steps[0] * away.x + self.steps[1] * away.y - direction * before;
        let hit = tracer.first_hit(origin.as_vec3(), direction.as_vec3())?;
        let depth = (f64::from(hit.distance) - before).max(0.0);
        (depth <= f64::from(self.fit.depth_range)).then_some((depth, hit.triangle))
    }

    /// Converts a stored depth to metres from the near plane.
    fn metres(&self, depth: f32) -> f64 {
        let from_near = if self.fit.depth == DepthConvention::Reversed { 1.0 - depth } else { depth };
        f64::from(from_near) * f64::from(self.fit.depth_range)
    }

    /// Converts metres from the near plane to a stored depth; `None` to the depth of a cleared map.
    pub(super) fn depth(&self, metres: Option<f64>) -> f32 {
        let from_near = metres.map_or(1.0, |metres| metres / f64::from(self.fit.depth_range)) as f32;
        if self.fit.depth == DepthConvention::Reversed { 1.0 - from_near } else { from_near }
    }
}
