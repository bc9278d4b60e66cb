//! Collects meshes and nodes into a scene.

use glam::{Quat, Vec3};

use super::palette::{self, Paint};
use super::solid::Solid;
use super::textures;
use crate::{Mesh, Node, Primitive, Scene, Transform};

/// Crease angle of round bodies, in radians: everything but right-angled edges is smooth.
pub(super) const SMOOTH: f32 = 1.2;
/// Crease angle of cut stone and carpentry, in radians.
pub(super) const CRISP: f32 = 0.6;

/// A scene under construction.
pub(super) struct Builder {
    /// What is built so far.
    pub(super) scene: Scene,
}

impl Builder {
    /// An empty scene with all materials and images.
    pub(super) fn new(name: &str) -> Self {
        let scene = Scene {
            name: name.to_owned(),
            materials: palette::materials(),
            images: textures::images(),
            ..Scene::default()
        };
        Self { scene }
    }

    /// Adds a mesh and returns its index.
    pub(super) fn mesh(&mut self, name: &str, primitives: Vec<Primitive>) -> usize {
        let mesh = Mesh { name: name.to_owned(), primitives, morph_weights: Vec::new() };
        self.scene.meshes.push(mesh);
        self.scene.meshes.len() - 1
    }

    /// Adds a mesh of one solid.
    pub(super) fn solid(&mut self, name: &str, solid: &Solid, paint: Paint, crease: f32) -> usize {
        self.mesh(name, vec![solid.primitive(paint.index(), crease)])
    }

    /// Adds a node and returns its index.
    pub(super) fn node(&mut self, name: &str, parent: Option<usize>, rest: Transform, mesh: Option<usize>) -> usize {
        let node = Node { name: name.to_owned(), parent, rest, mesh, ..Node::default() };
        self.scene.nodes.push(node);
        self.scene.nodes.len() - 1
    }

    /// Places a mesh under `parent`, turned by `yaw` radians about the vertical.
    pub(super) fn place(&mut self, parent: usize, mesh: usize, at: Vec3, yaw: f32) -> usize {
        let name = self.scene.meshes[mesh].name.clone();
        let rest = Transform { translation: at, rotation: Quat::from_rotation_y(yaw), ..Transform::default() };
        self.node(&name, Some(parent), rest, Some(mesh))
    }

    /// Places a mesh under `parent`, scaled by `scale`.
    pub(super) fn place_scaled(&mut self, parent: usize, mesh: usize, at: Vec3, scale: Vec3) -> usize {
        let node = self.place(parent, mesh, at, 0.0);
        self.scene.nodes[node].rest.scale = scale;
        node
    }

    /// Adds a group: a node without a mesh.
    pub(super) fn group(&mut self, name: &str, at: Vec3, yaw: f32) -> usize {
        let rest = Transform { translation: at, rotation: Quat::from_rotation_y(yaw), ..Transform::default() };
        self.node(name, None, rest, None)
    }
}
