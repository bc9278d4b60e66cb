//! The meshes of a scene: where each lies in the buffers, by numbers that are never used twice.

use core::ops::Range;

use glam::Vec3;

use super::deform::Deforming;
use crate::hierarchy::WIDTH;
use crate::mesh::RayMesh;
use crate::records::{NO_ROOT, packed};

/// A mesh of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MeshId {
    place: u32,
    generation: u32,
}

impl MeshId {
    /// No mesh.
    pub(crate) const NONE: Self = Self { place: u32::MAX, generation: u32::MAX };
}

/// Where a mesh lies.
#[derive(Debug)]
pub(crate) struct Placed {
    pub(crate) nodes: Range<u32>,
    pub(crate) triangles: Range<u32>,
    pub(crate) cut_outs: Range<u32>,
    /// Stack that a ray through it needs.
    pub(crate) stack: usize,
    /// The box around it, in its own space.
    pub(crate) bounds: [Vec3; 2],
    pub(crate) deforming: Option<Deforming>,
}

impl Placed {
    /// Its root, packed.
    pub(crate) fn root(&self) -> u32 {
        match self.nodes.len() {
            0 => NO_ROOT,
            // A leaf.
            WIDTH => packed(self.triangles.len() as u32, self.triangles.start),
            _ => packed(0, self.nodes.start + WIDTH as u32),
        }
    }

    /// Whether a mesh takes as much room.
    pub(crate) fn has_room_for(&self, mesh: &RayMesh) -> bool {
        [self.nodes.len(), self.triangles.len(), self.cut_outs.len()]
            == [mesh.hierarchy.nodes.len(), mesh.triangles.len(), mesh.cut_outs.len()]
    }

    /// The same room, of a mesh that keeps its shape.
    pub(crate) fn ranges(&self) -> Self {
        let [nodes, triangles, cut_outs] = [&self.nodes, &self.triangles, &self.cut_outs].map(Clone::clone);
        Self { nodes, triangles, cut_outs, stack: self.stack, bounds: self.bounds, deforming: None }
    }
}

/// All meshes.
#[derive(Debug, Default)]
pub(crate) struct Meshes {
    /// With the number of meshes that each place had before.
    places: Vec<(u32, Option<Placed>)>,
    free: Vec<u32>,
}

impl Meshes {
    pub(crate) fn add(&mut self, mesh: Placed) -> MeshId {
        let place = self.free.pop().unwrap_or_else(|| {
            self.places.push((0, None));
            self.places.len() as u32 - 1
        });
        let (generation, stored) = &mut self.places[place as usize];
        *stored = Some(mesh);
        MeshId { place, generation: *generation }
    }

    pub(crate) fn remove(&mut self, id: MeshId) -> Option<Placed> {
        let (generation, stored) = self.places.get_mut(id.place as usize)?;
        let mesh = stored.take_if(|_| *generation == id.generation)?;
        *generation += 1;
        self.free.push(id.place);
        Some(mesh)
    }

    pub(crate) fn get(&self, id: MeshId) -> Option<&Placed> {
        let (generation, mesh) = self.places.get(id.place as usize)?;
        mesh.as_ref().filter(|_| *generation == id.generation)
    }

    pub(crate) fn get_mut(&mut self, id: MeshId) -> Option<&mut Placed> {
        let (generation, mesh) = self.places.get_mut(id.place as usize)?;
        mesh.as_mut().filter(|_| *generation == id.generation)
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Placed> {
        self.places.iter().filter_map(|(_, mesh)| mesh.as_ref())
    }
}
