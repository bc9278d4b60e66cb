//! The tables of docs/VIEWER.md, which list keys and actions as the viewer has them.

use shadowfit_egui::{KEYS, KeyGroup, KeyHelp, KeyLayout, key_table};
use shadowfit_testing::package_folder;

use crate::play::script::ACTIONS;

/// Text in a cell of a table in Markdown.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

fn assert_docs_hold(table: &str) {
    let page = package_folder(env!("CARGO_MANIFEST_DIR")).join("../../docs/VIEWER.md");
    let text = std::fs::read_to_string(page).expect("docs/VIEWER.md can be read");
    assert!(text.contains(table), "put this table into docs/VIEWER.md in place of the old one:\n\n{table}");
}

#[test]
fn the_docs_list_every_key() {
    let lines = KEYS.iter().map(|group| {
        let keys: Vec<String> =
            group.keys.iter().map(|line| format!("**{}** {}", line.keys, cell(&line.does))).collect();
        format!("| {} | {} |\n", group.heading, keys.join(" · "))
    });
    assert_docs_hold(&format!("| | keys |\n|---|---|\n{}", lines.collect::<String>()));
}

#[test]
fn the_docs_list_the_keys_that_are_others_in_browsers() {
    let lines = |groups: Vec<KeyGroup>| groups.into_iter().flat_map(|group| group.keys).collect::<Vec<KeyHelp>>();
    let window = lines(key_table(KeyLayout::Window));
    let mut browser = lines(key_table(KeyLayout::Browser));
    browser.retain(|line| !window.contains(line));
    let keys: Vec<String> = browser.iter().map(|line| format!("**{}** {}", line.keys, line.does)).collect();
    assert_docs_hold(&format!("nothing quits: {}.", keys.join(" · ")));
}

#[test]
fn the_docs_list_every_action() {
    let lines = ACTIONS.iter().map(|action| {
        let line = format!("{} {}", action.name, action.takes);
        format!("| `{}` | {} |\n", cell(line.trim_end()), cell(action.does))
    });
    assert_docs_hold(&format!("| action | what it does |\n|---|---|\n{}", lines.collect::<String>()));
}
