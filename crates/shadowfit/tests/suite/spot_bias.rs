//! A spot light's automatic biases are sufficient in f32, on hardware that snaps, in every format of the map.
//!
//! The computation is a GPU's. Vertices are in f32, and depths are stored at centres that are off by the
//! rasteriser's snap, divided and rounded to the format. Positions and biases of the receiver are in f32, and
//! the sampler snaps texture coordinates.

use proptest::prelude::*;
use proptest::strategy::Union;
use shadowfit::DepthConvention;
use shadowfit::bias::MIN_COSINE;
use shadowfit::diagnostics::{DepthStorage, depth_step_at};
use shadowfit::glam::{DMat3, DVec2, DVec3, UVec2, Vec3};
use shadowfit::settings::{BiasSettings, MapFormat};
use shadowfit::spot::{SpotBias, SpotFit};
use shadowfit::spot::{depth_gradient, normal_offset, on_hardware};

use crate::filters::{Filter, filters};
use crate::spot::{any_depth, any_lamp, homogeneous, in_window, lamp};
use crate::support::{any_direction, cases, double, float};

const STORAGES: [DepthStorage; 5] =
    [DepthStorage::Unorm8, DepthStorage::Unorm16, DepthStorage::Unorm24, DepthStorage::Float16, DepthStorage::Float32];

/// Sub-texel steps of rasteriser and sampler.
const SNAPS: f64 = 256.0;

/// A point of a plane under a light, and the normal on the light's side.
#[derive(Clone, Copy, Debug)]
struct Case {
    fit: SpotFit,
    point: DVec3,
    normal: Vec3,
}

impl Case {
    fn is_reversed(&self) -> bool {
        self.fit.depth == DepthConvention::Reversed
    }

    /// Returns a world position on the plane, moved along its normal by `lift`, at a position in the map in
    /// texels. Uses the matrix for drawing casters.
    fn at(&self, texel: DVec2, lift: f64) -> DVec3 {
        let m = self.fit.clip_from_world.as_dmat4();
        let clip = texel / self.fit.resolution.as_dvec2() * DVec2::new(2.0, -2.0) + DVec2::new(-1.0, 1.0);
        let (x, y) = (m.row(0) - m.row(3) * clip.x, m.row(1) - m.row(3) * clip.y);
        let normal = self.normal.as_dvec3();
        let rows = DMat3::from_cols(x.truncate(), y.truncate(), normal).transpose();
        let along = normal.dot(self.point - self.fit.origin) + lift * normal.length();
        self.fit.origin + rows.inverse() * DVec3::new(-x.w, -y.w, along)
    }

    /// Returns the depth of a vertex at the texel's centre, or `None` if the plane is not before the light.
    fn vertex_depth(&self, centre: DVec2) -> Option<f64> {
        let clip = homogeneous(&self.fit.clip_from_world, &self.fit, self.at(centre, 0.0));
        let depth = clip.z / clip.w;
        let stored = if self.fit.depth == DepthConvention::NegativeOneToOne { depth * 0.5 + 0.5 } else { depth };
        (clip.w > 0.0).then_some(f64::from(stored))
    }

    /// Returns the stored depth of a texel, with the centre off by half a snap to the worse side.
    fn stored(&self, storage: DepthStorage, centre: DVec2) -> Option<f64> {
        let snap = 0.5 / SNAPS;
        let mut worst: Option<f64> = None;
        for (x, y) in [(-snap, -snap), (snap, -snap), (-snap, snap), (snap, snap)] {
            let depth = self.vertex_depth(centre + DVec2::new(x, y))?;
            let worse = |other: f64| if self.is_reversed() { other.max(depth) } else { other.min(depth) };
            worst = Some(worst.map_or(depth, worse));
        }
        let depth = worst.filter(|depth| (0.0..=1.0).contains(depth))?;
        let step = f64::from(depth_step_at(storage, 1.0, depth as f32).unwrap());
        // Formats round to the nearest of equal steps from 0.
        Some((depth / step).round() * step)
    }

