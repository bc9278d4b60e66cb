//! Scenes with known shadows, and pictures of them.

use shadowfit::SingleMap;
use shadowfit::glam::{Affine3A, DVec3, Vec3};
use shadowfit::settings::{BiasSettings, FilterKind, FitKind, Shape, Stabilise};
use shadowfit::{PerspectiveCamera, Technique};
use shadowfit_scene::Scene;
use shadowfit_study::{Comparison, Judging, SharedTruth, View};
use shadowfit_truth::PictureTally;

use crate::support::test_gpu;

/// Size of the judged pictures, in pixels.
pub(super) const SIZE: [u32; 2] = [480, 270];

/// Corners of a triangle, world space, metres.
pub(super) type Corners = [Vec3; 3];

/// Returns an axis-aligned box.
pub(super) fn solid(min: Vec3, max: Vec3) -> Vec<Corners> {
    let corner = |index: usize| {
        let pick = |bit: usize, low: f32, high: f32| if index >> bit & 1 == 0 { low } else { high };
        Vec3::new(pick(0, min.x, max.x), pick(1, min.y, max.y), pick(2, min.z, max.z))
    };
    let faces = [[0, 2, 6, 4], [1, 5, 7, 3], [0, 4, 5, 1], [2, 3, 7, 6], [0, 1, 3, 2], [4, 6, 7, 5]];
    faces.into_iter().flat_map(|face| quad(face.map(corner))).collect()
}

/// Returns a level square around the origin.
pub(super) fn floor(half: f32) -> Vec<Corners> {
    let corner = |x: f32, z: f32| Vec3::new(x * half, 0.0, z * half);
    quad([corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)])
}

fn quad([a, b, c, d]: [Vec3; 4]) -> Vec<Corners> {
    vec![[a, b, c], [a, c, d]]
}

/// Objects with a camera and a light.
#[derive(Clone)]
pub(super) struct Arrangement {
    pub(super) objects: Vec<Vec<Corners>>,
    pub(super) camera: PerspectiveCamera,
    pub(super) direction: Vec3,
    pub(super) ray_offset: f64,
}

impl Arrangement {
    /// Creates a view from `eye` toward `target`, with the light travelling in `direction`.
    pub(super) fn new(objects: Vec<Vec<Corners>>, eye: Vec3, target: Vec3, direction: Vec3) -> Self {
        let camera = PerspectiveCamera {
            eye: eye.as_dvec3(),
            forward: (target - eye).normalize(),
            up: Vec3::Y,
            fov_y: 0.9,
            aspect: SIZE[0] as f32 / SIZE[1] as f32,
            near: 0.1,
            far: 60.0,
        };
        Self { objects, camera, direction: direction.normalize(), ray_offset: 1e-3 }
    }

    /// Returns the arrangement turned, moved, and in another unit.
    pub(super) fn moved(&self, motion: &Affine3A, scale: f32) -> Self {
        let point = |point: Vec3| motion.transform_point3(point) * scale;
        let camera = PerspectiveCamera {
            eye: DVec3::from(point(self.camera.eye.as_vec3())),
            forward: motion.transform_vector3(self.camera.forward),
            up: motion.transform_vector3(self.camera.up),
            near: self.camera.near * scale,
            far: self.camera.far * scale,
            ..self.camera
        };
        let moved = |triangles: &Vec<Corners>| triangles.iter().map(|corners| corners.map(point)).collect();
        Self {
            objects: self.objects.iter().map(moved).collect(),
            camera,
            direction: motion.transform_vector3(self.direction),
            ray_offset: self.ray_offset * f64::from(scale),
        }
    }

    /// Returns the sums over the picture with a technique.
    pub(super) fn judged(&self, technique: &Technique) -> PictureTally {
        self.judged_away(technique, Vec3::ZERO)
    }

    /// Returns the sums with everything moved by the scene's nodes, in metres.
    pub(super) fn judged_away(&self, technique: &Technique, away: Vec3) -> PictureTally {
        let judging = Judging { size: SIZE, ray_offset: self.ray_offset, ..Judging::default() };
        let mut scene = Scene::from_objects("shapes", &self.objects);
        scene.nodes.iter_mut().for_each(|node| node.rest.translation = away.as_dvec3());
        let mut comparison = Comparison::new(test_gpu(), scene, judging).expect("a scene");
        comparison.add(*technique).expect("a technique");
        let camera = PerspectiveCamera { eye: self.camera.eye + away.as_dvec3(), ..self.camera };
        let view = View { camera: camera.into(), direction: self.direction, is_first: true };
        let outcomes = comparison.frame(&view, &mut SharedTruth::default()).expect("a frame");
        outcomes[0].judged.tally.clone()
    }
}

/// Returns a technique with one map of 512 texels around the view, with a filter and a bias.
pub(super) fn single(kind: FitKind, filter: FilterKind, bias: BiasSettings) -> Technique {
    let one = SingleMap { shape: Shape::new(kind), stabilise: Stabilise::Off };
    Technique::default().with_maps(one).with_resolution(512, 512).with_look_up(filter, bias)
}

/// No bias at all.
pub(super) const NO_BIAS: BiasSettings =
    BiasSettings { constant: 0.0, slope: 0.0, normal_offset: 0.0, receiver_plane: 0.0, depth_steps: 0.0 };
