//! A test of the pictures that the docs show.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::process;

/// Names of the files in folders, each behind its folder, relative to the workspace's folder.
fn files(folders: &[&str], ending: &str) -> BTreeSet<String> {
    let below = |folder: &&str| {
        let entries = fs::read_dir(process::root().join(folder)).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names.filter(|name| name.ends_with(ending)).map(|name| format!("{folder}/{name}")).collect::<Vec<_>>()
    };
    folders.iter().flat_map(below).collect()
}

#[test]
fn the_docs_show_every_picture_of_theirs_and_none_that_is_missing() {
    let mut pages = files(&["docs", "docs/samples"], ".md");
    pages.insert("README.md".to_owned());
    let text: String = pages.iter().map(|page| fs::read_to_string(process::root().join(page)).unwrap()).collect();
    // What stands between the folder's name and the bracket that closes the link.
    let links = text.split("images/").skip(1).filter_map(|rest| rest.split_once(')'));
    let endings = ["png", "svg", "webp"];
    let is_picture =
        |name: &str| Path::new(name).extension().is_some_and(|ending| endings.iter().any(|&e| e == ending));
    let shown: BTreeSet<String> =
        links.filter(|(name, _)| is_picture(name)).map(|(name, _)| format!("docs/images/{name}")).collect();
    let folders = ["docs/images", "docs/images/benchmarks", "docs/images/maths", "docs/images/samples"];
    let there: BTreeSet<String> = endings.iter().flat_map(|ending| files(&folders, &format!(".{ending}"))).collect();
    assert_eq!(shown, there, "shown, and there");
}
