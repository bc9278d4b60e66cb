//! The code that an engine writes for its shadows: the number of lines in the example `engine_integration`,
//! and the code blocks of the guide, which are copies from the examples.
//!
//! The lines of a step follow a comment with its number (`// STEP 3: ...`). The lines of a part of exact
//! edges follow a comment with its name (`// EXACT triangles: ...`). Both end at the next empty line, or
//! where a brace closes that was opened before them. Comments do not count.

use std::path::Path;

use crate::support::workspace;

/// Greatest number of lines of all steps together.
const MOST_LINES: usize = 35;

/// Greatest number of lines of exact edges, in addition to the steps.
const MOST_EXACT_LINES: usize = 40;

/// Files of the example.
const FILES: [&str; 4] = [
    "engine_integration.rs",
    "engine_integration/exact.rs",
    "engine_integration/gpu.rs",
    "engine_integration/scene.rs",
];

/// Words that occur only in code for shadows.
const WORDS: [&str; 7] = ["shadow", "caster", "self.sun", "sun.", "sun:", "receiver", "rays."];

fn read(path: impl AsRef<Path>) -> String {
    let path = workspace().join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Returns whether a line contains only a comment.
fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with("//")
}

fn indentation(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// Returns the name after the marker of a comment: the number of a step, or the name of a part of exact
/// edges.
fn beginning(line: &str) -> Option<&str> {
    let rest = line.split_once("// STEP ").or_else(|| line.split_once("// EXACT "))?.1;
    rest.split_once(':').map(|(name, _)| name)
}

/// Returns the code lines of the steps and parts, with their names, and all other code lines.
fn marked(text: &str) -> (Vec<(&str, &str)>, Vec<&str>) {
    let (mut inside, mut outside) = (Vec::new(), Vec::new());
    let mut current: Option<(&str, usize)> = None;
    for line in text.lines() {
        if let Some(name) = beginning(line) {
            current = Some((name, indentation(line)));
        }
        let ends = |(_, start): &(&str, usize)| line.trim().is_empty() || indentation(line) < *start;
        current = current.filter(|current| !ends(current));
        match current {
            _ if is_comment(line) || line.trim().is_empty() => {}
            Some((name, _)) => inside.push((name, line)),
            None => outside.push(line),
        }
    }
    (inside, outside)
}

fn example(file: &str) -> String {
    read(Path::new("examples").join(file))
}

#[test]
fn an_engine_writes_at_most_35_lines_for_its_shadows_and_40_for_exact_edges() {
    let texts = FILES.map(example);
    let names: Vec<&str> = texts.iter().flat_map(|text| marked(text).0).map(|(name, _)| name).collect();
    let mut steps: Vec<u32> = names.iter().filter_map(|name| name.parse().ok()).collect();
    let [lines, exact_lines] = [steps.len(), names.len() - steps.len()];
    println!("{lines} lines, and {exact_lines} for exact edges");
    assert!(lines <= MOST_LINES, "{lines} lines: {steps:?}");
    assert!((1..=MOST_EXACT_LINES).contains(&exact_lines), "{exact_lines} lines for exact edges");
    steps.sort_unstable();
    steps.dedup();
    assert_eq!(steps, (1..=10).collect::<Vec<u32>>(), "the steps of the example");
}

#[test]
fn no_line_outside_of_the_steps_has_to_do_with_shadows() {
    for file in FILES {
        let text = example(file);
        for line in marked(&text).1 {
            // Code that chooses the adapter contains the word only in its crate's name.
            let lower = line.to_lowercase().replace("shadowfit_adapter", "");
            assert!(!WORDS.iter().any(|word| lower.contains(word)), "{file}: {line}");
        }
    }
}

/// Returns the fenced blocks of a document, with their languages and trimmed lines.
fn blocks(text: &str) -> Vec<(String, Vec<String>)> {
    let mut blocks: Vec<(String, Vec<String>)> = Vec::new();
    let mut is_open = false;
    for line in text.lines() {
        match (line.trim_start().strip_prefix("```"), is_open) {
            (Some(language), false) => {
                blocks.push((language.to_owned(), Vec::new()));
                is_open = true;
            }
            (Some(_), true) => is_open = false,
            (None, true) => blocks.last_mut().expect("an open block").1.push(line.trim().to_owned()),
            (None, false) => {}
        }
    }
    blocks
}

/// Returns whether a text contains these consecutive lines.
fn stands_in(lines: &[String], text: &[String]) -> bool {
    !lines.is_empty() && text.windows(lines.len()).any(|window| window == lines)
}

fn trimmed(text: &str) -> Vec<String> {
    text.lines().map(|line| line.trim().to_owned()).collect()
}

#[test]
fn every_block_of_code_in_the_integration_guide_stands_in_an_example() {
    let examples = [
        "cached_walk",
        "engine_integration",
        "engine_integration/exact",
        "fit_once",
        "gpu_casters/engine",
        "still_maps",
    ];
    let examples = examples.map(|name| trimmed(&read(format!("examples/{name}.rs"))));
    let blocks = blocks(&read("docs/INTEGRATION.md"));
    assert!(blocks.len() >= 10, "the guide has {} blocks", blocks.len());
    for (language, lines) in blocks {
        assert!(["rust", "wgsl"].contains(&language.as_str()), "a block of {language:?}");
        let found = examples.iter().any(|example| stands_in(&lines, example));
        assert!(found, "no example has these lines:\n{}", lines.join("\n"));
    }
}

#[test]
fn what_engines_take_chooses_no_graphics_api_for_them() {
    let manifest = |path: &str| read(path).parse::<toml::Table>().unwrap_or_else(|error| panic!("{path}: {error}"));
    let features = |wgpu: &toml::Value| -> Vec<String> {
        let listed = wgpu.get("features").and_then(toml::Value::as_array);
        listed.into_iter().flatten().filter_map(toml::Value::as_str).map(str::to_owned).collect()
    };
    let shared = &manifest("Cargo.toml")["workspace"]["dependencies"]["wgpu"];
    assert_eq!(shared.get("default-features"), Some(&toml::Value::Boolean(false)), "wgpu's defaults are its APIs");
    assert_eq!(features(shared), ["std", "wgsl"]);
    let own = &manifest("crates/shadowfit-wgpu/Cargo.toml")["dependencies"]["wgpu"];
    assert!(features(own).is_empty(), "{own}");
}
