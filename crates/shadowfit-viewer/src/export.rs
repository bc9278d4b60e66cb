//! Settings as text that starts the viewer again: a command line, and what a screenshot carries.

use std::fmt::Write as _;

use shadowfit::params::{self, PARAMETERS};
use shadowfit::tool::Settings;

use crate::source::SceneSource;

/// The command line that opens a scene with these settings. `home` are the settings that the scene is opened with:
/// only what differs from them is written.
pub(crate) fn command_line(source: &SceneSource, settings: &Settings, home: &Settings) -> String {
    let mut line = String::from("viewer");
    if *source != SceneSource::default() {
        let _ = write!(line, " {}", quoted(&source.text()));
    }
    // Parameters that only others bring about come after these in the table.
    let mut reached = *home;
    for parameter in PARAMETERS.iter().filter(|parameter| parameter.is_present(settings)) {
        if !parameter.is_equal(settings, &reached) {
            let mut value = String::new();
            // Writing to a String cannot fail.
            let _ = params::format_value(settings, parameter, &mut value);
            let _ = write!(line, " --set {}", quoted(&format!("{}={value}", parameter.id)));
            parameter.copy(&mut reached, settings);
        }
    }
    line
}

/// A word as a shell reads it as one.
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
    use crate::cli::Arguments;

    #[test]
    fn the_command_line_brings_the_settings_back() {
        let home = Settings::default();
        let mut settings = home;
        settings.technique = settings.technique.with_count(3).with_splits(SplitScheme::Practical(0.25));
        settings.technique.bias.constant = 0.7;
        (settings.light.hour, settings.view.inset_depths) = (Some(8.5), Some([0.25, 0.5]));
        let line = command_line(&SceneSource::from_text("a town.glb"), &settings, &home);
        assert!(line.starts_with("viewer 'a town.glb' --set "), "{line}");
        let words = line.replace("'a town.glb'", "a-town.glb");
        let arguments = Arguments::try_parse_from(words.split(' ')).expect("a command line");
        let mut read = home;
        arguments.apply(&mut read).expect("settings");
        assert_eq!(read, settings);
        assert_eq!(command_line(&SceneSource::default(), &home, &home), "viewer");
    }

    #[test]
    fn words_with_spaces_and_quotes_stay_one_word() {
        assert_eq!(quoted("it's here"), r"'it'\''s here'");
        assert_eq!(quoted("bias.constant=0.5"), "bias.constant=0.5");
        assert_eq!(quoted(""), "''");
    }
}
