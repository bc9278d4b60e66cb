//! From file to parsed JSON: GLB chunks, JSON, version and required extensions.
//!
//! The gltf crate's own GLB reader and validation are not used: both can panic on bad input.

use std::borrow::Cow;
use std::path::Path;

use gltf::json::{Root, Value, deserialize, serialize};

use super::{extensions, material, repair, transforms};
use crate::{SceneError, Transform};

/// Byte order mark that some editors write before UTF-8 text.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// A parsed file.
pub(crate) struct Source {
    /// The JSON part.
    pub(crate) root: Root,
    /// The binary chunk of a GLB.
    pub(crate) binary: Option<Vec<u8>>,
    /// Transforms of the nodes, in the precision of the file.
    pub(crate) transforms: Vec<Transform>,
    /// Sentences about extensions that the file uses and import ignores.
    pub(crate) notes: Vec<String>,
}

/// Parses the content of the file `path`. Calls `tell_json` with the length of the JSON, in bytes, before
/// parsing it.
pub(crate) fn parse(path: &Path, bytes: &[u8], tell_json: impl FnOnce(u64)) -> Result<Source, SceneError> {
    let malformed = |(element, reason)| malformed(path, element, reason);
    let (json, binary) = split(bytes).map_err(malformed)?;
    tell_json(json.len() as u64);
    let (json, root) = readable(path, json)?;
    check_version(&root.asset.version).map_err(malformed)?;
    extensions::check(path, root.extensions_required.iter().map(String::as_str), has_plain_textures(&root))?;
    let transforms = transforms::read(&json).map_err(|error| malformed(("JSON", error.to_string())))?;
    let notes = root.extensions_used.iter().filter_map(|name| extensions::note(name)).collect();
    Ok(Source { root, binary: binary.map(<[u8]>::to_vec), transforms, notes })
}

/// Returns the JSON in a form that the gltf crate reads, and its parsed content. If the crate cannot read it,
/// first refuses other versions of glTF and required extensions, whose layout may be the reason.
fn readable<'a>(path: &Path, json: &'a [u8]) -> Result<(Cow<'a, [u8]>, Root), SceneError> {
    // The crate ignores animation pointers, which are extensions beside `node`.
    let has_pointers = |root: &Root| root.extensions_used.iter().any(|name| name == "KHR_animation_pointer");
    let unread = match deserialize::from_slice(json) {
        Ok(root) if !has_pointers(&root) => return Ok((Cow::Borrowed(json), root)),
        Ok(_) => None,
        Err(error) => Some(error),
    };
    let malformed = |(element, reason)| malformed(path, element, reason);
    let mut loose: Value = deserialize::from_slice(json).map_err(|error| malformed(("JSON", error.to_string())))?;
    check_version(version_of(&loose)).map_err(malformed)?;
    let required = loose["extensionsRequired"].as_array().into_iter().flatten();
    extensions::check(path, required.filter_map(Value::as_str), true)?;
    repair::complete(&mut loose);
    let repaired = serialize::to_vec(&loose).and_then(|json| Ok((deserialize::from_slice(&json)?, json)));
    // Only the first error has the line and column in the original file.
    let (root, json) = repaired.map_err(|error| malformed(("JSON", unread.unwrap_or(error).to_string())))?;
    Ok((Cow::Owned(json), root))
}

/// Returns whether each texture that import reads has an image that needs no extension.
fn has_plain_textures(root: &Root) -> bool {
    let textures = root.materials.iter().flat_map(material::textures);
    // The material's loader refuses a missing texture.
    textures
        .filter_map(|index| root.textures.get(index.value()))
        .all(|texture| material::has_plain_image(root, texture))
}

fn malformed(path: &Path, element: &str, reason: String) -> SceneError {
    SceneError::Malformed {
        path: path.to_owned(),
        element: element.to_owned(),
        reason,
        hint: "Export it again as glTF 2.0, or fetch the file again if it was cut short",
    }
}

type Split<'a> = (&'a [u8], Option<&'a [u8]>);

/// Separates the JSON from the binary chunk. A byte order mark before the JSON is skipped.
fn split(bytes: &[u8]) -> Result<Split<'_>, (&'static str, String)> {
    let (json, binary) = chunks(bytes)?;
    Ok((json.strip_prefix(BYTE_ORDER_MARK).unwrap_or(json), binary))
}

fn chunks(bytes: &[u8]) -> Result<Split<'_>, (&'static str, String)> {
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
    // The specification requires readers to ignore chunks of other kinds.
    Ok((json, (kind == b"BIN\0").then_some(binary)))
}

type Chunk<'a> = (&'a [u8], &'a [u8], &'a [u8]);

/// Returns the kind and content of the first chunk, and the bytes after it.
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
