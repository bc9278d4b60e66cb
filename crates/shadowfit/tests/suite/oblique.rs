//! Views with tilted near planes: mirrors, water and portals, with all lenses and depth conventions. The
//! frustum contains the whole visible volume of such a view and is not much larger. The maps cover it, with
//! its casters.

use proptest::prelude::*;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::TestRunner;
use shadowfit::demand::{DepthRows, VisibleDemandSpace};
use shadowfit::glam::{DMat4, DVec2, DVec3, DVec4, Vec3};
use shadowfit::proof::{CoverageQuery, prove};
use shadowfit::{
    Aabb, Boxes, DepthConvention, FitError, FitInput, FittedMaps, PRESETS, Scratch, ShadowFitter, Technique,
    ViewFrustum,
};

use crate::scenes::{Lens, SceneView, any_light, any_view};
use crate::support::{any_direction, cases, double};

/// A plane through a point of a view. The eye is on its other side.
#[derive(Clone, Copy, Debug)]
struct TiltedPlane {
    /// Unit normal, pointing away from the eye.
    normal: DVec3,
    /// Distance of the eye, in metres.
    distance: f64,
    /// Factor of the clip depth. With 1, the far plane touches the farthest corner of the view.
    scale: f64,
}

/// A view with a replaced near plane.
#[derive(Clone, Copy, Debug)]
struct Oblique {
    view: SceneView,
    plane: TiltedPlane,
    /// Distance at which shadows end, in metres.
    distance: f32,
}

impl Oblique {
    /// Returns E. Lengyel's matrix, "Oblique view frustum depth projection and clipping", 2005, for any depth
    /// convention: from world axes relative to the eye to clip space.
    fn clip_from_eye(&self) -> DMat4 {
        let matrix = self.view.clip_from_eye();
        let depth = self.view.lens.depth;
        let plane = self.plane.normal.extend(-self.plane.distance);
        let plane = plane * (self.plane.scale / plane.dot(self.farthest_corner()));
        let mut rows = matrix.transpose();
        rows.z_axis = match depth {
            DepthConvention::ZeroToOne => plane,
            DepthConvention::Reversed => rows.w_axis - plane,
            DepthConvention::NegativeOneToOne => plane * 2.0 - rows.w_axis,
        };
        rows.transpose()
    }

    /// Returns the corner of the far plane that is farthest beyond the tilted plane, in homogeneous
    /// coordinates.
    fn farthest_corner(&self) -> DVec4 {
        let eye_from_clip = self.view.clip_from_eye().inverse();
        let clip_plane = eye_from_clip.transpose() * self.plane.normal.extend(-self.plane.distance);
        let far = f64::from(self.view.lens.depth.far());
        eye_from_clip * DVec4::new(clip_plane.x.signum(), clip_plane.y.signum(), far, 1.0)
    }

    /// Returns whether the matrix turns the plane around, since no corner of the far plane is beyond it.
    fn is_turned(&self) -> bool {
        self.plane.normal.extend(-self.plane.distance).dot(self.farthest_corner()) <= 0.0
    }

    fn frustum(&self) -> Result<ViewFrustum, FitError> {
        let world_from_clip = DMat4::from_translation(self.view.eye) * self.clip_from_eye().inverse();
        ViewFrustum::from_world_from_clip_f64(&world_from_clip, self.view.eye, self.view.lens.depth, self.distance)
    }

    /// Returns whether a point relative to the eye is in the picture and before the end of shadows.
    fn sees(&self, p: DVec3) -> bool {
        let clip = self.clip_from_eye() * p.extend(1.0);
        let (low, high) = match self.view.lens.depth {
            DepthConvention::NegativeOneToOne => (-clip.w, clip.w),
            _ => (0.0, clip.w),
        };
        let forward = self.view.axes()[2];
        clip.w > 0.0
            && clip.x.abs() <= clip.w
            && clip.y.abs() <= clip.w
            && (low..=high).contains(&clip.z)
            && p.dot(forward) <= f64::from(self.distance)
    }

