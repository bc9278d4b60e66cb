//! Tests that the views, keys, options, parameters and the script in docs/VIEWER.md exist in the viewer.

use clap::{CommandFactory as _, Parser as _};
use shadowfit_egui::{KeyLayout, key_table};
use shadowfit_params::PARAMETERS;
use shadowfit_testing::commands::doc_commands;
use shadowfit_testing::package_folder;

use crate::Arguments;
use crate::play::script;

/// Name of the page, for messages.
const PAGE: &str = "docs/VIEWER.md";

fn page() -> String {
    let path = package_folder(env!("CARGO_MANIFEST_DIR")).join("../..").join(PAGE);
    std::fs::read_to_string(path).expect("docs/VIEWER.md can be read")
}

/// Returns the page's code blocks, and its code in the text.
fn code(page: &str) -> (Vec<&str>, Vec<&str>) {
    let parts: Vec<&str> = page.split("```").collect();
    let blocks = parts.iter().skip(1).step_by(2).copied().collect();
    let spans = parts.iter().step_by(2).flat_map(|text| text.split('`').skip(1).step_by(2)).collect();
    (blocks, spans)
}

#[test]
fn the_docs_describe_every_view_under_its_key() {
    let page = page().to_lowercase();
    let views = key_table(KeyLayout::Window).into_iter().find(|group| group.heading == "Views").expect("a group");
    for view in views.keys {
        assert!(page.contains(&format!("**{} {}**", view.keys, view.does)), "{PAGE} lacks the view {view:?}");
    }
}

/// Returns whether a line of code has options of the viewer.
fn is_of_viewer(line: &str) -> bool {
    line.starts_with("--") || line.contains("cargo xtask run")
}

#[test]
fn options_and_parameters_in_the_docs_exist() {
    let page = page();
    let (blocks, spans) = code(&page);
    let lines: Vec<&str> = blocks.iter().flat_map(|block| block.lines()).chain(spans).collect();
    let mut command = Arguments::command();
    command.build();
    let options: Vec<&str> = command.get_arguments().filter_map(clap::Arg::get_long).collect();
    for word in lines.iter().filter(|line| is_of_viewer(line)).flat_map(|line| line.split_whitespace()) {
        let Some(name) = word.strip_prefix("--").filter(|name| !name.is_empty()) else { continue };
        assert!(options.contains(&name), "{PAGE} has the option --{name}, which the viewer lacks");
    }
    let ids: Vec<(&str, &str)> = PARAMETERS.iter().filter_map(|parameter| parameter.id.split_once('.')).collect();
    for word in lines.iter().flat_map(|line| line.split_whitespace()) {
        let Some(id) = word.split('=').next().and_then(|word| word.split_once('.')) else { continue };
        let is_parameter = ids.iter().any(|(group, _)| *group == id.0);
        assert!(!is_parameter || ids.contains(&id), "{PAGE} has the parameter {word}, which does not exist");
    }
}

#[test]
fn the_script_in_the_docs_can_be_played() {
    let page = page();
    let (blocks, _) = code(&page);
    let text = blocks.iter().find(|block| block.contains("await loaded")).expect("a script");
    let lines = script::lines(PAGE, text).expect("each line is an action");
    assert!(!lines.is_empty(), "{PAGE} has an empty script");
}

#[test]
fn every_command_of_the_docs_that_starts_the_viewer_is_understood() {
    let root = package_folder(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut count = 0;
    for command in doc_commands(&root) {
        let Some(["xtask", "run"]) = command.words.first_chunk::<2>().map(|words| words.each_ref().map(String::as_str))
        else {
            continue;
        };
        let words = std::iter::once("viewer").chain(command.words[2..].iter().map(String::as_str));
        let parsed = Arguments::try_parse_from(words);
        let is_help = |error: &clap::Error| error.kind() == clap::error::ErrorKind::DisplayHelp;
        assert!(parsed.is_ok() || parsed.is_err_and(|error| is_help(&error)), "{}: {:?}", command.page, command.words);
        count += 1;
    }
    assert!(count >= 10, "{count}");
}
