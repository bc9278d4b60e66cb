//! Stable shadow edges: the texel phase of fixed world points.
//!
//! Each look-up is computed in f32 as in a shader. It is compared with the previous frame (0.005 texel) and
//! with an f64 computation from the world's own origin (0.02 texel), at 0, 1, 10 and 100 km from there.

use proptest::prelude::*;
use shadowfit::BoundSource;
use shadowfit::glam::{DVec2, DVec3, UVec2, Vec3};
use shadowfit::settings::{FitKind, FitSettings, RectangleKind, SplitScheme, Stabilise};
use shadowfit::{
    Cascades, FitInput, FitState, FittedMap, FittedMaps, LightProjection, Scratch, Technique, ViewFrustum,
};

use crate::scenes::{COVERING, SceneView, Walk, any_light, any_view, any_walk};
use crate::support::{SNAP, ShaderDepths, apply, cases, double, sliced};

/// Margin above each step of extents, as a share of it.
const STEP_ROOM: f64 = 1e-5;

/// Returns the exact texel size: extents are eighths of an octave over the texels that the grid leaves.
pub(crate) fn exact_texel(fit: &LightProjection, border: f32) -> DVec2 {
    let usable = fit.resolution.as_dvec2() - (2.0 * f64::from(border) + 1.0);
    let exact = |rounded: f32, usable: f64| {
        let steps = (8.0 * (f64::from(rounded) * usable / (1.0 + STEP_ROOM)).log2()).round();
        let exact = (steps / 8.0).exp2() * (1.0 + STEP_ROOM) / usable;
        assert!((exact / f64::from(rounded) - 1.0).abs() < 1e-6, "{rounded} is no step: {exact}");
        exact
    };
    DVec2::new(exact(fit.texel_size.x, usable.x), exact(fit.texel_size.y, usable.y))
}

/// Returns the position of a world point on the map's grid, in texels right and down from the world's origin.
/// All values are f64 except the light's axes, which are f32 by definition.
pub(crate) fn grid_position(fit: &LightProjection, texel: DVec2, point: DVec3) -> DVec2 {
    let [x, y] = [fit.light_from_world.row(0), fit.light_from_world.row(1)].map(|row| row.truncate().as_dvec3());
    DVec2::new(x.dot(point) / texel.x, -y.dot(point) / texel.y)
}

/// Returns the position in the map, in texels, as a shader computes it.
pub(crate) fn shader_position(fit: &LightProjection, point: DVec3) -> DVec2 {
    let uv = apply(&fit.uv_from_world, (point - fit.origin).as_vec3());
    (uv.truncate() * fit.resolution.as_vec2()).as_dvec2()
}

/// Returns the difference of two texel phases, in texels.
pub(crate) fn apart(a: DVec2, b: DVec2) -> f64 {
    let d = a - b;
    (d - d.round()).abs().max_element()
}

fn settings(kind: FitKind, stabilise: Stabilise, count: u32, resolution: u32, border: f32) -> Technique {
    let fit = FitSettings::default()
        .with_kind(kind)
        .with_rectangle(RectangleKind::MinimumArea)
        .with_border(border)
        .with_max_distance(f32::MAX)
        .with_resolution(UVec2::splat(resolution));
    sliced(&fit, Cascades { count, splits: SplitScheme::Practical(0.7), stabilise, ..Cascades::default() })
}

fn frame(fitter: &mut FitState, view: &SceneView, direction: Vec3, settings: &Technique) -> FittedMaps {
    let views: [ViewFrustum; 1] = [view.frustum()];
    let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
    fitter.fit(&FitInput::new(&views, direction), settings, &mut Scratch::new(&mut storage)).unwrap()
}

/// Returns visible points of the first frame in one of its maps.
fn points_in(map: &FittedMap, view: &SceneView, places: &[[f64; 3]]) -> Vec<DVec3> {
    let (near, far) = (f64::from(map.near()), f64::from(map.far()).min(view.lens.far));
    places.iter().map(|[x, y, z]| view.eye + view.point(*x, *y, near + (far - near) * z)).collect()
}

/// Moves the camera on and compares the maps of successive frames. `is_kept` tells from the previous frame
/// which maps must stay still. Returns the number of these.
fn walk(
    view: SceneView,
    step: Walk,
    direction: Vec3,
    settings: &Technique,
    places: &[[f64; 3]],
    is_kept: impl Fn(&LightProjection) -> bool,
) -> usize {
    let mut fitter = FitState::new();
    let mut before = frame(&mut fitter, &view, direction, settings);
    let points: Vec<Vec<DVec3>> = before.iter().map(|map| points_in(map, &view, places)).collect();
    let (mut view, mut kept) = (view, 0);
    for _ in 0..6 {
        view = step.moved(&view);
        let now = frame(&mut fitter, &view, direction, settings);
        for ((map, old), points) in now.iter().zip(before.iter()).zip(&points) {
            let is_kept = is_kept(&map.projection);
            kept += usize::from(is_kept);
            assert!(
                !is_kept || map.projection.texel_size == old.projection.texel_size,
                "{} {}",
                map.projection.texel_size,
                old.projection.texel_size
            );
            let texel = exact_texel(&map.projection, settings.border());
            // Leaps move the camera so that points are outside all maps, where their rounding is larger.
            for point in points.iter().filter(|point| map.projection.covers(**point) && old.projection.covers(**point))
            {
                let place = shader_position(&map.projection, *point);
                let by_grid = apart(place, grid_position(&map.projection, texel, *point));
                assert!(by_grid <= 0.02, "{by_grid} texels from the f64 chain at {point}");
                let crawl = if is_kept { apart(place, shader_position(&old.projection, *point)) } else { 0.0 };
                assert!(crawl <= 0.005, "{crawl} texels of crawl at {point}");
            }
        }
        before = now;
    }
    kept
}