    /// Returns points of the picture relative to the eye, by shares of its width, its height and its depth.
    fn points(&self, shares: &[[f64; 3]]) -> Vec<DVec3> {
        let (least, most) = (self.view.lens.near * 0.1, f64::from(self.distance));
        let depth = |share: f64| least * (most / least).powf(share);
        let points = shares.iter().map(|[x, y, share]| self.view.point(*x, *y, depth(*share)));
        points.filter(|p| self.sees(*p)).collect()
    }
}

/// Tilted planes that cut the view of a lens, at a distance that is a share of its depth.
fn any_plane() -> impl Strategy<Value = (Vec3, f64, f64)> {
    let scale = prop_oneof![3 => Just(1.0), 1 => double(0.4, 1.0)];
    (any_direction(), double(-3.0, -0.2).prop_map(|e| 10.0_f64.powf(e)), scale)
}

/// Views through tilted planes that leave something visible.
fn any_oblique() -> impl Strategy<Value = Oblique> {
    (any_view(), any_plane(), double(0.3, 1.5))
        .prop_map(|(view, (normal, distance, scale), end)| {
            let distance = distance * view.lens.far;
            let plane = TiltedPlane { normal: normal.as_dvec3().normalize(), distance, scale };
            Oblique { view, plane, distance: (view.lens.far * end) as f32 }
        })
        .prop_filter("the plane must leave some of the picture", |oblique| {
            // Before a plane that faces it, an orthographic view shows only points behind the camera.
            let is_ahead = view_is_ahead(oblique);
            is_ahead && !oblique.is_turned() && oblique.points(&grid(9)).len() > 12
        })
}

fn view_is_ahead(oblique: &Oblique) -> bool {
    let Oblique { view, plane, .. } = oblique;
    let lens = view.lens;
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(x, y)| view.point(x, y, lens.far));
    let is_cut = corners.iter().any(|corner| plane.normal.dot(*corner) > plane.distance);
    lens.is_perspective || is_cut && plane.normal.dot(view.axes()[2]) > 0.02
}

/// Returns shares at even steps along all three axes.
fn grid(side: u32) -> Vec<[f64; 3]> {
    let at = |i: u32| f64::from(i) / f64::from(side - 1);
    (0..side.pow(3)).map(|i| [at(i % side), at(i / side % side), at(i / side / side)]).collect()
}

/// Returns whether a frustum contains a point relative to its eye, up to a share of its distance.
fn holds(frustum: &ViewFrustum, p: DVec3, tolerance: f64) -> bool {
    let depth = p.dot(frustum.forward.as_dvec3());
    let (near, far) = (f64::from(frustum.near), f64::from(frustum.far));
    let free = tolerance * (p.length() + far.abs());
    let corners = frustum.corners.map(Vec3::as_dvec3);
    let centre = corners.iter().sum::<DVec3>() / 8.0;
    let is_inside = |side: usize| {
        let (a, b) = (corners[side + 4], corners[(side + 1) % 4 + 4]);
        let normal = (b - a).cross(a - corners[side]).normalize();
        let inward = if normal.dot(centre - a) < 0.0 { -normal } else { normal };
        inward.dot(p - a) >= -free
    };
    depth >= near - free && depth <= far + free && (0..4).all(is_inside)
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn all_that_a_tilted_near_plane_leaves_lies_in_the_frustum(
        oblique in any_oblique(),
        shares in prop::collection::vec([double(0.0, 1.0), double(0.0, 1.0), double(0.0, 1.0)], 200),
    ) {
        let (frustum, forward) = (oblique.frustum().unwrap(), oblique.view.axes()[2].as_vec3());
        prop_assert!(frustum.forward.abs_diff_eq(forward, 1e-5), "{} for {forward}", frustum.forward);
        for p in oblique.points(&shares).into_iter().chain(oblique.points(&grid(9))) {
            prop_assert!(holds(&frustum, p, 1e-6), "{p} is not in {frustum:?}");
        }
    }

    /// The elements of an f32 matrix define its picture, independent of the values that they were rounded
    /// from.
    #[test]
    fn all_that_an_f32_matrix_shows_lies_in_its_frustum(
        oblique in any_oblique(), clip in prop::collection::vec([double(-1.0, 1.0), double(-1.0, 1.0), double(-1.0, 1.0)], 200),
    ) {
        let Oblique { view, distance, .. } = oblique;
        let eye_from_clip = oblique.clip_from_eye().inverse().as_mat4();
        let Ok(frustum) = ViewFrustum::from_eye_from_clip(&eye_from_clip, view.eye, view.lens.depth, distance) else {
            // The far plane hardly differs from the near plane, so it may be lost to rounding.
            return Ok(());
        };
        let is_symmetric = view.lens.depth == DepthConvention::NegativeOneToOne;
        for [x, y, z] in clip {
            let at = eye_from_clip.as_dmat4() * DVec4::new(x, y, if is_symmetric { z } else { z.abs() }, 1.0);
            let p = at.truncate() / at.w;
            if at.w > 0.0 && p.dot(frustum.forward.as_dvec3()) <= f64::from(distance) {
                prop_assert!(holds(&frustum, p, 1e-5), "{p} is not in {frustum:?}");
            }
        }
    }
}

