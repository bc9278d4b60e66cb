//! Fuzz target for fit files.

#[cfg(test)]
#[path = "../../../../tests/fuzz/src/corpus.rs"]
mod corpus;

use glam::DVec3;

use super::FitFile;
use super::error::parse_json;

/// Reads a fit file. A file that is accepted must be measurable, and it must read back equal after writing.
///
/// # Panics
///
/// If a file is accepted and one of these fails.
pub fn fit_file(data: &[u8]) {
    let Some(fit) = read(data) else { return };
    let written = serde_json::to_vec(&fit).expect("JSON");
    assert_eq!(read(&written).as_ref(), Some(&fit), "{}", String::from_utf8_lossy(&written));
    for map in fit.frames.iter().flat_map(|frame| &frame.maps) {
        let _ = map.measured(DVec3::new(-0.3, 0.8, -0.2).normalize());
    }
}

fn read(data: &[u8]) -> Option<FitFile> {
    let fit: FitFile = parse_json(data).ok()?;
    fit.check().ok()?;
    Some(fit)
}

#[test]
fn what_fuzzing_took_for_files_of_fits_is_refused_or_read_back_the_same() {
    corpus::replay("fit_file", fit_file);
}