    /// Returns lift and depth of a bias at a point of the plane, as the receiver's shader computes them.
    fn on_plane(&self, bias: &SpotBias, point: DVec3) -> (f32, f32) {
        let to_light = (self.fit.position - self.fit.origin).as_vec3() - (point - self.fit.origin).as_vec3();
        let sine = self.normal.cross(self.fit.direction).length();
        let height = self.normal.dot(to_light).max(MIN_COSINE * to_light.length());
        let distance = homogeneous(&self.fit.uv_from_world, &self.fit, point).w;
        let offset = bias.normal_offset * distance * sine + bias.constant_offset;
        let lifted = self.look_up(point, offset).1.max(f32::MIN_POSITIVE);
        let gradient = depth_gradient(&self.fit, point, self.normal).unwrap().abs();
        let depth = bias.constant_depth
            + bias.distance_depth / lifted
            + bias.slope_depth * sine / height
            + bias.receiver_plane * (gradient.x + gradient.y);
        (offset, depth)
    }

    /// Returns position in the map (in texels), w, and depth of a lifted point.
    fn look_up(&self, point: DVec3, offset: f32) -> (DVec2, f32, f32) {
        let lifted = (point - self.fit.origin).as_vec3() + self.normal * offset;
        let at = self.fit.uv_from_world * lifted.extend(1.0);
        let uv = at.truncate().truncate() / at.w;
        ((uv * self.fit.resolution.as_vec2()).as_dvec2(), at.w, at.z / at.w)
    }

