//! One technique is recommended, and everything that a newcomer reads first uses it.

use shadowfit::presets::RECOMMENDED;
use shadowfit::settings::{
    BiasSettings, FilterKind, FitSettings, HoldSettings, MapFormat, ReceiverSource, SplitScheme, Stabilise,
};
use shadowfit::tool::Settings;
use shadowfit::{PRESETS, Technique};

const EXAMPLE: &str = include_str!("../../../../examples/fit_once.rs");
const README: &str = include_str!("../../README.md");
const DOCS: &str = include_str!("../../src/lib.rs");

#[test]
fn the_default_technique_is_the_recommended_preset() {
    assert_eq!(Technique::preset(RECOMMENDED), Some(Technique::default()));
    assert_eq!(PRESETS.iter().filter(|preset| preset.technique() == Technique::default()).count(), 1);
    assert_eq!(Settings::default().technique, Technique::default());
}

#[test]
fn the_defaults_of_its_parts_are_those_of_the_technique() {
    let technique = Technique::default();
    assert_eq!(technique.fit, FitSettings::default());
    assert_eq!(technique.hold, HoldSettings::default());
    assert_eq!(technique.bias, BiasSettings::default());
    assert_eq!(technique.bias, BiasSettings::automatic(technique.filter));
    assert_eq!((technique.splits, technique.stabilise), (SplitScheme::default(), Stabilise::default()));
    assert_eq!((technique.filter, technique.format), (FilterKind::default(), MapFormat::default()));
    assert_eq!(technique.receivers, ReceiverSource::default());
}

/// The first code block of a page.
fn first_example<'a>(page: impl Iterator<Item = &'a str>) -> String {
    let code = page.skip_while(|line| !line.starts_with("```")).skip(1).take_while(|line| !line.starts_with("```"));
    code.collect::<Vec<_>>().join("\n")
}

#[test]
fn readme_docs_and_example_begin_with_the_same_code_and_the_default_technique() {
    let example = &EXAMPLE[EXAMPLE.find("use shadowfit").expect("the example uses shadowfit")..];
    assert!(example.contains("Technique::default()"));
    assert_eq!(first_example(README.lines()), example.trim_end());
    let docs =
        DOCS.lines().map(|line| line.trim_start_matches("//!")).map(|line| line.strip_prefix(' ').unwrap_or(line));
    assert_eq!(first_example(docs), example.trim_end());
}
