//! Tests of docs that show code or output of this repository.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::gallery::sample_pictures;
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

#[test]
fn the_docs_show_every_picture_of_theirs_and_none_that_is_missing() {
    let names = |folder: &str, ending: &str| -> BTreeSet<String> {
        let entries = fs::read_dir(process::root().join(folder)).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names.filter(|name| name.ends_with(ending)).collect()
    };
    let mut pages: Vec<String> = names("docs", ".md").iter().map(|name| format!("docs/{name}")).collect();
    pages.push("README.md".to_owned());
    let text: String = pages.iter().map(|page| fs::read_to_string(process::root().join(page)).unwrap()).collect();
    // What stands between the folder's name and the bracket that closes the link.
    let links = text.split("images/").skip(1).filter_map(|rest| rest.split_once(')'));
    let files = links
        .map(|(name, _)| name.to_owned())
        .filter(|name| Path::new(name).extension().is_some_and(|end| end == "png") && !name.contains('/'));
    assert_eq!(files.collect::<BTreeSet<_>>(), names("docs/images", ".png"), "shown, and there");
    let pages: Vec<String> = names("docs/samples", ".md")
        .iter()
        .map(|page| fs::read_to_string(process::root().join("docs/samples").join(page)).unwrap())
        .chain([text])
        .collect();
    let shown: BTreeSet<String> = pages.iter().flat_map(|page| sample_pictures(page)).map(str::to_owned).collect();
    assert_eq!(shown, names("docs/images/samples", ".png"), "of the samples, shown and there");
}
