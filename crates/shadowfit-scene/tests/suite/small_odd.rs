//! Unusual files: valid ones, and common invalid ones.

use glam::Vec3;
use shadowfit_scene::{Scene, load_gltf};

use crate::build::{Build, F32, TRIANGLE, U8, load_text, write};

fn triangles(scene: &Scene) -> Vec<[Vec3; 3]> {
    scene.pose(None, 0.0).triangles(scene).iter().map(|triangle| triangle.vertices).collect()
}

fn triangle() -> Build {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    build.one_primitive(&format!(r#"{{"attributes":{{"POSITION":{positions}}}}}"#));
    build
}

#[test]
fn whole_numbers_may_be_written_with_a_fraction() {
    let text = triangle().json().replace(r#""count":3"#, r#""count":3.0"#).replace(r#""mesh":0"#, r#""mesh":0.0"#);
    assert_eq!(triangles(&load_text("fraction", &text).unwrap()).len(), 1);
    let text = triangle().json().replace(r#""count":3"#, r#""count":3.5"#);
    let message = load_text("fraction", &text).unwrap_err().to_string();
    assert!(message.contains("3.5") && message.contains("line 2"), "{message}");
}

#[test]
fn channels_without_a_target_node_and_scenes_without_nodes_are_no_reason_to_refuse() {
    let mut build = triangle();
    let times = build.floats("SCALAR", 1, &[0.0, 1.0]);
    build.members(&format!(
        r#""scene":0,"scenes":[{{"nodes":[0]}},{{"name":"empty"}}],"animations":[{{"samplers":[{{"input":{times},
        "output":{times}}}],"channels":[{{"sampler":0,"target":{{"path":"pointer","extensions":
        {{"KHR_animation_pointer":{{"pointer":"/nodes/0/extensions/KHR_node_visibility/visible"}}}}}}}}]}}],
        "extensionsUsed":["KHR_animation_pointer"]"#
    ));
    let scene = build.load("pointer").unwrap();
    assert_eq!((triangles(&scene).len(), scene.animations.len()), (1, 0));
    assert!(scene.notes.iter().any(|note| note.starts_with("KHR_animation_pointer is ignored")), "{:?}", scene.notes);
}

#[test]
fn interleaved_attributes_and_a_stride_of_zero_are_read() {
    let mut build = Build::default();
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0_f32]];
    let rows: Vec<u8> =
        corners.iter().flat_map(|[x, y]| [*x, *y, 0.0, 0.0, 0.0, 1.0]).flat_map(f32::to_le_bytes).collect();
    let view = build.view(&rows);
    let tight = build.view(&TRIANGLE.map(f32::to_le_bytes).concat());
    let accessor = |view: usize, offset: usize| {
        format!(r#"{{"bufferView":{view},"byteOffset":{offset},"componentType":{F32},"type":"VEC3","count":3}}"#)
    };
    let [positions, normals] = [0, 12].map(|offset| build.push_accessor(&accessor(view, offset)));
    let plain = build.push_accessor(&accessor(tight, 0));
    build.members(&format!(
        r#""nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[
        {{"attributes":{{"POSITION":{positions},"NORMAL":{normals}}}}},{{"attributes":{{"POSITION":{plain}}}}}]}}]"#
    ));
    // Sets the stride of the first view without one.
    let stride = |text: &str, stride: usize| {
        text.replacen(r#"{"buffer":0,"#, &format!(r#"{{"byteStride":{stride},"buffer":0,"#), 1)
    };
    let text = stride(&stride(&build.json(), 24), 0);
    let scene = load_text("strides", &text).unwrap();
    assert_eq!(triangles(&scene), [[Vec3::ZERO, Vec3::X, Vec3::Y]; 2]);
    assert_eq!(scene.meshes[0].primitives[0].normals, [Vec3::Z; 3]);
}

#[test]
fn empty_primitives_zero_scales_and_equal_names_draw_nothing_wrong() {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let none = build.push_accessor(&format!(r#"{{"componentType":{U8},"type":"SCALAR","count":0}}"#));
    let nothing = build.push_accessor(&format!(r#"{{"componentType":{F32},"type":"VEC3","count":0}}"#));
    build.members(&format!(
        r#""nodes":[{{"name":"a","mesh":0}},{{"name":"a","mesh":1}},{{"name":"a","mesh":1,"scale":[0,0,0],"translation":[0,5,0]}},
        {{"mesh":2}}],"meshes":[{{"name":"m","primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{none}}},
        {{"attributes":{{"POSITION":{nothing}}}}}]}},{{"name":"m","primitives":[{{"attributes":{{"POSITION":{positions}}}}}]}},
        {{"primitives":[]}}]"#
    ));
    let scene = build.load("empty").unwrap();
    assert_eq!(triangles(&scene), [[Vec3::ZERO, Vec3::X, Vec3::Y], [Vec3::Y * 5.0; 3]]);
    assert_eq!(scene.bounds(&scene.pose(None, 0.0)).unwrap().max, Vec3::new(1.0, 5.0, 0.0));
}

#[test]
fn more_vertices_than_16_bits_count_need_no_indices() {
    let mut build = Build::default();
    let count = 70_002;
    let positions: Vec<f32> =
        (0..count).flat_map(|vertex| [vertex as f32, (vertex % 3) as f32, (vertex % 2) as f32]).collect();
    let positions = build.floats("VEC3", 3, &positions);
    build.one_primitive(&format!(r#"{{"attributes":{{"POSITION":{positions}}}}}"#));
    let scene = build.load("many").unwrap();
    let all = triangles(&scene);
    assert_eq!(all.len(), count / 3);
    assert_eq!(all[count / 3 - 1][2], Vec3::new(count as f32 - 1.0, 2.0, ((count - 1) % 2) as f32));
}

#[test]
fn separators_of_windows_in_file_names_are_followed_inside_the_folder_alone() {
    let bytes = TRIANGLE.map(f32::to_le_bytes).concat();
    let folder = write("windows", "odd.gltf", b"").parent().unwrap().join("bin");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("a.bin"), &bytes).unwrap();
    let text = |uri: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":36,"uri":"{uri}"}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}}],
            "nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}]}}"#
        )
    };
    let load = |uri: &str| load_gltf(&write("windows", "odd.gltf", text(uri).as_bytes()));
    assert_eq!(triangles(&load(r"bin\\a.bin").unwrap()).len(), 1);
    assert_eq!(triangles(&load("bin%5Ca.bin").unwrap()).len(), 1);
    assert!(load(r"..\\windows\\bin\\a.bin").unwrap_err().to_string().contains("buffers[0]"));
}
