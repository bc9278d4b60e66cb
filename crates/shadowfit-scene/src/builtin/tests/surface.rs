//! Surfaces of all scenes: arrays of equal length, outward normals, closed solids, textures that exist.

use std::collections::HashMap;

use super::facts::{primitives, triangles};
use super::{AlphaMode, Primitive, Scene, every};

/// Open sheets that face up, with the ids of their scenes.
const GROUNDS: [(&str, &str); 8] = [
    ("courtyard", "floor"),
    ("plain", "land"),
    ("arcade", "gravel"),
    ("forest", "forest floor"),
    ("town", "cobbles"),
    ("town", "meadow"),
    ("shadow-mapping", "grid floor"),
    ("terrain", "land"),
];

/// Returns whether a mesh is an open sheet under the objects of a scene. The sheet of the street also faces
/// sideways.
fn is_ground(id: &str, mesh: &str) -> bool {
    (id, mesh) == ("street", "strip") || GROUNDS.contains(&(id, mesh))
}

/// Returns whether a primitive is a sheet of leaves or grass: cut out, with two sides. The courtyard's
/// lattice is solid.
pub(super) fn is_foliage(scene: &Scene, primitive: &Primitive) -> bool {
    let material = &scene.materials[primitive.material];
    material.double_sided && material.name != "lattice"
}

#[test]
fn vertex_arrays_agree_and_every_index_is_in_range() {
    for (id, scene) in every() {
        for (name, primitive) in primitives(&scene) {
            let count = primitive.positions.len();
            assert_eq!((primitive.normals.len(), primitive.uvs.len()), (count, count), "{id}: {name}");
            assert!(primitive.colors.is_empty() || primitive.colors.len() == count, "{id}: {name}");
            assert!(primitive.indices.iter().all(|&index| (index as usize) < count), "{id}: {name}");
            assert_eq!(primitive.indices.len() % 3, 0, "{id}: {name}");
            assert!(primitive.material < scene.materials.len(), "{id}: {name}");
        }
    }
}

#[test]
fn every_material_is_used_and_its_texture_exists_and_is_small() {
    for (id, scene) in every() {
        let textures = || scene.materials.iter().filter_map(|material| material.base_color_texture);
        assert!(textures().all(|texture| texture.image < scene.images.len()), "{id}");
        for (index, image) in scene.images.iter().enumerate() {
            assert_eq!(image.rgba.len(), (image.width * image.height * 4) as usize, "{id}: {}", image.name);
            assert!(image.width.is_power_of_two() && image.width <= 1024, "{id}: {}", image.name);
            assert!(textures().any(|texture| texture.image == index), "{id}: {} is not used", image.name);
        }
        for (index, material) in scene.materials.iter().enumerate() {
            let is_used = primitives(&scene).any(|(_, primitive)| primitive.material == index);
            assert!(is_used, "{id}: {} is not used", material.name);
        }
    }
}

#[test]
fn every_triangle_has_area_and_unit_normals_on_its_outer_side() {
    for (id, scene) in every() {
        for (name, primitive) in primitives(&scene) {
            for corners in triangles(primitive) {
                let [a, b, c] = corners.map(|index| primitive.positions[index]);
                let area = (b - a).cross(c - a);
                // Twice 0.01 mm².
                assert!(area.length() > 2e-8, "{id}: {name}: {a} {b} {c}");
                for index in corners {
                    let normal = primitive.normals[index];
                    assert!((normal.length() - 1.0).abs() < 1e-4, "{id}: {name}: {normal}");
                    assert!(normal.dot(area) > 0.0, "{id}: {name}: {normal} at {a}");
                }
            }
        }
    }
}

#[test]
fn every_solid_is_closed_and_faces_outwards() {
    for (id, scene) in every() {
        let solids =
            primitives(&scene).filter(|(name, primitive)| !is_ground(id, name) && !is_foliage(&scene, primitive));
        for (name, primitive) in solids {
            let key = |index: usize| primitive.positions[index].to_array().map(|value| (value + 0.0).to_bits());
            let mut edges: HashMap<_, i32> = HashMap::new();
            let mut volume = 0.0;
            for [a, b, c] in triangles(primitive) {
                let [pa, pb, pc] = [a, b, c].map(|index| primitive.positions[index]);
                volume += pa.dot(pb.cross(pc));
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    *edges.entry((key(from), key(to))).or_default() += 1;
                    *edges.entry((key(to), key(from))).or_default() -= 1;
                }
            }
            // Triangles pass each edge equally often in both directions.
            assert!(edges.values().all(|&count| count == 0), "{id}: {name} has an open edge");
            assert!(volume > 0.0, "{id}: {name} is inside out");
        }
    }
}

#[test]
fn grounds_are_there_and_face_up() {
    for (id, scene) in every() {
        for (_, mesh) in GROUNDS.iter().filter(|(of, _)| *of == id) {
            let ground = primitives(&scene).find(|(name, _)| name == mesh).expect(mesh).1;
            assert!(ground.normals.iter().all(|normal| normal.y > 0.5), "{id}");
        }
    }
}

#[test]
fn foliage_is_masked_and_neither_a_full_square_nor_dust() {
    for (builtin, scene) in every() {
        for material in scene.materials.iter().filter(|m| m.double_sided && m.name != "lattice") {
            assert!(matches!(material.alpha, AlphaMode::Mask { .. }), "{builtin:?}: {}", material.name);
            let image = &scene.images[material.base_color_texture.expect("a texture").image];
            let (width, covered) = (image.width as usize, |pixel: usize| image.rgba[pixel * 4 + 3] >= 128);
            let pixels = image.rgba.len() / 4;
            let share = (0..pixels).filter(|&pixel| covered(pixel)).count() as f32 / pixels as f32;
            assert!((0.15..0.75).contains(&share), "{builtin:?}: {}: {share}", image.name);
            // Noise changes at every second pixel, leaves only at their outlines.
            let changes =
                (1..pixels).filter(|pixel| pixel % width != 0 && covered(*pixel) != covered(pixel - 1)).count();
            assert!((changes as f32) < 0.15 * pixels as f32, "{builtin:?}: {}: {changes}", image.name);
        }
    }
}
