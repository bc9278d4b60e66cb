//! The swept receiver volume keeps every caster with a visible shadow, and few other casters.

use proptest::prelude::*;
use shadowfit::bias::FilterRadius;
use shadowfit::culling::Sweep;
use shadowfit::fit_scene;
use shadowfit::glam::{DVec2, DVec3, Vec2, Vec3};
use shadowfit::settings::{FitKind, FitSettings, MapSelection, SplitScheme, Stabilise};
use shadowfit::{
    Aabb, Boxes, Cascades, CasterVolume, FitError, FitInput, FitState, LightProjection, Scratch, ViewFrustum,
};

use crate::support::{DIRECTION, any_direction, camera, cases, double, exact, fitted, float, sliced};

const ALL_KINDS: [FitKind; 5] =
    [FitKind::XnaSample, FitKind::FrustumAabb, FitKind::Oriented, FitKind::Sphere, FitKind::Focused];

/// The rectangles of a view: from `low` to `high` along its right and up axes, in units of the depth
/// (perspective) or metres (orthographic).
#[derive(Clone, Copy, Debug)]
struct Lens {
    forward: Vec3,
    up: Vec3,
    low: Vec2,
    high: Vec2,
    near: f32,
    far: f32,
    is_orthographic: bool,
    is_mirrored: bool,
}

impl Lens {
    fn frustum(&self, origin: DVec3) -> ViewFrustum {
        let forward = self.forward.as_dvec3().normalize();
        let right = forward.cross(self.up.as_dvec3()).normalize();
        let up = right.cross(forward);
        let corner = |depth: f32, x: f32, y: f32| {
            let scale = if self.is_orthographic { 1.0 } else { f64::from(depth) };
            let side = right * f64::from(x) + up * f64::from(y);
            (forward * f64::from(depth) + side * scale).as_vec3()
        };
        let (left, right) = if self.is_mirrored { (self.high.x, self.low.x) } else { (self.low.x, self.high.x) };
        let picture = [(left, self.high.y), (right, self.high.y), (right, self.low.y), (left, self.low.y)];
        let mut corners = [Vec3::ZERO; 8];
        for (i, (x, y)) in picture.into_iter().enumerate() {
            corners[i] = corner(self.near, x, y);
            corners[i + 4] = corner(self.far, x, y);
        }
        ViewFrustum { origin, corners, near: self.near, far: self.far, forward: forward.as_vec3() }
    }
}

/// Perspective, orthographic, off-axis and mirrored views in any orientation.
fn any_lens() -> impl Strategy<Value = Lens> {
    let sides = (float(-1.5, 0.9), float(-1.5, 0.9), float(0.1, 2.0), float(0.1, 2.0));
    let depths = (float(-2.0, 1.0), float(0.3, 4.0));
    (any_direction(), any_direction(), sides, depths, any::<bool>(), any::<bool>())
        .prop_filter("up must not be parallel to forward", |(forward, up, ..)| forward.cross(*up).length() > 0.1)
        .prop_map(|(forward, up, (x, y, w, h), (near, ratio), is_orthographic, is_mirrored)| {
            let near = 10.0_f32.powf(near);
            let scale = if is_orthographic { near * 10.0 } else { 1.0 };
            let (low, high) = (Vec2::new(x, y) * scale, Vec2::new(x + w, y + h) * scale);
            Lens { forward, up, low, high, near, far: near * 10.0_f32.powf(ratio), is_orthographic, is_mirrored }
        })
}

/// One view, the eyes of a headset, or two views with different directions.
fn any_views() -> impl Strategy<Value = Vec<ViewFrustum>> {
    let eye = prop_oneof![
        Just(DVec3::ZERO),
        (double(-1e5, 1e5), double(-1e5, 1e5), double(-1e5, 1e5)).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    ];
    (any_lens(), any_lens(), eye, 0..3_u8, any_direction()).prop_map(|(one, other, eye, sort, aside)| match sort {
        0 => vec![one.frustum(eye)],
        1 => vec![one.frustum(eye), one.frustum(eye + aside.as_dvec3() * 0.065)],
        _ => vec![one.frustum(eye), other.frustum(eye + aside.as_dvec3() * 20.0)],
    })
}

