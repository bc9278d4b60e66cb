//! Extensions of glTF: the ones that import reads, the effect of ignoring others on the picture, and the ones
//! that a file may require.

use std::path::Path;

use crate::SceneError;

/// Extensions that import reads, to the extent that shadows and their receivers need them.
const READ: [&str; 10] = [
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
    // Metadata, which has no effect on pictures.
    "KHR_xmp_json_ld",
    "KHR_xmp",
];

/// Ignored extensions that do not change triangles, each with the effect of ignoring it. A file may require
/// them.
const HARMLESS: [(&str, &str); 35] = [
    ("ADOBE_materials_clearcoat_specular", "clear coats have no specular colour"),
    ("ADOBE_materials_thin_transparency", "thin glass is drawn by its alpha alone"),
    ("AGI_articulations", "articulations stay at rest"),
    ("AGI_stk_metadata", "its metadata has no effect"),
    ("CESIUM_RTC", "the scene stays at its own origin instead of its place on the globe"),
    ("CESIUM_primitive_outline", "outlines are not drawn"),
    ("EXT_instance_features", "features of instances have no effect"),
    ("EXT_lights_ies", "lights have no photometric profile"),
    ("EXT_lights_image_based", "the sky lights the scene instead of its environment image"),
    ("EXT_mesh_features", "features of meshes have no effect"),
    ("EXT_mesh_manifold", "its topology data has no effect"),
    ("EXT_structural_metadata", "its metadata has no effect"),
    ("EXT_texture_avif", "textures show their PNG, JPEG or WebP image, or none"),
    (
        "KHR_animation_pointer",
        "animations of materials, lights, cameras, visibility, weights of meshes and single weights are not played, \
         only those of nodes",
    ),
    ("KHR_audio_emitter", "audio is not played"),
    ("KHR_interactivity", "the scene does not react"),
    ("KHR_materials_anisotropy", "brushed surfaces are drawn with round highlights"),
    ("KHR_materials_clearcoat", "surfaces are drawn without clear coat"),
    ("KHR_materials_diffuse_transmission", "no light shines through thin surfaces"),
    ("KHR_materials_dispersion", "glass does not split colours"),
    ("KHR_materials_ior", "surfaces reflect as at an index of refraction of 1.5"),
    ("KHR_materials_iridescence", "thin films show no rainbow colours"),
    ("KHR_materials_sheen", "cloth is drawn without sheen"),
    ("KHR_materials_specular", "reflections of non-metals have their usual strength and colour"),
    ("KHR_materials_transmission", "glass is drawn opaque, and casts"),
    ("KHR_materials_unlit", "unlit surfaces are lit and shadowed"),
    ("KHR_materials_variants", "the default variant is drawn"),
    ("KHR_materials_volume", "light is not coloured or bent on its way through glass"),
    ("KHR_materials_volume_scatter", "light does not scatter below surfaces"),
    ("KHR_node_hoverability", "nodes do not react to a pointer"),
    ("KHR_node_selectability", "nodes cannot be selected"),
    ("KHR_texture_basisu", "textures show their PNG, JPEG or WebP image, or none"),
    ("MSFT_lod", "the finest level of detail is drawn"),
    ("MSFT_packing_occlusionRoughnessMetallic", "packed textures are not read"),
    ("MSFT_texture_dds", "textures show their PNG, JPEG or WebP image, or none"),
];

/// Compressions of meshes. Files that do not require them contain an uncompressed copy, which import reads.
pub(super) const COMPRESSED: [&str; 3] =
    ["EXT_meshopt_compression", "KHR_draco_mesh_compression", "KHR_meshopt_compression"];

/// Command that converts a file with compressed meshes.
pub(super) const DECOMPRESS: &str =
    "Decompress its meshes with glTF-Transform: gltf-transform cp compressed.glb plain.glb";

/// Command that converts a file with textures compressed for GPUs.
const DECODE_TEXTURES: &str =
    "Convert its textures to PNG with glTF-Transform: gltf-transform ktxdecompress compressed.glb plain.glb";

/// Returns a sentence about an extension that a file uses, or `None` if import reads it.
pub(super) fn note(name: &str) -> Option<String> {
    if READ.contains(&name) {
        return None;
    }
    let unknown = "this program does not know it, and draws the scene without its content";
    let compressed = COMPRESSED.contains(&name).then_some("the plain copy of its meshes is read");
    let lacking = compressed.or(harmless(name).map(|(_, lacking)| *lacking)).unwrap_or(unknown);
    Some(format!("{name} is ignored: {lacking}"))
}

/// Refuses a file that requires an extension without which its triangles or their holes would be wrong or
/// missing. `has_plain_textures` states that no texture needs an extension.
pub(super) fn check<'a>(
    path: &Path,
    required: impl Iterator<Item = &'a str>,
    has_plain_textures: bool,
) -> Result<(), SceneError> {
    for (index, name) in required.enumerate() {
        let opens = READ.contains(&name) || harmless(name).is_some();
        if !opens || (is_texture_format(name) && !has_plain_textures) {
            return Err(SceneError::Extension {
                path: path.to_owned(),
                element: format!("extensionsRequired[{index}]"),
                name: name.to_owned(),
                hint: hint(name),
            });
        }
    }
    Ok(())
}

fn harmless(name: &str) -> Option<&'static (&'static str, &'static str)> {
    HARMLESS.iter().find(|(known, _)| *known == name)
}

/// Returns whether the extension is a format of textures that import cannot read.
fn is_texture_format(name: &str) -> bool {
    matches!(name, "KHR_texture_basisu" | "EXT_texture_avif" | "MSFT_texture_dds")
}

fn hint(name: &str) -> &'static str {
    match name {
        _ if COMPRESSED.contains(&name) => DECOMPRESS,
        "KHR_texture_basisu" => DECODE_TEXTURES,
        "EXT_texture_avif" => "Convert its textures with glTF-Transform: gltf-transform png compressed.glb plain.glb",
        "MSFT_texture_dds" => "Export the file with PNG or JPEG textures",
        _ => "Export the file without it",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_extension_stands_in_one_list_and_its_note_is_a_sentence() {
        let mut all: Vec<&str> = READ.into_iter().chain(HARMLESS.map(|(name, _)| name)).collect();
        all.sort_unstable();
        let count = all.len();
        all.dedup();
        assert_eq!(all.len(), count);
        for (name, _) in HARMLESS {
            let note = note(name).expect("it is ignored");
            assert!(note.starts_with(name) && note.contains(" is ignored: "), "{note}");
        }
        assert_eq!(note("KHR_node_visibility"), None);
    }

    #[test]
    fn compressed_files_are_refused_with_the_command_that_converts_them() {
        for (name, command) in [
            ("KHR_draco_mesh_compression", "gltf-transform cp"),
            ("EXT_meshopt_compression", "gltf-transform cp"),
            ("KHR_meshopt_compression", "gltf-transform cp"),
            ("KHR_texture_basisu", "gltf-transform ktxdecompress"),
            ("EXT_texture_avif", "gltf-transform png"),
        ] {
            let error = check(Path::new("a.glb"), [name].into_iter(), false).expect_err(name).to_string();
            assert!(error.contains(name) && error.contains(command), "{error}");
        }
    }
}
