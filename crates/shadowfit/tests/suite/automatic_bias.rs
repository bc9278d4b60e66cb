//! The automatic biases are sufficient in f32, on hardware that snaps, in every format of the map.
//!
//! The computation is a GPU's. Vertices are in f32, and depths are stored at centres that are off by the
//! rasteriser's snap, rounded to the format. Positions and biases of the receiver are in f32, and the sampler
//! snaps texture coordinates.

use std::f32::consts::{FRAC_PI_2, SQRT_2};

use proptest::prelude::*;
use proptest::strategy::Union;
use shadowfit::bias::{FilterRadius, MIN_COSINE, depth_gradient, depth_precision, normal_offset, receiver_plane_depth};
use shadowfit::diagnostics::{DepthStorage, acne_margin, depth_step_at};
use shadowfit::glam::{DMat3, DVec2, DVec3, UVec2, Vec3, Vec3Swizzles};
use shadowfit::settings::{BiasSettings, FilterKind, FitKind, MapFormat, Softness};
use shadowfit::{Bias, DepthConvention, LightProjection};

use crate::filters::{Filter, filters};
use crate::support::{any_camera, any_direction, apply, cases, exact, fitted, float};

const STORAGES: [DepthStorage; 5] =
    [DepthStorage::Unorm8, DepthStorage::Unorm16, DepthStorage::Unorm24, DepthStorage::Float16, DepthStorage::Float32];

/// Sub-texel steps of rasteriser and sampler.
const SNAPS: f64 = 256.0;

/// The plane through a point, as the shadow pass stores it.
struct Stored<'a> {
    fit: &'a LightProjection,
    storage: DepthStorage,
    /// World position, relative to the fit's origin, from texture coordinates and the plane.
    world_from_rows: DMat3,
    offset: DVec3,
}

impl<'a> Stored<'a> {
    fn new(case: &'a Case, storage: DepthStorage) -> Self {
        let m = case.fit.uv_from_world.as_dmat4();
        let normal = case.normal.as_dvec3();
        let rows = DMat3::from_cols(m.row(0).truncate(), m.row(1).truncate(), normal).transpose();
        let offset = DVec3::new(-m.w_axis.x, -m.w_axis.y, normal.dot(case.point.as_dvec3()));
        Self { fit: &case.fit, storage, world_from_rows: rows.inverse(), offset }
    }

    /// Returns the distance from the near plane, 0..=1, of a vertex at the texel's centre.
    fn vertex_depth(&self, centre: DVec2) -> f64 {
        let uv = centre / self.fit.resolution.as_dvec2();
        let vertex = (self.world_from_rows * (uv.extend(0.0) + self.offset)).as_vec3();
        f64::from(apply(&self.fit.uv_from_world, vertex).z)
    }

    /// Returns the stored depth of a texel, with the centre off by half a snap to the worse side, or `None`
    /// if the plane is outside the map's depth range.
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

/// Returns the values that a format may store for a depth: the nearest one, or the one below or above on
/// hardware that only rounds down or up.
fn rounded(storage: DepthStorage, depth: f64) -> [f64; 3] {
    let step = f64::from(depth_step_at(storage, 1.0, depth as f32).unwrap());
    let steps = depth / step;
    [steps.round(), steps.floor(), steps.ceil()].map(|steps| (steps * step).clamp(0.0, 1.0))
}

/// A point of a plane in a fit, and the normal on the light's side.
#[derive(Clone, Copy, Debug)]
struct Case {
    fit: LightProjection,
    point: Vec3,
    normal: Vec3,
}

impl Case {
    /// Returns position (in texels) and compared depth of a point of the plane that is moved by `offset`
    /// along the normal and by `depth` toward the light, as the receiver's shader computes them.
    fn look_up(&self, point: Vec3, offset: f32, depth: f32) -> (DVec2, f64) {
        let uv = apply(&self.fit.uv_from_world, point + self.normal * offset);
        let toward_light = if self.fit.depth == DepthConvention::Reversed { depth } else { -depth };
        ((uv.truncate() * self.fit.resolution.as_vec2()).as_dvec2(), f64::from(uv.z + toward_light))
    }

    /// Returns offset and depth of a bias on the plane, as the receiver's shader computes them.
    fn on_plane(&self, bias: &Bias) -> (f32, f32) {
        let cosine = self.normal.dot(-self.fit.direction).clamp(MIN_COSINE, 1.0);
        let sine = (1.0 - cosine * cosine).sqrt();
        let gradient = depth_gradient(&self.fit, self.normal).unwrap().abs();
        let depth = bias.slope_depth * sine / cosine + bias.receiver_plane * (gradient.x + gradient.y);
        (bias.normal_offset * sine, bias.constant_depth + depth)
    }