/// Returns the point of a view at shares of its picture and of a depth range.
fn point_in(view: &ViewFrustum, near: f64, far: f64, share: DVec3) -> DVec3 {
    let depth = near + (far - near) * share.z;
    let t = (depth - f64::from(view.near)) / f64::from(view.far - view.near);
    let corner = |i: usize| view.corners[i].as_dvec3() * (1.0 - t) + view.corners[i + 4].as_dvec3() * t;
    let top = corner(0) * (1.0 - share.x) + corner(1) * share.x;
    let bottom = corner(3) * (1.0 - share.x) + corner(2) * share.x;
    view.origin + top * (1.0 - share.y) + bottom * share.y
}

fn fit_of(views: &[ViewFrustum], direction: Vec3, settings: &FitSettings, receivers: Option<Boxes>) -> LightProjection {
    let mut storage = vec![DVec2::ZERO; Scratch::required(1, views.len())];
    let input = FitInput { receivers, ..FitInput::new(views, direction) };
    fit_scene(&input, settings, &mut Scratch::new(&mut storage)).unwrap()
}

/// Returns an f32 box that contains an f64 point.
fn box_around(point: DVec3, half: f32, share: Vec3) -> (Vec3, Vec3) {
    let (low, high) = (point.as_vec3() - share * half, point.as_vec3() + (Vec3::ONE - share) * half);
    let down = |v: f32, p: f64| if f64::from(v) > p { v.next_down() } else { v };
    let up = |v: f32, p: f64| if f64::from(v) < p { v.next_up() } else { v };
    (
        Vec3::new(down(low.x, point.x), down(low.y, point.y), down(low.z, point.z)),
        Vec3::new(up(high.x, point.x), up(high.y, point.y), up(high.z, point.z)),
    )
}

/// Returns the texture coordinates of a world position, in f64.
fn uv(fit: &LightProjection, p: DVec3) -> DVec2 {
    let m = fit.uv_from_world.as_dmat4();
    let p = p - fit.origin;
    (m.x_axis * p.x + m.y_axis * p.y + m.z_axis * p.z + m.w_axis).truncate().truncate()
}

/// Positions of a sampled caster and its receiver.
#[derive(Clone, Debug)]
struct Sample {
    view: usize,
    at: DVec3,
    lift: Vec3,
    taps: Vec2,
    disc: Vec2,
    toward_light: f64,
    half: f32,
    share: Vec3,
}

fn any_sample() -> impl Strategy<Value = Sample> {
    // Corners and edges of the picture and of the depth range are as frequent as inner points.
    let share = || prop_oneof![double(0.0, 1.0), Just(0.0), Just(1.0)];
    let signed = || prop_oneof![float(-1.0, 1.0), Just(-1.0), Just(1.0)];
    (
        0..2_usize,
        (share(), share(), share()),
        any_direction(),
        (signed(), signed()),
        (double(0.0, std::f64::consts::TAU), float(0.0, 1.0)),
        (double(-3.0, 4.0), float(-4.0, 2.0)),
        (float(0.0, 1.0), float(0.0, 1.0), float(0.0, 1.0)),
    )
        .prop_map(|(view, (x, y, z), lift, taps, (turn, radius), (along, half), (a, b, c))| Sample {
            view,
            at: DVec3::new(x, y, z),
            lift,
            taps: Vec2::new(taps.0, taps.1),
            disc: DVec2::from_angle(turn).as_vec2() * radius,
            toward_light: 10.0_f64.powf(along),
            half: 10.0_f32.powf(half),
            share: Vec3::new(a, b, c),
        })
}

