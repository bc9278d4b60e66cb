//! Values that are held from frame to frame stay constant, although the rounding of every input varies.

use shadowfit::demand::DepthHistogram;
use shadowfit::glam::{DVec2, DVec3, Mat4, Vec3};
use shadowfit::light_steps::{LightStepState, LightSteps};
use shadowfit::proof::{CoverageQuery, prove};
use shadowfit::scroll::Scroll;
use shadowfit::settings::{FitKind, Shape, SplitScheme, Stabilise};
use shadowfit::{
    Aabb, Boxes, Cascades, DepthConvention, FitInput, FitState, FittedMaps, PerspectiveCamera, Scratch, Technique,
    ViewFrustum,
};

/// Number of frames with an unmoving camera.
const FRAMES: u32 = 60;

/// Moves numbers randomly by at most one step of f32, with a linear congruential generator.
struct Waver(u64);

impl Waver {
    fn f32(&mut self, value: f32) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        match (self.0 >> 33) % 3 {
            0 => value.next_up(),
            1 => value.next_down(),
            _ => value,
        }
    }

    fn vec3(&mut self, value: Vec3) -> Vec3 {
        value.map(|v| self.f32(v))
    }

    fn matrix(&mut self, matrix: &Mat4) -> Mat4 {
        // Zeros are exact in every engine's projection.
        Mat4::from_cols_array(&matrix.to_cols_array().map(|v| if v == 0.0 { v } else { self.f32(v) }))
    }
}

/// The form of a camera's input.
#[derive(Clone, Copy, Debug)]
enum Way {
    Camera,
    EyeMatrix(DepthConvention),
    WorldMatrix(DepthConvention),
}

const WAYS: [Way; 5] = [
    Way::Camera,
    Way::EyeMatrix(DepthConvention::ZeroToOne),
    Way::EyeMatrix(DepthConvention::Reversed),
    Way::WorldMatrix(DepthConvention::NegativeOneToOne),
    Way::WorldMatrix(DepthConvention::Reversed),
];

fn camera() -> PerspectiveCamera {
    PerspectiveCamera {
        eye: DVec3::new(12.0, 3.0, -40.0),
        forward: Vec3::new(0.3, -0.2, -0.8),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 1.6,
        near: 0.05,
        far: 80.0,
    }
}

fn view(way: Way, waver: &mut Waver) -> ViewFrustum {
    let camera = camera();
    match way {
        Way::Camera => {
            let near = waver.f32(camera.near);
            PerspectiveCamera { near, forward: waver.vec3(camera.forward), ..camera }.frustum().unwrap()
        }
        Way::EyeMatrix(depth) => {
            let matrix = waver.matrix(&camera.clip_from_world(depth).inverse());
            ViewFrustum::from_eye_from_clip(&matrix, camera.eye, depth, f32::MAX).unwrap()
        }
        Way::WorldMatrix(depth) => {
            let relative = camera.clip_from_world(depth).inverse();
            let matrix = waver.matrix(&(Mat4::from_translation(camera.eye.as_vec3()) * relative));
            ViewFrustum::from_world_from_clip(&matrix, camera.eye, depth, f32::MAX).unwrap()
        }
    }
}

/// Returns a ground with houses on it.
fn boxes(waver: &mut Waver) -> Vec<Aabb> {
    let mut boxes = vec![Aabb::new(Vec3::new(-200.0, -0.2, -200.0), Vec3::new(200.0, 0.0, 200.0))];
    for i in 0..20_u8 {
        let (x, z) = (f32::from(i % 5) * 13.0 - 20.0, f32::from(i / 5) * -17.0 - 45.0);
        boxes.push(Aabb::new(Vec3::new(x, 0.0, z), Vec3::new(x + 5.0, 3.0 + f32::from(i % 7), z + 5.0)));
    }
    boxes.into_iter().map(|aabb| Aabb::new(waver.vec3(aabb.min), waver.vec3(aabb.max))).collect()
}

