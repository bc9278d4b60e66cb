//! From file to parsed JSON: GLB chunks, JSON, version and required extensions.
//!
//! The gltf crate's own GLB reader and validation are not used: both can panic on bad input.

use std::path::Path;

use gltf::json::{Root, Value, deserialize};

use crate::SceneError;

/// Largest file read, glTF and buffers alike: what a GLB can hold at most.
pub(crate) const MAX_FILE_BYTES: u64 = u32::MAX as u64;

/// Extensions that a file may require.
const SUPPORTED: [&str; 5] = [
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// A parsed file.
pub(crate) struct Source {
    /// The JSON part.
    pub(crate) root: Root,
    /// The binary chunk of a GLB.
    pub(crate) binary: Option<Vec<u8>>,
    /// Extensions that the file uses, does not require, and that import ignores.
    pub(crate) ignored_extensions: Vec<String>,
    /// Number of animation channels that move no node, which import ignores.
    pub(crate) channels_without_node: usize,
}

/// Parses the content of the file `path`. Before that, `tell_json` is called with the length of the JSON, in bytes.
pub(crate) fn parse(path: &Path, bytes: &[u8], tell_json: impl FnOnce(u64)) -> Result<Source, SceneError> {
    let malformed = |(element, reason): (&str, String)| SceneError::Malformed {
        path: path.to_owned(),
        element: element.to_owned(),
        reason,
        hint: "Export it again as glTF 2.0, or fetch the file again if it was cut short",
    };
    let (json, binary) = split(bytes).map_err(malformed)?;
    tell_json(json.len() as u64);
    let mut parsed = deserialize::from_slice::<Root>(json);
    let mut channels_without_node = 0;
    if parsed.is_err() {
        // The JSON may be sound and only of another version, or use an extension's own layout.
        let mut loose = deserialize::from_slice(json).map_err(|e| malformed(("JSON", e.to_string())))?;
        check_version(version_of(&loose)).map_err(malformed)?;
        let required = loose["extensionsRequired"].as_array().into_iter().flatten();
        check_extensions(path, required.filter_map(Value::as_str))?;
        channels_without_node = drop_channels_without_node(&mut loose);
        if channels_without_node > 0 {
            parsed = deserialize::from_value(loose);
        }
    }
    let root = parsed.map_err(|error| malformed(("JSON", error.to_string())))?;
    check_version(&root.asset.version).map_err(malformed)?;
    check_extensions(path, root.extensions_required.iter().map(String::as_str))?;
    let used = root.extensions_used.iter();
    let ignored_extensions = used.filter(|e| !SUPPORTED.contains(&e.as_str())).cloned().collect();
    Ok(Source { root, binary: binary.map(<[u8]>::to_vec), ignored_extensions, channels_without_node })
}

/// Removes the animation channels that move no node, such as channels of `KHR_animation_pointer`. Returns their number.
/// glTF allows them, but the gltf crate refuses their file.
fn drop_channels_without_node(json: &mut Value) -> usize {
    let mut dropped = 0;
    for animation in json.get_mut("animations").and_then(Value::as_array_mut).into_iter().flatten() {
        let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) else { continue };
        let before = channels.len();
        channels.retain(|channel| channel["target"].get("node").is_some());
        dropped += before - channels.len();
    }
    dropped
}

type Split<'a> = (&'a [u8], Option<&'a [u8]>);

/// Separates the JSON from the binary chunk.
fn split(bytes: &[u8]) -> Result<Split<'_>, (&'static str, String)> {
    if bytes.is_empty() {
        return Err(("file", "it is empty".to_owned()));
    }
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes, None));
    }
    let header = |reason: &str| ("GLB header", reason.to_owned());
    let version = u32_at(bytes, 4).ok_or_else(|| header("it is cut short"))?;
    let length = u32_at(bytes, 8).ok_or_else(|| header("it is cut short"))? as usize;
    if version != 2 {
        return Err(("GLB header", format!("its version is {version}, not 2")));
    }
    let body = bytes
        .get(12..length)
        .ok_or_else(|| ("GLB header", format!("it claims {length} bytes, the file has {}", bytes.len())))?;
    let (kind, json, rest) = chunk(body, "GLB chunk 0")?;
    if kind != b"JSON" {
        return Err(("GLB chunk 0", "it is not the JSON chunk".to_owned()));
    }
    if rest.is_empty() {
        return Ok((json, None));
    }
    let (kind, binary, _) = chunk(rest, "GLB chunk 1")?;
    // Chunks of other kinds are to be ignored, says the specification.
    Ok((json, (kind == b"BIN\0").then_some(binary)))
}

type Chunk<'a> = (&'a [u8], &'a [u8], &'a [u8]);

/// Kind and content of the first chunk, and what follows it.
fn chunk<'a>(bytes: &'a [u8], name: &'static str) -> Result<Chunk<'a>, (&'static str, String)> {
    let short = || (name, "it is cut short".to_owned());
    let length = u32_at(bytes, 0).ok_or_else(short)? as usize;
    let kind = bytes.get(4..8).ok_or_else(short)?;
    let content = &bytes[8..];
    if length > content.len() {
        let reason = format!("it claims {length} bytes, only {} are left", content.len());
        return Err((name, reason));
    }
    let (content, rest) = content.split_at(length);
    Ok((kind, content, rest))
}

fn u32_at(bytes: &[u8], offset: usize) -> Option<u32> {
    let word = bytes.get(offset..)?.first_chunk::<4>()?;
    Some(u32::from_le_bytes(*word))
}

fn version_of(json: &Value) -> &str {
    json["asset"]["version"].as_str().unwrap_or("missing")
}

fn check_version(version: &str) -> Result<(), (&'static str, String)> {
    if version.starts_with("2.") {
        return Ok(());
    }
    Err(("asset.version", format!("it is {version:?}, not 2.0")))
}

fn check_extensions<'a>(path: &Path, required: impl Iterator<Item = &'a str>) -> Result<(), SceneError> {
    for (index, name) in required.enumerate() {
        if !SUPPORTED.contains(&name) {
            return Err(SceneError::Extension {
                path: path.to_owned(),
                element: format!("extensionsRequired[{index}]"),
                name: name.to_owned(),
                hint: extension_hint(name),
            });
        }
    }
    Ok(())
}

fn extension_hint(name: &str) -> &'static str {
    if name.contains("draco") || name.contains("meshopt") {
        "Export the file without mesh compression, or decompress it with a tool such as glTF-Transform"
    } else {
        "Export the file without it"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cut_glb_files_are_refused_at_every_length() {
        let mut glb = b"glTF\x02\0\0\0\x20\0\0\0\x02\0\0\0JSON{}\x02\0\0\0BIN\0\x01\x02".to_vec();
        glb[8] = glb.len() as u8;
        let (json, binary) = split(&glb).unwrap();
        assert_eq!((json, binary), (&b"{}"[..], Some(&[1_u8, 2][..])));
        for length in 4..glb.len() {
            assert!(split(&glb[..length]).is_err(), "{length} bytes");
        }
    }

    #[test]
    fn a_glb_length_below_the_header_is_refused() {
        assert!(split(b"glTF\x02\0\0\0\x05\0\0\0").is_err());
    }
}
