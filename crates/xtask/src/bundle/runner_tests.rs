//! Tests of the bundle's runner, on fake programs that print the output of the test harness.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::{TESTS, write_runner};

/// A bundle of fake programs in its own folder, which is removed at the end.
struct FakeBundle(PathBuf);

impl FakeBundle {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("shadowfit-bundle-{name}-{}", std::process::id()));
        for programs in ["deps", "examples"] {
            fs::create_dir_all(folder.join("workspace/target/debug").join(programs)).unwrap();
        }
        write_runner(&folder.join("run.sh")).unwrap();
        let bundle = Self(folder);
        bundle.write("examples/adapters", "echo \"Fake GPU ($2)\"");
        bundle
    }

    /// Writes a shell script as a program.
    fn write(&self, program: &str, text: &str) {
        use std::os::unix::fs::PermissionsExt;
        let file = self.0.join("workspace/target/debug").join(program);
        fs::write(&file, format!("#!/bin/sh\n{text}\n")).unwrap();
        fs::set_permissions(file, fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// Writes a test program with these outputs and exit codes: `most` for most tests, the other for
    /// `a::own_process_x`.
    fn write_test(&self, program: &str, most: &str, own_process: Option<&str>) {
        let list = own_process.map_or("", |_| "echo 'a::own_process_x: test'");
        let own_process = own_process.unwrap_or_default();
        let most = format!("echo \"in ${{PWD##*/}}: $*\"; {most}");
        let text = format!("case \"$*\" in *--list*) {list};; *--exact*) {own_process};; *) {most};; esac");
        self.write(&format!("deps/{program}"), &text);
    }

    /// Runs the runner in a shell on test programs. Returns its exit code, and its output with its errors.
    fn run(&self, shell: &str, programs: &[&str], arguments: &[&str]) -> (Option<i32>, String) {
        let line = |name: &&str| format!("target/debug/deps/{name}\t.\tx/{name}\n");
        fs::write(self.0.join(TESTS), programs.iter().map(line).collect::<String>()).unwrap();
        // A relative path and a CDPATH that both lead to the same folder.
        let (here, folder) = (std::env::temp_dir(), Path::new(self.0.file_name().unwrap()));
        let mut command = Command::new(shell);
        command.arg(folder.join("run.sh")).args(arguments).current_dir(&here).env("CDPATH", &here);
        let output = command.output().unwrap();
        let text = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
        (output.status.code(), text)
    }
}

impl Drop for FakeBundle {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Shells that the runner supports. `sh` is dash on Debian.
const SHELLS: [&str; 2] = ["sh", "bash"];

/// Outputs and exit codes of test programs: harnesses with good, bad and refused tests, and crashes.
const GOOD: &str = "echo 'test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out'";
const BAD: &str = "echo 'test a::bad ... FAILED'; echo '---- a::bad stdout ----'; echo 'assertion failed'
    echo 'test result: FAILED. 1 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out'; exit 101";
const REFUSED: &str = "echo 'test a::lacks ... FAILED'; echo '---- a::lacks stdout ----'; echo 'LACKING: compute'
    echo 'test result: FAILED. 1 passed; 1 failed; 0 ignored; 0 measured; 0 filtered out'; exit 101";
const REFUSED_AND_BAD: &str = "echo '---- a::lacks stdout ----'; echo 'LACKING: one'; echo 'LACKING: two'
    echo '---- a::bad stdout ----'; echo 'assertion failed'
    echo 'test result: FAILED. 1 passed; 2 failed; 0 ignored; 0 measured; 0 filtered out'; exit 101";
const CRASH: &str = "kill -SEGV $$";
const LATE_CRASH: &str = "echo 'test result: ok. 3 passed; 0 failed; 0 ignored'; exit 3";

#[test]
fn the_runner_counts_results_and_only_refusals_are_no_failures() {
    let bundle = FakeBundle::new("results");
    let cases = [
        (GOOD, None, 0, "3 passed, 0 failed, 0 refused"),
        (BAD, None, 1, "1 passed, 1 failed, 0 refused"),
        (REFUSED, None, 0, "1 passed, 0 failed, 1 refused"),
        (REFUSED_AND_BAD, None, 1, "1 passed, 1 failed, 1 refused"),
        (CRASH, None, 1, "0 passed, 1 failed, 0 refused"),
        (LATE_CRASH, None, 1, "3 passed, 1 failed, 0 refused"),
        ("exit 0", None, 1, "0 passed, 1 failed, 0 refused"),
        (GOOD, Some(GOOD), 0, "6 passed, 0 failed, 0 refused"),
        (GOOD, Some(BAD), 1, "4 passed, 1 failed, 0 refused"),
        (CRASH, Some(REFUSED), 1, "1 passed, 1 failed, 1 refused"),
        (REFUSED, Some(CRASH), 1, "1 passed, 1 failed, 1 refused"),
        (REFUSED, Some(REFUSED), 0, "2 passed, 0 failed, 2 refused"),
    ];
    for (shell, (most, own_process, code, sums)) in SHELLS.iter().flat_map(|shell| cases.map(|case| (shell, case))) {
        bundle.write_test("one", most, own_process);
        let (found, text) = bundle.run(shell, &["one"], &[]);
        assert_eq!(found, Some(code), "{shell}, {most}, {own_process:?}: {text}");
        assert!(text.contains(sums), "{shell}, {most}, {own_process:?}: {text}");
    }
}

#[test]
fn the_runner_adds_up_its_programs_and_names_failed_tests_and_programs_that_ended_early() {
    let bundle = FakeBundle::new("sums");
    for (name, most) in [("good", GOOD), ("bad", BAD), ("refused", REFUSED), ("crash", CRASH)] {
        bundle.write_test(name, most, None);
    }
    bundle.write_test("hung", "sleep 100", None);
    for shell in SHELLS {
        let programs = ["good", "bad", "refused", "crash", "hung"];
        let (code, text) = bundle.run(shell, &programs, &["--limit", "1"]);
        assert_eq!(code, Some(1), "{text}");
        assert!(text.contains("5 passed, 3 failed, 1 refused on Fake GPU"), "{text}");
        for line in ["failed:\na::bad\n", "x/crash: exit code 139\n", "x/hung: no end after 1 seconds\n"] {
            assert!(text.contains(line), "{line:?} is missing in: {text}");
        }
    }
}

#[test]
fn the_runner_takes_options_and_filters_in_any_order_and_refuses_what_it_does_not_know() {
    let bundle = FakeBundle::new("options");
    bundle.write_test("good", GOOD, None);
    bundle.write_test("none", "echo 'test result: ok. 0 passed; 0 failed; 0 ignored'", None);
    for shell in SHELLS {
        for arguments in [&["one", "--adapter", "bar", "two"][..], &["--adapter=bar", "one", "--limit=9", "two"]] {
            let (code, text) = bundle.run(shell, &["good"], arguments);
            assert!(code == Some(0) && text.contains("adapter: Fake GPU (bar)"), "{arguments:?}: {text}");
            let log = fs::read_to_string(bundle.0.join("logs/x-good.log")).unwrap();
            assert!(log.contains("in workspace: one two --skip golden"), "{log}");
        }
        let refused: [(&[&str], &str); 5] = [
            (&["nonsense"], "no test was run"),
            (&["one", "--adapter"], "--adapter needs a value"),
            (&["--limit", "soon"], "--limit needs a number"),
            (&["--limit="], "--limit needs a number"),
            (&["one", "--such"], "unknown option --such"),
        ];
        for (arguments, message) in refused {
            let (code, text) = bundle.run(shell, &["none"], arguments);
            assert!(code == Some(2) && text.contains(message), "{arguments:?}: {text}");
        }
        let (code, text) = bundle.run(shell, &[], &[]);
        assert!(code == Some(2) && text.contains("is missing or empty"), "{text}");
        let (code, text) = bundle.run(shell, &[], &["--help"]);
        assert!(code == Some(0) && text.contains("--limit SECONDS") && text.contains("2 after bad input."), "{text}");
    }
}
