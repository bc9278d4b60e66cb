//! Geometry and materials of small files: modes, indices, sparse data, normals, textures.

use glam::{Mat4, Vec2, Vec3, Vec4};
use shadowfit_scene::{AlphaMode, Primitive, Scene, Wrap, load_gltf};

use crate::build::{Build, F32, TRIANGLE, U8, U16, U32, load_text, write};

fn only(scene: &Scene) -> &Primitive {
    &scene.meshes[0].primitives[0]
}

/// Four corners of a square, in strip order. As a fan they fold over.
const SQUARE: [f32; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0];

#[test]
fn all_seven_modes_give_their_triangles_and_points_and_lines_a_note() {
    for (mode, triangles) in [(0, 0), (1, 0), (2, 0), (3, 0), (4, 1), (5, 2), (6, 2)] {
        let mut build = Build::default();
        let positions = build.floats("VEC3", 3, &SQUARE);
        build.one_primitive(&format!(r#"{{"mode":{mode},"attributes":{{"POSITION":{positions}}}}}"#));
        let scene = build.load("modes").unwrap();
        let pose = scene.pose(None, 0.0);
        assert_eq!(pose.triangles(&scene).len(), triangles, "mode {mode}");
        assert_eq!(scene.notes.iter().any(|note| note.contains("skipped")), mode < 4, "{:?}", scene.notes);
        assert_eq!(scene.bounds(&pose).is_some(), mode >= 4);
    }
}

#[test]
fn indices_of_every_type_address_the_same_triangle() {
    let index_data: [(u32, &[u8]); 3] =
        [(U8, &[2, 0, 1]), (U16, &[2, 0, 0, 0, 1, 0]), (U32, &[2, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0])];
    for (component, data) in index_data {
        let mut build = Build::default();
        let positions = build.floats("VEC3", 3, &TRIANGLE);
        let normals = build.floats("VEC3", 3, &[0.0, 0.0, 2.0].repeat(3));
        let indices = build.accessor(component, "SCALAR", 3, data);
        build.one_primitive(&format!(
            r#"{{"attributes":{{"POSITION":{positions},"NORMAL":{normals}}},"indices":{indices}}}"#
        ));
        let scene = build.load("index_types").unwrap();
        assert_eq!(only(&scene).indices, [2, 0, 1]);
        assert_eq!(only(&scene).normals, [Vec3::Z; 3]);
        let triangles = scene.pose(None, 0.0).triangles(&scene);
        assert_eq!(triangles[0].vertices, [Vec3::Y, Vec3::ZERO, Vec3::X]);
    }
}

#[test]
fn missing_normals_are_computed_flat_on_split_vertices() {
    let mut build = Build::default();
    // Two perpendicular faces that share an edge.
    let positions = build.floats("VEC3", 3, &[0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1.]);
    let indices = build.accessor(U8, "SCALAR", 6, &[0, 1, 2, 0, 2, 3]);
    build.one_primitive(&format!(r#"{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}"#));
    let scene = build.load("flat").unwrap();
    assert_eq!(only(&scene).positions.len(), 6);
    assert_eq!(only(&scene).normals, [[Vec3::Z; 3], [Vec3::X; 3]].concat());
    assert!(scene.notes.iter().any(|note| note.starts_with("primitives without normals")), "{:?}", scene.notes);
}

#[test]
fn zero_area_triangles_are_dropped_with_a_note() {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let indices = build.accessor(U8, "SCALAR", 9, &[0, 0, 1, 0, 1, 2, 1, 1, 1]);
    build.one_primitive(&format!(r#"{{"attributes":{{"POSITION":{positions}}},"indices":{indices}}}"#));
    let scene = build.load("zero_area").unwrap();
    assert_eq!(scene.pose(None, 0.0).triangles(&scene).len(), 1);
    assert!(scene.notes.contains(&"triangles without area dropped: 2".to_owned()), "{:?}", scene.notes);
}

#[test]
fn sparse_accessors_replace_elements_with_and_without_a_base() {
    let mut build = Build::default();
    let base = build.view(&TRIANGLE.map(f32::to_le_bytes).concat());
    let indices = build.view(&[1, 0]);
    let values = build.view(&[5.0, 0.0, 0.0].map(f32::to_le_bytes).concat());
    let sparse = format!(
        r#""sparse":{{"count":1,"indices":{{"bufferView":{indices},"componentType":{U8}}},"values":{{"bufferView":{values}}}}}"#
    );
    let head = format!(r#""componentType":{F32},"type":"VEC3","count":3"#);
    let over = build.push_accessor(&format!(r#"{{"bufferView":{base},{head},{sparse}}}"#));
    let zero = build.push_accessor(&format!("{{{head},{sparse}}}"));
    build.members(&format!(
        r#""nodes":[{{"mesh":0,"weights":[1]}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{over}}},"targets":[{{"POSITION":{zero}}}]}}]}}]"#
    ));
    let scene = build.load("sparse").unwrap();
    assert_eq!(only(&scene).positions, [Vec3::ZERO, Vec3::X * 5.0, Vec3::Y]);
    assert_eq!(only(&scene).morphs[0].positions, [Vec3::ZERO, Vec3::X * 5.0, Vec3::ZERO]);
}

#[test]
fn quantised_positions_are_scaled_only_where_the_accessor_says_normalized() {
    for (more, far) in [(r#","normalized":true"#, 1.0), ("", 255.0)] {
        let mut build = Build::default();
        let positions = build.accessor_with(U8, "VEC3", 3, &[0, 0, 0, 255, 0, 0, 0, 255, 0], more);
        build.one_primitive(&format!(r#"{{"attributes":{{"POSITION":{positions}}}}}"#));
        let scene = build.load("quantised").unwrap();
        assert_eq!(only(&scene).positions[1], Vec3::X * far);
    }
}

#[test]
fn mirrored_nodes_keep_geometric_normals_outward() {
    for (scale, corners) in [
        ("[1,1,1]", [Vec3::ZERO, Vec3::X, Vec3::Y]),
        ("[-1,1,1]", [Vec3::ZERO, Vec3::Y, Vec3::NEG_X]),
        ("[-1,-1,1]", [Vec3::ZERO, Vec3::NEG_X, Vec3::NEG_Y]),
    ] {
        let mut build = Build::default();
        let positions = build.floats("VEC3", 3, &TRIANGLE);
        build.members(&format!(
            r#""nodes":[{{"mesh":0,"scale":{scale}}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions}}}}}]}}]"#
        ));
        let scene = build.load("mirrored").unwrap();
        let pose = scene.pose(None, 0.0);
        let [a, b, c] = pose.triangles(&scene)[0].vertices;
        assert_eq!([a, b, c], corners);
        assert_eq!((b - a).cross(c - a), Vec3::Z);
        assert_eq!(pose.is_mirrored(&scene, &scene.instances()[0]), scale == "[-1,1,1]");
    }
}

#[test]
fn nodes_are_parents_first_and_only_those_of_the_scene() {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    build.members(&format!(
        r#""scene":0,"scenes":[{{"nodes":[2]}}],"nodes":[{{"mesh":0,"translation":[1,0,0]}},{{"name":"other"}},
        {{"name":"root","children":[3,0],"matrix":[2,0,0,0,0,2,0,0,0,0,2,0,0,0,7,1]}},{{"name":"leaf"}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions}}}}}]}}]"#
    ));
    let scene = build.load("order").unwrap();
    let names: Vec<_> = scene.nodes.iter().map(|node| (node.name.as_str(), node.parent)).collect();
    assert_eq!(names, [("root", None), ("leaf", Some(0)), ("", Some(0))]);
    let pose = scene.pose(None, 0.0);
    let expected = Mat4::from_translation(Vec3::new(2.0, 0.0, 7.0)) * Mat4::from_scale(Vec3::splat(2.0));
    assert_eq!(pose.world_from_node[2], expected);
    assert!(scene.is_descendant(2, 0) && scene.is_descendant(0, 0) && !scene.is_descendant(2, 1));
    let bounds = scene.node_bounds(&pose, 0).unwrap();
    assert_eq!((bounds.min, bounds.max), (Vec3::new(2.0, 0.0, 7.0), Vec3::new(4.0, 2.0, 7.0)));
    assert!(scene.node_bounds(&pose, 1).is_none());
}

/// Returns a PNG of two pixels, red and green.
fn png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let pixels = image::RgbaImage::from_raw(2, 1, vec![255, 0, 0, 255, 0, 255, 0, 255]).unwrap();
    pixels.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// Returns a file with a textured triangle, with the given image and material members.
fn textured(build: &mut Build, material: &str, image: &str) -> String {
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let uvs = build.floats("VEC2", 2, &[0.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    let second = build.floats("VEC2", 2, &[0.5; 6]);
    build.one_primitive(&format!(
        r#"{{"material":0,"attributes":{{"POSITION":{positions},"TEXCOORD_0":{uvs},"TEXCOORD_1":{second}}}}}"#
    ));
    build.members(&format!(
        r#""materials":[{{{material}}}],"textures":[{{"source":0,"sampler":0}}],"images":[{{{image}}}],
        "samplers":[{{"wrapS":33071,"wrapT":33648,"magFilter":9728}}]"#
    ));
    build.json()
}

#[test]
fn materials_keep_factors_modes_textures_and_sampling() {
    let mut build = Build::default();
    let view = build.view(&png());
    let text = textured(
        &mut build,
        r#""alphaMode":"MASK","alphaCutoff":0.25,"doubleSided":true,"emissiveFactor":[1,0,0],
        "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":5}},"normalTexture":{"index":0,"scale":0.5},
        "pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.25,1],"metallicFactor":0.5,"roughnessFactor":0.75,
        "baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":
        {"offset":[0.25,0.5],"scale":[2,4],"rotation":1.5707963267948966}}}}"#,
        &format!(r#""bufferView":{view},"mimeType":"image/png""#),
    );
    let scene = load_text("materials", &text).unwrap();
    let material = &scene.materials[only(&scene).material];
    assert_eq!(material.base_color, Vec4::new(1.0, 0.5, 0.25, 1.0));
    assert_eq!((material.metallic, material.roughness, material.normal_scale), (0.5, 0.75, 0.5));
    assert_eq!(material.emissive, Vec3::X * 5.0);
    assert_eq!(material.alpha, AlphaMode::Mask { cutoff: 0.25 });
    assert!(material.double_sided);
    let texture = material.base_color_texture.unwrap();
    assert_eq!((texture.wrap, texture.nearest), ([Wrap::Clamp, Wrap::Mirror], true));
    // A quarter turn counter-clockwise in the image maps u to -v, which points up, and v to u.
    let [u, v] = texture.uv_from_texcoord;
    let apply = |uv: Vec2| Vec2::new(u.dot(uv.extend(1.0)), v.dot(uv.extend(1.0)));
    assert!((apply(Vec2::X) - Vec2::new(0.25, -1.5)).length() < 1e-6);
    assert!((apply(Vec2::Y) - Vec2::new(4.25, 0.5)).length() < 1e-6);
    assert_eq!(scene.images[texture.image].rgba, [255, 0, 0, 255, 0, 255, 0, 255]);
    assert_eq!(material.normal_texture.unwrap().image, texture.image);
    assert_eq!(only(&scene).tangents, [Vec4::new(1.0, 0.0, 0.0, 1.0); 3]);
}

#[test]
fn textures_read_the_set_of_coordinates_that_they_name() {
    let mut build = Build::default();
    let view = build.view(&png());
    let image = format!(r#""bufferView":{view},"mimeType":"image/png""#);
    let material = r#""pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1}}"#;
    let scene = load_text("second_set", &textured(&mut build, material, &image)).unwrap();
    assert_eq!(only(&scene).uvs, [Vec2::splat(0.5); 3]);
    assert!(only(&scene).tangents.is_empty());
}

#[test]
fn unusable_images_become_a_placeholder_and_a_note() {
    let gif = "data:image/gif;base64,R0lGODlhAQABAIAAAAAAAP///yH5BAEAAAAALAAAAAABAAEAAAIBRAA7";
    for uri in ["missing.png", "../outside.png", "https://example.com/a.png", gif, "data:image/png;base64,iVBORw0KGgo="]
    {
        let mut build = Build::default();
        let material = r#""normalTexture":{"index":0},"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}"#;
        let scene = load_text("unusable", &textured(&mut build, material, &format!(r#""uri":"{uri}""#))).unwrap();
        let material = &scene.materials[1];
        let image = &scene.images[material.base_color_texture.unwrap().image];
        assert_eq!((image.width, image.height, &image.rgba[..]), (1, 1, &[255; 4][..]));
        assert!(material.normal_texture.is_none());
        let note = scene.notes.iter().find(|note| note.contains("images[0]"));
        assert!(note.is_some_and(|note| note.contains("placeholder")), "{uri}: {:?}", scene.notes);
    }
}

#[test]
fn external_files_are_found_by_percent_encoded_and_non_ascii_names() {
    let bytes = TRIANGLE.map(f32::to_le_bytes).concat();
    write("external", "zäune 100%.bin", &bytes);
    for uri in ["zäune 100%.bin", "z%C3%A4une%20100%25.bin", "./zäune%20100%.bin"] {
        let text = format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":36,"uri":"{uri}"}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}}],
            "nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}]}}"#
        );
        let path = write("external", "❤.gltf", text.as_bytes());
        assert_eq!(load_gltf(&path).unwrap().name, "❤", "{uri}");
    }
}
