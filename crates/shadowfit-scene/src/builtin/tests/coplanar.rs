//! No two surfaces of a scene lie in one place and fight for it.

use std::collections::{BTreeSet, HashMap};

use glam::Vec3;

use super::{Scene, Triangle, every};

/// Steps of a unit normal that count as one direction: a third of a degree.
const TURNS: f32 = 200.0;
/// Steps of a plane's distance that count as one, a metre: half a millimetre.
const STEPS: f32 = 2000.0;

/// A plane, rounded.
type Plane = [i32; 4];

/// Unit normal of a triangle, and its plane.
fn plane(triangle: &Triangle) -> (Vec3, Plane) {
    let [a, b, c] = triangle.vertices;
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let [x, y, z] = (normal * TURNS).round().to_array().map(|value| value as i32);
    (normal, [x, y, z, (normal.dot(a) * STEPS).round() as i32])
}

/// Whether the middle of `a` is inside `b`, whose unit normal is given, by more than a millimetre.
fn covers(b: &Triangle, normal: Vec3, a: &Triangle) -> bool {
    let middle = a.vertices.iter().sum::<Vec3>() / 3.0;
    (0..3).all(|corner| {
        let (from, to) = (b.vertices[corner], b.vertices[(corner + 1) % 3]);
        normal.cross(to - from).normalize_or_zero().dot(middle - from) > 1e-3
    })
}

/// Names of meshes of which one has a triangle in the place of another's. What faces down is left out: the bottoms of
/// what stands side by side in the ground; and so is what hangs on `jointed`, whose limbs overlap where they meet.
fn fighting(scene: &Scene, jointed: Option<usize>) -> BTreeSet<[String; 2]> {
    let triangles = scene.pose(None, 0.0).triangles(scene);
    let instances = scene.instances();
    let mesh = |triangle: &Triangle| &scene.meshes[instances[triangle.instance as usize].mesh];
    let is_left_out = |triangle: &Triangle| {
        let instance = instances[triangle.instance as usize];
        let material = mesh(triangle).primitives[instance.primitive].material;
        scene.materials[material].double_sided || jointed.is_some_and(|root| scene.is_descendant(instance.node, root))
    };
    let mut planes: HashMap<Plane, Vec<(&Triangle, Vec3)>> = HashMap::new();
    for triangle in triangles.iter().filter(|triangle| !is_left_out(triangle)) {
        let (normal, plane) = plane(triangle);
        if normal.y < -0.99 {
            continue;
        }
        planes.entry(plane).or_default().push((triangle, normal));
    }
    let mut found = BTreeSet::new();
    for together in planes.values() {
        for (index, (a, normal_a)) in together.iter().enumerate() {
            for (b, normal_b) in &together[index + 1..] {
                if covers(b, *normal_b, a) || covers(a, *normal_a, b) {
                    found.insert([a, b].map(|triangle| mesh(triangle).name.clone()));
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