proptest! {
    #![proptest_config(cases(2000))]

    /// Checks receivers anywhere in the view, moved by the normal offset, with the filter's footprint around
    /// them: a caster over the footprint is kept.
    #[test]
    fn a_caster_that_casts_a_shadow_into_view_is_kept(
        views in any_views(), direction in any_direction(), kind in prop::sample::select(&ALL_KINDS[..]),
        (cut_a, cut_b) in (double(0.0, 1.0), double(0.0, 1.0)), sample in any_sample(),
        (taps, disc, offset) in (float(0.0, 4.0), float(0.0, 8.0), float(0.0, 1.0)),
    ) {
        let near = views.iter().map(|view| view.near).fold(f32::MAX, f32::min);
        let far = views.iter().map(|view| view.far).fold(f32::MIN, f32::max);
        // The depths are f32 numbers, and the receiver's depths derive from them.
        let at = |share: f64| near + ((far - near) as f64 * share * share * share) as f32;
        let (near, far) = (at(cut_a.min(cut_b)), at(cut_a.max(cut_b)));
        prop_assume!(near < far);
        let view = &views[sample.view % views.len()];
        let (from, to) = (near.max(view.near), far.min(view.far));
        prop_assume!(from < to);
        let receiver = point_in(view, from.into(), to.into(), sample.at);

        // Focused on the nearer half of the view, which then contains the receivers.
        let middle = point_in(view, from.into(), to.into(), DVec3::splat(0.5)) - view.origin;
        let size = Vec3::splat((to - from) * 2.0);
        let receivers = [Aabb::new(middle.as_vec3() - size, middle.as_vec3() + size)];
        let receivers = (kind == FitKind::Focused).then_some(Boxes { origin: view.origin, boxes: &receivers });
        let reach = FilterRadius { taps, disc: Vec2::new(disc, disc * 0.5) };
        let settings = exact(kind).with_border(taps + disc + 1.0).with_max_distance(far);
        let fit = fit_of(&views, direction, &settings, receivers);

        let normal_offset = offset * (to - from).min(1.0);
        let looked_up = receiver + sample.lift.normalize().as_dvec3() * f64::from(normal_offset);
        prop_assume!(fit.covers(looked_up));
        let texels = sample.taps * taps + sample.disc * reach.disc;
        let across = fit.light_from_world.transpose();
        let (x, y) = (across.x_axis.truncate().as_dvec3(), across.y_axis.truncate().as_dvec3());
        let aside = x * f64::from(texels.x * fit.texel_size.x) + y * f64::from(texels.y * fit.texel_size.y);
        let caster = looked_up + aside - fit.direction.as_dvec3() * sample.toward_light;
        let in_map = uv(&fit, caster);
        prop_assume!(in_map.cmpge(DVec2::ZERO).all() && in_map.cmple(DVec2::ONE).all());

        let sweep = Sweep { near, far, filter_radius: reach, normal_offset, ..Sweep::new(&views) };
        let volume = CasterVolume::swept(&fit, &sweep).unwrap();
        // Relative to the fit's origin, and to the world's origin, which is up to 170 km away.
        let elsewhere = CasterVolume::swept(&fit.relative_to(DVec3::ZERO), &sweep).unwrap();
        for volume in [volume, volume.relative_to(DVec3::ZERO), elsewhere] {
            let (min, max) = box_around(caster - volume.origin, sample.half, sample.share);
            prop_assert!(volume.intersects_aabb(min, max), "{min} {max} relative to {}", volume.origin);
        }
    }

    /// For both selections, and for two blended maps.
    #[test]
    fn no_map_of_several_loses_a_caster_by_its_own_volume(
        lens in any_lens(), direction in any_direction(), kind in 0..5_usize,
        (is_bordered, is_held) in any::<(bool, bool)>(), selection in prop::sample::select(vec![
            MapSelection::default(), MapSelection::ViewDepth { overlap: 0.0 }, MapSelection::ViewDepth { overlap: 0.3 },
        ]),
        points in prop::collection::vec(prop::array::uniform3(double(0.0, 1.0)), 12), half in float(0.001, 0.2),
    ) {
        let views = [lens.frustum(DVec3::new(12.0, 3.0, -40.0))];
        let fit = FitSettings::default().with_kind(ALL_KINDS[kind]).with_casters(shadowfit::settings::CasterPolicy::DepthClamp);
        let fit = if is_bordered { fit } else { fit.with_border(0.0) };
        let stabilise = if is_held { Stabilise::default() } else { Stabilise::Off };
        let splits = SplitScheme::Practical(0.5);
        let technique = sliced(&fit, Cascades { splits, stabilise, selection, ..Cascades::default() });
        let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
        let input = FitInput::new(&views, direction);
        let fitted = FitState::new().fit(&input, &technique, &mut Scratch::new(&mut storage));
        prop_assume!(fitted.is_ok());
        let maps = fitted.unwrap();
        let volumes = maps.caster_volumes(&views, &technique).unwrap();
        let (view, to_light) = (&views[0], -direction.as_dvec3());
        for share in points.into_iter().map(DVec3::from_array) {
            let point = point_in(view, f64::from(view.near), f64::from(view.far), share);
            let depth = (point - view.origin).dot(view.forward.as_dvec3());
            let Some(read) = maps.read(&technique, point, depth) else { continue };
            for map in [Some(read.map), read.blend.map(|blend| blend.map)].into_iter().flatten() {
                let (map, volume) = (&maps[map], &volumes[map]);
                let over = point + to_light * f64::from(view.far) * share.x - map.projection.origin;
                let half = Vec3::splat(half * view.far);
                let centre = over.as_vec3();
                let kind = ALL_KINDS[kind];
                prop_assert!(volume.intersects_aabb(centre - half, centre + half), "{point} by {kind:?}, {selection:?}");
            }
        }
    }

    #[test]
    fn a_swept_volume_holds_no_more_than_the_map_but_toward_the_light(
        lens in any_lens(), direction in any_direction(), kind in prop::sample::select(&ALL_KINDS[..]),
        (x, y, z) in (float(-2.0, 2.0), float(-2.0, 2.0), float(-2.0, 2.0)), half in float(-4.0, 2.0),
    ) {
        let views = [lens.frustum(DVec3::ZERO)];
        let fit = fit_of(&views, direction, &exact(kind), None);
        let swept = CasterVolume::swept(&fit, &Sweep::new(&views)).unwrap().cut_at_near_plane(&fit);
        let size = (fit.box_max - fit.box_min).max_element();
        let (centre, half) = (fit.corners().into_iter().sum::<Vec3>() / 8.0, size * 10.0_f32.powf(half));
        let centre = centre + Vec3::new(x, y, z) * size;
        if swept.intersects_aabb(centre - half, centre + half) {
            prop_assert!(fit.caster_volume().intersects_aabb(centre - half, centre + half));
        }
    }
}

