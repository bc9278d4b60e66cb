//! The automatic biases hold in f32, on hardware that snaps, in every format of the map.
//!
//! The chain is a GPU's: vertices in f32, depths stored at centres that are off by the
//! rasteriser's snap, rounded to the format; positions and biases of the receiver in f32, texture
//! coordinates snapped by the sampler.

use proptest::prelude::*;
use shadowfit::bias::{MIN_COSINE, depth_gradient};
use shadowfit::diagnostics::{DepthStorage, acne_margin, depth_step_at};
use shadowfit::glam::{DMat3, DVec2, DVec3, UVec2, Vec3};
use shadowfit::{Bias, DepthConvention, FitKind, LightFit};

use crate::filters::{Filter, filters};
use crate::support::{any_camera, any_direction, apply, exact, fitted, float};

const STORAGES: [DepthStorage; 5] =
    [DepthStorage::Unorm8, DepthStorage::Unorm16, DepthStorage::Unorm24, DepthStorage::Float16, DepthStorage::Float32];

/// Sub-texel steps of rasteriser and sampler.
const SNAPS: f64 = 256.0;

/// The plane through a point, as the shadow pass stores it.
struct Stored<'a> {
    fit: &'a LightFit,
    storage: DepthStorage,
    /// World position, relative to the fit's origin, from texture coordinates and from the plane.
    world_from_rows: DMat3,
    offset: DVec3,
}

impl<'a> Stored<'a> {
    fn new(fit: &'a LightFit, storage: DepthStorage, point: Vec3, normal: Vec3) -> Self {
        let m = fit.uv_from_world.as_dmat4();
        let normal = normal.as_dvec3();
        let rows = DMat3::from_cols(m.row(0).truncate(), m.row(1).truncate(), normal).transpose();
        let offset = DVec3::new(-m.w_axis.x, -m.w_axis.y, normal.dot(point.as_dvec3()));
        Self { fit, storage, world_from_rows: rows.inverse(), offset }
    }

    /// Distance from the near plane, 0..=1, that a vertex at the texel's centre gets.
    fn vertex_depth(&self, centre: DVec2) -> f64 {
        let uv = centre / self.fit.resolution.as_dvec2();
        let vertex = (self.world_from_rows * (uv.extend(0.0) + self.offset)).as_vec3();
        f64::from(apply(&self.fit.uv_from_world, vertex).z)
    }

    /// Stored depth at a texel, with the centre off by half a snap to the worse side; `None`
    /// where the plane leaves the map's depths.
    fn depth(&self, centre: DVec2) -> Option<f64> {
        let snap = 0.5 / SNAPS;
        let corners = [(-snap, -snap), (snap, -snap), (-snap, snap), (snap, snap)];
        let depths = corners.map(|(x, y)| self.vertex_depth(centre + DVec2::new(x, y)));
        let depth = match self.fit.depth {
            DepthConvention::Reversed => depths.into_iter().fold(f64::MIN, f64::max),
            _ => depths.into_iter().fold(f64::MAX, f64::min),
        };
        let step = |depth: f64| f64::from(depth_step_at(self.storage, 1.0, depth as f32).unwrap());
        // Formats round to the nearest of equal steps from 0.
        (0.0..=1.0).contains(&depth).then(|| (depth / step(depth)).round() * step(depth))
    }
}

/// A point of a plane under a fit, and the normal on the light's side.
#[derive(Clone, Copy, Debug)]
struct Case {
    fit: LightFit,
    point: Vec3,
    normal: Vec3,
}

impl Case {
    /// Texels and compared depth of the point, as the receiver's shader has them.
    fn look_up(&self, bias: &Bias) -> (DVec2, f64) {
        let Self { fit, point, normal } = *self;
        let cosine = normal.dot(-fit.direction).clamp(MIN_COSINE, 1.0);
        let sine = (1.0 - cosine * cosine).sqrt();
        let uv = apply(&fit.uv_from_world, point + normal * (bias.normal_offset * sine));
        let gradient = depth_gradient(&fit, normal).unwrap().abs();
        let depth =
            bias.constant_depth + bias.slope_depth * sine / cosine + bias.receiver_plane * (gradient.x + gradient.y);
        let toward_light = if fit.depth == DepthConvention::Reversed { depth } else { -depth };
        ((uv.truncate() * fit.resolution.as_vec2()).as_dvec2(), f64::from(uv.z + toward_light))
    }

