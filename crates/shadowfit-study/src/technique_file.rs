//! Techniques by name, and as TOML files.
//!
//! A file has a table for each group of the parameter table and a line for each parameter. The option `--set
//! map.filter=pcf_3x3` on a command line is `filter = "pcf_3x3"` under `[map]` in a file. A parameter that is
//! missing in a file has the recommended technique's value.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use shadowfit::Preset;
use shadowfit::{PRESETS, Technique};
use shadowfit_params::tool::Settings;
use shadowfit_params::{Inputs, NAMED_INPUTS, NamedInputs};
use toml::Value;

use crate::settings_file::{is_of_technique_file, read_settings, technique_to_toml};

/// A technique with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedTechnique {
    /// Name, for tables.
    pub name: String,
    /// Description in a few words.
    pub summary: String,
    /// The technique.
    pub technique: Technique,
    /// Inputs of its fits.
    pub inputs: Inputs,
}

impl Default for NamedTechnique {
    fn default() -> Self {
        Self::preset(Preset::RECOMMENDED).unwrap_or_else(|| Technique::default().into())
    }
}

impl From<Technique> for NamedTechnique {
    /// Returns a technique without a name.
    fn from(technique: Technique) -> Self {
        Self { name: String::new(), summary: String::new(), technique, inputs: Inputs::default() }
    }
}

impl NamedTechnique {
    /// Returns the preset with a name. The name may also be a [name for a preset with an
    /// input](NAMED_INPUTS).
    pub fn preset(name: &str) -> Option<Self> {
        let named = NamedInputs::find(name);
        let preset = named.map_or(name, |named| named.preset);
        let preset = PRESETS.iter().find(|known| known.name == preset)?;
        let (summary, inputs) = match named {
            Some(named) => (format!("{}: {}", preset.name, preset.summary), named.inputs),
            None => (preset.summary.to_owned(), Inputs::default()),
        };
        Some(Self { name: name.to_owned(), summary, technique: preset.technique(), inputs })
    }

    /// Returns a sentence about the technique and the inputs of its fits.
    pub fn description(&self) -> String {
        format!("{}; {}", self.summary, self.inputs)
    }

    /// Returns this technique with maps of another width and height, in texels.
    #[must_use]
    pub fn with_resolution(mut self, texels: u32) -> Self {
        self.technique = self.technique.with_resolution(texels, texels);
        self
    }

    /// Returns the preset with a name, or reads a technique from a TOML file if the text ends in `.toml`.
    ///
    /// # Errors
    ///
    /// If there is no such preset, or the file cannot be read or is invalid.
    pub fn find(text: &str) -> Result<Self> {
        let file = Path::new(text);
        if file.extension().is_some_and(|extension| extension == "toml") {
            return Self::read(file);
        }
        Self::preset(text).with_context(|| {
            let inputs = NAMED_INPUTS.iter().map(|named| named.name);
            let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).chain(inputs).collect();
            format!("there is no technique \"{text}\"; give a .toml file or one of {}", names.join(", "))
        })
    }

    /// Reads a technique from a TOML file. A technique without a name is named after the file.
    ///
    /// # Errors
    ///
    /// If the file cannot be read or is invalid. The message names file, group and parameter.
    pub fn read(file: &Path) -> Result<Self> {
        let at = || file.display().to_string();
        let text = std::fs::read_to_string(file).with_context(at)?;
        Ok(Self::from_toml(&text).with_context(at)?.or_named_after(file))
    }

    /// Returns the technique. If it has no name, it is named after its file, without the extension.
    #[must_use]
    pub fn or_named_after(mut self, file: &Path) -> Self {
        if self.name.is_empty() {
            self.name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        }
        self
    }

    /// Parses a technique from TOML text, as written by [`Self::to_toml`].
    ///
    /// # Errors
    ///
    /// If the text is not TOML, or has an unknown table or key, or a value that the parameter does not
    /// accept.
    pub fn from_toml(text: &str) -> Result<Self> {
        let mut file: toml::Table = toml::from_str(text)?;
        let mut word = |key: &str| match file.remove(key) {
            None => Ok(String::new()),
            Some(Value::String(text)) => Ok(text),
            Some(other) => bail!("{key} is {other}; give a text in quotes"),
        };
        let (name, summary) = (word("name")?, word("summary")?);
        let mut settings = Settings::default();
        read_settings(&file, is_of_technique_file, &mut settings)?;
        let Settings { technique, inputs, .. } = settings;
        Ok(Self { name, summary, technique, inputs })
    }

    /// Returns the technique as TOML for [`Self::read`].
    ///
    /// # Errors
    ///
    /// If a number lies outside its parameter's range or is not finite, so that it could not be read back.
    pub fn to_toml(&self) -> Result<String> {
        let Self { name, summary, technique, inputs } = self;
        let mut text = format!("name = {}\nsummary = {}\n", Value::from(name.as_str()), Value::from(summary.as_str()));
        let _ = writeln!(text, "\n{}", technique_to_toml(technique, *inputs, "").trim_end());
        let read = Self::from_toml(&text).context("a number that a file cannot hold")?;
        ensure!(read == *self, "a number that a file cannot hold");
        Ok(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shadowfit::Cascades;
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
    fn up_manual_splits_and_a_height_survive_a_file() {
        let mut technique = Technique::default()
            .with_maps(Cascades::default().with_splits(SplitScheme::Manual([0.1, 2.5, 7.0, 11.0, 12.3, 13.0, 99.9])))
            .with_resolution(1024, 768);
        technique.fit.up = Vec3::Z;
        technique.fit.border = Some(0.0);
        let named = NamedTechnique { name: "\"quoted\"".to_owned(), summary: "a\nb".to_owned(), ..technique.into() };
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
            ("map = 3", "map is not a table"),
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
        assert!(format!("{:#}", NamedTechnique::find("none").expect_err("unknown")).contains(Preset::RECOMMENDED));
        assert!(NamedTechnique::find("/nowhere/x.toml").is_err());
    }
}
