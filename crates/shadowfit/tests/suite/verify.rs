//! The certificate: what it proves of fits, and what it finds in broken ones.

use proptest::prelude::*;
use shadowfit::bias::Reach;
use shadowfit::glam::{DQuat, DVec2, DVec3, UVec2, Vec3};
use shadowfit::verify::{Certificate, Claim, verify};
use shadowfit::{
    Aabb, Boxes, CascadeFitter, CascadeSettings, CasterPolicy, DepthConvention, FitInput, FitKind, FitSettings,
    HoldSettings, PerspectiveCamera, RectangleKind, SplitScheme, Stabilise, ViewFrustum, Workspace,
};

use crate::support::{any_camera, any_direction, double, float};

const COVERING: [FitKind; 4] = [FitKind::FrustumAabb, FitKind::Oriented, FitKind::Sphere, FitKind::Focused];

fn storage(boxes: usize) -> Vec<DVec2> {
    vec![DVec2::ZERO; Workspace::required(boxes, 10)]
}

/// A box by its place and size, in shares of the view's extent.
#[derive(Clone, Copy, Debug)]
struct Plan {
    centre: DVec3,
    half: DVec3,
}

fn any_plan() -> impl Strategy<Value = Plan> {
    let place = || double(-1.2, 1.2);
    let size = || prop_oneof![double(0.0, 0.02), double(0.0, 0.3), double(0.5, 2.0), Just(0.0)];
    ((place(), place(), place()), (size(), size(), size()))
        .prop_map(|((x, y, z), (a, b, c))| Plan { centre: DVec3::new(x, y, z), half: DVec3::new(a, b, c) })
}

/// Boxes around a camera, relative to the world's origin or to a place near the eye.
#[derive(Clone, Debug)]
struct Scene {
    receivers: Option<Vec<Aabb>>,
    casters: Vec<Aabb>,
    origin: DVec3,
}

impl Scene {
    fn receivers(&self) -> Option<Boxes<'_>> {
        self.receivers.as_ref().map(|boxes| Boxes { origin: self.origin, boxes })
    }

    fn casters(&self) -> Boxes<'_> {
        Boxes { origin: self.origin, boxes: &self.casters }
    }

    fn input<'a>(&'a self, views: &'a [ViewFrustum], direction: Vec3) -> FitInput<'a> {
        FitInput { receivers: self.receivers(), casters: self.casters(), ..FitInput::new(views, direction) }
    }

    fn len(&self) -> usize {
        self.casters.len().max(self.receivers.as_ref().map_or(0, Vec::len))
    }
}

type Plans = (Option<Vec<Plan>>, Vec<Plan>, bool);

fn any_plans() -> impl Strategy<Value = Plans> {
    let boxes = || prop::collection::vec(any_plan(), 0..12);
    (prop_oneof![1 => Just(None), 4 => boxes().prop_map(Some)], boxes(), any::<bool>())
}

fn scene(plans: &Plans, camera: &PerspectiveCamera) -> Scene {
    let origin = if plans.2 { DVec3::ZERO } else { camera.eye.round() };
    // Somewhere in the view, so that scenes of a wide range of depths are hit too.
    let scale = f64::from(camera.near) * (f64::from(camera.far) / f64::from(camera.near)).sqrt() * 4.0;
    let centre = camera.eye - origin + camera.forward.as_dvec3() * scale * 0.5;
    let aabb = |plan: &Plan| {
        let (middle, half) = (centre + plan.centre * scale, plan.half * scale);
        Aabb::new((middle - half).as_vec3(), (middle + half).as_vec3())
    };
    let receivers: Option<Vec<Aabb>> = plans.0.as_ref().map(|plans| plans.iter().map(aabb).collect());
    // What receives also casts.
    let casters = plans.1.iter().map(aabb).chain(receivers.iter().flatten().copied()).collect();
    Scene { receivers, casters, origin }
}

fn any_depth() -> impl Strategy<Value = DepthConvention> {
    prop::sample::select(vec![DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne])
}

fn any_fit() -> impl Strategy<Value = FitSettings> {
    let kind = prop::sample::select(COVERING.to_vec());
    let rectangle = prop::sample::select(vec![
        RectangleKind::AxisAligned,
        RectangleKind::MinimumArea,
        RectangleKind::MinimumSquare,
    ]);
    let casters = prop::sample::select(vec![CasterPolicy::List, CasterPolicy::SceneBounds, CasterPolicy::DepthClamp]);
    let resolution = prop::sample::select(vec![UVec2::new(2048, 2048), UVec2::new(512, 1024), UVec2::new(64, 40)]);
    let distance = prop_oneof![Just(f32::MAX), float(5.0, 500.0)];
    (kind, rectangle, casters, resolution, any_depth(), distance, prop_oneof![Just(0.0), float(0.0, 6.0)]).prop_map(
        |(kind, rectangle, casters, resolution, depth, max_distance, kernel_margin)| FitSettings {
            kind,
            rectangle,
            casters,
            resolution,
            depth,
            max_distance,
            kernel_margin,
            ..FitSettings::default()
        },
    )
}

