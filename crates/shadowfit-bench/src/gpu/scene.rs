//! Scenes of the engine: triangles in world space, divided into casters, and a walk.

use std::path::Path;

use anyhow::{Context, Result};
use glam::{DVec3, Vec3};
use shadowfit::{Aabb, PerspectiveCamera};
use shadowfit_params::tool::LightSettings;
use shadowfit_render::{Cluster, clustered};
use shadowfit_scene::{Casting, Scene, builtin, load_gltf};
use shadowfit_truth::Tracer;

use crate::cuboid::triangles;

/// Frames a second, speed in metres a second, and turn in radians a second.
const RATE: f64 = 60.0;
const SPEED: f64 = 1.5;
const TURN: f64 = 10.0 * core::f64::consts::PI / 180.0;

/// Every tenth node moves, by this amplitude in metres, once a second.
const MOVING: usize = 10;
const BOB: f32 = 0.5;

/// Candidate places for the eye along a side, and its height above the ground, in metres.
const PLACES: u16 = 9;
const EYE: f32 = 1.7;

/// A caster, which is one draw.
pub(crate) struct Caster {
    /// Its vertices.
    pub(crate) vertices: core::ops::Range<u32>,
    /// Bounds in world space at rest, in metres.
    pub(crate) bounds: Aabb,
    pub(crate) moves: bool,
}

/// A scene of the benchmark.
pub(crate) struct BenchScene {
    pub(crate) name: String,
    /// Corners of the triangles, in world space, in metres.
    pub(crate) vertices: Vec<Vec3>,
    pub(crate) casters: Vec<Caster>,
    /// Start of the walk, and the angle of its direction to the right of -z, in radians.
    eye: DVec3,
    yaw: f64,
}

impl BenchScene {
    pub(crate) fn built_in() -> Self {
        let (eye, target) = builtin::default_camera();
        let ahead = target - eye;
        let place = (eye.as_dvec3(), f64::from(ahead.x.atan2(-ahead.z)));
        Self::new(&builtin::default_scene(), "courtyard", Some(place))
    }

    pub(crate) fn load(file: &Path) -> Result<Self> {
        let scene = load_gltf(file)?;
        let name = file.file_stem().context("no name")?.to_string_lossy().into_owned();
        Ok(Self::new(&scene, &name, None))
    }

    fn new(scene: &Scene, name: &str, place: Option<(DVec3, f64)>) -> Self {
        let pose = scene.pose(None, 0.0);
        let (mut vertices, mut casters) = (Vec::new(), Vec::new());
        let mut nodes: Vec<usize> = scene.instances().iter().map(|instance| instance.node).collect();
        nodes.dedup();
        for instance in scene.instances() {
            let primitive = &scene.meshes[instance.mesh].primitives[instance.primitive];
            if scene.casting(primitive) == Casting::Nothing {
                continue;
            }
            let matrix = pose.world_from_instance(scene, &instance);
            let positions: Vec<Vec3> = primitive.positions.iter().map(|p| matrix.transform_point3(*p)).collect();
            let (indices, clusters) = clustered(&positions, &primitive.indices, false);
            let first = vertices.len() as u32;
            vertices.extend(indices.iter().map(|index| positions[*index as usize]));
            let number = nodes.iter().position(|node| *node == instance.node).unwrap_or(0);
            let caster = |Cluster { indices, bounds }: Cluster| Caster {
                vertices: first + indices.start..first + indices.end,
                bounds,
                moves: number % MOVING == MOVING - 1,
            };
            casters.extend(clusters.into_iter().map(caster));
        }
        let (eye, yaw) = place.unwrap_or_else(|| (street(&vertices), 0.0));
        Self { name: name.to_owned(), vertices, casters, eye, yaw }
    }

    /// Builds a field of instances. Half of them cannot cast shadows into view: they are behind the eye, away
    /// from the sun.
    pub(crate) fn field(instances: u16) -> Self {
        let instance = |index: u16| {
            let place = |base: f64, size: f64| ((f64::from(index) * base).fract() * size) as f32;
            let (x, z) = (place(0.754_877_67, 120.0) - 60.0, place(0.569_840_3, 60.0));
            let behind = index.is_multiple_of(2);
            let offset = Vec3::new(x, 0.0, if behind { 60.0 + z } else { -z - 2.0 });
            Aabb::new(offset + Vec3::new(-0.2, 0.0, -0.2), offset + Vec3::new(0.2, 1.4, 0.2))
        };
        Self::of_boxes("field", DVec3::new(0.0, 1.7, 0.0), (0..instances).map(instance))
    }

    /// Builds a scene of static boxes, one caster each, with an eye that starts its walk along -z.
    pub(crate) fn of_boxes(name: &str, eye: DVec3, boxes: impl Iterator<Item = Aabb>) -> Self {
        let (mut vertices, mut casters) = (Vec::new(), Vec::new());
        for bounds in boxes {
            let first = vertices.len() as u32;
            vertices.extend(triangles(&bounds).flatten());
            casters.push(Caster { vertices: first..vertices.len() as u32, bounds, moves: false });
        }
        Self { name: name.to_owned(), vertices, casters, eye, yaw: 0.0 }
    }

    /// Returns the camera of a frame.
    pub(crate) fn camera(&self, frame: usize, aspect: f32) -> PerspectiveCamera {
        let seconds = frame as f64 / RATE;
        // Back and forth, so that the walk stays in the scene.
        let along = SPEED * (seconds % 8.0 - 4.0).abs() - 6.0;
        let yaw = self.yaw + TURN * seconds;
        let ahead = DVec3::new(self.yaw.sin(), 0.0, -self.yaw.cos());
        let forward = Vec3::new(yaw.sin() as f32, -0.12, -yaw.cos() as f32).normalize();
        PerspectiveCamera {
            eye: self.eye - ahead * along,
            forward,
            up: Vec3::Y,
            fov_y: 0.9,
            aspect,
            near: 0.1,
            far: 200.0,
        }
    }

    /// Returns the displacement of a moving caster, in metres.
    pub(crate) fn bob(frame: usize, caster: usize) -> Vec3 {
        let phase = frame as f32 / RATE as f32 + caster as f32 * 0.37;
        Vec3::Y * BOB * (phase * core::f32::consts::TAU).sin()
    }

    /// Returns the direction of travel of the light.
    pub(crate) fn direction() -> Vec3 {
        LightSettings::default().direction()
    }
}

/// Returns a place near the middle of a scene, above its lowest ground.
fn street(vertices: &[Vec3]) -> DVec3 {
    let bounds = Aabb::from_points(vertices.iter().copied()).unwrap_or_default();
    let tracer = Tracer::new(vertices.as_chunks::<3>().0.iter().copied());
    let (middle, size) = ((bounds.min + bounds.max) * 0.5, bounds.size());
    let mut lowest: Option<Vec3> = None;
    for index in 0..PLACES * PLACES {
        let cell = Vec3::new(f32::from(index % PLACES), 0.0, f32::from(index / PLACES)) / f32::from(PLACES - 1) - 0.5;
        let from = (middle + cell * size * 0.4).with_y(bounds.max.y + 1.0);
        if let Some(hit) = tracer.first_hit(from, Vec3::NEG_Y) {
            let ground = from.with_y(from.y - hit.distance);
            if lowest.is_none_or(|lowest| ground.y < lowest.y - 0.01) {
                lowest = Some(ground);
            }
        }
    }
    (lowest.unwrap_or(middle) + Vec3::Y * EYE).as_dvec3()
}
