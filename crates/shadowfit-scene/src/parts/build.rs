//! Collects meshes and nodes into a scene.

use glam::{Mat3, Quat, Vec3};

use super::solid::Solid;
use crate::{Image, Lens, Material, Mesh, Node, Primitive, Scene, SceneCamera, Sun, Transform};

/// Crease angle of round bodies, in radians. Everything but right-angled edges is smooth.
pub const SMOOTH: f32 = 1.2;
/// Crease angle of cut stone and carpentry, in radians.
pub const CRISP: f32 = 0.6;

/// Distance of the near plane of every start view, in metres: closer than any object that one can walk up to.
const NEAR: f32 = 0.1;

/// A scene under construction.
pub struct Builder {
    /// Scene built so far.
    pub scene: Scene,
}

impl Builder {
    /// Creates a scene of materials and images alone.
    pub fn new(name: &str, materials: Vec<Material>, images: Vec<Image>) -> Self {
        let scene = Scene { name: name.to_owned(), materials, images, ..Scene::default() };
        Self { scene }
    }

    /// Adds a mesh and returns its index.
    pub fn mesh(&mut self, name: &str, primitives: Vec<Primitive>) -> usize {
        let mesh = Mesh { name: name.to_owned(), primitives, morph_weights: Vec::new() };
        self.scene.meshes.push(mesh);
        self.scene.meshes.len() - 1
    }

    /// Adds a mesh of one solid and returns its index.
    pub fn solid(&mut self, name: &str, solid: &Solid, paint: impl Into<usize>, crease: f32) -> usize {
        self.mesh(name, vec![solid.primitive(paint.into(), crease)])
    }

    /// Adds a mesh of solids, each with its paint and the crease angle of its edges, and returns its index.
    pub fn solids<P: Into<usize>, const N: usize>(&mut self, name: &str, solids: [(Solid, P, f32); N]) -> usize {
        let primitives = solids.map(|(solid, paint, crease)| solid.primitive(paint.into(), crease));
        self.mesh(name, primitives.to_vec())
    }

    /// Adds a node and returns its index.
    pub fn node(&mut self, name: &str, parent: Option<usize>, rest: Transform, mesh: Option<usize>) -> usize {
        let node = Node { name: name.to_owned(), parent, rest, mesh, ..Node::default() };
        self.scene.nodes.push(node);
        self.scene.nodes.len() - 1
    }

    /// Places a mesh under `parent`, turned by `yaw` radians about the vertical. Returns the node.
    pub fn place(&mut self, parent: usize, mesh: usize, at: impl Into<Vec3>, yaw: f32) -> usize {
        self.pose(parent, mesh, turned(at, yaw))
    }

    /// Places a mesh under `parent`, scaled by `scale` and turned by `yaw` radians about the vertical.
    pub fn place_sized(
        &mut self,
        parent: usize,
        mesh: usize,
        at: impl Into<Vec3>,
        scale: impl Into<Vec3>,
        yaw: f32,
    ) -> usize {
        self.pose(parent, mesh, Transform::new(at.into(), Quat::from_rotation_y(yaw), scale.into()))
    }

    /// Places a mesh under `parent` with a full transform. Returns the node.
    pub fn pose(&mut self, parent: usize, mesh: usize, rest: Transform) -> usize {
        let name = self.scene.meshes[mesh].name.clone();
        self.node(&name, Some(parent), rest, Some(mesh))
    }

    /// Adds a mesh of one solid under `parent` without a transform. Returns the node.
    pub fn fix(&mut self, parent: usize, name: &str, solid: &Solid, paint: impl Into<usize>, crease: f32) -> usize {
        let mesh = self.solid(name, solid, paint, crease);
        self.place(parent, mesh, Vec3::ZERO, 0.0)
    }

    /// Adds a mesh of one primitive without a parent or transform. Returns the node.
    pub fn lay(&mut self, name: &str, primitive: Primitive) -> usize {
        let mesh = self.mesh(name, vec![primitive]);
        self.node(name, None, Transform::default(), Some(mesh))
    }

    /// Adds a group: a node without a mesh.
    pub fn group(&mut self, name: &str, at: impl Into<Vec3>, yaw: f32) -> usize {
        self.node(name, None, turned(at, yaw), None)
    }

    /// Adds the start view: a camera at `eye` that looks at `target`, world positions in metres, with a vertical field
    /// of view in radians and a far plane in metres.
    pub fn start_view(&mut self, eye: Vec3, target: Vec3, fov_y: f32, far: f32) {
        self.view(eye, target, Lens::Perspective { fov_y, near: NEAR, far: Some(far) });
    }

    /// Adds the start view with a given lens.
    pub fn view(&mut self, eye: Vec3, target: Vec3, lens: Lens) {
        let back = (eye - target).normalize();
        let right = Vec3::Y.cross(back).normalize();
        let rotation = Quat::from_mat3(&Mat3::from_cols(right, back.cross(right), back));
        let rest = Transform::new(eye, rotation, Vec3::ONE);
        let node = self.node("start view", None, rest, None);
        self.scene.cameras.push(SceneCamera { name: "start view".to_owned(), node, lens });
    }
}

/// Returns a transform to a place, with a turn by `yaw` radians about the vertical.
pub fn turned(at: impl Into<Vec3>, yaw: f32) -> Transform {
    Transform::new(at.into(), Quat::from_rotation_y(yaw), Vec3::ONE)
}

/// Returns sunlight from `azimuth` (from +z toward +x) and `elevation` above the horizon, in radians.
pub fn sunlight(azimuth: f32, elevation: f32) -> Sun {
    let (sin, cos) = azimuth.sin_cos();
    let flat = elevation.cos();
    let to_sun = Vec3::new(sin * flat, elevation.sin(), cos * flat);
    Sun { direction: -to_sun, color: Vec3::new(1.0, 0.95, 0.87), intensity: 80_000.0 }
}
