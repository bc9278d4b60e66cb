//! Where tests find the files of their package.

use std::path::PathBuf;

/// Returns the folder of the package under test: the one that Cargo, or the runner of a bundle of tests, names at run time.
/// A test that is started by hand reads `built`, the folder that it was built from: pass `env!("CARGO_MANIFEST_DIR")`.
pub fn package_folder(built: &str) -> PathBuf {
    std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| built.into(), PathBuf::from)
}
