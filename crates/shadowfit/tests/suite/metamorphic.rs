//! Metamorphic tests: the effect on a fit of turning, mirroring, scaling and moving whole scenes, including
//! boxes.
//!
//! The light's own axes are not compared where they are not guaranteed. Rectangles that may turn are compared
//! up to quarter turns and mirror images of the map. If two rectangles are equally good, only their costs are
//! compared.

use proptest::prelude::*;
use shadowfit::glam::{DMat3, DQuat, DVec2, DVec3, Mat3, UVec2, Vec3};
use shadowfit::settings::{CasterPolicy, FitKind, FitSettings, RectangleKind};
use shadowfit::{
    Aabb, Boxes, DepthConvention, FitInput, FitState, LightProjection, Scratch, SingleMap, Technique, ViewFrustum,
};

use crate::scenes::{BoxPlan, COVERING, SceneView, any_box, any_light, any_view};
use crate::support::{SNAP, any_direction, apply, cases, double};
use crate::texel_phase::exact_texel;

/// A scene in plain numbers, relative to the eye.
#[derive(Clone, Debug)]
struct Scene {
    frustum: ViewFrustum,
    direction: Vec3,
    /// Relative to the eye, so that moving the eye does not change their rounding.
    receivers: Option<Vec<Aabb>>,
    casters: Vec<Aabb>,
}

fn scene(view: &SceneView, direction: Vec3, boxes: Option<&[BoxPlan]>) -> Scene {
    let boxes = boxes.map(|plans| plans.iter().map(|plan| plan.aabb(view, view.eye)).collect::<Vec<_>>());
    Scene { frustum: view.frustum(), direction, casters: boxes.clone().unwrap_or_default(), receivers: boxes }
}

impl Scene {
    fn fit(&self, settings: &FitSettings) -> LightProjection {
        let origin = self.frustum.origin;
        let views = [self.frustum];
        let receivers = self.receivers.as_ref().map(|boxes| Boxes { origin, boxes });
        let casters = Boxes { origin, boxes: &self.casters };
        let input = FitInput { receivers, casters: Some(casters), ..FitInput::new(&views, self.direction) };
        let mut storage = vec![DVec2::ZERO; Scratch::required(self.casters.len(), 1)];
        shadowfit::fit_scene(&input, settings, &mut Scratch::new(&mut storage)).unwrap()
    }

    /// Returns the scene under a linear map, which must map boxes to boxes if the scene has boxes.
    fn image(&self, map: DMat3) -> Self {
        let turned = |v: Vec3| (map * v.as_dvec3()).as_vec3();
        let boxed = |b: &Aabb| Aabb::new(turned(b.min).min(turned(b.max)), turned(b.min).max(turned(b.max)));
        Self {
            frustum: ViewFrustum {
                corners: self.frustum.corners.map(turned),
                forward: turned(self.frustum.forward).normalize(),
                ..self.frustum
            },
            direction: turned(self.direction),
            receivers: self.receivers.as_ref().map(|boxes| boxes.iter().map(boxed).collect()),
            casters: self.casters.iter().map(boxed).collect(),
        }
    }

    fn scaled(&self, scale: f32) -> Self {
        let boxed = |b: &Aabb| Aabb::new(b.min * scale, b.max * scale);
        let frustum = self.frustum;
        Self {
            frustum: ViewFrustum {
                origin: frustum.origin * f64::from(scale),
                corners: frustum.corners.map(|c| c * scale),
                near: frustum.near * scale,
                far: frustum.far * scale,
                forward: frustum.forward,
            },
            direction: self.direction,
            receivers: self.receivers.as_ref().map(|boxes| boxes.iter().map(boxed).collect()),
            casters: self.casters.iter().map(boxed).collect(),
        }
    }

    /// Returns the texture coordinates of the view's corners.
    fn uvs(&self, fit: &LightProjection) -> [Vec3; 8] {
        self.frustum.corners.map(|c| apply(&fit.uv_from_world, c))
    }
}

fn settings(kind: FitKind, rectangle: RectangleKind) -> FitSettings {
    FitSettings::default()
        .with_kind(kind)
        .with_rectangle(rectangle)
        .with_casters(CasterPolicy::PerObject)
        .with_max_distance(f32::MAX)
        .with_caster_extension(0.0)
        .with_border(0.0)
        .with_resolution(UVec2::splat(512))
}

