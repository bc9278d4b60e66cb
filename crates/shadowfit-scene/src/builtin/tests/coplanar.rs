//! No two surfaces of a scene are coplanar and overlap, which would cause z-fighting.

use std::collections::{BTreeSet, HashMap};

use glam::Vec3;

use super::{Scene, Triangle, every};

/// Rounding steps of a unit normal that count as one direction: a third of a degree.
const TURNS: f32 = 200.0;
/// Rounding steps of a plane's distance, per metre: half a millimetre each.
const STEPS: f32 = 2000.0;

/// A plane, rounded.
type Plane = [i32; 4];

/// Returns the unit normal of a triangle, and its rounded plane.
fn plane(triangle: &Triangle) -> (Vec3, Plane) {
    let [a, b, c] = triangle.vertices;
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let [x, y, z] = (normal * TURNS).round().to_array().map(|value| value as i32);
    (normal, [x, y, z, (normal.dot(a) * STEPS).round() as i32])
}

/// Returns whether the middle of `a` lies in the plane of `b` and more than a millimetre inside `b`. `normal`
/// is the unit normal of `b`.
fn covers(b: &Triangle, normal: Vec3, a: &Triangle) -> bool {
    let middle = a.vertices.iter().sum::<Vec3>() / 3.0;
    // Far from the origin, planes of almost one direction may differ more than their rounded distances show.
    let is_in_plane = normal.dot(middle - b.vertices[0]).abs() < 1.0 / STEPS;
    is_in_plane
        && (0..3).all(|corner| {
            let (from, to) = (b.vertices[corner], b.vertices[(corner + 1) % 3]);
            normal.cross(to - from).normalize_or_zero().dot(middle - from) > 1e-3
        })
}

/// A triangle with its unit normal and its bounds.
struct Surface<'a> {
    triangle: &'a Triangle,
    normal: Vec3,
    min: Vec3,
    max: Vec3,
}

impl<'a> Surface<'a> {
    fn new(triangle: &'a Triangle, normal: Vec3) -> Self {
        let [a, b, c] = triangle.vertices;
        Self { triangle, normal, min: a.min(b).min(c), max: a.max(b).max(c) }
    }

    /// Returns whether the bounds of two triangles overlap.
    fn meets(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }
}

/// Returns the names of pairs of meshes with coplanar, overlapping triangles. Ignores triangles that face
/// down (bottoms of neighbouring objects in the ground), double-sided materials, and the descendants of
/// `jointed`, whose limbs overlap at the joints.
fn fighting(scene: &Scene, jointed: Option<usize>) -> BTreeSet<[String; 2]> {
    let triangles = scene.pose(None, 0.0).triangles(scene);
    let instances = scene.instances();
    let mesh = |triangle: &Triangle| &scene.meshes[instances[triangle.instance as usize].mesh];
    let is_left_out = |triangle: &Triangle| {
        let instance = instances[triangle.instance as usize];
        let material = mesh(triangle).primitives[instance.primitive].material;
        scene.materials[material].double_sided || jointed.is_some_and(|root| scene.is_descendant(instance.node, root))
    };
    let mut planes: HashMap<Plane, Vec<Surface>> = HashMap::new();
    for triangle in triangles.iter().filter(|triangle| !is_left_out(triangle)) {
        let (normal, plane) = plane(triangle);
        if normal.y < -0.99 {
            continue;
        }
        planes.entry(plane).or_default().push(Surface::new(triangle, normal));
    }
    let mut found = BTreeSet::new();
    for mut together in planes.into_values() {
        // Sorting along x keeps the number of compared pairs small: the middle of one triangle must lie in
        // the box of the other.
        together.sort_by(|a, b| a.min.x.total_cmp(&b.min.x));
        for (index, a) in together.iter().enumerate() {
            let near = together[index + 1..].iter().take_while(|b| b.min.x <= a.max.x);
            for b in near.filter(|b| a.meets(b)) {
                if covers(b.triangle, b.normal, a.triangle) || covers(a.triangle, a.normal, b.triangle) {
                    found.insert([a, b].map(|surface| mesh(surface.triangle).name.clone()));
                }
            }
        }
    }
    found
}

#[test]
fn no_two_surfaces_that_face_the_same_way_share_a_place() {
    for (id, scene) in every() {
        let jointed = scene.subject.filter(|_| ["courtyard", "shadow-mapping"].contains(&id));
        assert_eq!(fighting(&scene, jointed), BTreeSet::new(), "{id}");
    }
}
