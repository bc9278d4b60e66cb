//! Paths of the files and the program of the package under test.

use std::path::{Path, PathBuf};

/// Returns the folder of the package under test, which Cargo or the runner of a bundle sets at run time. A
/// test that is started by hand uses `built`, the folder of its build. Pass `env!("CARGO_MANIFEST_DIR")`.
pub fn package_folder(built: &str) -> PathBuf {
    std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| built.into(), PathBuf::from)
}

/// Returns the program of the package under test: in a bundle, the one next to the test's folder, otherwise
/// the one that Cargo built. Pass `env!("CARGO_BIN_EXE_name")`.
pub fn package_program(built: &str) -> PathBuf {
    let built = Path::new(built);
    let test = std::env::current_exe().unwrap_or_default();
    // The test is in target/<profile>/deps.
    let beside = test.ancestors().nth(2).zip(built.file_name()).map(|(profile, name)| profile.join(name));
    beside.filter(|program| program.is_file()).unwrap_or_else(|| built.to_owned())
}
