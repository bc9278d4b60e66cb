//! Tests of docs that show code or output of this repository.

use std::fs;

use crate::process;

#[test]
fn the_crate_docs_begin_with_the_example_fit_once() {
    let read = |path: &str| fs::read_to_string(process::root().join(path)).unwrap();
    let (example, docs) = (read("examples/fit_once.rs"), read("crates/shadowfit/src/lib.rs"));
    let code = example.split_once("\n\n").unwrap().1;
    let shown: Vec<&str> = docs
        .lines()
        .skip_while(|line| *line != "//! ```")
        .skip(1)
        .take_while(|line| *line != "//! ```")
        .map(|line| line.strip_prefix("//!").unwrap().strip_prefix(' ').unwrap_or_default())
        .collect();
    assert_eq!(shown.join("\n"), code.trim_end(), "examples/fit_once.rs and the docs of shadowfit show different code");
}