/// A half space: a point p is inside where n·p + d >= 0.
type HalfSpace = (DVec3, f64);

/// Returns whether the intersection of half spaces, which bound a volume, is not empty, with a `margin` in
/// metres. If so, three of their planes meet in a point of it.
fn meet(planes: &[HalfSpace], margin: f64) -> bool {
    let inside = |p: DVec3| planes.iter().all(|(n, d)| n.dot(p) + d >= margin - 1e-9);
    let shifted = |i: usize| (planes[i].0, planes[i].1 - margin);
    for i in 0..planes.len() {
        for j in 0..i {
            for k in 0..j {
                let [(a, da), (b, db), (c, dc)] = [i, j, k].map(shifted);
                let volume = a.dot(b.cross(c));
                if volume.abs() > 1e-9 && inside(-(b.cross(c) * da + c.cross(a) * db + a.cross(b) * dc) / volume) {
                    return true;
                }
            }
        }
    }
    false
}

/// Returns the planes of a view.
fn planes_of(view: &ViewFrustum) -> Vec<HalfSpace> {
    let c = view.corners.map(Vec3::as_dvec3);
    let centre = c.into_iter().sum::<DVec3>() / 8.0;
    [[4, 5, 1], [5, 6, 2], [6, 7, 3], [7, 4, 0], [0, 1, 2], [4, 5, 6]]
        .map(|[i, j, k]| {
            let normal = (c[j] - c[i]).cross(c[k] - c[i]).normalize();
            let normal = if normal.dot(centre - c[i]) < 0.0 { -normal } else { normal };
            (normal, -normal.dot(c[i]))
        })
        .to_vec()
}

