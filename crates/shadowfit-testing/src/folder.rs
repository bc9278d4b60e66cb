//! Where tests find the files and the program of their package.

use std::path::{Path, PathBuf};

/// Returns the folder of the package under test: the one that Cargo, or the runner of a bundle of tests, names at run time.
/// A test that is started by hand reads `built`, the folder that it was built from: pass `env!("CARGO_MANIFEST_DIR")`.
pub fn package_folder(built: &str) -> PathBuf {
    std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| built.into(), PathBuf::from)
}

/// Returns the program of the package under test: beside the folder of the test, where a bundle of tests has it, or else
/// where Cargo built it. Pass `env!("CARGO_BIN_EXE_name")`.
pub fn package_program(built: &str) -> PathBuf {
    let built = Path::new(built);
    let test = std::env::current_exe().unwrap_or_default();
    // The test lies in target/<profile>/deps.
    let beside = test.ancestors().nth(2).zip(built.file_name()).map(|(profile, name)| profile.join(name));
    beside.filter(|program| program.is_file()).unwrap_or_else(|| built.to_owned())
}
