//! Writes the documentation while its examples are tested: `cargo doc` would check all dependencies again,
//! which the tests have already compiled. For this, the program acts as rustdoc.

use std::ffi::{OsStr, OsString};
use std::process::{Command, ExitCode};

use anyhow::Result;

use crate::process;

/// The environment variable that makes this program act as rustdoc.
const AS_RUSTDOC: &str = "SHADOWFIT_AS_RUSTDOC";

/// Makes a cargo command for doc tests also write the documentation, with warnings as errors.
///
/// # Errors
/// If the path of this program is unknown.
pub(crate) fn write_documentation(tests: &mut Command) -> Result<()> {
    tests.env("RUSTDOC", std::env::current_exe()?).env(AS_RUSTDOC, "1");
    Ok(())
}

/// Acts as rustdoc if cargo started this program in its place. When cargo tests the examples in the
/// documentation, it first writes the documentation, with warnings as errors.
pub(crate) fn as_rustdoc() -> Option<ExitCode> {
    std::env::var_os(AS_RUSTDOC)?;
    let arguments: Vec<OsString> = std::env::args_os().skip(1).collect();
    let runs = documenting(&arguments).into_iter().chain([arguments]);
    for arguments in runs {
        match Command::new("rustdoc").args(arguments).status() {
            Ok(status) if status.success() => {}
            Ok(status) => {
                return Some(ExitCode::from(status.code().and_then(|code| code.try_into().ok()).unwrap_or(1)));
            }
            Err(error) => {
                eprintln!("error: rustdoc does not start: {error}");
                return Some(ExitCode::FAILURE);
            }
        }
    }
    Some(ExitCode::SUCCESS)
}

/// Returns the arguments for writing the documentation, made from those for testing it, or `None` for other
/// arguments.
fn documenting(arguments: &[OsString]) -> Option<Vec<OsString>> {
    let is_test = |argument: &&OsString| argument.as_os_str() == OsStr::new("--test");
    arguments.iter().find(is_test)?;
    let folder = process::target_folder().join("doc").into_os_string();
    let more = ["--out-dir".into(), folder, "-D".into(), "warnings".into()];
    Some(arguments.iter().filter(|argument| !is_test(argument)).cloned().chain(more).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_documentation_is_written_from_the_arguments_of_its_tests() {
        let arguments = |text: &str| text.split(' ').map(OsString::from).collect::<Vec<_>>();
        let all = documenting(&arguments("--test src/lib.rs -L deps")).unwrap();
        assert_eq!(all[..4], arguments("src/lib.rs -L deps --out-dir"));
        assert_eq!(all[5..], arguments("-D warnings"));
        assert_eq!(documenting(&arguments("-vV")), None);
    }
}