/// Fits frame by frame with varying rounding, and proves each map.
fn fly(way: Way, technique: &Technique, knows_boxes: bool, mut visit: impl FnMut(&FittedMaps)) {
    let mut waver = Waver(7);
    let mut fitter = FitState::new();
    let counts: Vec<u32> = (0..64).map(|i| 5 + i % 11).collect();
    for _ in 0..FRAMES {
        let views = [view(way, &mut waver)];
        let boxes = boxes(&mut waver);
        let known = knows_boxes.then_some(Boxes { origin: DVec3::ZERO, boxes: &boxes });
        let (near, far) = (waver.f32(0.06), waver.f32(79.0));
        let input = FitInput {
            receivers: known,
            casters: known,
            histogram: Some(DepthHistogram { near, far, bins: &counts, classes: 1 }),
            ..FitInput::new(&views, waver.vec3(Vec3::new(0.3, -0.8, 0.4)))
        };
        let mut storage = vec![DVec2::ZERO; Scratch::required(boxes.len(), 1)];
        let mut scratch = Scratch::new(&mut storage);
        let maps = fitter.fit(&input, technique, &mut scratch).unwrap();
        for map in maps.iter() {
            let query = CoverageQuery::of_map(map, technique, technique.filter_radius_in(&map.projection))
                .with_normal_offset(map.bias.normal_offset);
            let proof = prove(&input, &map.projection, &query, &mut scratch).unwrap();
            assert!(proof.is_proven(), "{way:?}: {proof:?}");
        }
        visit(&maps);
    }
}

fn held(kind: FitKind, splits: SplitScheme) -> Technique {
    let stabilise = Stabilise::default();
    Technique::default().with_maps(Cascades { shape: Shape::new(kind), splits, stabilise, ..Cascades::default() })
}

fn assert_kept(name: &str, technique: &Technique) {
    for (way, knows_boxes) in WAYS.into_iter().flat_map(|way| [(way, true), (way, false)]) {
        let mut last: Option<FittedMaps> = None;
        fly(way, technique, knows_boxes, |maps| {
            for (a, b) in last.iter().flat_map(|last| last.iter()).zip(maps.iter()) {
                let what = format!("{name}, {way:?}, boxes known: {knows_boxes}");
                let split = |map: &shadowfit::FittedMap| map.depths.map(|range| (range.near, range.far));
                assert_eq!(split(a), split(b), "splits of {what}");
                assert_eq!(a.projection.texel_size, b.projection.texel_size, "texels of {what}");
                let scroll = Scroll::between(a, b);
                assert!(!scroll.is_new, "{what}: {a:?} {b:?}");
            }
            last = Some(*maps);
        });
    }
}

#[test]
fn held_maps_and_splits_stay_although_every_input_wavers() {
    for splits in [SplitScheme::FromHistogram, SplitScheme::FromBoxes, SplitScheme::Practical(0.5)] {
        for kind in [FitKind::Focused, FitKind::Oriented, FitKind::FrustumAabb] {
            assert_kept(&format!("{kind:?} {splits:?}"), &held(kind, splits));
        }
    }
}

#[test]
fn the_spheres_of_a_stable_fit_stay_although_every_input_wavers() {
    assert_kept("stable-4", &Technique::preset("stable-4").unwrap());
}

#[test]
fn a_light_that_wavers_does_not_step() {
    let (mut waver, mut steps) = (Waver(3), LightStepState::default());
    let settings = LightSteps::default().with_texels(0.0).with_fade(1.0);
    let direction = Vec3::new(0.3, -0.8, 0.4).normalize();
    let first = steps.update(direction, &settings, 0.1).unwrap();
    for _ in 0..FRAMES {
        let step = steps.update(waver.vec3(direction), &settings, 0.1).unwrap();
        assert_eq!(step, first);
    }
}