    /// Returns by how much the nearest texel of the footprint lies before the compared depth of a look-up.
    /// Positive values are acne.
    fn acne(&self, stored: &Stored, filter: &Filter, (at, compared): (DVec2, f64)) -> f64 {
        let snapped = (at * SNAPS).round() / SNAPS;
        let before =
            |depth: f64| if self.fit.depth == DepthConvention::Reversed { depth - compared } else { compared - depth };
        filter.texels(snapped).filter_map(|centre| stored.depth(centre)).map(before).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns the acne of the case's own point under a bias.
    fn acne_under(&self, bias: &Bias, filter: &Filter, storage: DepthStorage) -> f64 {
        let (offset, depth) = self.on_plane(bias);
        self.acne(&Stored::new(self, storage), filter, self.look_up(self.point, offset, depth))
    }

    /// Returns points of the plane whose look-ups, lifted by `offset`, are within rounding of a texel border
    /// or centre, where the footprint of a filter changes.
    fn worst_points(&self, offset: f32) -> impl Iterator<Item = Vec3> {
        let plane = Stored::new(self, DepthStorage::default());
        let farthest = self.fit.corners().map(Vec3::length).into_iter().fold(0.0, f32::max);
        let near = 0.5 / SNAPS + f64::from(f32::EPSILON * 2.0 * farthest / self.fit.texel_size.min_element());
        let (at, _) = self.look_up(self.point, 0.0, 0.0);
        let lift = self.normal.as_dvec3() * f64::from(offset);
        // Lifting changes the plane's constant, n·p.
        let lifted = DVec3::Z * self.normal.as_dvec3().dot(lift);
        (0..64).map(move |i| {
            let edge = DVec2::new(f64::from(i & 1), f64::from(i >> 1 & 1)) * 0.5;
            // The R2 sequence (M. Roberts, 2018) around it.
            let spread = (DVec2::new(0.754_877_666, 0.569_840_291) * f64::from(i)).fract() * 2.0 - 1.0;
            let uv = (at.floor() + edge + spread * near) / self.fit.resolution.as_dvec2();
            (plane.world_from_rows * (uv.extend(0.0) + plane.offset + lifted) - lift).as_vec3()
        })
    }
}

/// A plane drawn as one large triangle. Its vertices are rounded by their distance, which shifts the whole
/// triangle.
struct Triangle<'a> {
    case: &'a Case,
    vertices: [Vec3; 3],
    /// Texture coordinates and depth of the vertices, as the vertex shader computes them.
    projected: [Vec3; 3],
}

impl Triangle<'_> {
    /// Returns the weights of the three vertices at a position, given by two of their coordinates.
    fn weights([a, b, c]: [DVec2; 3], at: DVec2) -> DVec3 {
        let whole = (b - a).perp_dot(c - a);
        let (v, w) = ((at - a).perp_dot(c - a) / whole, (b - a).perp_dot(at - a) / whole);
        DVec3::new(1.0 - v - w, v, w)
    }

    /// Returns a sum as the rasteriser computes it in f32.
    fn interpolated(weights: DVec3, [a, b, c]: [f32; 3]) -> f32 {
        let weights = weights.as_vec3();
        a * weights.x + b * weights.y + c * weights.z
    }

    /// Returns the plane's point in the fragment shader: interpolated between the vertices.
    fn point(&self) -> Vec3 {
        let normal = self.case.normal.abs();
        let across = |v: Vec3| {
            let v = if normal.x >= normal.max_element() { v.yzx() } else { v };
            if normal.y >= normal.max_element() { v.xz().as_dvec2() } else { v.xy().as_dvec2() }
        };
        let weights = Self::weights(self.vertices.map(across), across(self.case.point));
        Vec3::from_array([0, 1, 2].map(|i| Self::interpolated(weights, self.vertices.map(|v| v[i]))))
    }

    /// Returns the depth that the triangle stores at a texel's centre.
    fn depth(&self, storage: DepthStorage, centre: DVec2) -> Option<f64> {
        let uv = centre / self.case.fit.resolution.as_dvec2();
        let weights = Self::weights(self.projected.map(|p| p.truncate().as_dvec2()), uv);
        let depth = f64::from(Self::interpolated(weights, self.projected.map(|p| p.z)));
        let step = |depth: f64| f64::from(depth_step_at(storage, 1.0, depth as f32).unwrap());
        (0.0..=1.0).contains(&depth).then(|| (depth / step(depth)).round() * step(depth))
    }

