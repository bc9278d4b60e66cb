//! Targets for fuzzing the viewer's files. Only fuzzing and test builds contain them.

#[cfg(test)]
#[path = "../../../tests/fuzz/src/corpus.rs"]
mod corpus;

use crate::keep::link::Link;
use crate::keep::saved::Saved;
use crate::play::script;

/// Parses saved state: the text is either rejected, or written so that it reads back the same.
///
/// # Panics
///
/// If the state does not read back the same.
pub fn saved_toml(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let Ok(saved) = Saved::from_toml(text) else { return };
    let written = saved.to_toml().expect("parsed state can be written");
    let read = Saved::from_toml(&written).unwrap_or_else(|error| panic!("{error:#}: {written}"));
    assert_eq!(read, saved, "{written}");
}

/// Parses a script, and each of its lines as a link.
///
/// # Panics
///
/// If a link cannot be read back from its own text.
pub fn script(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let _ = script::lines("fuzzed", text);
    for line in text.lines() {
        let _ = script::parse(line);
        let Ok(mut link) = Link::parse(line) else { continue };
        let read = Link::parse(&link.to_fragment()).unwrap_or_else(|error| panic!("{error:#}: {link:?}"));
        link.notes.clear();
        assert_eq!(read, link);
    }
}

#[test]
fn what_fuzzing_took_for_saved_files_is_refused_or_read_back_the_same() {
    corpus::replay("settings_toml", saved_toml);
}

#[test]
fn what_fuzzing_took_for_scripts_and_links_is_refused_or_read_back_the_same() {
    corpus::replay("script", script);
}