proptest! {
    #![proptest_config(cases(64))]

    /// With and without boxes, for every preset.
    #[test]
    fn all_that_a_tilted_near_plane_leaves_is_in_a_map_with_its_casters(oblique in any_oblique(), direction in any_light()) {
        let (views, eye) = ([oblique.frustum().unwrap()], oblique.view.eye);
        let (origin, to_light) = (eye.round(), -direction.as_dvec3().normalize());
        let half = f64::from(oblique.distance) * 0.01;
        let points: Vec<DVec3> = oblique.points(&grid(7)).into_iter().step_by(5).map(|p| eye + p).collect();
        let cube = |p: DVec3| {
            let p = p - origin;
            Aabb::new((p - half).as_vec3(), (p + half).as_vec3())
        };
        let casters: Vec<Aabb> = points.iter().map(|p| cube(*p + to_light * half * 7.0)).collect();
        let boxes: Vec<Aabb> = points.iter().map(|p| cube(*p)).chain(casters.iter().copied()).collect();
        // The XNA sample's map has no room for a filter.
        for preset in PRESETS.iter().filter(|preset| preset.name != "xna-1") {
            let technique = preset.technique().with_max_distance(oblique.distance);
            for known in [None, Some(Boxes { origin, boxes: &boxes })] {
                let input = FitInput { receivers: known, casters: known, ..FitInput::new(&views, direction) };
                let maps = *ShadowFitter::new(&technique).fit(&input).unwrap();
                assert_proven(&input, &maps, &technique);
                let volumes = maps.caster_volumes(&views, &technique).unwrap();
                for (p, caster) in points.iter().zip(&casters) {
                    let depth = (*p - eye).dot(views[0].forward.as_dvec3());
                    if depth > f64::from(oblique.distance) * (1.0 - 1e-6) {
                        continue;
                    }
                    let read = maps.read(&technique, *p, depth);
                    let read = read.unwrap_or_else(|| panic!("{p} is in no map of {}", preset.name));
                    prop_assert!(maps[read.map].projection.covers(*p));
                    if known.is_some() {
                        let volume = volumes[read.map].relative_to(origin);
                        prop_assert!(volume.intersects_aabb(caster.min, caster.max), "{caster:?} is culled");
                    }
                }
            }
        }
    }
}

/// Asserts that no map of a frame has a hole.
fn assert_proven(input: &FitInput, maps: &FittedMaps, technique: &Technique) {
    let mut storage = vec![DVec2::ZERO; input.scratch()];
    for (i, map) in maps.iter().enumerate() {
        let query = CoverageQuery::of_map(map, technique, technique.filter_radius_in(&map.projection))
            .with_normal_offset(map.bias.normal_offset);
        let proof = prove(input, &map.projection, &query, &mut Scratch::new(&mut storage)).unwrap();
        assert!(proof.is_proven(), "map {i}: {proof:?} of {:?}", technique.maps);
    }
}

