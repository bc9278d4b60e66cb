//! Settings as TOML, driven by the parameter table, for saved settings and technique files.
//!
//! The file has a table for each group and a line for each parameter. Every parameter is written, so that a
//! new default does not change saved settings.

use std::fmt::Write as _;

use anyhow::{Context, Result, bail, ensure};
use shadowfit::Technique;
use shadowfit_params::tool::Settings;
use shadowfit_params::{self as params, Group, Inputs, Kind, PARAMETERS, Parameter};
use toml::Value;

/// Writes settings as TOML text for [`settings_from_toml`]: a table for each group, with `prefix` before its
/// name, such as `settings.`.
///
/// Numbers that are not finite are left out. A number out of its range, such as the near plane of a tiny
/// scene, is written as the nearest number in the range, so that it can be read.
pub fn settings_to_toml(settings: &Settings, prefix: &str) -> String {
    write_settings(settings, prefix, |_| true)
}

/// Writes the tables of [`settings_to_toml`] for a technique and the inputs of its fits.
pub fn technique_to_toml(technique: &Technique, inputs: Inputs, prefix: &str) -> String {
    let settings = Settings { inputs, ..Settings::default().with_technique(*technique) };
    write_settings(&settings, prefix, is_of_technique_file)
}

/// Returns whether technique files contain a group: the parts of a technique, and the inputs of its fits.
pub(crate) fn is_of_technique_file(group: Group) -> bool {
    group.is_technique() || group == Group::Input
}

/// Sets the parameters that a table names. All others stay unchanged.
///
/// # Errors
///
/// If the table has an unknown group or key, or a value that the parameter does not accept. The settings are
/// then unchanged.
pub fn settings_from_toml(table: &toml::Table, settings: &mut Settings) -> Result<()> {
    read_settings(table, |_| true, settings)
}

/// Writes the tables of some groups.
pub(crate) fn write_settings(settings: &Settings, prefix: &str, has: impl Fn(Group) -> bool) -> String {
    let settings = &within_ranges(settings);
    let mut text = String::new();
    for group in Group::ALL.into_iter().filter(|group| has(*group)) {
        let _ = writeln!(text, "[{prefix}{}]", group.id());
        for parameter in group.parameters().filter(|parameter| parameter.is_present(settings)) {
            if parameter.number(settings).is_none_or(f64::is_finite) {
                let _ = writeln!(text, "{} = {}", key(parameter), value_of(parameter, settings));
            }
        }
        text.push('\n');
    }
    text
}

/// Returns settings with each finite number clamped to its parameter's range.
fn within_ranges(settings: &Settings) -> Settings {
    let mut within = *settings;
    for parameter in PARAMETERS {
        let Kind::Number(range) = &parameter.kind else { continue };
        let is_out = |number: &f64| number.is_finite() && !(range.min..=range.max).contains(number);
        // Setting an angle resets the choice of the file's sun. This parameter comes after the angles and
        // restores it.
        let follows = parameter.id == "light.file";
        if follows || parameter.number(settings).is_some_and(|number| is_out(&number)) {
            parameter.copy(&mut within, settings);
        }
    }
    within
}

/// Sets the parameters of some groups from a table. Any other group is an error. The settings are then
/// unchanged.
pub(crate) fn read_settings(table: &toml::Table, has: impl Fn(Group) -> bool, settings: &mut Settings) -> Result<()> {
    let mut left = table.clone();
    let mut read = *settings;
    // In the order of the parameter table, so that a scheme comes before the numbers that only it has.
    for parameter in PARAMETERS.iter().filter(|parameter| has(parameter.group)) {
        let Some(group) = left.get_mut(parameter.group.id()) else { continue };
        let group = group.as_table_mut().with_context(|| format!("{} is not a table", parameter.group.id()))?;
        let Some(value) = group.remove(key(parameter)) else { continue };
        params::set_from_str(&mut read, parameter.id, &text_of(&value).with_context(|| parameter.id)?)?;
    }
    refuse_the_rest(&left, has)?;
    *settings = read;
    Ok(())
}

