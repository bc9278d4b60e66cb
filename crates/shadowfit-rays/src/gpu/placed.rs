//! The meshes of a scene with their places in the buffers, by identifiers that are never reused.

use glam::Vec3;

use super::deform::Deforming;
use super::ranges::MeshRanges;

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

/// A mesh in the buffers of a scene.
#[derive(Debug)]
pub(crate) struct Placed {
    pub(crate) ranges: MeshRanges,
    /// Stack for a ray through the mesh.
    pub(crate) stack: usize,
    /// The box around the mesh, in its own space.
    pub(crate) bounds: [Vec3; 2],
    pub(crate) deforming: Option<Deforming>,
}

/// All meshes.
#[derive(Debug, Default)]
pub(crate) struct Meshes {
    /// The meshes, each with the number of earlier meshes in its place.
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
