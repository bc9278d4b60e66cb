//! The origin of a scene. Positions in f32 are coarse far from it, so a scene that lies far from the file's
//! origin gets another one.

use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

use glam::{DVec3, Mat4, Vec3, Vec4};
use shadowfit::Aabb;

use super::accessor::Reader;
use super::nodes::Tree;
use super::notes::Notes;
use crate::error::Problem;
use crate::limits::MAX_COORDINATE;
use crate::{Geometry, Scene};

/// Greatest coordinate of a scene's middle at which the scene keeps the file's origin, in metres. Up to twice
/// this distance, f32 positions are exact to half a millimetre.
const NEAR_ORIGIN: f64 = 4096.0;

/// Least factor by which a new origin must reduce the median distance of the triangles. A smaller factor
/// would gain less than two bits of precision, and would move a large scene that starts at its origin.
const NEARER: f64 = 4.0;

/// Least distance at which neighbouring f32 positions are more than a millimetre apart, in metres.
const COARSE: f64 = 16_384.0;

/// Share of a scene's triangles near the file's origin from which the scene keeps that origin.
const MANY: f64 = 0.4;

/// Moves the scene's origin to the median of its triangles if these lie far from the file's origin. Notes the
/// new origin, and parts whose positions remain coarse.
pub(super) fn place(scene: &mut Scene, tree: &Tree, reader: &Reader, notes: &mut Notes) -> Result<(), Problem> {
    let parts = parts(scene, tree, reader)?;
    let middle = DVec3::from_array([0, 1, 2].map(|axis| median(&parts, |part| part.middle[axis])));
    let reach = |origin: DVec3| median(&parts, |part| part.farthest(origin));
    let is_far = middle.abs().max_element() > NEAR_ORIGIN;
    if is_far && reach(middle) * NEARER <= reach(DVec3::ZERO) && !has_place_here(&parts, middle) {
        scene.origin = middle.round();
        let [x, y, z] = scene.origin.to_array();
        notes.add(format!(
            "moved near the origin, where positions are exact: world positions are relative to ({x}, {y}, {z}) m of the file"
        ));
    }
    let distances = parts.iter().map(|part| part.nearest(scene.origin)).filter(|&distance| distance >= COARSE);
    let (count, farthest) = distances.fold((0, 0.0), |(count, farthest), distance| (count + 1, distance.max(farthest)));
    if count > 0 {
        let far = farthest as f32;
        let (all, apart) = (parts.len(), far.next_up() - far);
        notes.add(format!(
            "parts that lie up to {farthest:.0} m from the origin, where positions are {apart:.3} m apart: {count} of {all}"
        ));
    }
    Ok(())
}

/// Returns whether many triangles lie near the file's origin and would be coarse relative to `origin`. This
/// is the case for a place with a detailed backdrop far away.
fn has_place_here(parts: &[Part], origin: DVec3) -> bool {
    let all: u64 = parts.iter().map(|part| part.triangles).sum();
    let here = parts.iter().filter(|part| part.farthest(DVec3::ZERO) <= NEAR_ORIGIN && part.nearest(origin) >= COARSE);
    here.map(|part| part.triangles).sum::<u64>() as f64 >= MANY * all as f64
}

/// World bounds of an instance at rest, relative to the origin of the file.
struct Part {
    middle: DVec3,
    half_size: DVec3,
    triangles: u64,
}

impl Part {
    /// Returns the greatest coordinate of the bounds relative to an origin.
    fn farthest(&self, origin: DVec3) -> f64 {
        ((self.middle - origin).abs() + self.half_size).max_element()
    }

    /// Returns the greatest coordinate that all points of the bounds reach, relative to an origin.
    fn nearest(&self, origin: DVec3) -> f64 {
        ((self.middle - origin).abs() - self.half_size).max_element()
    }
}

/// Returns the median over the triangles of a scene, the upper one of two. Returns 0 for a scene without
/// parts.
fn median(parts: &[Part], of: impl Fn(&Part) -> f64) -> f64 {
    let half = parts.iter().map(|part| part.triangles).sum::<u64>() / 2;
    let mut values: Vec<(f64, u64)> = parts.iter().map(|part| (of(part), part.triangles)).collect();
    values.sort_unstable_by(|(a, _), (b, _)| a.total_cmp(b));
    let mut below = 0;
    let at_half = values.into_iter().find(|(_, triangles)| {
        below += triangles;
        below > half
    });
    at_half.map_or(0.0, |(value, _)| value)
}

/// Bounds of a geometry in mesh space, and the joints that move it.
struct Shape {
    bounds: Option<Aabb>,
    joints: Vec<u16>,
}

impl Shape {
    fn of(geometry: &Geometry) -> Self {
        let slots = geometry.joints.iter().flatten().zip(geometry.weights.iter().flat_map(Vec4::to_array));
        let joints: BTreeSet<u16> = slots.filter(|(_, weight)| *weight > 0.0).map(|(&joint, _)| joint).collect();
        let bounds = Aabb::from_points(geometry.positions.iter().copied());
        Self { bounds, joints: joints.into_iter().collect() }
    }
}

/// Computes the bounds of all instances from the corners of their geometry's box. Visits no vertex per node,
/// so sharing a mesh stays cheap. Fails if positions exceed [`MAX_COORDINATE`].
fn parts(scene: &Scene, tree: &Tree, reader: &Reader) -> Result<Vec<Part>, Problem> {
    let rest = scene.pose(None, 0.0);
    let skins: Vec<Vec<Mat4>> = scene.skins.iter().map(|skin| rest.world_from_mesh_by_joint(skin)).collect();
    let mut shapes = HashMap::new();
    let mut parts = Vec::new();
    for instance in scene.each_instance() {
        let geometry = &scene.meshes[instance.mesh].primitives[instance.primitive].geometry;
        let shape = shapes.entry(Arc::as_ptr(geometry)).or_insert_with(|| Shape::of(geometry));
        let Some(bounds) = shape.bounds else { continue };
        let element = || format!("nodes[{}]", tree.file_index[instance.node]);
        let matrices = match scene.nodes[instance.node].skin.filter(|_| !shape.joints.is_empty()) {
            Some(skin) => {
                reader.spend(shape.joints.len(), &element())?;
                shape.joints.iter().map(|&joint| skins[skin][usize::from(joint)]).collect()
            }
            None => vec![rest.world_from(instance.node)],
        };
        let mut all = Aabb::EMPTY;
        for matrix in matrices {
            let Some(world) = world_bounds(bounds, matrix) else {
                let reason = format!("it puts geometry beyond {MAX_COORDINATE:e} m");
                return Err(Problem::new(element(), reason).hint("Scale the scene down"));
            };
            all = all.union(world);
        }
        let (min, max) = (all.min.as_dvec3(), all.max.as_dvec3());
        let triangles = geometry.indices.len() as u64 / 3;
        parts.push(Part { middle: min.midpoint(max), half_size: (max - min) * 0.5, triangles });
    }
    Ok(parts)
}

/// Returns the world bounds of a box, or `None` if they exceed [`MAX_COORDINATE`].
fn world_bounds(bounds: Aabb, world_from_local: Mat4) -> Option<Aabb> {
    let corners = bounds.corners().map(|corner| world_from_local.transform_point3(corner));
    let is_near = |corner: &Vec3| corner.is_finite() && corner.abs().max_element() <= MAX_COORDINATE;
    Aabb::from_points(corners).filter(|_| corners.iter().all(is_near))
}