/// Returns a parameter's name in its group.
fn key(parameter: &Parameter) -> &'static str {
    parameter.id.split_once('.').map_or(parameter.id, |(_, key)| key)
}

/// Returns a parameter's value in TOML: a number, true or false, or an option's id in quotes.
fn value_of(parameter: &Parameter, settings: &Settings) -> String {
    let text = params::format_value(settings, parameter);
    let is_bare = parameter.number(settings).is_some() || matches!(parameter.kind, Kind::Toggle);
    if is_bare { text } else { Value::from(text).to_string() }
}

/// Returns a TOML value as text for the parameter table.
fn text_of(value: &Value) -> Result<String> {
    Ok(match value {
        Value::String(text) => text.clone(),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) => number.to_string(),
        Value::Boolean(on) => on.to_string(),
        other => bail!("{other} is not a number, text, true or false"),
    })
}

/// Returns an error for the remaining tables and keys of a file, outside the groups that it `has`.
fn refuse_the_rest(file: &toml::Table, has: impl Fn(Group) -> bool) -> Result<()> {
    let groups: Vec<Group> = Group::ALL.into_iter().filter(|group| has(*group)).collect();
    for (name, value) in file {
        let known = groups.iter().find(|group| group.id() == name);
        let names = || groups.iter().map(|group| group.id()).collect::<Vec<_>>().join(", ");
        let group = known.with_context(|| format!("there is no group {name:?}; there are {}", names()))?;
        if let Some(key) = value.as_table().and_then(|group| group.keys().next()) {
            let keys: Vec<&str> = group.parameters().map(self::key).collect();
            bail!("there is no parameter {name}.{key}; under [{name}] there are {}", keys.join(", "));
        }
        ensure!(value.is_table(), "{name} is {value}; give a table");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use shadowfit::Cascades;
    use shadowfit::settings::SplitScheme;
    use shadowfit_params::tool::{ErrorMarks, ViewMode};

    use super::*;

    fn table(text: &str) -> toml::Table {
        toml::from_str(text).expect("TOML")
    }

    #[test]
    fn a_number_out_of_its_range_is_written_as_the_nearest_one_within() {
        let mut settings = Settings::default();
        settings.camera.near = 4e-8;
        let file: toml::Table = toml::from_str(&settings_to_toml(&settings, "")).expect("TOML");
        let mut read = Settings::default();
        settings_from_toml(&file, &mut read).expect("it can be read");
        assert_eq!(read.camera.near, 1e-6);
    }

    #[test]
    fn a_sun_of_the_file_overhead_or_below_the_horizon_is_still_followed_when_it_is_read_back() {
        for elevation in [90.000_01_f32.to_radians(), -0.5] {
            let mut settings = Settings::default();
            (settings.light.file, settings.light.elevation) = (Some(2), elevation);
            let mut read = Settings::default();
            settings_from_toml(&table(&settings_to_toml(&settings, "")), &mut read).expect("it can be read");
            assert_eq!(read.light.file, Some(2), "{elevation}");
        }
    }

    #[test]
    fn settings_are_read_back_as_they_were_written() {
        let mut settings = Settings::default();
        settings.technique =
            settings.technique.with_maps(Cascades::default().with_count(3).with_splits(SplitScheme::Practical(0.3)));
        (settings.light.hour, settings.camera.speed) = (Some(7.25), 12.5);
        (settings.view.mode, settings.view.marks) = (ViewMode::Error, ErrorMarks::Blink);
        settings.view.inset_depths = Some([0.25, 0.75]);
        let text = settings_to_toml(&settings, "settings.");
        let file = table(&text);
        let mut read = Settings::default();
        settings_from_toml(file["settings"].as_table().expect("a table"), &mut read).expect("the written text");
        assert_eq!(read, settings);
        // A person who reads the file finds names instead of variant numbers.
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
            ("[fit]\nkind = \"windows\"\n[splits]\nscheme = \"uniform\"", "splits.scheme"),
        ] {
            let before = settings;
            let error = settings_from_toml(&table(text), &mut settings).expect_err(text);
            assert!(format!("{error:#}").contains(word), "{error:#}");
            assert_eq!(settings, before);
        }
    }
}