/// Returns a technique with one map on the world grid.
fn snapped(fit: &FitSettings) -> Technique {
    Technique::default().with_maps(SingleMap { shape: fit.shape, stabilise: SNAP }).with_fit(fit.map)
}

fn area(fit: &LightProjection) -> f64 {
    let size = (fit.box_max - fit.box_min).as_dvec3();
    size.x * size.y
}

/// Returns the rounding of corners and axes in f32, 2⁻²³ of the view's reach, as a share of the map's least
/// extent. It is large for a map of a small distant object.
fn rounding(scene: &Scene, fit: &LightProjection) -> f64 {
    let reach = scene.frustum.corners.iter().fold(0.0, |m: f64, c| m.max(c.as_dvec3().length()));
    reach / (fit.box_max - fit.box_min).as_dvec3().min_element() / 8_388_608.0
}

fn difference(a: [Vec3; 8], b: [Vec3; 8]) -> f32 {
    a.into_iter().zip(b).map(|(a, b)| (a - b).abs().max_element()).fold(0.0, f32::max)
}

/// Returns the eight symmetries of the square map.
fn symmetries(uv: Vec3) -> [Vec3; 8] {
    let (u, v, z) = (uv.x, uv.y, uv.z);
    let (s, t) = (1.0 - u, 1.0 - v);
    [(u, v), (v, s), (s, t), (t, u), (s, v), (u, t), (v, u), (t, s)].map(|(u, v)| Vec3::new(u, v, z))
}

/// Returns the least difference of two maps' coordinates over the symmetries.
fn symmetric_difference(a: [Vec3; 8], b: [Vec3; 8]) -> f32 {
    (0..8).map(|i| difference(a.map(|uv| symmetries(uv)[i]), b)).fold(f32::MAX, f32::min)
}

/// Returns whether an outline has two rectangles within 1e-3 of the best cost. Any pair of its points may
/// define a direction.
fn is_ambiguous(points: &[DVec2]) -> bool {
    let cost = |axis: DVec2| {
        let (mut min, mut max) = (DVec2::MAX, DVec2::MIN);
        for p in points {
            let q = DVec2::new(p.dot(axis), p.perp_dot(axis));
            (min, max) = (min.min(q), max.max(q));
        }
        (max - min).x * (max - min).y
    };
    let mut found: Vec<(f64, DVec2)> = Vec::new();
    for (i, a) in points.iter().enumerate() {
        for b in &points[..i] {
            if let Some(axis) = (*a - *b).try_normalize() {
                found.push((cost(axis), axis));
            }
        }
    }
    let best = found.iter().copied().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, DVec2::X));
    let is_turned = |axis: DVec2| axis.dot(best.1).abs().min(axis.perp_dot(best.1).abs()) > 1e-4;
    found.iter().any(|(cost, axis)| *cost <= best.0 * (1.0 + 1e-3) && is_turned(*axis))
}

/// Compares two fits that must be equal up to the map's symmetries.
fn assert_same_shape(a: (&Scene, &LightProjection), b: (&Scene, &LightProjection), rectangle: RectangleKind) {
    let ratio = area(a.1) / area(b.1);
    assert!((ratio - 1.0).abs() < 1e-5 + 8.0 * rounding(a.0, a.1), "areas differ by {ratio}");
    let axes = Mat3::from_mat4(a.1.light_from_world).as_dmat3();
    let outline: Vec<DVec2> = a.0.frustum.corners.iter().map(|c| (axes * c.as_dvec3()).truncate()).collect();
    let bounds_itself = a.0.receivers.is_none();
    if rectangle == RectangleKind::MinimumArea && bounds_itself && !is_ambiguous(&outline) {
        let error = symmetric_difference(a.0.uvs(a.1), b.0.uvs(b.1));
        assert!(error < 1e-3, "{error} of the map");
    }
}

fn any_rectangle() -> impl Strategy<Value = RectangleKind> {
    prop::sample::select(vec![RectangleKind::MinimumArea, RectangleKind::MinimumSquare])
}

fn any_boxes() -> impl Strategy<Value = Option<Vec<BoxPlan>>> {
    prop_oneof![1 => Just(None), 3 => prop::collection::vec(any_box(), 1..6).prop_map(Some)]
}