    /// Returns by how much the nearest texel of a filter's footprint lies before the compared depth. Positive
    /// values are acne.
    fn acne(&self, bias: &Bias, filter: &Filter, storage: DepthStorage) -> f64 {
        let (offset, depth) = self.case.on_plane(bias);
        let (at, compared) = self.case.look_up(self.point(), offset, depth);
        let is_reversed = self.case.fit.depth == DepthConvention::Reversed;
        let before = |depth: f64| if is_reversed { depth - compared } else { compared - depth };
        let snapped = (at * SNAPS).round() / SNAPS;
        let depths = filter.texels(snapped).filter_map(|centre| self.depth(storage, centre));
        depths.map(before).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Fits of any camera and light, with maps of at least 64 texels and uneven texels, relative to the eye or to
/// points up to 60 boxes away, where f32 is coarse.
fn any_fit() -> impl Strategy<Value = LightProjection> {
    let depth = prop_oneof![Just(DepthConvention::ZeroToOne), Just(DepthConvention::Reversed)];
    let resolution =
        (prop_oneof![Just(64_u32), Just(500), Just(2048)], prop_oneof![Just(64_u32), Just(1024), Just(8192)]);
    let origin = (any_direction(), prop_oneof![Just(0.0), Just(4.0), Just(60.0)]);
    (any_camera(), any_direction(), depth, resolution, origin).prop_map(
        |(camera, direction, depth, (width, height), (away, boxes))| {
            let settings = exact(FitKind::FrustumAabb).with_depth(depth).with_resolution(UVec2::new(width, height));
            let fit = fitted(&camera, direction, &settings);
            let corners = fit.corners();
            fit.relative_to(fit.origin + (away * corners[0].distance(corners[6]) * boxes).as_dvec3())
        },
    )
}

/// Points in the middle half of the map, on planes from 0° to 88.7° to the light.
fn any_case() -> impl Strategy<Value = Case> {
    let tangent = [0.0, 3e-4, 0.1, 1.0, 10.0, 45.0].map(Just);
    // Along an axis of the map, only one coordinate has to be at its worst.
    let azimuth = prop_oneof![(0..4_u8).prop_map(|i| f32::from(i) * FRAC_PI_2), float(0.0, 6.3)];
    let slope = (azimuth, Union::new(tangent));
    (any_fit(), slope, (float(0.25, 0.75), float(0.25, 0.75), float(0.25, 0.75))).prop_map(
        |(fit, (azimuth, tangent), (a, b, c))| {
            let corners = fit.corners();
            let edge = |i: usize, share: f32| (corners[i] - corners[0]) * share;
            let point = corners[0] + edge(1, a) + edge(3, b) + edge(4, c);
            let m = fit.light_from_world;
            let slope = m.row(0).truncate() * azimuth.cos() + m.row(1).truncate() * azimuth.sin();
            Case { fit, point, normal: (slope * tangent - fit.direction).normalize() }
        },
    )
}

/// Returns whether a plane that faces the light shadows itself at any of a thousand depths of a fit's range,
/// with a number of depth steps and no other bias, for every possible rounding of the stored depth.
fn has_bands(fit: &LightProjection, format: MapFormat, depth_steps: f32) -> bool {
    let settings = BiasSettings { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps };
    let bias = f64::from(Bias::from_texels(&settings, format, fit).constant_depth);
    // Rounding of a 32-bit float, which the depth steps cover as part of the rounding of positions.
    let float = f64::from(f32::EPSILON) * 0.5;
    let is_reversed = fit.depth == DepthConvention::Reversed;
    (0..1000).map(|i| (f64::from(i) + 0.377) / 1000.0).any(|depth| {
        let stored = rounded(format.into(), depth).into_iter();
        if is_reversed {
            stored.fold(0.0, f64::max) > depth + bias + float
        } else {
            stored.fold(1.0, f64::min) < depth - bias - float
        }
    })
}

#[test]
fn one_depth_step_clears_a_plane_in_every_coarse_format_and_none_does_not() {
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed] {
        let camera = crate::support::camera();
        let settings = exact(FitKind::FrustumAabb).with_depth(depth).with_caster_extension(300.0);
        let fit = fitted(&camera, crate::support::DIRECTION, &settings);
        for format in MapFormat::ALL {
            assert!(!has_bands(&fit, format, 1.0), "{format:?} {depth:?}");
            // Steps of 24 bits are as fine as the rounding of 32-bit floats.
            let is_coarse = ![DepthStorage::Float32, DepthStorage::Unorm24].contains(&format.into());
            assert_eq!(has_bands(&fit, format, 0.0), is_coarse, "{format:?} {depth:?}");
            assert_eq!(
                has_bands(&fit, format, 0.9),
                is_coarse,
                "{format:?} {depth:?}: it is no larger than it must be"
            );
        }
    }
}

/// Returns the direction of light that travels down at an elevation.
fn sunlight(elevation: f32) -> Vec3 {
    Vec3::new(elevation.cos() * 0.6, -elevation.sin(), elevation.cos() * 0.8)
}

#[test]
fn a_constant_bias_grows_with_the_slope_of_the_ground_and_not_beyond_its_need() {
    let softness = Softness::default();
    for degrees in [5.0_f32, 20.0, 45.0, 80.0] {
        let direction = sunlight(degrees.to_radians());
        let fit = fitted(&crate::support::camera(), direction, &exact(FitKind::FrustumAabb));
        let filter = FilterKind::Pcf3x3;
        let bias = Bias::automatic_constant(filter, DepthStorage::Unorm24, &fit, Vec3::Y).unwrap();
        let least = receiver_plane_depth(&fit, FilterRadius::from(filter), Vec3::Y).unwrap();
        let spare = depth_precision(&fit, DepthStorage::Unorm24) + 0.01 * least;
        assert!((least..least * SQRT_2 * 1.01 + spare * 2.0).contains(&bias.constant_depth), "{degrees}°: {bias:?}");
        assert_eq!((bias.normal_offset, bias.slope_depth, bias.receiver_plane), (0.0, 0.0, 0.0));
        // The settings of a technique know the elevation only.
        let settings = BiasSettings::automatic_constant(filter, &softness, degrees.to_radians());
        let by_settings = Bias::from_texels(&settings, MapFormat::Depth24Unorm, &fit);
        let ratio = by_settings.constant_depth / bias.constant_depth;
        // They count with the longer side of a texel.
        assert!((0.95..1.5).contains(&ratio), "{degrees}°: {ratio}");
    }
}

#[test]
fn maps_of_back_faces_need_a_bias_for_rounding_alone() {
    let fit = fitted(&crate::support::camera(), sunlight(0.7), &exact(FitKind::FrustumAabb));
    for storage in [DepthStorage::Unorm16, DepthStorage::Unorm24, DepthStorage::Float32] {
        let bias = Bias::back_faces(storage, &fit);
        assert_eq!(bias, Bias { constant_depth: depth_precision(&fit, storage), ..Bias::default() });
    }
    let by_settings = Bias::from_texels(&BiasSettings::back_faces(), MapFormat::Depth24Unorm, &fit);
    let precision = depth_precision(&fit, DepthStorage::Unorm24);
    assert!((by_settings.constant_depth / precision - 1.0).abs() < 1e-3, "{by_settings:?}");
}

#[test]
fn a_disc_in_metres_has_the_same_width_in_every_map() {
    for texels in [256, 2048] {
        let settings = exact(FitKind::FrustumAabb).with_resolution(UVec2::new(texels, texels * 2));
        let fit = fitted(&crate::support::camera(), sunlight(0.7), &settings);
        let radius = FilterRadius::HARDWARE_2X2.over_disc_of_metres(0.3, &fit);
        assert!((radius.disc * fit.texel_size - 0.3).abs().max_element() < 1e-6, "{radius:?}");
        assert_eq!(radius.taps, FilterRadius::HARDWARE_2X2.taps);
    }
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn the_automatic_biases_clear_planes_in_f32_in_every_format(case in any_case()) {
        for filter in filters() {
            for storage in STORAGES {
                for bias in [
                    Bias::automatic(filter.reach, storage, &case.fit).unwrap(),
                    Bias::automatic_receiver_plane(filter.reach, storage, &case.fit).unwrap(),
                    Bias::automatic_constant(filter.reach, storage, &case.fit, case.normal).unwrap(),
                ] {
                    let acne = case.acne_under(&bias, &filter, storage);
                    prop_assert!(acne <= 0.0, "{}, {storage:?}: {acne:e} with {bias:?}", filter.name);
                }
            }
        }
    }

    /// A ground of many kilometres in one triangle, close to the eye.
    #[test]
    fn the_automatic_biases_clear_large_triangles(mut case in any_case(), (size, turn) in (float(0.5, 5.0), float(0.0, 6.3))) {
        let size = case.fit.depth_range.max(case.fit.box_max.x - case.fit.box_min.x) * 10.0_f32.powf(size);
        let (a, b) = case.normal.any_orthonormal_pair();
        let vertices = [0.3, 2.3, 4.5].map(|angle: f32| case.point + (a * (angle + turn).cos() + b * (angle + turn).sin()) * size);
        case.fit.vertex_distance = vertices.map(Vec3::length).into_iter().fold(0.0, f32::max);
        // The plane is defined by the rounded vertices.
        let [p, q, r] = vertices.map(Vec3::as_dvec3);
        let normal = (q - p).cross(r - p).normalize();
        let normal = if normal.dot(case.normal.as_dvec3()) < 0.0 { -normal } else { normal };
        let moved = normal * (p - case.point.as_dvec3()).dot(normal);
        (case.point, case.normal) = ((case.point.as_dvec3() + moved).as_vec3(), normal.as_vec3());
        let projected = vertices.map(|vertex| apply(&case.fit.uv_from_world, vertex));
        let triangle = Triangle { case: &case, vertices, projected };
        for filter in filters() {
            for storage in STORAGES {
                for bias in [
                    Bias::automatic(filter.reach, storage, &case.fit).unwrap(),
                    Bias::automatic_receiver_plane(filter.reach, storage, &case.fit).unwrap(),
                    Bias::automatic_constant(filter.reach, storage, &case.fit, case.normal).unwrap(),
                ] {
                    let acne = triangle.acne(&bias, &filter, storage);
                    prop_assert!(acne <= 0.0, "{}, {storage:?}: {acne:e} with {bias:?}", filter.name);
                }
            }
        }
        // The default technique compares each texel of the hardware's 2×2 with the plane's own depth.
        for format in MapFormat::ALL {
            for (kind, reach) in [(FilterKind::Point, FilterRadius::POINT), (FilterKind::Pcf5x5, FilterRadius::HARDWARE_2X2)] {
                let bias = Bias::from_texels(&BiasSettings::automatic(kind), format, &case.fit);
                let all = filters();
                let filter = all.iter().find(|filter| filter.reach == reach).expect("a filter of this reach");
                let acne = triangle.acne(&bias, filter, format.into());
                prop_assert!(acne <= 0.0, "{kind:?}, {format:?}: {acne:e} with {bias:?}");
            }
        }
    }

    /// A point with a predicted margin of at least zero has no acne.
    #[test]
    fn a_margin_of_zero_or_more_means_no_acne(case in any_case(), (share, spare) in (float(0.0, 1.0), float(-0.5, 0.01))) {
        for filter in filters() {
            let storage = DepthStorage::Unorm16;
            // A share of the plane's need as an offset, the rest as depth, in total slightly too little or
            // too much.
            let reach = filter.reach.on_hardware(&case.fit);
            let needed = (1.0 + spare) * normal_offset(&case.fit, reach, case.normal).unwrap();
            let cosine = -case.normal.dot(case.fit.direction);
            let sine = (1.0 - cosine * cosine).max(1e-12).sqrt();
            let rest = (1.0 - share) * needed / (cosine * case.fit.depth_range);
            let constant = depth_precision(&case.fit, storage) + rest;
            let bias = Bias { constant_depth: constant, normal_offset: share * needed / sine, ..Bias::default() };
            let point = case.fit.origin + case.point.as_dvec3();
            let margin = acne_margin(&case.fit, &bias, filter.reach, storage, point, case.normal).unwrap().unwrap();
            if margin.metres >= 0.0 {
                let (offset, depth) = case.on_plane(&bias);
                let stored = Stored::new(&case, storage);
                for point in case.worst_points(offset) {
                    let acne = case.acne(&stored, &filter, case.look_up(point, offset, depth));
                    prop_assert!(acne <= 0.0, "{}: {acne:e} with {bias:?}", filter.name);
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
            let offset = normal_offset(&case.fit, filter.reach.on_hardware(&case.fit), case.normal).unwrap();
            let depth = Bias::automatic(filter.reach, storage, &case.fit).unwrap().constant_depth;
            let stored = Stored::new(&case, storage);
            for point in case.worst_points(offset) {
                let acne = case.acne(&stored, &filter, case.look_up(point, offset, depth));
                prop_assert!(acne <= 0.0, "{}: {acne:e} with {offset} and {depth}", filter.name);
            }
        }
    }
}
