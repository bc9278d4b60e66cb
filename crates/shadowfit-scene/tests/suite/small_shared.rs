//! Primitives that share accessors: time and memory depend on the file's size alone.

use std::sync::Arc;

use glam::{Vec2, Vec3, Vec4};
use shadowfit_scene::Scene;

use crate::build::{Build, F32, U8, U32, refusal};

/// Vertices of the shared accessors.
const VERTICES: usize = 62_000;

/// Primitives with one triangle each. All of their vertices together would exceed the import limit by far.
const PRIMITIVES: usize = 1500;

fn position(vertex: usize) -> Vec3 {
    Vec3::new((vertex % 250) as f32, (vertex / 250) as f32, (vertex % 7) as f32)
}

/// Returns the corners of primitive `number`, in mixed order.
fn corners(number: usize) -> [usize; 3] {
    let first = number * 41;
    [first + 2, first, first + 251]
}

/// Adds one index accessor for each primitive and returns the first accessor's index.
fn indices(build: &mut Build) -> usize {
    let all: Vec<u8> = (0..PRIMITIVES).flat_map(corners).flat_map(|corner| (corner as u32).to_le_bytes()).collect();
    let view = build.view(&all);
    let accessor = |number: usize| {
        format!(
            r#"{{"bufferView":{view},"byteOffset":{},"componentType":{U32},"type":"SCALAR","count":3}}"#,
            number * 12
        )
    };
    let numbers: Vec<usize> = (0..PRIMITIVES).map(|number| build.push_accessor(&accessor(number))).collect();
    numbers[0]
}

fn primitives(attributes: &str, more: &str, first: usize) -> String {
    let primitive = |number: usize| format!(r#"{{"attributes":{{{attributes}}},"indices":{}{more}}}"#, first + number);
    (0..PRIMITIVES).map(primitive).collect::<Vec<_>>().join(",")
}

fn assert_corners(scene: &Scene) {
    assert_eq!(scene.meshes[0].primitives.len(), PRIMITIVES);
    for (number, primitive) in scene.meshes[0].primitives.iter().enumerate() {
        assert_eq!(primitive.positions, corners(number).map(position), "primitive {number}");
        assert_eq!(primitive.indices, [0, 1, 2]);
    }
}

#[test]
fn primitives_keep_the_vertices_that_they_use_of_shared_accessors() {
    let mut build = Build::default();
    let positions: Vec<f32> = (0..VERTICES).flat_map(|vertex| position(vertex).to_array()).collect();
    let positions = build.floats("VEC3", 3, &positions);
    let normals = build.floats("VEC3", 3, &[0.0, 1.0, 0.0].repeat(VERTICES));
    let uvs: Vec<f32> = (0..VERTICES).flat_map(|vertex| [vertex as f32, 0.5]).collect();
    let uvs = build.floats("VEC2", 2, &uvs);
    let colors: Vec<u8> = (0..VERTICES).flat_map(|vertex| [(vertex % 256) as u8, 0, 0, 255]).collect();
    let colors = build.accessor_with(U8, "VEC4", VERTICES, &colors, r#","normalized":true"#);
    let first = indices(&mut build);
    let attributes = format!(r#""POSITION":{positions},"NORMAL":{normals},"TEXCOORD_0":{uvs},"COLOR_0":{colors}"#);
    let targets = format!(r#","targets":[{{"POSITION":{positions}}}]"#);
    let primitives = primitives(&attributes, &targets, first);
    build.members(&format!(r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{primitives}]}}]"#));
    let scene = build.load("shared").unwrap();
    assert_corners(&scene);
    for (number, primitive) in scene.meshes[0].primitives.iter().enumerate() {
        let corners = corners(number);
        assert_eq!(primitive.normals, [Vec3::Y; 3]);
        assert_eq!(primitive.uvs, corners.map(|corner| Vec2::new(corner as f32, 0.5)));
        assert_eq!(primitive.colors, corners.map(|corner| Vec4::new((corner % 256) as f32 / 255.0, 0.0, 0.0, 1.0)));
        assert_eq!(primitive.morphs[0].positions, corners.map(position));
    }
}

#[test]
fn a_sparse_accessor_is_put_together_once() {
    let mut build = Build::default();
    // All of its elements are replaced, so each copy of it would count.
    let replaced: Vec<u8> = (0..VERTICES as u32).flat_map(u32::to_le_bytes).collect();
    let values: Vec<u8> =
        (0..VERTICES).flat_map(|vertex| position(vertex).to_array()).flat_map(f32::to_le_bytes).collect();
    let (replaced, values) = (build.view(&replaced), build.view(&values));
    let positions = build.push_accessor(&format!(
        r#"{{"componentType":{F32},"type":"VEC3","count":{VERTICES},"sparse":{{"count":{VERTICES},
        "indices":{{"bufferView":{replaced},"componentType":{U32}}},"values":{{"bufferView":{values}}}}}}}"#
    ));
    let normals = build.floats("VEC3", 3, &[0.0, 1.0, 0.0].repeat(VERTICES));
    let first = indices(&mut build);
    let primitives = primitives(&format!(r#""POSITION":{positions},"NORMAL":{normals}"#), "", first);
    build.members(&format!(r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{primitives}]}}]"#));
    assert_corners(&build.load("sparse").unwrap());
}

#[test]
fn primitives_that_differ_in_material_alone_share_their_geometry_until_one_is_changed() {
    let mut build = Build::default();
    let positions: Vec<f32> = (0..VERTICES).flat_map(|vertex| position(vertex * 37 % VERTICES).to_array()).collect();
    let positions = build.floats("VEC3", 3, &positions);
    let primitive = |material: usize| format!(r#"{{"attributes":{{"POSITION":{positions}}},"material":{material}}}"#);
    // Together, their vertices would exceed the import limit.
    let primitives: Vec<String> = (0..2500).map(|number| primitive(number % 3)).collect();
    let primitives = primitives.join(",");
    build.members(&format!(
        r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{primitives}]}}],"materials":[{{}},{{}},{{}}]"#
    ));
    let mut scene = build.load("materials").unwrap();
    let all = &mut scene.meshes[0].primitives;
    assert_eq!(all.iter().map(|primitive| primitive.material).take(4).collect::<Vec<_>>(), [1, 2, 3, 1]);
    assert!(all.iter().all(|primitive| Arc::ptr_eq(&primitive.geometry, &all[0].geometry)));
    all[1].positions[0] = Vec3::X * 1e3;
    assert_ne!(all[0].positions[0], all[1].positions[0]);
}

#[test]
fn vertices_that_no_triangle_uses_may_be_broken_and_others_are_named_by_the_file() {
    for (corner, is_sound) in [(0_u8, true), (3, false)] {
        let mut build = Build::default();
        let nan = f32::NAN;
        let positions = build.floats("VEC3", 3, &[0., 0., 0., 1., 0., 0., 0., 1., 0., nan, 0., 0., 9., 9., 9.]);
        let indices = build.accessor(U8, "SCALAR", 6, &[2, 0, 1, 1, corner, 2]);
        build.one_primitive(&format!(r#"{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}"#));
        let loaded = build.load("unused");
        if is_sound {
            assert_eq!(loaded.unwrap().meshes[0].primitives[0].positions.len(), 6);
        } else {
            assert!(refusal(loaded).contains("vertex 3 is not finite"));
        }
    }
}
