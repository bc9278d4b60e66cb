//! Boxes around small groups of a large mesh's triangles. The bounding box of a level that is a single mesh
//! is useless for fits.

use std::sync::{Arc, Mutex, PoisonError};

use bevy::mesh::{PrimitiveTopology, VertexAttributeValues};
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::tasks::futures::check_ready;
use bevy::tasks::{AsyncComputeTaskPool, Task};
use shadowfit::glam::Vec3 as FitVec3;

/// Marks a mesh whose vertices a shader moves within its bounding box. Fits use the whole box, never tighter
/// boxes around its triangles.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Default, Debug, Clone, PartialEq)]
pub struct WholeBox;

/// Least half-length of the boxes of meshes that are split into clusters, as a share of the shadow distance.
pub(crate) const LARGE: f32 = 1.0 / 32.0;

/// Triangles per cluster, and maximum number of clusters per mesh. Each cluster costs about 0.3 µs per fit.
const TRIANGLES_PER_CLUSTER: usize = 32;
const MAX_CLUSTERS: usize = 512;

type Triangles = Vec<[FitVec3; 3]>;
type Boxes = Option<Arc<[shadowfit::Aabb]>>;

/// Clusters of meshes in mesh space. They are computed in the background when a fit first requests them.
#[derive(Resource, Default)]
pub(crate) struct MeshClusters {
    made: HashMap<AssetId<Mesh>, Boxes>,
    on_their_way: HashMap<AssetId<Mesh>, Task<Boxes>>,
    asked: Mutex<Vec<AssetId<Mesh>>>,
}

impl MeshClusters {
    /// Returns the clusters of a mesh. If there are none yet, returns `None` and records the request.
    pub(crate) fn of(&self, mesh: AssetId<Mesh>) -> Option<&[shadowfit::Aabb]> {
        match self.made.get(&mesh) {
            Some(boxes) => boxes.as_deref(),
            None => {
                self.asked.lock().unwrap_or_else(PoisonError::into_inner).push(mesh);
                None
            }
        }
    }
}

/// Collects finished clusters, starts requested ones, and drops the clusters of changed meshes.
pub(crate) fn update_clusters(
    mut clusters: ResMut<MeshClusters>,
    meshes: Option<Res<Assets<Mesh>>>,
    mut events: MessageReader<AssetEvent<Mesh>>,
) {
    let clusters = &mut *clusters;
    for event in events.read() {
        if let AssetEvent::Modified { id } | AssetEvent::Removed { id } = event {
            clusters.made.remove(id);
            clusters.on_their_way.remove(id);
        }
    }
    let finished = clusters.on_their_way.iter_mut().filter_map(|(id, task)| Some((*id, check_ready(task)?)));
    clusters.made.extend(finished);
    clusters.on_their_way.retain(|id, _| !clusters.made.contains_key(id));
    for id in clusters.asked.get_mut().unwrap_or_else(PoisonError::into_inner).drain(..) {
        if clusters.made.contains_key(&id) || clusters.on_their_way.contains_key(&id) {
            continue;
        }
        match meshes.as_ref().and_then(|meshes| meshes.get(id)).and_then(triangles) {
            Some(triangles) => {
                let task = AsyncComputeTaskPool::get().spawn(async move { cut(&triangles) });
                clusters.on_their_way.insert(id, task);
            }
            None => _ = clusters.made.insert(id, None),
        }
    }
}

/// Returns the triangles of a mesh if they are still on the CPU and enough to be split; otherwise `None`.
fn triangles(mesh: &Mesh) -> Option<Triangles> {
    if mesh.primitive_topology() != PrimitiveTopology::TriangleList {
        return None;
    }
    let VertexAttributeValues::Float32x3(positions) = mesh.try_attribute(Mesh::ATTRIBUTE_POSITION).ok()? else {
        return None;
    };
    let corner = |index: usize| positions.get(index).map(|position| FitVec3::from_array(*position));
    let corners: Vec<FitVec3> = match mesh.try_indices_option().ok()? {
        Some(indices) => indices.iter().map(corner).collect::<Option<_>>()?,
        None => (0..positions.len()).map(corner).collect::<Option<_>>()?,
    };
    let triangles = corners.as_chunks::<3>().0;
    (triangles.len() >= TRIANGLES_PER_CLUSTER).then(|| triangles.to_vec())
}

fn cut(triangles: &[[FitVec3; 3]]) -> Boxes {
    let limit = (triangles.len() / TRIANGLES_PER_CLUSTER).clamp(2, MAX_CLUSTERS);
    let clusters = shadowfit::Clusters::build(&[triangles], limit).ok()?;
    Some(clusters.boxes().into())
}