    /// Depth by which the nearest texel in reach lies before the point's compared depth; positive
    /// is acne.
    fn acne(&self, bias: &Bias, filter: &Filter, storage: DepthStorage) -> f64 {
        let (at, compared) = self.look_up(bias);
        let stored = Stored::new(&self.fit, storage, self.point, self.normal);
        let snapped = (at * SNAPS).round() / SNAPS;
        let before =
            |depth: f64| if self.fit.depth == DepthConvention::Reversed { depth - compared } else { compared - depth };
        filter.texels(snapped).filter_map(|centre| stored.depth(centre)).map(before).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Fits of any camera and light, with maps from 64 texels on and uneven texels.
fn any_fit() -> impl Strategy<Value = LightFit> {
    let depth = prop_oneof![Just(DepthConvention::ZeroToOne), Just(DepthConvention::Reversed)];
    let resolution =
        (prop_oneof![Just(64_u32), Just(500), Just(2048)], prop_oneof![Just(64_u32), Just(1024), Just(8192)]);
    (any_camera(), any_direction(), depth, resolution).prop_map(|(camera, direction, depth, (width, height))| {
        let settings = exact(FitKind::FrustumAabb).with_depth(depth).with_resolution(UVec2::new(width, height));
        fitted(&camera, direction, &settings)
    })
}

/// Points in the middle half of the map, on planes up to 88.8° from the light.
fn any_case() -> impl Strategy<Value = Case> {
    (any_fit(), any_direction(), (float(0.25, 0.75), float(0.25, 0.75), float(0.25, 0.75)))
        .prop_filter("the plane is not edge-on", |(fit, normal, _)| normal.dot(fit.direction).abs() > 0.02)
        .prop_map(|(fit, normal, (a, b, c))| {
            let corners = fit.corners();
            let edge = |i: usize, share: f32| (corners[i] - corners[0]) * share;
            let point = corners[0] + edge(1, a) + edge(3, b) + edge(4, c);
            let side = if normal.dot(fit.direction) > 0.0 { -1.0 } else { 1.0 };
            Case { fit, point, normal: normal * side }
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn the_automatic_biases_clear_planes_in_f32_in_every_format(case in any_case()) {
        for filter in filters() {
            for storage in STORAGES {
                for bias in [
                    Bias::automatic(filter.reach, storage, &case.fit).unwrap(),
                    Bias::automatic_receiver_plane(filter.reach, storage, &case.fit).unwrap(),
                ] {
                    let acne = case.acne(&bias, &filter, storage);
                    prop_assert!(acne <= 0.0, "{}, {storage:?}: {acne:e} with {bias:?}", filter.name);
                }
            }
        }
    }

    /// What is foretold to be clear is clear, whatever the bias.
    #[test]
    fn a_margin_of_zero_or_more_means_no_acne(
        case in any_case(), (slope, offset, constant) in (float(0.0, 2.0), float(0.0, 2.0), float(0.0, 2.0)),
    ) {
        for filter in filters() {
            let automatic = Bias::automatic(filter.reach, DepthStorage::Unorm16, &case.fit).unwrap();
            let texel = case.fit.texel_size.max_element() / case.fit.depth_range;
            let bias = Bias {
                constant_depth: automatic.constant_depth + constant * texel,
                slope_depth: slope * texel,
                normal_offset: automatic.normal_offset * offset,
                receiver_plane: 0.0,
            };
            let point = case.fit.origin + case.point.as_dvec3();
            let margin = acne_margin(&case.fit, &bias, filter.reach, DepthStorage::Unorm16, point, case.normal);
            if margin.unwrap().unwrap().metres >= 0.0 {
                let acne = case.acne(&bias, &filter, DepthStorage::Unorm16);
                prop_assert!(acne <= 0.0, "{}: {acne:e} with {bias:?}", filter.name);
            }
        }
    }
}