    /// Returns by how much the nearest texel of the footprint lies before the compared depth. Positive values
    /// are acne.
    fn acne(&self, storage: DepthStorage, filter: &Filter, point: DVec3, (offset, bias): (f32, f32)) -> f64 {
        let (at, _, depth) = self.look_up(point, offset);
        let compared = f64::from(if self.is_reversed() { depth + bias } else { depth - bias });
        let snapped = (at * SNAPS).round() / SNAPS;
        let before = |depth: f64| if self.is_reversed() { depth - compared } else { compared - depth };
        let stored = filter.texels(snapped).filter_map(|centre| self.stored(storage, centre));
        stored.map(before).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns points of the plane whose look-ups, lifted by `lift`, are within rounding of a texel border or
    /// centre, where the footprint of a filter changes.
    fn worst_points(&self, lift: impl Fn(DVec3) -> f32) -> Vec<DVec3> {
        let near = 1.0 / SNAPS;
        let (middle, _, _) = self.look_up(self.point, 0.0);
        let point = |i: u32| {
            let edge = DVec2::new(f64::from(i & 1), f64::from(i >> 1 & 1)) * 0.5;
            // The R2 sequence (M. Roberts, 2018) around it.
            let spread = (DVec2::new(0.754_877_666, 0.569_840_291) * f64::from(i)).fract() * 2.0 - 1.0;
            let at = middle.floor() + edge + spread * near;
            let mut point = self.point;
            // The lift depends slightly on the position, so iterate. Near the end of the plane there may be
            // no such point.
            for _ in 0..6 {
                let offset = f64::from(lift(point));
                point = self.at(at, offset) - self.normal.as_dvec3() * offset;
                if !self.fit.covers(point) {
                    return None;
                }
            }
            Some(point)
        };
        (0..32).filter_map(point).collect()
    }
}

/// Maps of any lamp, of 128 to 8192 texels, relative to the light or to points up to four times the far
/// distance away.
fn any_fit() -> impl Strategy<Value = (shadowfit::spot::SpotLight, SpotFit)> {
    let side = || prop_oneof![Just(128_u32), Just(500), Just(2048), Just(8192)];
    let origin = (any_direction(), prop_oneof![Just(0.0), Just(0.5), Just(4.0)]);
    let lamps = any_lamp().prop_filter("the roll is defined", |l| l.direction.cross(l.up).length() > 0.1);
    (lamps, any_depth(), side(), side(), origin).prop_map(|(lamp, depth, width, height, (away, share))| {
        let fit = lamp.fit(UVec2::new(width, height), depth).unwrap();
        (lamp, fit.relative_to(lamp.position + away.as_dvec3() * f64::from(lamp.far) * share))
    })
}

/// Points within the map, on planes from 0° to 88.7° to the ray from the light.
fn any_case() -> impl Strategy<Value = Case> {
    let tangent = [0.0, 3e-4, 0.1, 1.0, 10.0, 45.0].map(Just);
    let place = (double(-0.7, 0.7), double(-0.7, 0.7), double(0.02, 0.9));
    (any_fit(), place, float(0.0, 6.3), Union::new(tangent), any::<bool>()).prop_map(
        |((lamp, fit), (x, y, share), azimuth, tangent, from_axis)| {
            let (near, far) = (f64::from(lamp.near), f64::from(lamp.far));
            let point = in_window(&lamp, x, y, near + (far - near) * share * share);
            // Around the ray, or around the axis: a plane perpendicular to the axis has constant depth.
            let toward = (fit.position - point).normalize().as_vec3();
            let around = if from_axis && tangent < 1.0 { -fit.direction } else { toward };
            let (u, v) = around.any_orthonormal_pair();
            let normal = (around + (u * azimuth.cos() + v * azimuth.sin()) * tangent).normalize();
            let normal = if normal.dot(toward) < 0.0 { -normal } else { normal };
            Case { fit, point, normal }
        },
    )
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn the_automatic_biases_clear_planes_in_f32_in_every_format(case in any_case()) {
        for filter in filters() {
            for storage in STORAGES {
                for bias in [
                    SpotBias::automatic(filter.reach, storage, &case.fit),
                    SpotBias::automatic_receiver_plane(filter.reach, storage, &case.fit),
                ] {
                    let Ok(bias) = bias else { continue };
                    let given = case.on_plane(&bias, case.point);
                    let acne = case.acne(storage, &filter, case.point, given);
                    prop_assert!(acne <= 0.0, "{}, {storage:?}: {acne:e} with {bias:?}", filter.name);
                }
            }
        }
    }

    /// The offset that depends on the azimuth is not larger than necessary. So test the hardware's snap and
    /// the rounding of f32 at the worst points.
    #[test]
    fn the_offset_of_the_plane_itself_clears_it_at_the_worst_points(case in any_case()) {
        for filter in filters() {
            let storage = DepthStorage::Float32;
            let precision = SpotBias::precision(storage, &case.fit);
            let reach = on_hardware(&case.fit, filter.reach).unwrap();
            let least = |p| normal_offset(&case.fit, reach, p, case.normal);
            let lift = |p| least(p).map_or(0.0, |h| h + precision.constant_offset);
            if SpotBias::automatic(filter.reach, storage, &case.fit).is_err() {
                continue;
            }
            for point in case.worst_points(lift) {
                let (_, depth) = case.on_plane(&precision, point);
                let acne = case.acne(storage, &filter, point, (lift(point), depth));
                prop_assert!(acne <= 0.0, "{}: {acne:e} with {} and {depth}", filter.name, lift(point));
            }
        }
    }

    /// The formula of the docs is the one that the crate computes.
    #[test]
    fn a_bias_on_a_plane_is_what_the_shader_s_formula_gives(case in any_case()) {
        let bias = SpotBias {
            constant_depth: 0.001, distance_depth: 0.002, slope_depth: 0.003,
            normal_offset: 0.004, constant_offset: 0.0, receiver_plane: 1.5,
        };
        let fit = case.fit.relative_to(case.fit.position);
        let case = Case { fit, ..case };
        let ours = bias.on_plane(&fit, case.point, case.normal).unwrap();
        let (offset, depth) = case.on_plane(&bias, case.point);
        let rounding = 1e-4 * offset.abs() + 1e-6 * 0.004 * fit.far;
        prop_assert!((ours.offset - offset).abs() <= rounding, "{ours:?}: {offset}");
        prop_assert!((ours.depth / depth - 1.0).abs() < 1e-3, "{ours:?}: {depth}");
        let turned = bias.on_plane(&fit, case.point, -case.normal * 7.0).unwrap();
        prop_assert!((turned.depth / ours.depth - 1.0).abs() < 1e-5, "the side and length of a normal do not matter");
    }
}

/// Returns whether any of 2000 points on planes square to the axis shadows itself with a share of the
/// precision.
fn has_bands(depth: DepthConvention, storage: DepthStorage, away: f64, share: f32) -> bool {
    let fit = lamp().fit(UVec2::splat(1024), depth).unwrap();
    let fit = fit.relative_to(fit.position + DVec3::new(0.6, 0.64, 0.48) * away);
    let whole = SpotBias::precision(storage, &fit);
    let bias = SpotBias {
        constant_depth: whole.constant_depth * share,
        distance_depth: whole.distance_depth * share,
        constant_offset: whole.constant_offset * share,
        ..whole
    };
    (0..2000).any(|i| {
        let turn = f64::from(i);
        let place = (DVec2::new(0.754_877_666, 0.569_840_291) * turn).fract() * 1.8 - 0.9;
        let point = in_window(&lamp(), place.x, place.y, 0.3 + turn * 0.029);
        let case = Case { fit, point, normal: -fit.direction };
        let nearest = &filters()[0];
        case.acne(storage, nearest, point, case.on_plane(&bias, point)) > 0.0
    })
}

#[test]
fn the_precision_clears_planes_without_slope_and_a_part_of_it_does_not() {
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed] {
        for away in [0.0, 100.0] {
            for storage in STORAGES {
                assert!(!has_bands(depth, storage, away, 1.0), "{depth:?} {storage:?} {away}");
                // For a coarse step, rounding to the nearest needs half of it, and hardware that also rounds
                // the compared depth needs the other half. The f32 part bounds roundings that seldom agree,
                // so that none of these points needs more than a 24th of it, or a 128th relative to an origin
                // 100 m away with reversed depth.
                let share = match storage {
                    DepthStorage::Unorm8 | DepthStorage::Float16 => 1.0 / 4.0,
                    DepthStorage::Unorm16 => 1.0 / 6.0,
                    DepthStorage::Unorm24 => 1.0 / 32.0,
                    DepthStorage::Float32 => 1.0 / 128.0,
                };
                assert!(has_bands(depth, storage, away, share), "{depth:?} {storage:?} {away}");
            }
        }
    }
}

