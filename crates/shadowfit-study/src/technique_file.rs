//! Techniques by name, and as TOML files.
//!
//! A file has a table for each group of the parameter table and a line for each parameter, so that what is written as
//! `--set map.filter=pcf_3x3` on a command line is `filter = "pcf_3x3"` under `[map]` in a file. What a file leaves out
//! is as in the recommended technique.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use shadowfit::params::{self, Group, Parameter, technique_parameters};
use shadowfit::presets::RECOMMENDED;
use shadowfit::tool::Settings;
use shadowfit::{PRESETS, Technique};
use toml::Value;

/// A technique with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedTechnique {
    /// Name, for tables.
    pub name: String,
    /// What it is, in a few words.
    pub summary: String,
    /// The technique.
    pub technique: Technique,
}

impl Default for NamedTechnique {
    fn default() -> Self {
        Self::preset(RECOMMENDED).unwrap_or_else(|| Technique::default().into())
    }
}

impl From<Technique> for NamedTechnique {
    /// A technique without a name.
    fn from(technique: Technique) -> Self {
        Self { name: String::new(), summary: String::new(), technique }
    }
}

impl NamedTechnique {
    /// The preset of a name.
    pub fn preset(name: &str) -> Option<Self> {
        let preset = PRESETS.iter().find(|preset| preset.name == name)?;
        Some(Self { name: preset.name.to_owned(), summary: preset.summary.to_owned(), technique: preset.technique() })
    }

    /// This technique with maps of another width and height, in texels.
    #[must_use]
    pub fn with_resolution(mut self, texels: u32) -> Self {
        self.technique = self.technique.with_resolution(texels, texels);
        self
    }

    /// The preset of a name, or the technique of a TOML file where the text ends in `.toml`.
    ///
    /// # Errors
    ///
    /// When there is no such preset, or the file cannot be read or makes no sense.
    pub fn find(text: &str) -> Result<Self> {
        let file = Path::new(text);
        if file.extension().is_some_and(|extension| extension == "toml") {
            return Self::read(file);
        }
        Self::preset(text).with_context(|| {
            let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
            format!("there is no technique \"{text}\"; give a .toml file or one of {}", names.join(", "))
        })
    }

    /// Reads a technique from a TOML file; one without a name gets the file's.
    ///
    /// # Errors
    ///
    /// When it cannot be read or makes no sense; the message names file, group and parameter.
    pub fn read(file: &Path) -> Result<Self> {
        let at = || file.display().to_string();
        let text = std::fs::read_to_string(file).with_context(at)?;
        let mut named = Self::from_toml(&text).with_context(at)?;
        if named.name.is_empty() {
            named.name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        }
        Ok(named)
    }

    /// The technique of a TOML text, as [`Self::to_toml`] writes it.
    ///
    /// # Errors
    ///
    /// When the text is no TOML, has a table or a key that no technique has, or a value that the parameter does not
    /// take.
    pub fn from_toml(text: &str) -> Result<Self> {
        let mut file: toml::Table = toml::from_str(text)?;
        let mut word = |key: &str| match file.remove(key) {
            None => Ok(String::new()),
            Some(Value::String(text)) => Ok(text),
            Some(other) => bail!("{key} is {other}; give a text in quotes"),
        };
        let (name, summary) = (word("name")?, word("summary")?);
        let mut technique = Technique::default();
        // In the order of the table: a scheme stands before the numbers that only it has.
        for parameter in technique_parameters() {
            let (group, key) = (parameter.group.id(), key(parameter));
            let Some(group) = file.get_mut(group) else { continue };
            let group = group.as_table_mut().with_context(|| format!("{} is no table", parameter.group.id()))?;
            if let Some(value) = group.remove(key) {
                let value = text_of(&value).with_context(|| parameter.id)?;
                params::set_technique_from_str(&mut technique, parameter.id, &value)
                    .map_err(|error| anyhow!("{error}"))?;
            }
        }
        refuse_the_rest(&file, Group::is_technique)?;
        Ok(Self { name, summary, technique })
    }

    /// The technique as [`Self::read`] reads it.
    ///
    /// # Errors
    ///
    /// When a number lies outside its parameter's range or is not finite, so that it could not be read back.
    pub fn to_toml(&self) -> Result<String> {
        let Self { name, summary, technique } = self;
        let settings = Settings::default().with_technique(*technique);
        let mut text = format!("name = {}\nsummary = {}\n", Value::from(name.as_str()), Value::from(summary.as_str()));
        for group in Group::ALL.into_iter().filter(|group| group.is_technique()) {
            let mut lines = String::new();
            for parameter in group.parameters().filter(|parameter| parameter.is_present(&settings)) {
                let _ = writeln!(lines, "{} = {}", key(parameter), value_of(parameter, &settings));
            }
            if !lines.is_empty() {
                let _ = write!(text, "\n[{}]\n{lines}", group.id());
            }
        }
        let read = Self::from_toml(&text).context("a number that no file can hold")?;
        ensure!(read == *self, "a number that no file can hold");
        Ok(text)
    }
}