/// Returns the share of a frustum that its view shows, by points at even steps.
fn shown(oblique: &Oblique) -> f64 {
    const STEPS: u32 = 12;
    let frustum = oblique.frustum().unwrap();
    let corner = frustum.corners.map(Vec3::as_dvec3);
    let (mut shown, mut all) = (0.0, 0.0);
    for i in 0..STEPS.pow(3) {
        let [x, y, z] =
            [i % STEPS, i / STEPS % STEPS, i / STEPS / STEPS].map(|i| (f64::from(i) + 0.5) / f64::from(STEPS));
        let at = |c: usize| {
            let (top, bottom) = (corner[c].lerp(corner[c + 1], x), corner[c + 3].lerp(corner[c + 2], x));
            top.lerp(bottom, y)
        };
        let width = |c: usize| corner[c].distance(corner[c + 1]);
        let area = (width(0) * (1.0 - z) + width(4) * z).powi(2);
        all += area;
        shown += if oblique.sees(at(0).lerp(at(4), z)) { area } else { 0.0 };
    }
    shown / all
}

#[test]
fn frusta_are_not_much_larger_than_what_they_are_for() {
    let mut runner = TestRunner::deterministic();
    let mut shares: Vec<f64> =
        (0..200).map(|_| shown(&any_oblique().new_tree(&mut runner).unwrap().current())).collect();
    shares.sort_by(f64::total_cmp);
    let [tenth, quarter, half] = [20, 50, 100].map(|i| shares[i]);
    assert!(tenth > 0.25 && quarter > 0.4 && half > 0.6, "{tenth} {quarter} {half}");
}

/// Returns a camera over water that looks down by an angle, mirrored at the water.
fn mirrored(height: f64, pitch: f64) -> Oblique {
    let lens = Lens {
        is_perspective: true,
        left: -0.8,
        right: 0.8,
        bottom: -0.5,
        top: 0.5,
        near: 0.1,
        far: 300.0,
        is_infinite: false,
        is_mirrored: true,
        depth: DepthConvention::ZeroToOne,
    };
    let forward = DVec3::new(-0.1, pitch.tan(), -1.0).normalize().as_vec3();
    let view = SceneView { lens, eye: DVec3::new(10.0, -height, 90.0), forward, up: Vec3::Y };
    Oblique { view, plane: TiltedPlane { normal: DVec3::Y, distance: height, scale: 1.0 }, distance: 200.0 }
}

#[test]
fn a_mirror_s_frustum_leaves_out_what_lies_under_the_water() {
    for (height, pitch) in [(1.7, 0.0), (1.7, 0.2), (10.0, 0.4), (30.0, 1.0)] {
        let oblique = mirrored(height, pitch);
        let (frustum, share) = (oblique.frustum().unwrap(), shown(&oblique));
        assert!(share > 0.75, "{height} m, {pitch}: {share}");
        // The upper edge of the picture meets the water first.
        let [_, up, forward] = oblique.view.axes();
        let least = height / (forward.y + 0.5 * up.y);
        let near = f64::from(frustum.near) / least;
        assert!((0.91..=1.0).contains(&near), "{height} m, {pitch}: {near}");
    }
}

/// The state that is held from frame to frame depends on the lens and on the depth at which shadows begin.
#[test]
fn frusta_of_a_moving_mirror_mostly_keep_their_lens() {
    let lens = |i: u32| {
        let oblique = mirrored(3.0 + 0.2 * (f64::from(i) * 0.05).sin(), 0.3 + 0.02 * (f64::from(i) * 0.031).cos());
        let frustum = oblique.frustum().unwrap();
        // The planes, and the angles of the sides up to rounding.
        let tangent = |c: usize| (frustum.corners[c].length() / frustum.far * 1e4).round();
        (frustum.near.to_bits(), frustum.far.to_bits(), [4, 5, 6, 7].map(tangent).map(f32::to_bits))
    };
    let changes = (1..400).filter(|i| lens(*i) != lens(i - 1)).count();
    assert!(changes <= 12, "{changes} of 400 frames");
}

