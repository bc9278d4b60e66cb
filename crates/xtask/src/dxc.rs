//! Microsoft's shader compiler (DXC) for tests of HLSL. No package of Debian has it, but a Python wheel contains its
//! library.

use std::path::PathBuf;
use std::process::Command;

use anyhow::Result;

use crate::process;

/// The environment variable that gives tests the path of the library.
pub(crate) const LIBRARY: &str = "SHADOWFIT_DXC";

/// The wheel, for Linux on x86-64, with its hash.
const WHEEL: &str = "compushady-lrtu==0.18.0 \
                     --hash=sha256:a851dcfa7b3f8954e63eafa5c6328a23b6e81e7fb06e67e37935f5a7220cd782\n";
/// Python and platform of the wheel. Only its library is used, by any Python.
const PLATFORM: [&str; 4] = ["--python-version", "3.12", "--platform", "manylinux_2_28_x86_64"];

/// Path of the library in the wheel.
const PATH: &str = "compushady/backends/libdxcompiler_x86_64.so";

/// Returns the library if an earlier call has fetched it.
pub(crate) fn fetched() -> Option<PathBuf> {
    Some(folder().join(PATH)).filter(|library| library.is_file())
}

/// Returns the library. Fetches it with pip the first time.
///
/// # Errors
/// If pip fails.
pub(crate) fn fetch() -> Result<Option<PathBuf>> {
    let is_supported = cfg!(all(target_os = "linux", target_arch = "x86_64"));
    if fetched().is_some() || !is_supported {
        return Ok(fetched());
    }
    let folder = folder();
    std::fs::create_dir_all(&folder)?;
    let requirements = folder.join("requirements.txt");
    std::fs::write(&requirements, WHEEL)?;
    let mut pip = Command::new("python3");
    pip.args(["-m", "pip", "download", "--quiet", "--no-deps", "--only-binary", ":all:"]).args(PLATFORM);
    process::run(pip.arg("--require-hashes").arg("--dest").arg(&folder).arg("--requirement").arg(&requirements))?;
    for entry in std::fs::read_dir(&folder)? {
        let wheel = entry?.path();
        if wheel.extension().is_some_and(|extension| extension == "whl") {
            process::run(Command::new("python3").args(["-m", "zipfile", "-e"]).arg(&wheel).arg(&folder))?;
            std::fs::remove_file(&wheel)?;
        }
    }
    Ok(fetched())
}

fn folder() -> PathBuf {
    process::target_folder().join("dxc")
}