/// A parameter's name in its group.
pub(crate) fn key(parameter: &Parameter) -> &'static str {
    parameter.id.split_once('.').map_or(parameter.id, |(_, key)| key)
}

/// A parameter's value as TOML has it: a number, true or false, or an option's id in quotes.
pub(crate) fn value_of(parameter: &Parameter, settings: &Settings) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = params::format_value(settings, parameter, &mut text);
    let is_number = text.parse::<f64>().is_ok() && !matches!(parameter.kind, params::Kind::Choice(_));
    if is_number || matches!(parameter.kind, params::Kind::Toggle(_)) { text } else { Value::from(text).to_string() }
}

/// A TOML value as the parameter table reads it.
pub(crate) fn text_of(value: &Value) -> Result<String> {
    Ok(match value {
        Value::String(text) => text.clone(),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) => number.to_string(),
        Value::Boolean(on) => on.to_string(),
        other => bail!("{other} is no number, text, true or false"),
    })
}

/// Refuses what is left of a file: tables and keys that are not of the groups which it `has`.
pub(crate) fn refuse_the_rest(file: &toml::Table, has: impl Fn(Group) -> bool) -> Result<()> {
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
    use super::*;
    use shadowfit::glam::Vec3;
    use shadowfit::settings::SplitScheme;

    #[test]
    fn every_preset_is_written_and_read_back_the_same() {
        let folder = std::env::temp_dir().join(format!("shadowfit-techniques-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        for preset in &PRESETS {
            let named = NamedTechnique::find(preset.name).expect("a known name");
            let file = folder.join(format!("{}.toml", preset.name));
            std::fs::write(&file, named.to_toml().expect("text")).expect("written");
            assert_eq!(NamedTechnique::find(&file.to_string_lossy()).expect("read back"), named);
        }
        std::fs::remove_dir_all(&folder).expect("removed");
    }

    #[test]
    fn up_and_manual_splits_survive_a_file() {
        let mut technique = Technique::default()
            .with_splits(SplitScheme::Manual([0.1, 2.5, 7.0, 11.0, 12.3, 13.0, 99.9]))
            .with_resolution(1024, 768);
        technique.fit.up = Vec3::Z;
        technique.fit.border = Some(0.0);
        let named = NamedTechnique { name: "\"quoted\"".to_owned(), summary: "a\nb".to_owned(), technique };
        assert_eq!(NamedTechnique::from_toml(&named.to_toml().expect("text")).expect("read back"), named);
    }

    #[test]
    fn what_no_file_can_hold_is_an_error() {
        let mut named = NamedTechnique::default();
        named.technique.bias.slope = f32::NAN;
        assert!(named.to_toml().is_err());
        named.technique.bias.slope = 1e9;
        assert!(named.to_toml().is_err());
    }

    #[test]
    fn files_that_make_no_sense_are_refused_by_name_and_reason() {
        let folder = std::env::temp_dir().join(format!("shadowfit-bad-techniques-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let refused = |text: &str| {
            let file = folder.join("bad.toml");
            std::fs::write(&file, text).expect("written");
            format!("{:#}", NamedTechnique::find(&file.to_string_lossy()).expect_err(text))
        };
        for (text, reason) in [
            ("map = 3", "map is no table"),
            ("name = 3", "name is 3"),
            ("[splits]\ncount = 9", "splits.count is 9, which is out of range; give a whole number from 1 to 8"),
            ("[splits]\ncount = -1", "splits.count"),
            ("[map]\nresolution = 64", "map.resolution is 64"),
            ("[bias]\nslope = nan", "bias.slope is NaN"),
            ("[map]\nfilter = \"blur\"", "blur"),
            ("[splits]\nlambda = 0.5", "splits.lambda cannot be set"),
            ("[light]\nelevation = 30", "there is no group \"light\""),
            ("[map]\ncolour = 1", "there is no parameter map.colour"),
            ("colour = 1", "colour"),
            ("[map", "bad.toml"),
        ] {
            let error = refused(text);
            assert!(error.contains(reason) && error.contains("bad.toml"), "{text}: {error}");
        }
        std::fs::remove_dir_all(&folder).expect("removed");
        assert!(format!("{:#}", NamedTechnique::find("none").expect_err("unknown")).contains(RECOMMENDED));
        assert!(NamedTechnique::find("/nowhere/x.toml").is_err());
    }
}
