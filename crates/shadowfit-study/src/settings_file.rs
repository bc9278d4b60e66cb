//! All settings as TOML, by the parameter table: what tools save.
//!
//! A table for each group and a line for each parameter, as in the files of techniques, and every parameter is written,
//! so that a new default does not change what a person had set.

use std::fmt::Write as _;

use anyhow::{Context, Result, anyhow};
use shadowfit::params::{self, Group, PARAMETERS};
use shadowfit::tool::Settings;

use crate::technique_file::{key, refuse_the_rest, text_of, value_of};

/// Settings as TOML text that [`settings_from_toml`] reads: a table for each group, its name behind `prefix`, such as
/// `settings.`.
///
/// Numbers that are not finite are left out.
pub fn settings_to_toml(settings: &Settings, prefix: &str) -> String {
    let mut text = String::new();
    for group in Group::ALL {
        let _ = writeln!(text, "[{prefix}{}]", group.id());
        for parameter in group.parameters().filter(|parameter| parameter.is_present(settings)) {
            let value = value_of(parameter, settings);
            if !["NaN", "inf", "-inf"].contains(&value.trim_matches('"')) {
                let _ = writeln!(text, "{} = {value}", key(parameter));
            }
        }
        text.push('\n');
    }
    text
}

/// Takes what a table says, and leaves everything else as it is.
///
/// # Errors
///
/// When the table has a group or a key that there is not, or a value that the parameter does not take; the settings are
/// as they were then.
pub fn settings_from_toml(table: &toml::Table, settings: &mut Settings) -> Result<()> {
    let mut left = table.clone();
    let mut read = *settings;
    for parameter in PARAMETERS {
        let Some(group) = left.get_mut(parameter.group.id()) else { continue };
        let group = group.as_table_mut().with_context(|| format!("{} is no table", parameter.group.id()))?;
        if let Some(value) = group.remove(key(parameter)) {
            let value = text_of(&value).with_context(|| parameter.id)?;
            params::set_from_str(&mut read, parameter.id, &value).map_err(|error| anyhow!("{error}"))?;
        }
    }
    refuse_the_rest(&left, |_| true)?;
    *settings = read;
    Ok(())
}

#[cfg(test)]
mod tests {
    use shadowfit::settings::SplitScheme;
    use shadowfit::tool::{ErrorMarks, ViewMode};

    use super::*;

    fn table(text: &str) -> toml::Table {
        toml::from_str(text).expect("TOML")
    }

    #[test]
    fn settings_are_read_back_as_they_were_written() {
        let mut settings = Settings::default();
        settings.technique = settings.technique.with_count(3).with_splits(SplitScheme::Practical(0.3));
        (settings.light.hour, settings.camera.speed) = (Some(7.25), 12.5);
        (settings.view.mode, settings.view.marks) = (ViewMode::Error, ErrorMarks::Blink);
        settings.view.inset_depths = Some([0.25, 0.75]);
        let text = settings_to_toml(&settings, "settings.");
        let file = table(&text);
        let mut read = Settings::default();
        settings_from_toml(file["settings"].as_table().expect("a table"), &mut read).expect("what was written");
        assert_eq!(read, settings);
        // A person who reads the file finds names, and not numbers of variants.
        assert!(text.contains("[settings.view]") && text.contains("mode = \"error\""), "{text}");
    }

    #[test]
    fn what_is_left_out_stays_and_what_makes_no_sense_is_named() {
        let mut settings = Settings::default();
        settings_from_toml(&table("[bias]\nconstant = 0.5"), &mut settings).expect("one line");
        assert_eq!(settings.technique.bias.constant, 0.5);
        for (text, word) in [
            ("[bias]\nconstant = 1e9", "bias.constant"),
            ("[bias]\nbent = 1", "bias.bent"),
            ("[sun]\nelevation = 1", "sun"),
            ("view = 3", "view"),
        ] {
            let before = settings;
            let error = settings_from_toml(&table(text), &mut settings).expect_err(text);
            assert!(format!("{error:#}").contains(word), "{error:#}");
            assert_eq!(settings, before);
        }
    }
}
