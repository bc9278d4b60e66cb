//! Documentation that is written where the examples in it are tested: `cargo doc` would check all dependencies, which the
//! tests have compiled already. This program takes the place of rustdoc for that.

use std::ffi::{OsStr, OsString};
use std::process::{Command, ExitCode};

use anyhow::Result;

use crate::process;

/// The environment variable that makes this program rustdoc.
const AS_RUSTDOC: &str = "SHADOWFIT_AS_RUSTDOC";

/// Lets a cargo command that tests documentation write it, too, with warnings as errors.
///
/// # Errors
/// When the path of this program is unknown.
pub(crate) fn write_documentation(tests: &mut Command) -> Result<()> {
    tests.env("RUSTDOC", std::env::current_exe()?).env(AS_RUSTDOC, "1");
    Ok(())
}

/// Acts as rustdoc if this program was started in its place: where cargo tests the examples in the documentation, writes
/// the documentation first, and takes its warnings for errors.
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

/// Returns the arguments that write the documentation, given the arguments that test it. Returns `None` for all others.
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
