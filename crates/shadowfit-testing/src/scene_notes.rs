//! A scene with notes of its import.

/// A glTF file of two triangles, with lines that are skipped and a missing image.
pub const SCENE_WITH_NOTES: &str = r#"{
    "asset": { "version": "2.0" }, "nodes": [{ "mesh": 0 }],
    "meshes": [{ "primitives": [
        { "mode": 5, "attributes": { "POSITION": 0 }, "material": 0 }, { "mode": 3, "attributes": { "POSITION": 0 } }
    ] }],
    "materials": [{ "doubleSided": true, "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
    "textures": [{ "source": 0 }], "images": [{ "uri": "missing.png" }],
    "accessors": [{ "bufferView": 0, "componentType": 5121, "type": "VEC3", "count": 4 }],
    "bufferViews": [{ "buffer": 0, "byteLength": 12 }],
    "buffers": [{ "byteLength": 12, "uri": "data:;base64,AAAAAAAJCQAACQAJ" }]
}"#;

/// Beginnings of the notes of [`SCENE_WITH_NOTES`].
pub const NOTES: [&str; 2] =
    ["images[0]: replaced by a placeholder: ", "meshes[0].primitives[1]: lines skipped: only triangles are drawn"];