/// Returns whether a frustum's sphere is so near to a step of extents that the rounding of its corners (1e-7,
/// different in each frame) may select either step.
fn is_on_a_step(view: &SceneView, maps: &FittedMaps, radius: impl Fn(&FittedMap) -> f64) -> bool {
    let far = view.lens.far;
    maps.iter().filter(|map| f64::from(map.near()) < far).any(|map| {
        let steps = 8.0 * (2.0 * radius(map) * (1.0 - STEP_ROOM)).log2();
        (steps - steps.round()).abs() < 1e-4
    })
}

fn sphere_radius(view: &SceneView, map: &FittedMap) -> f64 {
    let slice = view.frustum().slice(map.near(), map.far().min(f32::MAX)).unwrap();
    slice.enclosing_sphere().unwrap().1
}

fn any_places() -> impl Strategy<Value = Vec<[f64; 3]>> {
    prop::collection::vec([double(0.0, 1.0), double(0.0, 1.0), double(0.0, 1.0)], 4)
}

fn any_setup() -> impl Strategy<Value = (u32, u32, f32)> {
    (1..=4_u32, prop::sample::select(vec![256_u32, 1024, 2048]), prop::sample::select(vec![0.0_f32, 1.5, 3.0]))
}

proptest! {
    #![proptest_config(cases(2000))]

    /// Neither movement nor turning changes texel size or phase of a stable map.
    #[test]
    fn spheres_stand_still_while_the_camera_moves_and_turns(
        view in any_view(), step in any_walk(), direction in any_light(), (count, size, border) in any_setup(),
        places in any_places(),
    ) {
        let settings = settings(FitKind::Sphere, SNAP, count, size, border);
        let maps = frame(&mut FitState::new(), &view, direction, &settings);
        prop_assume!(!is_on_a_step(&view, &maps, |map| sphere_radius(&view, map)));
        walk(view, step, direction, &settings, &places, |_| true);
    }

    /// While the camera does not turn, the corners relative to the eye keep all their bits, so all snapped
    /// maps stay still.
    #[test]
    fn snapped_boxes_stand_still_while_the_camera_moves(
        view in any_view(), step in any_walk(), direction in any_light(), (count, size, border) in any_setup(),
        kind in prop::sample::select(vec![FitKind::FrustumAabb, FitKind::Oriented]), places in any_places(),
    ) {
        let settings = settings(kind, SNAP, count, size, border);
        let step = Walk { turn: 0.0, ..step };
        // An f64 matrix is rounded by 2e-16 of the eye's distance, which may change a corner's last bit.
        let same = std::iter::successors(Some(view), |view| Some(step.moved(view))).take(7);
        prop_assume!(same.into_iter().all(|later| later.frustum().corners == view.frustum().corners));
        walk(view, step, direction, &settings, &places, |_| true);
    }

    /// Held maps stay still while they are held, for any camera movement.
    #[test]
    fn held_maps_stand_still_while_the_camera_moves_and_turns(
        view in any_view(), step in any_walk(), direction in any_light(), (count, size, border) in any_setup(),
        kind in prop::sample::select(COVERING.to_vec()), places in any_places(),
    ) {
        let settings = settings(kind, Stabilise::default(), count, size, border);
        walk(view, step, direction, &settings, &places, |fit| fit.bounds_from == [BoundSource::Held; 6]);
    }
}

/// During a walk with slow turns every map is held most of the time, so the test above is not vacuous.
#[test]
fn maps_are_held_on_a_walk() {
    let view = crate::scenes::of_camera(&crate::support::camera());
    let walk_on = Walk { step: DVec3::X * 0.0005, axis: DVec3::Y, turn: 0.002 };
    for kind in COVERING {
        let settings = settings(kind, Stabilise::default(), 4, 1024, 1.5);
        let kept = walk(view, walk_on, Vec3::new(0.3, -0.8, 0.4), &settings, &[[0.5; 3]], |fit| {
            fit.bounds_from == [BoundSource::Held; 6]
        });
        assert!(kept >= 16, "{kind:?}: {kept} of 24 maps were held");
    }
}
