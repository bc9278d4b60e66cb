//! The casters of a scene, by number: instances, or clusters of triangles of large meshes. Culling and the
//! order along the light thus work on parts of meshes.

use core::ops::Range;

use glam::{Mat4, Vec3};
use shadowfit::{Aabb, Boxes};
use shadowfit_wgpu::Casters;

/// Greatest number of triangles in a cluster. Smaller clusters are culled better, but cost more draw calls.
const CLUSTER_TRIANGLES: usize = 512;

/// Number of runs into which the casters of a pass are divided, nearest to the light first. Within a run
/// casters are grouped into draw calls. More runs would hide more casters, but cost more draw calls.
const RUNS: usize = 16;

/// A part of a primitive's index buffer.
#[derive(Clone, Debug)]
pub struct Cluster {
    /// Range of indices.
    pub indices: Range<u32>,
    /// Bounds in the space of the positions, in metres.
    pub bounds: Aabb,
}

/// A caster: an instance, or a cluster of one.
#[derive(Clone, Copy, Debug)]
struct Caster {
    part: u32,
    instance: u32,
    cluster: u32,
}

/// Casters of one draw call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct CasterDraw {
    pub(crate) part: usize,
    pub(crate) indices: Range<u32>,
    /// Instances of the scene, in the order of their data.
    pub(crate) instances: Range<usize>,
}

/// All casters of a scene.
#[derive(Debug, Default)]
pub(crate) struct SceneCasters {
    casters: Vec<Caster>,
    boxes: Vec<Aabb>,
    moves: Vec<bool>,
    /// Casters of the run that is being grouped.
    run: Vec<Caster>,
}

impl SceneCasters {
    /// Adds an instance of a part.
    pub(crate) fn push(&mut self, part: usize, instance: usize, clusters: usize, moves: bool) {
        for cluster in 0..clusters as u32 {
            self.casters.push(Caster { part: part as u32, instance: instance as u32, cluster });
            self.boxes.push(Aabb::EMPTY);
            self.moves.push(moves);
        }
    }

    /// Sets all boxes, in world space, in metres. `bounds` returns the box of a part's instance and cluster.
    pub(crate) fn set_boxes(&mut self, bounds: impl Fn(usize, usize, usize) -> Aabb) {
        for (aabb, caster) in self.boxes.iter_mut().zip(&self.casters) {
            *aabb = bounds(caster.part as usize, caster.instance as usize, caster.cluster as usize);
        }
    }

    /// Returns the casters by number, in world space.
    pub(crate) fn by_number(&self) -> Casters<'_> {
        Casters { moves: &self.moves, ..Casters::fixed(Boxes::world(&self.boxes)) }
    }

    /// Merges each caster's mask into its instance's mask. Instances that cast no shadow stay `None`.
    pub(crate) fn merge_masks(&self, masks: &[u8], of_instances: &mut [Option<u8>]) {
        for (caster, mask) in self.casters.iter().zip(masks) {
            let merged = &mut of_instances[caster.instance as usize];
            *merged = Some(merged.unwrap_or(0) | mask);
        }
    }

    /// Groups casters, sorted nearest to the light first, into draw calls. `indices` returns the indices of a
    /// part's cluster. `add` is called with each instance that is drawn.
    pub(crate) fn draws(
        &mut self,
        numbers: &[u32],
        indices: impl Fn(usize, usize) -> Range<u32>,
        mut add: impl FnMut(usize) -> usize,
        out: &mut Vec<CasterDraw>,
    ) {
        for run in numbers.chunks(numbers.len().div_ceil(RUNS).max(1)) {
            self.run.clear();
            self.run.extend(run.iter().map(|number| self.casters[*number as usize]));
            self.run.sort_unstable_by_key(|caster| (caster.part, caster.instance, caster.cluster));
            let first_of_run = out.len();
            let mut last_instance = u32::MAX;
            for caster in &self.run {
                let is_same = caster.instance == last_instance;
                last_instance = caster.instance;
                let range = indices(caster.part as usize, caster.cluster as usize);
                match out[first_of_run..].last_mut().filter(|last| last.part == caster.part as usize) {
                    // The next cluster of the same instance.
                    Some(last) if is_same && last.indices.end == range.start && last.instances.len() == 1 => {
                        last.indices.end = range.end;
                    }
                    // The same triangles for another instance.
                    Some(last) if !is_same && last.indices == range => {
                        last.instances.end = add(caster.instance as usize) + 1;
                    }
                    _ => {
                        let slot = add(caster.instance as usize);
                        out.push(CasterDraw { part: caster.part as usize, indices: range, instances: slot..slot + 1 });
                    }
                }
            }
        }
    }
}

/// Divides the triangles of a mesh into clusters of a few hundred. Returns reordered indices and the
/// clusters. A deforming mesh is one cluster. Panics if an index is out of range.
pub fn clustered(positions: &[Vec3], indices: &[u32], deforms: bool) -> (Vec<u32>, Vec<Cluster>) {
    if deforms {
        let triangles = indices.as_chunks::<3>().0;
        let whole = Cluster { indices: 0..triangles.len() as u32 * 3, bounds: bounds(positions, triangles.iter()) };
        return (triangles.as_flattened().to_vec(), vec![whole]);
    }
    let mut faces: Vec<Face> =
        indices.as_chunks::<3>().0.iter().map(|corners| Face::new(positions, *corners)).collect();
    let clusters = split(positions, &mut faces, 0);
    (faces.iter().flat_map(|face| face.corners).collect(), clusters)
}

/// A triangle with three times its middle, the sort key.
#[derive(Clone, Copy, Debug)]
struct Face {
    middle: Vec3,
    corners: [u32; 3],
}

