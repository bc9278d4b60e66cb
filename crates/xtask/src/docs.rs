//! Tests that the docs and their pictures belong together.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use clap::Parser;

use crate::{Cli, process};

#[path = "../../shadowfit-testing/src/commands.rs"]
#[allow(dead_code, unreachable_pub, reason = "the file of a library that other crates use")]
mod commands;

/// Returns the names of the files in folders, each with its folder, relative to the workspace's folder.
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
    let mut pages = files(&["docs", "docs/samples", "docs/figures"], ".md");
    pages.extend(["README.md", "crates/shadowfit-wasm/npm/README.md"].map(str::to_owned));
    let text: String = pages.iter().map(|page| fs::read_to_string(process::root().join(page)).unwrap()).collect();
    // The text between the folder's name and the bracket that closes the link.
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

/// Returns the anchor of a heading, as hosts of Markdown make it.
fn anchor(heading: &str) -> String {
    let kept = heading.trim().to_lowercase().replace(' ', "-");
    kept.chars().filter(|letter| letter.is_alphanumeric() || matches!(letter, '-' | '_')).collect()
}

/// Returns the anchors of a page's headings.
fn anchors(text: &str) -> BTreeSet<String> {
    let outside_of_code = text.split("```").step_by(2).flat_map(str::lines);
    outside_of_code.filter(|line| line.starts_with('#')).map(|line| anchor(line.trim_start_matches('#'))).collect()
}

#[test]
fn no_link_between_pages_is_dead() {
    let root = process::root();
    for page in commands::pages(&root) {
        let text = fs::read_to_string(&page).unwrap();
        let outside_of_code = text.split("```").step_by(2).collect::<String>();
        let links = outside_of_code.split("](").skip(1).filter_map(|rest| rest.split([')', ' ']).next());
        for link in links.filter(|link| !link.contains("://")) {
            let (file, place) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { page.clone() } else { page.parent().unwrap().join(file) };
            assert!(target.exists(), "{}: {link}", page.display());
            if !place.is_empty() && target.is_file() {
                let there = anchors(&fs::read_to_string(&target).unwrap());
                assert!(there.contains(place), "{}: {link}: only {there:?}", page.display());
            }
        }
    }
}

#[test]
fn every_command_of_the_docs_is_one_of_ours_with_options_that_it_has() {
    let root = process::root();
    let found = commands::doc_commands(&root);
    assert!(found.len() > 40, "{}", found.len());
    for command in &found {
        let at = format!("{}: cargo {}", command.page, command.words.join(" "));
        let first = command.words.first().map(String::as_str);
        if first == Some("xtask") && command.words.len() > 1 {
            let parsed = Cli::try_parse_from(&command.words);
            let is_help = |error: &clap::Error| error.kind() == clap::error::ErrorKind::DisplayHelp;
            assert!(parsed.is_ok() || parsed.as_ref().is_err_and(is_help), "{at}");
        } else if matches!(first, Some("run" | "test" | "bench")) {
            // The plugin for Bevy is a workspace of its own, with its own page.
            let is_of_bevy = Path::new(&command.page).starts_with("crates/bevy-shadowfit");
            let examples = if is_of_bevy { "crates/bevy-shadowfit/examples" } else { "examples" };
            for (option, folders) in [("-p", ["crates", "tests"]), ("--example", [examples; 2])] {
                let named = command.words.iter().position(|word| word == option).map(|at| &command.words[at + 1]);
                let exists = |name: &String| {
                    let short = name.trim_start_matches("shadowfit-");
                    let forms = [name.clone(), format!("{name}.rs"), short.to_owned()];
                    let own = format!("crates/{}/examples/{name}.rs", package(command));
                    folders.iter().any(|folder| forms.iter().any(|form| root.join(folder).join(form).exists()))
                        || root.join(own).exists()
                };
                assert!(named.is_none_or(exists), "{at}");
            }
        }
    }
}

/// Returns the package that a command names.
fn package(command: &commands::DocCommand) -> &str {
    let at = command.words.iter().position(|word| word == "-p");
    at.and_then(|at| command.words.get(at + 1)).map_or("", String::as_str)
}
