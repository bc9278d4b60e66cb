//! The prose check: counts phrases that make English hard to read, in Markdown and in comments.
//!
//! Most of them put a pronoun in the place of a noun, as in "what is seen" for "the visible points". A hit is a place to
//! read aloud. The check fails if the count grows.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};

use crate::machine::Machine;
use crate::process;
use crate::source::texts;

/// The phrases. Commas separate alternatives of the last word.
const PHRASES: [&str; 12] = [
    "what is,are,was,has,have,had,they,it,a,an,the,follows,comes,stands,there,no,needs,makes,only,moves,does,shows,serves,goes",
    "that of",
    "those of,that,with,in,which",
    "of which,what,whose",
    "by which,what,whose",
    "from which,what,whose",
    "with which,what,whose",
    "is no,told,said",
    "are no,told,said",
    "as many,much,far,long",
    "so many,much",
    "of its,their",
];
/// Words that are hits alone.
const WORDS: [&str; 4] = ["whatever", "whichever", "anew", "stands"];
/// Word that must follow "of its" and "of their".
const OWN: &str = "own";
/// Folders without pages of the project.
const OUTPUTS: [&str; 3] = ["target", "out", "node_modules"];
/// Greatest number of hits. Lower it when the text gets better; never raise it.
const MOST: usize = 170;

/// Counts all hits.
pub(super) fn check(_: &Machine) -> Result<()> {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for folder in ["crates", "examples", "tests"] {
        for (file, text) in texts(folder)? {
            counts.insert(file, hits(&comments(&text)));
        }
    }
    for page in pages(&process::root())? {
        let text = fs::read_to_string(&page).with_context(|| page.display().to_string())?;
        counts.insert(page.display().to_string(), hits(&paragraphs(&text)));
    }
    let all: usize = counts.values().sum();
    let mut most: Vec<(&String, &usize)> = counts.iter().collect();
    most.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
    let most: Vec<String> = most.iter().take(10).map(|(file, count)| format!("{file} {count}")).collect();
    println!("{all} hard phrases, at most {MOST}; most in {}", most.join(", "));
    ensure!(
        all <= MOST,
        "{all} hard phrases are more than {MOST}: put nouns where \"what is\", \"that of\", \"by which\" ..."
    );
    Ok(())
}

/// Returns the Markdown pages below a folder, build outputs aside.
fn pages(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut pages = Vec::new();
    for entry in fs::read_dir(folder).with_context(|| folder.display().to_string())? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.is_dir() && !name.starts_with('.') && !OUTPUTS.contains(&name.as_ref()) {
            pages.extend(self::pages(&path)?);
        } else if path.extension().is_some_and(|ending| ending == "md") {
            pages.push(path);
        }
    }
    Ok(pages)
}

/// Returns the text of the whole-line comments.
fn comments(code: &str) -> String {
    let lines = code.lines().map(str::trim_start).filter(|line| line.starts_with("//"));
    paragraphs(&lines.map(|line| line.trim_start_matches(['/', '!']).trim()).collect::<Vec<_>>().join("\n"))
}

/// Returns the text outside of code fences.
fn paragraphs(text: &str) -> String {
    text.split("```").step_by(2).collect::<Vec<_>>().join("\n")
}

fn hits(text: &str) -> usize {
    let lower = text.to_lowercase();
    let words: Vec<&str> =
        lower.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let is_hit = |(index, word): (usize, &&str)| {
        let following = words.get(index + 1).copied().unwrap_or_default();
        let pair = PHRASES.iter().any(|phrase| {
            let (first, last) = phrase.split_once(' ').unwrap_or((phrase, ""));
            first == *word && last.split(',').any(|last| last == following)
        });
        let is_own = !matches!(following, "its" | "their") || words.get(index + 2) == Some(&OWN);
        WORDS.contains(word) || (pair && is_own)
    };
    words.iter().enumerate().filter(|pair| is_hit(*pair)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phrases_count_across_lines_and_outside_of_code() {
        assert_eq!(hits("It returns what\nis seen, and those\nof the scene."), 2);
        assert_eq!(hits(&comments("let a = 1;\n/// The size of its own map stands.\n// plain\n")), 2);
        assert_eq!(hits(&paragraphs("Plain text.\n```\nwhat is\n```\nThe middle of its box.")), 0);
    }
}