/// Returns the planes of a box together with the volume that it shadows.
fn shadow_of(min: Vec3, max: Vec3, direction: Vec3) -> Vec<HalfSpace> {
    let (min, max, direction) = (min.as_dvec3(), max.as_dvec3(), direction.as_dvec3());
    let mut planes = Vec::new();
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        let across = axis.cross(direction).normalize_or_zero();
        for normal in [axis, -axis, across, -across] {
            if normal != DVec3::ZERO && normal.dot(direction) >= -1e-12 {
                let least = (normal * min).min(normal * max);
                planes.push((normal, -least.element_sum()));
            }
        }
    }
    planes
}

/// Returns boxes over and around a view with realistic sizes: up to a share of the view's size, and not much
/// farther away.
fn boxes_around(view: &ViewFrustum, half: f64, count: usize) -> impl Iterator<Item = (Vec3, Vec3)> {
    let (low, high) = view.corners.iter().fold((Vec3::MAX, Vec3::MIN), |(low, high), c| (low.min(*c), high.max(*c)));
    let (middle, size) = ((low + high) * 0.5, high - low);
    // The fractional parts of multiples of three irrational numbers fill the cube evenly.
    let at = |i: usize, step: f64| ((i as f64 + 1.0) * step).fract();
    (0..count).map(move |i| {
        let share = DVec3::new(at(i, 0.819_172_5), at(i, 0.671_043_6), at(i, 0.549_700_5)).as_vec3();
        let extent = DVec3::new(at(i, 0.618_034), at(i, 0.414_213_6), at(i, 0.732_050_8)).as_vec3();
        let half = size * (half as f32) * (extent + 0.05);
        let centre = middle + size * (share - 0.5) * 3.0;
        (centre - half, centre + half)
    })
}

/// Number of boxes that cast a shadow into view, and number of other boxes that are kept.
#[derive(Debug, Default)]
struct Counts {
    shadowing: usize,
    others: usize,
    kept_in_vain: usize,
    kept_in_vain_by_the_map: usize,
}

impl Counts {
    /// Returns the number of unnecessary boxes per box that casts a shadow into view.
    fn waste(&self) -> f64 {
        self.kept_in_vain as f64 / self.shadowing as f64
    }
}

/// Counts boxes. Panics if a box that casts a shadow into view is culled.
fn count(fit: &LightProjection, view: &ViewFrustum, half: f64) -> Counts {
    let sweep = Sweep { filter_radius: FilterRadius::taps(0.0), ..Sweep::new(std::slice::from_ref(view)) };
    let volume = CasterVolume::swept(fit, &sweep).unwrap();
    let slice = planes_of(view);
    // The footprint of one texel, and rounding.
    let margin = f64::from(fit.texel_size.max_element()) * 2.0 + 1e-4;
    let mut counts = Counts::default();
    for (min, max) in boxes_around(view, half, 4000) {
        let planes: Vec<_> = slice.iter().copied().chain(shadow_of(min, max, fit.direction)).collect();
        let is_kept = volume.intersects_aabb(min, max);
        if meet(&planes, 1e-4) {
            counts.shadowing += 1;
            assert!(is_kept, "{min} {max} throws a shadow into view");
        } else if !meet(&planes, -margin) {
            counts.others += 1;
            counts.kept_in_vain += usize::from(is_kept);
            counts.kept_in_vain_by_the_map += usize::from(fit.caster_volume().intersects_aabb(min, max));
        }
    }
    counts
}

