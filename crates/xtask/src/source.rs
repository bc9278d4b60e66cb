//! Source files as text: reads them and removes comments and tests.

use std::collections::BTreeMap;
use std::fs;

use anyhow::{Context, Result};

use crate::process;

/// Reads the Rust and WGSL files below a folder. Keys are paths relative to the workspace's folder.
pub(crate) fn texts(folder: &str) -> Result<BTreeMap<String, String>> {
    let mut texts = BTreeMap::new();
    for entry in fs::read_dir(process::root().join(folder)).with_context(|| format!("cannot read {folder}"))? {
        let entry = entry?;
        let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
        let path = entry.path();
        if path.is_dir() && !path.ends_with("target") {
            texts.extend(self::texts(&name)?);
        } else if path.extension().is_some_and(|ending| ending == "rs" || ending == "wgsl") {
            let text = fs::read_to_string(&path).with_context(|| format!("cannot read {name}"))?;
            texts.insert(name, text);
        }
    }
    Ok(texts)
}

pub(crate) fn is_part_of_word(character: char) -> bool {
    character.is_alphanumeric() || character == '_'
}

/// Returns the text without comments. Replaces strings and characters by the word `S`, and keeps line ends.
pub(crate) fn without_comments(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(next) = rest.chars().next() {
        let (length, word) = match (comment_length(rest), literal_length(rest)) {
            (Some(length), _) => (length, ""),
            (None, Some(length)) => (length, "S"),
            (None, None) => (next.len_utf8(), &rest[..next.len_utf8()]),
        };
        code.push_str(word);
        if !word.starts_with('\n') {
            code.extend(rest[..length].matches('\n'));
        }
        rest = &rest[length..];
    }
    code
}

/// Returns the length of the comment at the start of a text.
fn comment_length(text: &str) -> Option<usize> {
    if text.starts_with("//") {
        return Some(text.find('\n').unwrap_or(text.len()));
    }
    let mut depth = 0;
    text.starts_with("/*").then_some(())?;
    for (at, pair) in text.as_bytes().windows(2).enumerate() {
        depth += i32::from(pair == b"/*") - i32::from(pair == b"*/");
        if depth == 0 && pair == b"*/" {
            return Some(at + 2);
        }
    }
    Some(text.len())
}

/// Returns the length of the string or character at the start of a text.
fn literal_length(text: &str) -> Option<usize> {
    let after =
        |pattern: &str, from: usize| text[from..].find(pattern).map_or(text.len(), |at| from + at + pattern.len());
    let raw = text.trim_start_matches('b').strip_prefix('r').unwrap_or_default();
    let hashes = raw.len() - raw.trim_start_matches('#').len();
    if raw[hashes..].starts_with('"') {
        return Some(after(&format!("\"{}", &raw[..hashes]), text.len() - raw.len() + hashes + 1));
    }
    if text.starts_with('"') {
        let mut is_escaped = false;
        let end = text.char_indices().skip(1).find(|(_, character)| {
            let is_end = *character == '"' && !is_escaped;
            is_escaped = *character == '\\' && !is_escaped;
            is_end
        });
        return Some(end.map_or(text.len(), |(at, _)| at + 1));
    }
    // A quote without its pair begins a lifetime.
    let character = text.strip_prefix('\'')?.chars().next()?;
    let end = 1 + character.len_utf8();
    match character {
        '\\' => Some(after("'", end + 1)),
        _ => text[end..].starts_with('\'').then_some(end + 1),
    }
}

/// Removes test-only items from text without comments. Keeps line ends.
pub(crate) fn without_tests(code: &str) -> String {
    let mut product = String::with_capacity(code.len());
    let mut at = 0;
    for (start, end) in test_items(code) {
        if start >= at {
            product.push_str(&code[at..start]);
            product.extend(code[start..end].matches('\n'));
            at = end;
        }
    }
    product + &code[at..]
}

/// Returns start and end of the test-only items, including attributes.
pub(crate) fn test_items(code: &str) -> Vec<(usize, usize)> {
    let is_test = |at: usize| code[at..].starts_with("#[cfg(test)]") || code[at..].starts_with("#[cfg(all(test");
    code.match_indices("#[cfg(").filter(|(at, _)| is_test(*at)).map(|(at, _)| (at, item_end(code, at))).collect()
}

/// Returns the end of the item that begins at `start`: behind its semicolon or its closing brace.
pub(crate) fn item_end(code: &str, start: usize) -> usize {
    let mut depth = 0;
    for (at, byte) in code.bytes().enumerate().skip(start) {
        depth += i32::from(byte == b'{') - i32::from(byte == b'}');
        if depth == 0 && matches!(byte, b';' | b'}') {
            return at + 1 + usize::from(code[at..].starts_with("};"));
        }
    }
    code.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_go_and_strings_become_words() {
        let cases = [
            ("a // b\nc", "a \nc"),
            ("a /* b /* c\n */ d */ e", "a \n e"),
            (r#"f("// \" {", 'a', '\'', b'{')"#, "f(S, S, S, bS)"),
            ("r#\"a\" // \n\"# + br\"\\\" x", "S\n + S x"),
            ("fn f<'a>(x: &'a str, y: 'é')", "fn f<'a>(x: &'a str, y: S)"),
        ];
        for (text, expected) in cases {
            assert_eq!(without_comments(text), expected, "{text}");
        }
    }

    #[test]
    fn items_for_tests_go_with_their_bodies() {
        let code = "a;\n#[cfg(test)]\nmod tests {\n    fn f() { g(); }\n}\nb;\n#[cfg(all(test, unix))]\nuse x;\nc;";
        assert_eq!(without_tests(code), "a;\n\n\n\n\nb;\n\n\nc;");
    }
}