fn any_cascades() -> impl Strategy<Value = CascadeSettings> {
    let splits = prop_oneof![
        Just(SplitScheme::Uniform),
        Just(SplitScheme::Logarithmic),
        float(0.0, 1.0).prop_map(SplitScheme::Practical),
        Just(SplitScheme::FromBoxes),
    ];
    let stabilise = prop::sample::select(vec![Stabilise::Off, Stabilise::Snap, Stabilise::Hysteresis]);
    let hold = prop_oneof![Just(0.0), Just(0.02), float(0.0, 0.5)];
    (any_fit(), 1..=8_u32, splits, prop_oneof![Just(0.0), float(0.0, 1.0)], stabilise, hold).prop_map(
        |(fit, count, splits, overlap, stabilise, margin)| CascadeSettings {
            fit,
            count,
            splits,
            overlap,
            stabilise,
            hold: HoldSettings::default().with_margin(margin),
            ..CascadeSettings::default()
        },
    )
}

/// The reach that a kernel margin is enough for.
fn reach_of(settings: &FitSettings) -> Reach {
    Reach::taps(settings.kernel_margin + 0.5)
}

#[derive(Clone, Copy, Debug)]
struct Walk {
    step: DVec3,
    axis: DVec3,
    turn: f64,
}

/// Standing still, walking, turning and leaps.
fn any_walk() -> impl Strategy<Value = Walk> {
    let step = prop_oneof![1 => Just(0.0), 3 => double(0.0, 0.01), 1 => double(0.0, 0.3)];
    let turn = prop_oneof![1 => Just(0.0), 3 => double(0.0, 0.02), 1 => double(0.0, 1.0)];
    (any_direction(), step, any_direction(), turn).prop_map(|(d, step, axis, turn)| Walk {
        step: d.as_dvec3() * step,
        axis: axis.as_dvec3().normalize(),
        turn,
    })
}

impl Walk {
    fn moved(&self, camera: &PerspectiveCamera) -> PerspectiveCamera {
        let turn = DQuat::from_axis_angle(self.axis, self.turn);
        let turned = |v: Vec3| (turn * v.as_dvec3()).as_vec3();
        let eye = camera.eye + self.step * f64::from(camera.far);
        PerspectiveCamera { eye, forward: turned(camera.forward), up: turned(camera.up), ..*camera }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, max_global_rejects: 1_000_000, ..ProptestConfig::default() })]

    #[test]
    fn a_single_map_has_no_holes(
        camera in any_camera(), plans in any_plans(), direction in any_direction(), fit in any_fit(),
    ) {
        prop_assume!(camera.near < fit.max_distance);
        let scene = scene(&plans, &camera);
        let views = [camera.frustum().unwrap()];
        let input = scene.input(&views, direction);
        let mut storage = storage(scene.len());
        let mut workspace = Workspace::new(&mut storage);
        let map = shadowfit::fit_scene(&input, &fit, &mut workspace).unwrap();
        let claim = Claim::of_fit(&fit, reach_of(&fit));
        let certificate = verify(&input, &map, &claim, &mut workspace).unwrap();
        prop_assert!(certificate.is_proven(), "{certificate:?}");
    }

    #[test]
    fn cascades_have_no_holes_while_the_camera_walks_and_turns(
        camera in any_camera(), plans in any_plans(), direction in any_direction(), settings in any_cascades(),
        (walk, frames) in (any_walk(), 1..6_usize),
    ) {
        prop_assume!(camera.near < settings.fit.max_distance);
        let scene = scene(&plans, &camera);
        let mut storage = storage(scene.len());
        let mut workspace = Workspace::new(&mut storage);
        let (mut fitter, mut camera) = (CascadeFitter::new(), camera);
        for frame in 0..frames {
            let views = [camera.frustum().unwrap()];
            let input = scene.input(&views, direction);
            let maps = fitter.fit(&input, &settings, &mut workspace).unwrap();
            for (i, map) in maps.iter().enumerate() {
                let claim = Claim::of_map(map, &settings, reach_of(&settings.fit));
                let certificate = verify(&input, &map.fit, &claim, &mut workspace).unwrap();
                prop_assert!(certificate.is_proven(), "frame {frame}, map {i}: {certificate:?} of {map:?}");
            }
            camera = walk.moved(&camera);
        }
    }
}

/// Keeps the names in use while the fits are under test.
#[test]
fn certificate_says_when_it_is_not_proven() {
    let point = DVec3::ZERO;
    assert!(!Certificate::LeftOut { point }.is_proven());
}