/// A near plane that is turned by 180° shows the eye's own side of it.
#[test]
fn a_near_plane_that_faces_the_eye_is_refused_by_name() {
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne] {
        let mut oblique = mirrored(2.0, 0.3);
        oblique.view.lens.depth = depth;
        let read =
            |matrix: DMat4, named| ViewFrustum::from_world_from_clip_f64(&matrix.inverse(), DVec3::ZERO, named, 200.0);
        let matrix = oblique.clip_from_eye();
        assert!(read(matrix, depth).is_ok());
        // A plane that is turned around keeps its far plane.
        let mut rows = matrix.transpose();
        rows.z_axis = match depth {
            DepthConvention::Reversed => rows.w_axis * 2.0 - rows.z_axis,
            _ => -rows.z_axis,
        };
        let (other, advice) = match depth {
            DepthConvention::Reversed => (DepthConvention::ZeroToOne, "name DepthConvention::Reversed"),
            _ => (DepthConvention::Reversed, "not reversed"),
        };
        for (matrix, named, part) in [(rows.transpose(), depth, "turn the plane around"), (matrix, other, advice)] {
            let error = read(matrix, named).unwrap_err();
            assert!(matches!(error, FitError::UnusablePlane { plane: "near plane", .. }), "{depth:?}: {error}");
            assert!(error.to_string().contains(part), "{depth:?}: {error}");
        }
    }
}

#[test]
fn planes_of_a_picture_that_cannot_be_divided_by_w_are_named() {
    let identity = DMat4::IDENTITY;
    let with_w = |x: f64, y: f64, w: f64| DMat4 {
        x_axis: identity.x_axis.with_w(x),
        y_axis: identity.y_axis.with_w(y),
        w_axis: identity.w_axis.with_w(w),
        ..identity
    };
    for (matrix, plane) in [
        (with_w(1.5, 0.0, 1.0), "left plane"),
        (with_w(-1.0, 0.0, 1.0), "right plane"),
        (with_w(0.1, 2.0, 1.0), "bottom plane"),
        (with_w(0.1, -2.0, 1.0), "top plane"),
    ] {
        let error = ViewFrustum::from_eye_from_clip(&matrix.as_mat4(), DVec3::ZERO, DepthConvention::ZeroToOne, 50.0);
        let text = error.unwrap_err().to_string();
        assert!(text.contains(plane) && text.contains("changes its sign"), "{text}");
    }
    // A keystone projection with positive w.
    let frustum = ViewFrustum::from_eye_from_clip(
        &with_w(0.4, 0.2, 1.0).as_mat4(),
        DVec3::ZERO,
        DepthConvention::ZeroToOne,
        50.0,
    );
    assert_eq!(frustum.unwrap().forward, Vec3::Z);
}

/// With a far-tilted plane and an infinite lens, some rays have no end.
#[test]
fn a_tilted_far_plane_at_infinity_needs_a_distance() {
    let oblique = Oblique { distance: f32::MAX, ..mirrored(2.0, 0.1) };
    assert_eq!(oblique.frustum(), Err(FitError::Endless));
}

/// All visible points are behind the end of shadows.
#[test]
fn a_mirror_beyond_the_shadows_is_an_empty_view() {
    let mut oblique = mirrored(100.0, 0.8);
    oblique.distance = 40.0;
    let frustum = oblique.frustum().unwrap();
    assert!(frustum.is_empty() && !frustum.begins_before(f32::MAX) && frustum.near > 90.0, "{frustum:?}");
    oblique.distance = 200.0;
    assert!(!oblique.frustum().unwrap().is_empty());
}

