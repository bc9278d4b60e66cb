//! `cargo xtask generate`: writes the parts of files that repeat other files, so that both stay equal.
//!
//! These are the first examples of READMEs and crate docs and, with the feature `tools`, the pictures of
//! docs/MATHS.md and the shaders of engines that do not use wgpu.

use std::fs;

use anyhow::{Context, Result, ensure};

use crate::process;
#[cfg(feature = "tools")]
use crate::{capi, maths, shaders};

/// Lines around the first example of a Markdown page, and of a crate's docs.
const PAGE: [&str; 2] = ["```rust\n", "```"];
const DOCS: [&str; 2] = ["//! ```\n", "//! ```"];
/// Lines around the first example of docs that is only compiled.
const COMPILED_DOCS: [&str; 2] = ["//! ```no_run\n", "//! ```"];

/// Writes the files that are out of date.
///
/// # Errors
/// If a file cannot be read or written, or lacks the place for its generated part.
pub(crate) fn generate() -> Result<()> {
    for (name, text) in stale()? {
        fs::write(process::root().join(&name), text).with_context(|| format!("cannot write {name}"))?;
        println!("{name} is written");
    }
    Ok(())
}

/// Compares the files with their generated form.
///
/// # Errors
/// If a file is out of date.
pub(crate) fn check() -> Result<()> {
    let names: Vec<String> = stale()?.into_iter().map(|(name, _)| name).collect();
    ensure!(names.is_empty(), "out of date: {}; run `cargo xtask generate` and look at the diff", names.join(", "));
    Ok(())
}

/// Returns the files that differ from their generated form, with the new text.
fn stale() -> Result<Vec<(String, String)>> {
    let example = read("examples/fit_once.rs")?;
    let example = &example[example.find("\nuse ").context("examples/fit_once.rs uses nothing")? + 1..];
    let wgpu_docs = read("crates/shadowfit-wgpu/src/lib.rs")?;
    let [_, wgpu_example, _] =
        around(&wgpu_docs, COMPILED_DOCS).context("the docs of shadowfit-wgpu have no example")?;
    let parts = [
        ("README.md", PAGE, example.to_owned()),
        ("crates/shadowfit/README.md", PAGE, example.to_owned()),
        ("crates/shadowfit/src/lib.rs", DOCS, as_docs(example)),
        ("crates/shadowfit-wgpu/README.md", PAGE, shown(wgpu_example)),
    ];
    let mut files = Vec::new();
    for (name, marks, part) in parts {
        let page = read(name)?;
        let [before, _, after] = around(&page, marks).with_context(|| format!("{name} lacks {marks:?}"))?;
        files.push((name.to_owned(), [before, &part, after].concat()));
    }
    #[cfg(feature = "tools")]
    {
        files.extend(maths::pictures()?);
        files.extend(shaders::files()?);
        files.extend(capi::generated()?);
    }
    files.retain(|(name, text)| read(name).ok().as_ref() != Some(text));
    Ok(files)
}

fn read(name: &str) -> Result<String> {
    fs::read_to_string(process::root().join(name)).with_context(|| format!("cannot read {name}"))
}

/// Splits a text after the first `begin` and before the next `end`.
fn around<'a>(text: &'a str, [begin, end]: [&str; 2]) -> Option<[&'a str; 3]> {
    let start = text.find(begin)? + begin.len();
    let end = start + text[start..].find(end)?;
    Some([&text[..start], &text[start..end], &text[end..]])
}

/// Returns code as lines of a crate's docs.
fn as_docs(code: &str) -> String {
    code.lines().map(|line| format!("//! {line}").trim_end().to_owned() + "\n").collect()
}

/// Returns the code of an example in a crate's docs, without its hidden lines.
fn shown(docs: &str) -> String {
    let lines = docs.lines().map(|line| line.strip_prefix("//!").unwrap_or(line));
    let lines = lines.map(|line| line.strip_prefix(' ').unwrap_or(line));
    lines.filter(|line| *line != "#" && !line.starts_with("# ")).flat_map(|line| [line, "\n"]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_committed_files_are_what_is_generated() {
        check().unwrap();
    }

    #[test]
    fn docs_lose_their_hidden_lines() {
        let docs = as_docs("# use a;\n#\nf(b);\n\n    #[cfg(c)]\n");
        assert_eq!(docs, "//! # use a;\n//! #\n//! f(b);\n//!\n//!     #[cfg(c)]\n");
        assert_eq!(shown(&docs), "f(b);\n\n    #[cfg(c)]\n");
    }
}
