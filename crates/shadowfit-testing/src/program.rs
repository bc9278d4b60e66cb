//! Tests that apply to all programs.

use std::process::Command;

use shadowfit_adapter::ADAPTER_VARIABLE;

use crate::test_gpu;

/// Exit code after refused input.
const REFUSED: i32 = 2;

/// Asserts that a program refuses a graphics adapter that the machine lacks, named by an option or by the
/// environment. It must end with exit code 2 and a list of the available adapters, before any other output.
///
/// # Panics
///
/// If the program behaves otherwise.
pub fn refuses_missing_adapter(program: impl Fn() -> Command) {
    let present = test_gpu().adapter.get_info().name;
    let (mut by_option, mut by_variable) = (program(), program());
    by_option.args(["--adapter", "no such adapter"]);
    by_variable.env(ADAPTER_VARIABLE, "no such adapter");
    for mut command in [by_option, by_variable] {
        let output = command.output().expect("the program starts");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(REFUSED), "{message}");
        assert!(message.contains("\"no such adapter\"") && message.contains(&present), "{message}");
        assert!(output.stdout.is_empty(), "it begins: {}", String::from_utf8_lossy(&output.stdout));
    }
}