#[test]
fn a_mirror_s_depth_buffer_is_counted_where_its_points_are() {
    const SIZE: [u32; 2] = [80, 50];
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne] {
        let mut oblique = mirrored(2.0, 0.3);
        (oblique.view.lens.depth, oblique.view.lens.is_mirrored) = (depth, false);
        let view = oblique.frustum().unwrap();
        let space = VisibleDemandSpace::new(&view, Vec3::new(0.2, -0.7, -0.5), Vec3::Y, 200.0).unwrap();
        // A wall over the water, 40 m away, square to the light's horizon.
        let wall = -40.0;
        let counted = |clip_from_world: DMat4| {
            let world_from_clip = clip_from_world.inverse();
            let stored = |i: u32| {
                let ndc = |i: u32, side: u32| (f64::from(i) + 0.5) / f64::from(side) * 2.0 - 1.0;
                let (x, y) = (ndc(i % SIZE[0], SIZE[0]), -ndc(i / SIZE[0], SIZE[1]));
                // Any two points of a ray give its direction.
                let [a, b] = [0.2, 0.8].map(|z| world_from_clip * DVec4::new(x, y, z, 1.0));
                let ray = (a.truncate() * b.w - b.truncate() * a.w).normalize();
                let clip = clip_from_world * (ray * (wall / ray.z)).extend(1.0);
                let z = clip.z / clip.w;
                let is_shown = (wall / ray.z * ray).y > 2.0;
                let z = if is_shown { z } else { f64::from(depth.far()) };
                (if depth == DepthConvention::NegativeOneToOne { z * 0.5 + 0.5 } else { z }) as f32
            };
            let depths: Vec<f32> = (0..SIZE[0] * SIZE[1]).map(stored).collect();
            let mut seen = shadowfit::VisibleDemand::new(space);
            let clip_from_world = clip_from_world.as_mat4();
            let rows = DepthRows { depths: &depths, width: SIZE[0], clip_from_world, depth, view: &view };
            seen.count_rows(&rows, 1).unwrap();
            let bins = seen.histogram().bins.to_vec();
            (seen.demand().counts.iter().sum::<u32>(), bins.iter().sum::<u32>(), bins)
        };
        let (tilted, plain) = (counted(oblique.clip_from_eye()), counted(oblique.view.clip_from_eye()));
        assert!(plain.1 > 500, "{depth:?}: {}", plain.1);
        assert!(tilted.1.abs_diff(plain.1) * 20 < plain.1, "{depth:?}: {} and {}", tilted.1, plain.1);
        assert!(tilted.0.abs_diff(plain.0) * 20 < plain.0, "{depth:?}: {} and {} in the grid", tilted.0, plain.0);
        let moved: u32 = tilted.2.iter().zip(&plain.2).map(|(a, b)| a.abs_diff(*b)).sum();
        assert!(moved * 10 < plain.1, "{depth:?}: {moved} of {} points are elsewhere", plain.1);
    }
}

/// A camera below the water's surface that looks down, with a near plane that leaves only the objects above
/// the surface.
#[test]
fn a_plane_that_hides_the_whole_picture_leaves_an_empty_view() {
    let (tangent, pitch) = (DVec2::new(0.8, 0.5), 0.8_f64);
    let forward = DVec3::new(0.0, -pitch.sin(), -pitch.cos());
    let up = DVec3::new(0.0, pitch.cos(), -pitch.sin());
    let rows = [
        (DVec3::X / tangent.x).extend(0.0),
        (up / tangent.y).extend(0.0),
        DVec4::new(0.0, 1.0, 0.0, -2.0),
        forward.extend(0.0),
    ];
    let clip_from_eye = DMat4::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose();
    for distance in [50.0, f32::MAX] {
        let matrix = clip_from_eye.inverse();
        let view = ViewFrustum::from_world_from_clip_f64(&matrix, DVec3::ZERO, DepthConvention::ZeroToOne, distance);
        assert!(view.unwrap().is_empty(), "{view:?}");
    }
}
