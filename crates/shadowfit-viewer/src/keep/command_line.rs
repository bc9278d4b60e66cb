//! Settings as a command line, which starts the viewer with them again.

use std::fmt::Write as _;

use shadowfit_classics::SampleValues;
use shadowfit_params::tool::Settings;
use shadowfit_params::{self as params, PARAMETERS};

use crate::scene_source::SceneSource;
use crate::stage::SampleShow;

/// Returns the command line that opens a scene with one of its animations and these settings, ignoring saved
/// state. `own` are the scene's own settings; only differences from them are written.
pub(crate) fn command_line(
    source: &SceneSource,
    animation: usize,
    settings: &Settings,
    own: &Settings,
    sample: Option<&SampleShow>,
) -> String {
    let mut line = String::from("viewer");
    if matches!(source, SceneSource::Sample { .. }) {
        let _ = write!(line, " --sample {}", quoted(&source.text()));
    } else if *source != SceneSource::default() {
        let _ = write!(line, " {}", quoted(&source.text()));
    }
    line.push_str(" --no-state");
    if let Some(index) = source.index() {
        let _ = write!(line, " --scene-index {index}");
    }
    if animation > 0 {
        let _ = write!(line, " --animation {animation}");
    }
    for (id, value) in differences(settings, own) {
        // Writing to a String cannot fail.
        let _ = write!(line, " --set {}", quoted(&format!("{id}={value}")));
    }
    for (option, value) in sample.into_iter().flat_map(changed) {
        let _ = write!(line, " --set {}", quoted(&format!("sample.{option}={value}")));
    }
    line
}

/// Returns the parameters that differ between two settings, by id, with their values in `settings`. Set in
/// this order, they change `own` into `settings`. A value outside its range is written as the nearest valid
/// value.
pub(crate) fn differences(settings: &Settings, own: &Settings) -> Vec<(String, String)> {
    // In the table, a choice comes before the parameters that depend on it.
    let mut reached = *own;
    let mut differences = Vec::new();
    for parameter in PARAMETERS.iter().filter(|parameter| parameter.is_present(settings)) {
        if !parameter.is_equal(settings, &reached) {
            parameter.copy(&mut reached, settings);
            differences.push((parameter.id.to_owned(), params::format_value(&reached, parameter)));
        }
    }
    differences
}

/// Returns the options of a sample that differ from its own values, or from the values of its variant.
pub(crate) fn changed(show: &SampleShow) -> impl Iterator<Item = (&'static str, String)> {
    let SampleShow { sample, variant, values, .. } = show;
    let own = SampleValues::of_variant(sample, *variant).unwrap_or_else(|_| SampleValues::new(sample));
    let both: Vec<_> = own.iter().zip(values.iter()).collect();
    let changed = both.into_iter().filter(|((_, own), (_, value))| own != value);
    changed.map(|(_, (option, value))| (option.id, SampleValues::text(option, value)))
}

/// Quotes a word for a shell.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-/=,+:".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;
    use shadowfit::settings::SplitScheme;

    use super::*;
    use crate::arguments::Arguments;

    #[test]
    fn the_command_line_brings_the_settings_back() {
        let home = Settings::default();
        let mut settings = home;
        settings.technique = settings
            .technique
            .with_maps(shadowfit::Cascades::default().with_count(3).with_splits(SplitScheme::Practical(0.25)));
        settings.technique.bias.constant = 0.7;
        (settings.light.hour, settings.view.inset_depths) = (Some(8.5), Some([0.25, 0.5]));
        let town = SceneSource::from_text("a town.glb").with_index(Some(2)).expect("files have scenes");
        let line = command_line(&town, 1, &settings, &home, None);
        let path = quoted(&town.text());
        let start = format!("viewer {path} --no-state --scene-index 2 --animation 1 --set ");
        assert!(path.starts_with('\'') && line.starts_with(&start), "{line}");
        let words = line.replace(&path, "a-town.glb");
        let arguments = Arguments::try_parse_from(words.split(' ')).expect("a command line");
        assert!(arguments.no_state && arguments.scene_index == Some(2) && arguments.animation == 1);
        let mut read = home;
        arguments.apply(&mut read).expect("settings");
        assert_eq!(read, settings);
        assert_eq!(command_line(&SceneSource::default(), 0, &home, &home, None), "viewer --no-state");
    }

    #[test]
    fn words_with_spaces_and_quotes_stay_one_word() {
        assert_eq!(quoted("it's here"), r"'it'\''s here'");
        assert_eq!(quoted("bias.constant=0.5"), "bias.constant=0.5");
        assert_eq!(quoted(""), "''");
    }
}
