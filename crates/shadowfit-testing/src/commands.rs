//! The commands that the docs name, for tests that check them.

use std::fs;
use std::path::{Path, PathBuf};

/// A command of the docs.
#[derive(Clone, Debug)]
pub struct DocCommand {
    /// Page that has it, relative to the workspace's folder.
    pub page: String,
    /// Words after `cargo`.
    pub words: Vec<String>,
}

impl DocCommand {
    /// Returns the words after `--`, if a word before them is `name`.
    pub fn program_arguments(&self, name: &str) -> Option<Vec<String>> {
        let split = self.words.iter().position(|word| word == "--")?;
        let is_named = self.words[..split].iter().any(|word| word == name);
        is_named.then(|| self.words[split + 1..].to_vec())
    }
}

/// Returns the commands that begin with `cargo` in all pages of the workspace in `root`, from code fences and inline
/// code. Variables before `cargo` and comments are left out.
pub fn doc_commands(root: &Path) -> Vec<DocCommand> {
    let mut commands = Vec::new();
    for page in pages(root) {
        let text = fs::read_to_string(&page).unwrap_or_default();
        let name = page.strip_prefix(root).unwrap_or(&page).display().to_string();
        let found = codes(&text).into_iter().filter_map(|code| words(&code));
        commands.extend(found.map(|words| DocCommand { page: name.clone(), words }));
    }
    commands
}

/// Returns the pages: README, docs and the READMEs of the crates.
pub fn pages(root: &Path) -> Vec<PathBuf> {
    let mut folders = vec![root.to_owned(), root.join("docs"), root.join("docs/samples"), root.join("docs/figures")];
    let crates = fs::read_dir(root.join("crates")).into_iter().flatten().flatten();
    folders.extend(crates.map(|entry| entry.path()));
    let files = folders.iter().flat_map(|folder| fs::read_dir(folder).into_iter().flatten().flatten());
    let mut pages: Vec<PathBuf> =
        files.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|end| end == "md")).collect();
    pages.sort();
    pages
}

/// Returns the lines of code fences, continued lines joined, and the inline code of a page.
fn codes(text: &str) -> Vec<String> {
    let mut codes = Vec::new();
    for (part, text) in text.split("```").enumerate() {
        if part % 2 == 1 {
            codes.extend(text.replace("\\\n", " ").lines().skip(1).map(str::to_owned));
        } else {
            codes.extend(text.split('`').skip(1).step_by(2).map(|code| code.replace('\n', " ")));
        }
    }
    codes
}

/// Returns the words after `cargo` of a command, without its comment.
fn words(code: &str) -> Option<Vec<String>> {
    let code = code.split(" #").next().unwrap_or_default();
    let mut words = code.split_whitespace().skip_while(|word| word.contains('='));
    (words.next() == Some("cargo")).then(|| words.map(str::to_owned).collect())
}
