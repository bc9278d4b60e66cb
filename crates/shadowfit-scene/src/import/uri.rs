//! Bytes behind a URI: data URIs, and files inside the folder of the glTF file. Without a file system, the
//! files that were passed with the glTF file. No other file is ever opened.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;

/// Size of the largest file that is read, in bytes: the limit of a GLB, also used for buffers.
pub(crate) const MAX_FILE_BYTES: u64 = u32::MAX as u64;

/// Padding is optional: exporters disagree about it.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// Location of the files that a glTF file refers to.
#[derive(Clone, Copy)]
pub(crate) enum Folder<'a> {
    /// A folder of the file system. Web pages have none.
    #[cfg_attr(target_family = "wasm", expect(dead_code, reason = "only files in memory are loaded there"))]
    Disk(&'a Path),
    /// Contents of files by their paths.
    Memory(&'a BTreeMap<String, Vec<u8>>),
}

/// Reads the bytes behind `uri` from `folder`. The error is a readable reason.
pub(crate) fn read_uri(folder: Folder<'_>, uri: &str, max_bytes: u64) -> Result<Vec<u8>, String> {
    if let Some(data) = data_of(uri) {
        return decode_data(data);
    }
    if has_scheme(uri) {
        return Err(format!("the URI {} is neither a data URI nor a relative path", quoted(uri)));
    }
    let unreadable = |reason: String| format!("{} cannot be read: {reason}", quoted(uri));
    match folder {
        Folder::Disk(folder) => read_file(&locate(folder, uri)?, max_bytes).map_err(unreadable),
        Folder::Memory(files) => {
            let bytes =
                find(files, uri).ok_or_else(|| unreadable("it was not chosen together with the scene".to_owned()))?;
            check_length(bytes.len() as u64, max_bytes).map_err(unreadable)?;
            Ok(bytes.clone())
        }
    }
}

/// Reads a regular file of at most `max_bytes`. The error is a readable reason.
pub(crate) fn read_file(path: &Path, max_bytes: u64) -> Result<Vec<u8>, String> {
    let metadata = std::fs::metadata(path).map_err(|error| error.to_string())?;
    if !metadata.is_file() {
        return Err("it is not a regular file".to_owned());
    }
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len().min(max_bytes) + 1).unwrap_or(0));
    let file = File::open(path).map_err(|error| error.to_string())?;
    file.take(max_bytes + 1).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    check_length(bytes.len() as u64, max_bytes)?;
    Ok(bytes)
}

fn check_length(bytes: u64, max_bytes: u64) -> Result<(), String> {
    if bytes > max_bytes {
        return Err(format!("it is larger than the limit of {max_bytes} bytes"));
    }
    Ok(())
}

/// Returns the content of the file with the path of a relative URI, or else with its name alone.
fn find<'a>(files: &'a BTreeMap<String, Vec<u8>>, uri: &str) -> Option<&'a Vec<u8>> {
    let decoded = percent_decode_str(uri).decode_utf8().ok()?;
    let decoded = decoded.replace('\\', "/");
    let path = decoded.strip_prefix("./").unwrap_or(&decoded);
    let name = path.rsplit('/').next()?;
    files.get(path).or_else(|| files.get(uri)).or_else(|| files.get(name))
}

/// Returns the bytes of a file, or 0 if unknown.
pub(crate) fn file_size(path: &Path) -> u64 {
    std::fs::metadata(path).map_or(0, |metadata| metadata.len())
}

/// Returns the approximate number of bytes behind `uri`, or 0 if unknown.
pub(crate) fn uri_size(folder: Folder<'_>, uri: &str) -> u64 {
    match (data_of(uri), folder) {
        (Some(data), _) => data.len() as u64 / 4 * 3,
        (None, Folder::Disk(folder)) => locate(folder, uri).map_or(0, |path| file_size(&path)),
        (None, Folder::Memory(files)) => find(files, uri).map_or(0, |bytes| bytes.len() as u64),
    }
}

/// Returns the part of a data URI after its scheme, which is not case-sensitive.
fn data_of(uri: &str) -> Option<&str> {
    let (scheme, data) = uri.split_at_checked("data:".len())?;
    scheme.eq_ignore_ascii_case("data:").then_some(data)
}

fn decode_data(data: &str) -> Result<Vec<u8>, String> {
    let (head, payload) = data.split_once(',').ok_or("the data URI has no comma before its data")?;
    if head.to_ascii_lowercase().ends_with(";base64") {
        // Padding and plus signs may be percent-encoded.
        let payload: Cow<'_, [u8]> = percent_decode_str(payload).into();
        BASE64.decode(payload).map_err(|error| format!("the data URI is not valid base64: {error}"))
    } else {
        Ok(percent_decode_str(payload).collect())
    }
}