impl Face {
    fn new(positions: &[Vec3], corners: [u32; 3]) -> Self {
        Self { middle: corners.iter().map(|index| positions[*index as usize]).sum(), corners }
    }
}

/// Divides triangles at the median of their middles along the longest side, until there are few enough.
fn split(positions: &[Vec3], faces: &mut [Face], first: u32) -> Vec<Cluster> {
    let end = first + faces.len() as u32 * 3;
    if faces.len() <= CLUSTER_TRIANGLES {
        let bounds = bounds(positions, faces.iter().map(|face| &face.corners));
        return vec![Cluster { indices: first..end, bounds }];
    }
    let size = Aabb::from_points(faces.iter().map(|face| face.middle)).map_or(Vec3::ZERO, |middles| middles.size());
    let axis = size.max_position();
    let half = faces.len() / 2;
    faces.select_nth_unstable_by(half, |a, b| a.middle[axis].total_cmp(&b.middle[axis]));
    let (low, high) = faces.split_at_mut(half);
    let (mut clusters, others) =
        rayon::join(|| split(positions, low, first), || split(positions, high, first + half as u32 * 3));
    clusters.extend(others);
    clusters
}

fn bounds<'a>(positions: &[Vec3], triangles: impl Iterator<Item = &'a [u32; 3]>) -> Aabb {
    Aabb::from_points(triangles.flatten().map(|index| positions[*index as usize])).unwrap_or(Aabb::EMPTY)
}

/// Returns the world box of a box in mesh space.
pub(crate) fn transformed(bounds: &Aabb, matrix: &Mat4) -> Aabb {
    if bounds.is_empty() {
        return Aabb::EMPTY;
    }
    let center = matrix.transform_point3((bounds.min + bounds.max) * 0.5);
    let half = (bounds.max - bounds.min) * 0.5;
    let axis = |column: glam::Vec4| column.truncate().abs();
    let reach = axis(matrix.x_axis) * half.x + axis(matrix.y_axis) * half.y + axis(matrix.z_axis) * half.z;
    Aabb { min: center - reach, max: center + reach }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clusters_hold_every_triangle_once_and_their_boxes_hold_them() {
        let positions: Vec<Vec3> = (0..3000)
            .map(|i| {
                let i = i as f32;
                Vec3::new((i * 0.754_877).fract() * 40.0, (i * 0.569_84).fract(), (i * 0.31).fract() * 20.0)
            })
            .collect();
        let indices: Vec<u32> = (0..2998).flat_map(|i| [i, i + 1, i + 2]).collect();
        let (reordered, clusters) = clustered(&positions, &indices, false);
        let sorted = |indices: &[u32]| {
            let mut triangles = indices.as_chunks::<3>().0.to_vec();
            triangles.sort_unstable();
            triangles
        };
        assert_eq!(sorted(&reordered), sorted(&indices));
        assert_eq!(clusters.len(), 8);
        let mut next = 0;
        for cluster in &clusters {
            assert_eq!(cluster.indices.start, next);
            next = cluster.indices.end;
            let corners = reordered[cluster.indices.start as usize..next as usize].iter();
            let (min, max) = (cluster.bounds.min, cluster.bounds.max);
            assert!(corners.map(|i| positions[*i as usize]).all(|p| p.cmpge(min).all() && p.cmple(max).all()));
        }
        assert_eq!(next as usize, indices.len());
        assert_eq!(clustered(&positions, &indices, true).1.len(), 1);
    }

    #[test]
    fn draws_join_neighbouring_clusters_and_instances_of_the_same_triangles() {
        let mut casters = SceneCasters::default();
        // A large mesh of four clusters, and three instances of a small one.
        casters.push(0, 0, 4, false);
        for instance in 1..4 {
            casters.push(1, instance, 1, false);
        }
        let indices = |part: usize, cluster: usize| {
            if part == 0 { cluster as u32 * 30..cluster as u32 * 30 + 30 } else { 0..6 }
        };
        let mut added = Vec::new();
        let mut draws = Vec::new();
        let numbers = [5, 1, 4, 0, 6, 3];
        // One caster per run: nothing is joined.
        casters.draws(&numbers, indices, |i| (added.push(i), added.len() - 1).1, &mut draws);
        assert_eq!((draws.len(), added.as_slice()), (6, [2, 0, 1, 0, 3, 0].as_slice()));
        // Many numbers give runs of several casters.
        let numbers: Vec<u32> = numbers.iter().copied().cycle().take(6 * RUNS).collect();
        added.clear();
        draws.clear();
        casters.draws(&numbers, indices, |i| (added.push(i), added.len() - 1).1, &mut draws);
        assert_eq!(draws.len(), 3 * RUNS);
        let expected = [(0, 0..60, 1), (0, 90..120, 1), (1, 0..6, 3)];
        for (draw, (part, indices, instances)) in draws.iter().zip(expected) {
            assert_eq!((draw.part, &draw.indices, draw.instances.len()), (part, &indices, instances));
        }
    }

    #[test]
    fn bounds_follow_a_mirrored_and_turned_transform() {
        let matrix = Mat4::from_translation(Vec3::X * 5.0)
            * Mat4::from_rotation_y(core::f32::consts::FRAC_PI_2)
            * Mat4::from_scale(Vec3::new(-1.0, 2.0, 3.0));
        let bounds = transformed(&Aabb { min: Vec3::ZERO, max: Vec3::ONE }, &matrix);
        assert!((bounds.min - Vec3::new(5.0, 0.0, 0.0)).length() < 1e-5, "{bounds:?}");
        assert!((bounds.max - Vec3::new(8.0, 2.0, 1.0)).length() < 1e-5, "{bounds:?}");
    }
}
