//! Compares the recipes of `docs/ARCHITECTURE.md` with the code: a recipe must list exactly the files whose
//! code names its example.
//!
//! A recipe is a row of the table: the kind of addition, the names of the example, and the files, each in
//! backticks. `crate/a.rs` means `crates/crate/src/a.rs`, and a folder with a trailing slash means its
//! content. Comments and tests do not count. A file that has the example's name counts as naming it.

use std::collections::BTreeSet;
use std::path::Path;

use crate::support::{files_below, workspace};

/// Kinds of additions with a recipe.
const KINDS: [&str; 6] = ["a fit", "a filter", "a parameter", "a view", "a scene", "a sample"];

/// Start of a file's tests, which are at its end.
const TESTS: &str = "#[cfg(test)]\nmod tests {";

/// A row of the table.
struct Recipe {
    kind: String,
    /// Names of the example in code.
    names: Vec<String>,
    files: BTreeSet<String>,
}

fn recipes(page: &str) -> Vec<Recipe> {
    let (_, section) = page.split_once("\n## Recipes\n").expect("a section of recipes");
    let in_backticks = |cell: &str| cell.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>();
    let row = |line: &str| {
        let [_, kind, names, files, _] = line.split('|').collect::<Vec<_>>().try_into().expect("three cells");
        Recipe {
            kind: kind.trim().to_owned(),
            names: in_backticks(names),
            files: in_backticks(files).into_iter().collect(),
        }
    };
    section.lines().filter(|line| line.starts_with("| a ")).map(row).collect()
}

/// Returns the name of a file in the form of recipes, or `None` for files that additions never touch.
fn short_name(file: &Path) -> Option<String> {
    let parts: Vec<_> =
        file.strip_prefix(workspace().join("crates")).ok()?.iter().map(|p| p.to_string_lossy()).collect();
    let is_test = |part: &str| part == "tests" || part.ends_with("tests.rs");
    let is_code = file.extension().is_some_and(|ending| ending == "rs" || ending == "wgsl");
    let [name, source, rest @ ..] = &parts[..] else { return None };
    (is_code && source == "src" && name != "xtask" && !rest.iter().any(|part| is_test(part)))
        .then(|| format!("{name}/{}", rest.join("/")))
}

/// Returns whether a name occurs in code as whole words, before the tests and outside comments.
fn is_named(name: &str, code: &str) -> bool {
    let is_part_of_word = |c: char| c.is_alphanumeric() || c == '_';
    let code = code.split(TESTS).next().unwrap_or_default();
    code.lines().map(|line| line.split("//").next().unwrap_or_default()).any(|line| {
        line.match_indices(name).any(|(at, _)| {
            !line[..at].ends_with(is_part_of_word) && !line[at + name.len()..].starts_with(is_part_of_word)
        })
    })
}

/// Returns whether a file or one of its folders has the last word of a name as its name.
fn is_called(name: &str, path: &str) -> bool {
    path.split(['/', '.']).any(|part| name.split(' ').next_back() == Some(part))
}

#[test]
fn recipes_list_the_files_that_name_their_examples_and_no_others() {
    let code: Vec<(String, String)> = files_below(&workspace().join("crates"))
        .into_iter()
        .filter_map(|file| Some((short_name(&file)?, std::fs::read_to_string(&file).expect("text"))))
        .collect();
    let recipes = recipes(include_str!("../docs/ARCHITECTURE.md"));
    assert_eq!(recipes.iter().map(|recipe| recipe.kind.as_str()).collect::<Vec<_>>(), KINDS);
    for Recipe { kind, names, files } in recipes {
        let is_example =
            |(path, text): &&(String, String)| names.iter().any(|name| is_called(name, path) || is_named(name, text));
        let listed_as = |path: &String| files.iter().find(|file| file.ends_with('/') && path.starts_with(*file));
        let naming: BTreeSet<String> =
            code.iter().filter(is_example).map(|(path, _)| listed_as(path).unwrap_or(path).clone()).collect();
        assert_eq!(files, naming, "docs/ARCHITECTURE.md, {kind} like {names:?}: listed, and found in the code");
    }
}

#[test]
fn only_code_and_names_of_files_name_an_example() {
    assert!(is_named("Pcf", "match kind { Pcf => 1 }") && is_named("mod pcf", "pub mod pcf;"));
    for other in ["// Pcf", "Pcf7 Pcf_3", "fn f() {}\n#[cfg(test)]\nmod tests { Pcf }"] {
        assert!(!is_named("Pcf", other), "{other}");
    }
    assert!(is_called("mod oriented", "shadowfit/fits/oriented.rs") && !is_called("Oriented", "shadowfit/fits/mod.rs"));
}