/// Reproduces the figures in the documentation of `CasterVolume`.
#[test]
fn few_boxes_without_a_shadow_in_view_are_kept() {
    let view = camera().frustum().unwrap();
    for kind in ALL_KINDS {
        let fit = fitted(&camera(), DIRECTION, &exact(kind).with_caster_extension(200.0));
        for (half, most) in [(0.02, 0.01), (0.1, 0.07), (0.5, 0.25)] {
            let counts = count(&fit, &view, half);
            println!("{kind:?}, half extents up to {half} of the view: {counts:?}, waste {:.3}", counts.waste());
            assert!(counts.shadowing > 100 && counts.others > 3000);
            assert!(counts.waste() <= most, "{kind:?}, {half}: {counts:?}");
            assert!(counts.kept_in_vain_by_the_map > 3 * counts.kept_in_vain, "{kind:?}, {half}: {counts:?}");
        }
    }
}

#[test]
fn from_every_side_no_caster_is_lost_and_few_others_are_kept() {
    let turns = [0.1, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    for (height, turn) in [-0.9_f64, -0.5, -0.05, 0.3, 0.8].into_iter().flat_map(|y| turns.map(|turn| (y, turn))) {
        let level = (1.0 - height * height).sqrt();
        let direction = DVec3::new(level * f64::cos(turn), height, level * f64::sin(turn)).as_vec3();
        let fit = fitted(&camera(), direction, &exact(FitKind::Oriented).with_caster_extension(200.0));
        let counts = count(&fit, &camera().frustum().unwrap(), 0.1);
        assert!(counts.waste() < 0.1, "{direction}: {counts:?}");
    }
}

#[test]
fn a_long_box_past_a_corner_of_the_outline_is_the_known_false_positive() {
    // For a light from above, the view is a square on its corner.
    let lens = Lens {
        forward: Vec3::new(1.0, 0.0, -1.0),
        up: Vec3::Y,
        low: Vec2::NEG_ONE,
        high: Vec2::ONE,
        near: 0.0,
        far: 2.0,
        is_orthographic: true,
        is_mirrored: false,
    };
    let views = [lens.frustum(DVec3::ZERO)];
    let fit = fit_of(&views, Vec3::NEG_Y, &exact(FitKind::Oriented), None);
    let volume = CasterVolume::swept(&fit, &Sweep::new(&views)).unwrap();
    let corner = views[0].corners.into_iter().map(|c| c.x).fold(f32::MIN, f32::max);
    let beyond = |x: f32, half: f32, z: f32| {
        let centre = Vec3::new(corner + x, 5.0, z);
        volume.intersects_aabb(centre - Vec3::new(0.1, 0.1, half), centre + Vec3::new(0.1, 0.1, half))
    };
    // No part of the box is over the view, but it is not behind any side plane. A short box is.
    let middle = -std::f32::consts::FRAC_1_SQRT_2;
    assert!(beyond(0.2, 5.0, middle));
    assert!(!beyond(0.2, 0.05, middle));
}

/// Returns an orthographic view from above, 2 m wide and high, around a point of the ground.
fn from_above(x: f64, z: f64) -> ViewFrustum {
    let lens = Lens {
        forward: Vec3::NEG_Y,
        up: Vec3::NEG_Z,
        low: Vec2::NEG_ONE,
        high: Vec2::ONE,
        near: 1.0,
        far: 3.0,
        is_orthographic: true,
        is_mirrored: false,
    };
    lens.frustum(DVec3::new(x, 0.0, z))
}

#[test]
fn several_views_share_the_outline_around_them_all() {
    // Two squares, the second one 10 m to the right and 10 m down in the picture: their hull is a hexagon.
    let views = [from_above(0.0, 0.0), from_above(10.0, 10.0)];
    let fit = fit_of(&views, Vec3::NEG_Y, &exact(FitKind::FrustumAabb), None);
    let volume = CasterVolume::swept(&fit, &Sweep::new(&views)).unwrap();
    let touches = |x: f32, z: f32| volume.intersects_sphere(Vec3::new(x, 4.0, z), 0.1);
    assert!(touches(0.0, 0.0) && touches(10.0, 10.0) && touches(5.0, 5.0) && touches(-1.05, -1.05));
    // Outside the band between them, but inside the box around both: the band is 2 √2 m wide, plus 0.1 m.
    assert!(touches(6.0, 4.0) && !touches(6.2, 4.0 - 0.2) && !touches(0.0, 10.0) && !touches(10.0, 0.0));
    // Casters below the views cast no shadow into them.
    assert!(!volume.intersects_sphere(Vec3::new(0.0, -3.2, 0.0), 0.1));
    assert!(volume.intersects_sphere(Vec3::new(0.0, -2.9, 0.0), 0.1));
}

#[test]
fn an_outline_of_many_edges_is_simplified_outward() {
    // More and more views around a circle. The last ones have more corners than the storage.
    for count in [3, 8, 30, 400] {
        let turn = std::f64::consts::TAU / f64::from(count);
        let views: Vec<_> =
            (0..count).map(|i| f64::from(i) * turn).map(|a| from_above(100.0 * a.cos(), 100.0 * a.sin())).collect();
        let fit = fit_of(&views, Vec3::new(0.2, -1.0, 0.1), &exact(FitKind::FrustumAabb), None);
        let volume = CasterVolume::swept(&fit, &Sweep::new(&views)).unwrap();
        for view in &views {
            for corner in view.corners {
                let point = (view.origin - fit.origin).as_vec3() + corner - fit.direction * 50.0;
                assert!(volume.intersects_sphere(point, 0.0), "{count} views");
            }
        }
        // Six edges around a circle: the hexagon has 1.10 times the circle's area, and the square 1.27 times.
        let (mut inside, samples) = (0, 10_000);
        for i in 0..samples {
            let (x, z) = ((f64::from(i) * 0.618_034).fract() - 0.5, (f64::from(i) / f64::from(samples)) - 0.5);
            let point = DVec3::new(x * 240.0, -2.0, z * 240.0) - fit.origin;
            inside += i32::from(volume.intersects_sphere(point.as_vec3(), 0.0));
        }
        let area = f64::from(inside) / f64::from(samples) * 240.0 * 240.0;
        let circle = std::f64::consts::PI * 101.5 * 101.5;
        println!("{count} views: {:.3} of the circle, {} planes", area / circle, volume.count);
        assert!(area / circle < if count == 400 { 1.35 } else { 1.15 });
    }
}

#[test]
fn sweeps_that_make_no_sense_are_errors() {
    let views = [camera().frustum().unwrap()];
    let fit = fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb));
    let good = Sweep::new(&views);
    let error = |sweep: Sweep| CasterVolume::swept(&fit, &sweep).unwrap_err();
    for value in [f32::NAN, f32::INFINITY] {
        assert!(matches!(error(Sweep { near: value, ..good }), FitError::NotFinite { .. }));
        assert!(matches!(error(Sweep { far: value, ..good }), FitError::NotFinite { .. }));
        assert!(matches!(error(Sweep { normal_offset: value, ..good }), FitError::NotFinite { .. }));
        assert!(matches!(
            error(Sweep { filter_radius: FilterRadius::taps(value), ..good }),
            FitError::NotFinite { .. }
        ));
    }
    assert!(matches!(error(Sweep { normal_offset: -1.0, ..good }), FitError::OutOfRange { .. }));
    assert_eq!(error(Sweep { near: 3.0, far: 3.0, ..good }), FitError::NearNotBelowFar { near: 3.0, far: 3.0 });
    assert_eq!(error(Sweep { views: &[], ..good }), FitError::NoView);
    let mut broken = views;
    broken[0].corners[6].y = f32::NAN;
    assert!(matches!(error(Sweep { views: &broken, ..good }), FitError::NotFinite { .. }));
}

#[test]
fn depths_that_no_view_has_give_a_volume_that_holds_nothing() {
    let views = [camera().frustum().unwrap()];
    let fit = fitted(&camera(), DIRECTION, &exact(FitKind::FrustumAabb));
    let sweep = Sweep { near: 1000.0, far: 2000.0, ..Sweep::new(&views) };
    assert_eq!(CasterVolume::swept(&fit, &sweep).unwrap(), CasterVolume::nowhere(fit.origin));
}
