//! Extensions: hidden nodes, other kinds of materials, and notes about ignored extensions.

use glam::{Vec3, Vec4};
use shadowfit_scene::{AlphaMode, Casting, Scene, SceneError, load_gltf};

use crate::build::{Build, TRIANGLE, load_text, refusal, write};

/// Returns a triangle, with further members of its primitive and of the file.
fn triangle(primitive: &str, members: &str) -> String {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    build.one_primitive(&format!(r#"{{"attributes":{{"POSITION":{positions}}}{primitive}}}"#));
    if !members.is_empty() {
        build.members(members);
    }
    build.json()
}

/// A white pixel as a data URI.
const PIXEL: &str = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";

fn loaded(primitive: &str, members: &str) -> Result<Scene, SceneError> {
    load_text("extensions", &triangle(primitive, members))
}

#[test]
fn hidden_nodes_and_their_children_are_neither_drawn_nor_shine() {
    const HIDDEN: &str = r#""extensions":{"KHR_node_visibility":{"visible":false}}"#;
    let text = |nodes: &str| {
        let mut build = Build::default();
        let positions = build.floats("VEC3", 3, &TRIANGLE);
        build.members(&format!(
            r#""extensionsUsed":["KHR_node_visibility"],"extensionsRequired":["KHR_node_visibility"],
            "scenes":[{{"nodes":[0,1,2]}}],"nodes":[{nodes}],"cameras":[{{"type":"perspective","perspective":
            {{"yfov":1,"znear":0.1}}}}],"extensions":{{"KHR_lights_punctual":{{"lights":[{{"type":"directional"}}]}}}},
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions}}}}}]}}]"#
        ));
        build.json()
    };
    let light = r#""KHR_lights_punctual":{"light":0}"#;
    let hidden_light = HIDDEN.replace("}}", &format!("}},{light}}}"));
    let nodes = format!(
        r#"{{"mesh":0,"translation":[7,0,0],"extensions":{{"KHR_node_visibility":{{"visible":true}}}}}},
        {{"mesh":0,"children":[3],{HIDDEN}}},{{{hidden_light}}},{{"mesh":0,"camera":0,"extensions":{{"KHR_node_visibility":{{"visible":true}}}}}}"#
    );
    let scene = load_text("hidden", &text(&nodes)).unwrap();
    let triangles = scene.pose(None, 0.0).triangles(&scene);
    assert_eq!((triangles.len(), triangles[0].vertices[0]), (1, Vec3::X * 7.0));
    assert_eq!((scene.nodes.len(), scene.cameras.len(), scene.sun), (4, 1, None));
    let message = refusal(load_text("hidden", &text(&format!(r#"{{"mesh":0,{HIDDEN}}},{{}},{{}}"#))));
    assert!(message.contains("KHR_node_visibility hides every node"), "{message}");
}

#[test]
fn extensions_that_leave_triangles_in_place_open_with_a_note_each_even_if_required() {
    let names = [
        "KHR_materials_unlit",
        "KHR_materials_clearcoat",
        "KHR_materials_sheen",
        "KHR_materials_transmission",
        "KHR_materials_volume",
        "KHR_materials_ior",
        "KHR_materials_specular",
        "KHR_materials_iridescence",
        "KHR_materials_anisotropy",
        "KHR_materials_dispersion",
        "KHR_materials_variants",
        "KHR_materials_diffuse_transmission",
        "KHR_animation_pointer",
        "EXT_structural_metadata",
    ];
    for name in names {
        let scene = loaded("", &format!(r#""extensionsUsed":["{name}"],"extensionsRequired":["{name}"]"#)).unwrap();
        let start = format!("{name} is ignored: ");
        assert!(scene.notes.iter().any(|note| note.starts_with(&start)), "{name}: {:?}", scene.notes);
    }
    for name in ["KHR_xmp_json_ld", "KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_mesh_quantization"] {
        let scene = loaded("", &format!(r#""extensionsUsed":["{name}"],"extensionsRequired":["{name}"]"#)).unwrap();
        assert_eq!(scene.notes, ["primitives without normals given flat ones: 1"], "{name}");
    }
    let scene = loaded("", r#""extensionsUsed":["ACME_soup"]"#).unwrap();
    assert!(scene.notes.iter().any(|note| note.starts_with("ACME_soup is ignored")), "{:?}", scene.notes);
    let message = refusal(loaded("", r#""extensionsRequired":["ACME_soup"]"#));
    assert!(message.contains("extensionsRequired[0] requires ACME_soup"), "{message}");
}

#[test]
fn specular_glossiness_gives_base_colour_alpha_and_texture() {
    let mut build = Build::default();
    let positions = build.floats("VEC3", 3, &TRIANGLE);
    let uvs = build.floats("VEC2", 2, &[0.5; 6]);
    build.one_primitive(&format!(r#"{{"material":0,"attributes":{{"POSITION":{positions},"TEXCOORD_1":{uvs}}}}}"#));
    let members = r#""materials":[{"alphaMode":"MASK","extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":
        [1,0.5,0.25,0.75],"glossinessFactor":0.25,"diffuseTexture":{"index":0,"texCoord":0,"extensions":
        {"KHR_texture_transform":{"scale":[2,2],"texCoord":1}}}}}}],"textures":[{"source":0}],
        "images":[{"uri":"PIXEL"}],"extensionsUsed":["KHR_materials_pbrSpecularGlossiness"]"#;
    build.members(&members.replace("PIXEL", PIXEL));
    let scene = build.load("glossiness").unwrap();
    let material = &scene.materials[1];
    assert_eq!(material.base_color, Vec4::new(1.0, 0.5, 0.25, 0.75));
    assert_eq!((material.metallic, material.roughness), (0.0, 0.75));
    assert_eq!(material.base_color_texture.unwrap().uv_from_texcoord, [Vec3::X * 2.0, Vec3::Y * 2.0]);
    assert_eq!(scene.meshes[0].primitives[0].uvs.len(), 3, "its own set");
    assert!(matches!(scene.casting(&scene.meshes[0].primitives[0]), Casting::CutOut(least) if least < 0.5));
    let message = refusal(loaded(
        r#","material":0"#,
        r#""materials":[{"extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseFactor":"red"}}}]"#,
    ));
    assert!(message.contains("materials[0].extensions.KHR_materials_pbrSpecularGlossiness"), "{message}");
}

#[test]
fn specular_colours_make_black_materials_metals_and_are_noted_where_they_are_not_read() {
    let table = [
        (r#""diffuseFactor":[0,0,0,0.5],"specularFactor":[1,0.75,0.25]"#, Vec4::new(1.0, 0.75, 0.25, 0.5), 1.0, None),
        (r#""diffuseFactor":[0,0,0,1]"#, Vec4::ONE, 1.0, None),
        (r#""diffuseFactor":[0.5,0,0,1]"#, Vec4::new(0.5, 0.0, 0.0, 1.0), 0.0, None),
        // Black plastic.
        (
            r#""diffuseFactor":[0,0,0,1],"specularFactor":[0.04,0.04,0.04]"#,
            Vec4::new(0.0, 0.0, 0.0, 1.0),
            0.0,
            Some("specularFactor is read for black materials only"),
        ),
        (
            r#""diffuseFactor":[0,0,0,1],"specularGlossinessTexture":{"index":0}"#,
            Vec4::new(0.0, 0.0, 0.0, 1.0),
            0.0,
            Some("specularGlossinessTexture is not read"),
        ),
    ];
    for (members, color, metallic, note) in table {
        let material = format!(r#"{{"extensions":{{"KHR_materials_pbrSpecularGlossiness":{{{members}}}}}}}"#);
        let scene = loaded(r#","material":0"#, &format!(r#""materials":[{material}]"#)).unwrap();
        assert_eq!((scene.materials[1].base_color, scene.materials[1].metallic), (color, metallic), "{members}");
        let found = scene.notes.iter().find(|note| note.contains("Glossiness"));
        assert_eq!(found.is_some(), note.is_some(), "{members}: {found:?}");
        assert!(found.is_none_or(|found| found.contains(note.unwrap_or_default())), "{found:?}");
    }
}

#[test]
fn textures_fall_back_to_plain_images_and_are_refused_without_one_with_the_command() {
    let members = |texture: &str| {
        format!(
            r#""materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],"textures":[{texture}],
            "images":[{{"uri":"{PIXEL}"}},{{"uri":"a.ktx2"}}],
            "extensionsUsed":["KHR_texture_basisu"],"extensionsRequired":["KHR_texture_basisu"]"#
        )
    };
    let basisu = r#""extensions":{"KHR_texture_basisu":{"source":1}}"#;
    let scene = loaded(r#","material":0"#, &members(&format!(r#"{{"source":0,{basisu}}}"#))).unwrap();
    assert_eq!(scene.images.len(), 1);
    assert!(!scene.notes.iter().any(|note| note.contains("replaced")), "{:?}", scene.notes);
    let message = refusal(loaded(r#","material":0"#, &members(&format!("{{{basisu}}}"))));
    assert!(message.contains("gltf-transform ktxdecompress"), "{message}");
}

#[test]
fn only_textures_that_are_read_need_a_plain_image_and_a_compressed_one_is_none() {
    let members = |material: &str, texture: &str| {
        format!(
            r#""materials":[{{{material}}}],"textures":[{{"source":0}},{texture}],"extensionsRequired":["KHR_texture_basisu"],
            "images":[{{"uri":"{PIXEL}"}},{{"uri":"a.KTX2"}},{{"bufferView":0,"mimeType":"image/ktx2"}},
            {{"uri":"data:image/ktx2;base64,AAAA"}}]"#
        )
    };
    let basisu = r#"{"extensions":{"KHR_texture_basisu":{"source":1}}}"#;
    let base = r#""pbrMetallicRoughness":{"baseColorTexture":{"index":1}}"#;
    let gloss = r#""extensions":{"KHR_materials_pbrSpecularGlossiness":{"diffuseTexture":{"index":1}}}"#;
    let unread = [
        r#""occlusionTexture":{"index":1},"emissiveTexture":{"index":1}"#.to_owned(),
        r#""pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":{"index":1}}"#.to_owned(),
        format!("{},{base}", gloss.replace(r#""index":1"#, r#""index":0"#)),
    ];
    for material in unread {
        let scene = loaded(r#","material":0"#, &members(&material, basisu)).unwrap();
        assert!(!scene.notes.iter().any(|note| note.contains("replaced")), "{:?}", scene.notes);
    }
    let normal = r#""normalTexture":{"index":1}"#;
    for material in [base, gloss, normal] {
        for texture in [basisu, r#"{"source":1}"#, r#"{"source":2}"#, r#"{"source":3}"#] {
            let message = refusal(loaded(r#","material":0"#, &members(material, texture)));
            assert!(message.contains("gltf-transform ktxdecompress"), "{message}");
        }
    }
}

#[test]
fn compressed_meshes_without_a_plain_copy_are_refused_with_the_command() {
    let draco = r#","extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}"#;
    let used = r#""extensionsUsed":["KHR_draco_mesh_compression"]"#;
    let scene = loaded(draco, used).unwrap();
    assert!(scene.notes.iter().any(|note| note.contains("plain copy")), "{:?}", scene.notes);
    let bare = triangle(draco, used).replace(r#""bufferView":0,"componentType""#, r#""componentType""#);
    let message = refusal(load_text("extensions", &bare));
    assert!(message.contains("meshes[0].primitives[0]") && message.contains("gltf-transform cp"), "{message}");
    let meshopt = r#""extensions":{"EXT_meshopt_compression":{"fallback":true}},"uri":"#;
    let start = triangle("", "");
    let uri = start.find(r#""uri":"data"#).unwrap();
    let end = uri + start[uri..].find('}').unwrap();
    let bare = format!("{}{}{}", &start[..uri], meshopt.trim_end_matches(r#","uri":"#), &start[end..]);
    let message = refusal(load_text("extensions", &bare));
    assert!(message.contains("buffers[0]") && message.contains("gltf-transform cp"), "{message}");
}

#[test]
fn a_cutoff_above_one_hides_a_primitive_and_blended_ones_cast_where_they_are_opaque() {
    let material = |members: &str| {
        let positions = triangle(r#","material":0"#, &format!(r#""materials":[{{{members}}}]"#));
        load_text("cutoff", &positions).unwrap()
    };
    let hidden = material(r#""alphaMode":"MASK","alphaCutoff":1.001"#);
    assert!(hidden.instances().is_empty());
    assert!(hidden.notes.iter().any(|note| note.contains("alphaCutoff")), "{:?}", hidden.notes);
    let casting = |scene: &Scene| scene.casting(&scene.meshes[0].primitives[0]);
    assert!(
        matches!(casting(&material(r#""alphaMode":"MASK","alphaCutoff":1"#)), Casting::CutOut(least) if least < 1.0)
    );
    assert_eq!(casting(&material(r#""alphaMode":"OPAQUE","alphaCutoff":7"#)), Casting::Whole);
    // Transparent texels are holes at the smallest cutoffs, and opaque only at 0.
    for cutoff in [1e-6, 1e-4, 9e-4, 2e-3_f32] {
        let found = casting(&material(&format!(r#""alphaMode":"MASK","alphaCutoff":{cutoff}"#)));
        assert!(matches!(found, Casting::CutOut(least) if least > 0.0 && least < cutoff), "{cutoff}: {found:?}");
    }
    assert_eq!(casting(&material(r#""alphaMode":"MASK","alphaCutoff":0"#)), Casting::CutOut(0.0));
    for (alpha, wanted) in [("1", Casting::Whole), ("0.5", Casting::Whole), ("0.498", Casting::Nothing)] {
        let scene =
            material(&format!(r#""alphaMode":"BLEND","pbrMetallicRoughness":{{"baseColorFactor":[1,1,1,{alpha}]}}"#));
        assert_eq!(casting(&scene), wanted, "{alpha}");
        assert_eq!(scene.materials[1].alpha, AlphaMode::Blend);
        assert!(scene.notes.iter().any(|note| note.starts_with("blended materials cast")), "{:?}", scene.notes);
    }
}

#[test]
fn a_byte_order_mark_before_the_json_is_skipped() {
    let text = triangle("", "");
    let marked = format!("\u{feff}{text}");
    assert_eq!(load_text("marked", &marked).unwrap().meshes.len(), 1);
    let mut json = marked.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = |bytes: usize| (bytes as u32).to_le_bytes();
    let header = [*b"glTF", length(2), length(20 + json.len()), length(json.len()), *b"JSON"].concat();
    let path = write("marked", "marked.glb", &[header, json].concat());
    assert_eq!(load_gltf(&path).unwrap().meshes.len(), 1);
}