/// Returns whether the URI starts with a scheme (RFC 3986), including Windows drive letters.
fn has_scheme(uri: &str) -> bool {
    let Some((scheme, _)) = uri.split_once(':') else { return false };
    let allowed = |c: char| c.is_ascii_alphanumeric() || "+-.".contains(c);
    scheme.starts_with(|c: char| c.is_ascii_alphabetic()) && scheme.chars().all(allowed)
}

/// Returns the file that a relative URI names. The URI is percent-decoded. If that file does not exist, also
/// tries the URI as written, then Windows separators.
fn locate(folder: &Path, uri: &str) -> Result<PathBuf, String> {
    let decoded = percent_decode_str(uri).decode_utf8();
    let decoded = decoded.map_err(|_| format!("the URI {} is not UTF-8", quoted(uri)))?;
    // Exporters on Windows write its separators.
    let others = [uri.to_owned(), decoded.replace('\\', "/")];
    let found = inside(folder, uri, &decoded);
    others
        .iter()
        .filter(|other| **other != decoded)
        .fold(found, |found, other| found.or_else(|error| inside(folder, uri, other).map_err(|_| error)))
}

/// Joins and resolves a path. Fails if the result is outside `folder`, links included.
fn inside(folder: &Path, uri: &str, relative: &str) -> Result<PathBuf, String> {
    let outside = || format!("the URI {} leads out of the file's folder", quoted(uri));
    let relative = Path::new(relative);
    if relative.components().any(|part| !matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err(outside());
    }
    let missing = |error: std::io::Error| format!("{} cannot be read: {error}", quoted(uri));
    let folder = folder.canonicalize().map_err(missing)?;
    let file = folder.join(relative).canonicalize().map_err(missing)?;
    if file.starts_with(&folder) { Ok(file) } else { Err(outside()) }
}

/// Returns the URI in quotes, shortened for messages.
fn quoted(uri: &str) -> String {
    const LONGEST: usize = 80;
    if uri.chars().count() <= LONGEST {
        return format!("{uri:?}");
    }
    let start: String = uri.chars().take(LONGEST).collect();
    format!("{:?}", format!("{start}…"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_uris_are_decoded_with_and_without_padding() {
        let folder = Folder::Disk(Path::new("."));
        assert_eq!(read_uri(folder, "data:;base64,AQI=", 9).unwrap(), [1, 2]);
        assert_eq!(read_uri(folder, "data:application/octet-stream;base64,AQI", 9).unwrap(), [1, 2]);
        assert_eq!(read_uri(folder, "data:text/plain,a%20b", 9).unwrap(), b"a b");
        assert_eq!(read_uri(folder, "DATA:image/x-odd;charset=utf-8;Base64,+/8%3D", 9).unwrap(), [251, 255]);
        assert!(read_uri(folder, "data:;base64,???", 9).unwrap_err().contains("base64"));
    }

    #[test]
    fn uris_that_leave_the_folder_or_have_a_scheme_are_refused() {
        let folder = Folder::Disk(Path::new("."));
        for uri in ["../a.bin", "a/../../b", "/etc/hostname", "%2e%2e/a", "..%2Fa"] {
            assert!(read_uri(folder, uri, 9).unwrap_err().contains("leads out"), "{uri}");
        }
        for uri in ["file:///etc/hostname", "http://example.com/a", "C:/a"] {
            assert!(read_uri(folder, uri, 9).unwrap_err().contains("neither"), "{uri}");
        }
    }

    #[test]
    fn files_in_memory_go_by_their_paths_and_else_by_their_names() {
        let files = [("a b.bin", vec![1]), ("textures/c.png", vec![2]), ("d.png", vec![3; 10])];
        let files = files.map(|(name, bytes)| (name.to_owned(), bytes)).into_iter().collect();
        let read = |uri| read_uri(Folder::Memory(&files), uri, 9);
        assert_eq!(read("a%20b.bin").unwrap(), [1]);
        assert_eq!(read("./textures/c.png").unwrap(), [2]);
        assert!(read("textures/d.png").unwrap_err().contains("limit of 9 bytes"));
        for uri in ["c.png", "../c.png", "/etc/hostname"] {
            assert!(read(uri).unwrap_err().contains("not chosen together"), "{uri}");
        }
    }
}
