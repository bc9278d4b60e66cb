//! The size table: lines of code per crate, without tests, comments and blank lines, and the number of long
//! functions.
//!
//! The check never fails. It only prints the numbers, so that the log shows how much code a change adds.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;

use anyhow::Result;

use crate::machine::Machine;
use crate::source::{is_part_of_word, item_end, test_items, texts, without_comments, without_tests};

/// Folders with code.
const FOLDERS: [&str; 3] = ["crates", "examples", "tests"];

/// Greatest number of lines of a function that fits on a screen.
const SCREEN: usize = 40;

/// Lines of the files of a crate or folder.
#[derive(Default)]
struct Lines {
    files: usize,
    code: usize,
    tests: usize,
    comments: usize,
}

/// Prints the table of all folders.
pub(super) fn check(_: &Machine) -> Result<()> {
    let mut all = BTreeMap::new();
    for folder in FOLDERS {
        all.extend(texts(folder)?);
    }
    println!("{}", table(&all));
    Ok(())
}

/// Returns the table for files, given by their names relative to the workspace's folder.
fn table(texts: &BTreeMap<String, String>) -> String {
    let test_modules: BTreeSet<String> =
        texts.iter().flat_map(|(file, text)| test_modules(file, &without_comments(text))).collect();
    let (mut crates, mut all): (BTreeMap<String, Lines>, Lines) = Default::default();
    let mut lengths = Vec::new();
    for (file, text) in texts {
        let parts: Vec<&str> = file.split('/').collect();
        let module = Path::new(file).with_extension("");
        let is_test = parts.iter().any(|part| matches!(*part, "tests" | "benches"))
            || test_modules.iter().any(|tests| module.starts_with(tests));
        let code = without_comments(text);
        let product = if is_test { String::new() } else { without_tests(&code) };
        if Path::new(file).extension().is_some_and(|ending| ending == "rs") {
            lengths.extend(function_lengths(&product));
        }
        let crate_name = parts[..if parts[0] == "crates" { 2 } else { 1 }].join("/");
        for sum in [crates.entry(crate_name).or_default(), &mut all] {
            sum.files += 1;
            sum.code += filled_lines(&product);
            sum.tests += filled_lines(&code) - filled_lines(&product);
            sum.comments += text.lines().filter(|line| line.trim_start().starts_with("//")).count();
        }
    }
    let mut rows: Vec<(String, Lines)> = crates.into_iter().collect();
    rows.sort_by_key(|(_, lines)| std::cmp::Reverse(lines.code));
    rows.push(("all".to_owned(), all));
    let mut table = format!("{:34} {:>6} {:>7} {:>7} {:>9}\n", "crate", "files", "code", "tests", "comments");
    for (name, Lines { files, code, tests, comments }) in rows {
        let _ = writeln!(table, "{name:34} {files:6} {code:7} {tests:7} {comments:9}");
    }
    let long = lengths.iter().filter(|length| **length > SCREEN).count();
    table + &format!("{} functions, {long} over {SCREEN} lines", lengths.len())
}

fn filled_lines(code: &str) -> usize {
    code.lines().filter(|line| !line.trim().is_empty()).count()
}

/// Returns the test-only modules that a file declares, as file names without extension.
fn test_modules(file: &str, code: &str) -> Vec<String> {
    let (folder, name) = file.rsplit_once('/').unwrap_or(("", file));
    let stem = match name {
        "mod.rs" | "lib.rs" | "main.rs" => folder,
        _ => file.trim_end_matches(".rs"),
    };
    let names = test_items(code).into_iter().filter_map(|(start, end)| {
        let item = code[start..end].rsplit(']').next()?.trim();
        item.strip_suffix(';')?.rsplit_once("mod ").map(|(_, name)| name.trim())
    });
    names.flat_map(|name| [format!("{stem}/{name}"), format!("{folder}/{name}")]).collect()
}

/// Returns the lengths of a text's functions in lines of code.
fn function_lengths(code: &str) -> Vec<usize> {
    let starts = code.match_indices("fn ").filter(|(at, _)| !code[..*at].ends_with(is_part_of_word));
    let bodies = starts.map(|(at, _)| &code[at..item_end(code, at)]);
    bodies.filter(|body| body.ends_with('}')).map(filled_lines).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_and_tests_are_counted_apart() {
        let long = format!("fn long() {{\n{}}}\nfn short() {{}}\n", "    x();\n".repeat(SCREEN));
        let texts = BTreeMap::from([
            ("crates/a/src/lib.rs", "// Why.\nmod b;\n\n#[cfg(test)]\nmod tests;\n".to_owned()),
            ("crates/a/src/b.rs", long),
            ("crates/a/src/tests.rs", "fn f() {}\n".to_owned()),
            ("tests/main.rs", "fn g() {}\n".to_owned()),
        ]);
        let texts = texts.into_iter().map(|(file, text)| (file.to_owned(), text)).collect();
        let table = table(&texts);
        let numbers = |name: &str| -> Vec<usize> {
            let row = table.lines().find_map(|line| line.strip_prefix(name)).expect(name);
            row.split_whitespace().map(|number| number.parse().expect("a number")).collect()
        };
        assert_eq!(numbers("crates/a"), [3, 44, 3, 1]);
        assert_eq!(numbers("tests"), [1, 0, 1, 0]);
        assert_eq!(numbers("all"), [4, 44, 4, 1]);
        assert!(table.ends_with("2 functions, 1 over 40 lines"), "{table}");
    }
}