fn any_fit_kind() -> impl Strategy<Value = FitKind> {
    prop::sample::select(COVERING.to_vec())
}

/// Rotations that map the coordinate axes onto each other.
fn any_quarter_turn() -> impl Strategy<Value = DMat3> {
    (0..6_usize, 0..4_usize).prop_map(|(side, turn)| {
        let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
        let (first, mut second) = (axes[side], axes[(side + 1) % 6]);
        for _ in 0..turn {
            second = first.cross(second);
        }
        DMat3::from_cols(first, second, first.cross(second))
    })
}

proptest! {
    #![proptest_config(cases(2000))]

    /// Rectangles that turn about the light do not depend on the world's axes.
    #[test]
    fn a_rigid_motion_turns_the_oriented_fit_with_it(
        view in any_view(), direction in any_light(), axis in any_direction(), turn in double(0.0, 6.3),
        rectangle in any_rectangle(), kind in prop::sample::select(vec![FitKind::Oriented, FitKind::Focused]),
    ) {
        let here = scene(&view, direction, None);
        let there = here.image(DMat3::from_quat(DQuat::from_axis_angle(axis.as_dvec3().normalize(), turn)));
        let settings = settings(kind, rectangle);
        let (a, b) = (here.fit(&settings), there.fit(&settings));
        assert_same_shape((&here, &a), (&there, &b), rectangle);
    }

    /// A box that contains the whole view leaves the fit to the frustum.
    #[test]
    fn a_box_around_all_that_is_seen_changes_nothing(
        view in any_view(), direction in any_light(), rectangle in any_rectangle(),
    ) {
        let bare = scene(&view, direction, None);
        let reach = bare.frustum.corners.iter().fold(0.0_f32, |m, c| m.max(c.abs().max_element())) * 4.0;
        let boxed = Scene { receivers: Some(vec![Aabb::new(Vec3::splat(-reach), Vec3::splat(reach))]), ..bare.clone() };
        let (a, b) = (bare.fit(&settings(FitKind::Oriented, rectangle)), boxed.fit(&settings(FitKind::Focused, rectangle)));
        // The clipped box's vertices are the frustum's own corners, interpolated once more in f64.
        prop_assert!((area(&a) / area(&b) - 1.0).abs() < 1e-6);
        prop_assert!((a.depth_range / b.depth_range - 1.0).abs() < 1e-6);
        prop_assert_eq!(a.bounds_from, b.bounds_from);
    }

    /// Boxes stay boxes under quarter turns about the world's axes.
    #[test]
    fn quarter_turns_about_any_axis_leave_size_and_depth_of_fits_around_boxes(
        view in any_view(), direction in any_light(), boxes in any_boxes(), rectangle in any_rectangle(),
        turn in any_quarter_turn(),
    ) {
        let here = scene(&view, direction, boxes.as_deref());
        let there = here.image(turn);
        // Edge-on casters are clipped by an outline with a rounding margin, at any height, so leave them out.
        let settings = settings(FitKind::Focused, rectangle).with_casters(CasterPolicy::None);
        let (a, b) = (here.fit(&settings), there.fit(&settings));
        assert_same_shape((&here, &a), (&there, &b), rectangle);
        prop_assert_eq!(a.is_empty, b.is_empty);
        // The light's axis in f32 differs by 1e-7. Corners of orthographic views are up to twice as far away
        // as their depth.
        let reach = view.lens.far * 4.0;
        prop_assert!(f64::from((a.depth_range - b.depth_range).abs()) < 1e-5 * reach, "{} {}", a.depth_range, b.depth_range);
    }

    /// Powers of two change no rounding: all bits that a shader reads stay equal, with casters, receivers and
    /// the snapped grid.
    #[test]
    fn powers_of_two_scale_whole_scenes_without_a_trace(
        view in any_view(), direction in any_light(), boxes in any_boxes(), kind in any_fit_kind(),
        rectangle in any_rectangle(), exponent in -12_i32..12,
    ) {
        let here = scene(&view, direction, boxes.as_deref());
        let there = here.scaled(2.0_f32.powi(exponent));
        let settings = settings(kind, rectangle);
        let (a, b) = (here.fit(&settings), there.fit(&settings));
        prop_assert_eq!(here.uvs(&a), there.uvs(&b));
        prop_assert_eq!(a.texel_size * 2.0_f32.powi(exponent), b.texel_size);
    }

    /// Any other unit rounds each corner differently. Ties may turn the rectangle, so only its area is
    /// compared.
    #[test]
    fn any_unit_gives_the_same_texels(
        view in any_view(), direction in any_light(), rectangle in any_rectangle(), exponent in double(-3.0, 3.0),
        kind in prop::sample::select(vec![FitKind::FrustumAabb, FitKind::Oriented]),
    ) {
        let here = scene(&view, direction, None);
        let scale = 10.0_f64.powf(exponent) as f32;
        let there = here.scaled(scale);
        let settings = settings(kind, rectangle);
        let (a, b) = (here.fit(&settings), there.fit(&settings));
        let ratio = area(&b) / (area(&a) * f64::from(scale).powi(2));
        prop_assert!((ratio - 1.0).abs() <= 1e-6 + 4.0 * rounding(&here, &a), "{ratio}");
    }

    /// Quantised extents are eighths of an octave, so a unit of 2^(k/8) scales them exactly, unless the
    /// extent is within rounding of a step.
    #[test]
    fn an_eighth_of_an_octave_scales_snapped_maps_by_just_that(
        view in any_view(), direction in any_light(), eighths in -24_i32..24, kind in any_fit_kind(),
    ) {
        let technique = snapped(&settings(kind, RectangleKind::AxisAligned));
        let texel = |scene: &Scene| {
            let views = [scene.frustum];
            let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
            let input = FitInput::new(&views, scene.direction);
            FitState::new().fit(&input, &technique, &mut Scratch::new(&mut storage)).unwrap()[0].projection.texel_size
        };
        let scale = (f64::from(eighths) / 8.0).exp2();
        let here = scene(&view, direction, None);
        let ratio = (texel(&here.scaled(scale as f32)) / texel(&here)).as_dvec2() / scale;
        let step = (1.0_f64 / 8.0).exp2();
        let is_one_step_off = |r: f64| (r * step - 1.0).abs() < 1e-6 || (r / step - 1.0).abs() < 1e-6;
        // On a step, rounding decides.
        prop_assume!(!is_one_step_off(ratio.x) && !is_one_step_off(ratio.y));
        prop_assert!((ratio - 1.0).abs().max_element() < 1e-6, "{ratio}");
    }

    /// The shortest arc from straight down has x = +x and y = -z for a light straight down. The mirror image
    /// in x turns the other way about: x' = -Mx, y' = My, so u becomes 1 - u. The mirror image in z has x' =
    /// Mx, y' = -My, so v becomes 1 - v.
    #[test]
    fn mirror_images_mirror_the_map(
        view in any_view(), direction in any_direction(), boxes in any_boxes(),
        // Look-at axes depend on x alone: any upright mirror mirrors them in u.
        (kind, in_z) in prop::sample::select(vec![
            (FitKind::XnaSample, false),
            (FitKind::FrustumAabb, false),
            (FitKind::FrustumAabb, true),
            (FitKind::Focused, false),
            (FitKind::Focused, true),
        ]),
    ) {
        // Straight up and down, the plan's own axes replace a shortest arc or an azimuth.
        prop_assume!(direction.x.hypot(direction.z) > 1e-3);
        let here = scene(&view, direction, boxes.as_deref());
        let mirror = if in_z { DVec3::new(1.0, 1.0, -1.0) } else { DVec3::new(-1.0, 1.0, 1.0) };
        let there = here.image(DMat3::from_diagonal(mirror));
        let settings = settings(kind, RectangleKind::AxisAligned);
        let (a, b) = (here.fit(&settings), there.fit(&settings));
        let expected = here.uvs(&a).map(|uv| {
            if in_z { Vec3::new(uv.x, 1.0 - uv.y, uv.z) } else { Vec3::new(1.0 - uv.x, uv.y, uv.z) }
        });
        // Corners far outside a small box's map have large coordinates.
        let largest = expected.iter().fold(1.0_f32, |m, uv| m.max(uv.abs().max_element()));
        let error = difference(expected, there.uvs(&b)) / largest;
        prop_assert!(f64::from(error) < 1e-5 + 4.0 * rounding(&here, &a), "{error}");
    }

    /// Reversal and range affect only the stored depth.
    #[test]
    fn the_depth_convention_changes_depth_only(
        view in any_view(), direction in any_light(), boxes in any_boxes(), kind in any_fit_kind(),
        rectangle in any_rectangle(),
    ) {
        let here = scene(&view, direction, boxes.as_deref());
        let by = |depth| here.fit(&settings(kind, rectangle).with_depth(depth));
        let (plain, reversed, gl) =
            (by(DepthConvention::ZeroToOne), by(DepthConvention::Reversed), by(DepthConvention::NegativeOneToOne));
        prop_assert_eq!(plain.light_from_world, reversed.light_from_world);
        for corner in here.frustum.corners {
            let [p, r, g] = [&plain, &reversed, &gl].map(|fit| apply(&fit.uv_from_world, corner));
            prop_assert_eq!((p.x, p.y), (r.x, r.y));
            prop_assert_eq!((p.x, p.y), (g.x, g.y));
            // A sum of products and an offset, each of the size of the corner's distance in ranges.
            let tolerance = 4e-7 * (1.0 + p.z.abs() + corner.length() / plain.depth_range);
            prop_assert!((p.z + r.z - 1.0).abs() <= tolerance && (p.z - g.z).abs() <= tolerance, "{p} {r} {g}");
        }
    }

    /// Moving everything by the same offset changes no bit of a fit without a grid, also far from the world's
    /// origin.
    #[test]
    fn translation_changes_no_bit_of_fits_around_boxes(
        view in any_view(), direction in any_light(), boxes in any_boxes(), rectangle in any_rectangle(),
        kind in prop::sample::select(vec![FitKind::FrustumAabb, FitKind::Oriented, FitKind::Focused]),
        (x, y, z) in (double(-1e6, 1e6), double(-1e6, 1e6), double(-1e6, 1e6)),
    ) {
        let here = scene(&view, direction, boxes.as_deref());
        let origin = here.frustum.origin + DVec3::new(x, y, z);
        let there = Scene { frustum: ViewFrustum { origin, ..here.frustum }, ..here.clone() };
        let settings = settings(kind, rectangle);
        prop_assert_eq!(LightProjection { origin, ..here.fit(&settings) }, there.fit(&settings));
    }

    /// Snapped maps move with a world that moves by whole texels.
    #[test]
    fn whole_texels_of_movement_leave_snapped_maps_as_they_were(
        view in any_view(), direction in any_light(), boxes in any_boxes(), kind in any_fit_kind(),
        (i, j) in (-5000_i32..5000, -5000_i32..5000),
    ) {
        let technique = snapped(&settings(kind, RectangleKind::AxisAligned));
        let here = scene(&view, direction, boxes.as_deref());
        let snapped = |scene: &Scene| {
            let (views, origin) = ([scene.frustum], scene.frustum.origin);
            let mut storage = vec![DVec2::ZERO; Scratch::required(scene.casters.len(), 1)];
            let receivers = scene.receivers.as_ref().map(|boxes| Boxes { origin, boxes });
            let input = FitInput { receivers, ..FitInput::new(&views, scene.direction) };
            FitState::new().fit(&input, &technique, &mut Scratch::new(&mut storage)).unwrap()[0].projection
        };
        let a = snapped(&here);
        let [right, up] = [a.light_from_world.row(0), a.light_from_world.row(1)].map(|r| r.truncate().as_dvec3());
        let texel = exact_texel(&a, 0.0);
        // The f32 axes are not exactly orthonormal, so the step is solved for.
        let (xx, xy, yy) = (right.dot(right), right.dot(up), up.dot(up));
        let (s, t) = (texel.x * f64::from(i), texel.y * f64::from(j));
        let step = (right * (s * yy - t * xy) + up * (t * xx - s * xy)) / (xx * yy - xy * xy);
        let origin = here.frustum.origin + step;
        let b = snapped(&Scene { frustum: ViewFrustum { origin, ..here.frustum }, ..here.clone() });
        prop_assert_eq!(a.texel_size, b.texel_size);
        // The map's middle is rounded to f32, and the view's position to f64, by 1e-16 of it.
        let centre = |fit: &LightProjection| fit.light_from_world.w_axis.truncate().truncate().as_dvec2();
        let shift = ((centre(&b) - centre(&a)) / texel).abs().max_element();
        let rounding = 2e-7 * centre(&a).abs().max_element() / texel.min_element();
        prop_assert!(shift <= 1e-3 + rounding, "{shift} texels");
    }
}