#[test]
fn texels_become_depth_and_metres_by_the_longer_side_at_the_distance() {
    let fit = lamp().fit(UVec2::new(512, 2048), DepthConvention::ZeroToOne).unwrap();
    let texel = fit.texel_size.max_element();
    assert!(fit.texel_size.min_element() < texel);
    let settings =
        BiasSettings { constant: 0.5, slope: 2.0, normal_offset: 3.0, receiver_plane: 0.7, depth_steps: 0.0 };
    let bias = SpotBias::from_texels(&settings, MapFormat::Depth16Unorm, &fit);
    assert_eq!((bias.constant_depth, bias.constant_offset), (0.0, 0.0));
    assert_eq!((bias.normal_offset, bias.receiver_plane), (3.0 * texel, 0.7));
    // Half a texel at 7 m corresponds to the depth between 7 m and half a texel before it, up to a texel's
    // share of 7 m.
    let depth = fit.depth_at(7.0) - fit.depth_at(7.0 - 3.5 * f64::from(texel));
    assert!((f64::from(bias.distance_depth) / 7.0 / depth - 1.0).abs() < f64::from(texel), "{bias:?} for {depth}");
    assert!((bias.slope_depth / bias.distance_depth - 4.0).abs() < 1e-5);
    let steps = SpotBias::from_texels(&settings.with_depth_steps(2.0), MapFormat::Depth16Unorm, &fit);
    let one = SpotBias::precision(MapFormat::Depth16Unorm, &fit);
    assert_eq!(steps.constant_depth, 2.0 * one.constant_depth);
    assert!(one.constant_depth > 1.0 / 65_535.0 && one.constant_depth < 1.4 / 65_535.0, "{one:?}");
    let fixed = SpotBias::fixed(0.01).unwrap();
    assert_eq!(fixed, SpotBias { constant_depth: 0.01, ..SpotBias::default() });
}

#[test]
fn reversed_depth_in_floats_needs_a_fiftieth_of_the_bias_far_from_the_light() {
    let at = |depth, storage: DepthStorage| {
        let fit = lamp().fit(UVec2::splat(1024), depth).unwrap();
        let bias = SpotBias::precision(storage, &fit);
        bias.constant_depth + bias.distance_depth / fit.far
    };
    let share = |storage| at(DepthConvention::Reversed, storage) / at(DepthConvention::ZeroToOne, storage);
    let (single, half) = (share(DepthStorage::Float32), share(DepthStorage::Float16));
    assert!(single < 0.02 && half < 0.02, "{single} {half}");
    assert!((share(DepthStorage::Unorm16) - 1.0).abs() < 0.3, "equal steps are the same either way");
}
