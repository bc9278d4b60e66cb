//! Options of a sample: a table, and their values.

use core::fmt;

/// One option of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleOption {
    /// Name in command lines and files.
    pub id: &'static str,
    /// Name for people.
    pub label: &'static str,
    /// Effect.
    pub help: &'static str,
    /// Possible values.
    pub kind: OptionKind,
}

/// Possible values of an option.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OptionKind {
    /// One of several, by name and label. The first is the default.
    Choice(&'static [(&'static str, &'static str)]),
    /// A number.
    Number {
        /// Least value.
        min: f32,
        /// Greatest value.
        max: f32,
        /// The source's value.
        default: f32,
        /// Unit, possibly empty.
        unit: &'static str,
    },
    /// On or off.
    Toggle {
        /// The source's value.
        default: bool,
    },
}

/// Reason why an option cannot be set.
#[derive(Clone, Debug, PartialEq)]
pub enum OptionError {
    /// The sample has no such option.
    Unknown {
        /// The given name.
        id: String,
        /// The sample.
        sample: &'static str,
    },
    /// The option does not allow the value.
    Value {
        /// The option.
        id: &'static str,
        /// The given value.
        given: String,
        /// Allowed values.
        possible: String,
    },
}

impl fmt::Display for OptionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unknown { id, sample } => write!(f, "{sample} has no option {id}"),
            Self::Value { id, given, possible } => write!(f, "{id} cannot be {given}; give {possible}"),
        }
    }
}

impl core::error::Error for OptionError {}

impl SampleOption {
    /// Lighting of surfaces, as in the source or modern.
    pub(crate) const LIGHTING: Self = Self::choice(
        "lighting",
        "Lighting",
        "As the source, in display values, or modern: linear light with a tone curve.",
        &[("source", "as the source"), ("modern", "modern")],
    );

    /// Whether the map is shown in a corner.
    pub(crate) const INSET: Self = Self::toggle(
        "inset",
        "Map in a corner",
        "Shows the stored depths as greys, in the same place as the source.",
        true,
    );

    /// Returns the option for the right half of the picture. The first choice is `("none", ...)`, the others
    /// are `option=value` with labels.
    pub(crate) const fn beside(choices: &'static [(&'static str, &'static str)]) -> Self {
        let help = "Shows a comparison in the right half of the picture, on the same view.";
        Self::choice("beside", "Right half", help, choices)
    }

    /// Returns the option for the map's texels each way.
    pub(crate) const fn map_size(help: &'static str, choices: &'static [(&'static str, &'static str)]) -> Self {
        Self::choice("map", "Map size", help, choices)
    }

    /// Returns an option with several choices. The first is the source's.
    pub(crate) const fn choice(
        id: &'static str,
        label: &'static str,
        help: &'static str,
        choices: &'static [(&'static str, &'static str)],
    ) -> Self {
        Self { id, label, help, kind: OptionKind::Choice(choices) }
    }

    /// Returns an on/off option.
    pub(crate) const fn toggle(id: &'static str, label: &'static str, help: &'static str, default: bool) -> Self {
        Self { id, label, help, kind: OptionKind::Toggle { default } }
    }

    /// Returns the source's value: the number, the index of the choice, or 1 for on.
    pub fn default_value(&self) -> f32 {
        match self.kind {
            OptionKind::Choice(_) => 0.0,
            OptionKind::Number { default, .. } => default,
            OptionKind::Toggle { default } => f32::from(u8::from(default)),
        }
    }

    /// Returns the allowed values as text.
    pub fn possible(&self) -> String {
        match self.kind {
            OptionKind::Choice(choices) => choices.iter().map(|(id, _)| *id).collect::<Vec<_>>().join("|"),
            OptionKind::Number { min, max, unit, .. } => format!("{min}..{max} {unit}").trim_end().to_owned(),
            OptionKind::Toggle { .. } => "on|off".to_owned(),
        }
    }

    fn parse(&self, text: &str) -> Option<f32> {
        match self.kind {
            OptionKind::Choice(choices) => choices.iter().position(|(id, _)| *id == text).map(|index| index as f32),
            OptionKind::Number { min, max, .. } => text.parse().ok().filter(|value| (min..=max).contains(value)),
            OptionKind::Toggle { .. } => match text {
                "on" | "true" => Some(1.0),
                "off" | "false" => Some(0.0),
                _ => None,
            },
        }
    }
}

/// The values of a sample's options.
#[derive(Clone, Debug, PartialEq)]
pub struct SampleValues {
    sample: &'static str,
    options: &'static [SampleOption],
    values: Vec<f32>,
}

impl SampleValues {
    /// Returns the source's values of a sample with this name and these options.
    pub(crate) fn of(sample: &'static str, options: &'static [SampleOption]) -> Self {
        Self { sample, options, values: options.iter().map(SampleOption::default_value).collect() }
    }

    /// Returns the value of an option: a number, the index of a choice, or 1 for on. Returns 0 if the sample
    /// does not have the option.
    pub fn get(&self, id: &str) -> f32 {
        self.index(id).map_or(0.0, |index| self.values[index])
    }

    /// Returns the name of an option's current choice. Empty if the option is not a choice.
    pub fn choice(&self, id: &str) -> &'static str {
        let Some(index) = self.index(id) else { return "" };
        match self.options[index].kind {
            OptionKind::Choice(choices) => choices.get(self.values[index] as usize).map_or("", |(id, _)| id),
            _ => "",
        }
    }

    /// Returns `source` or `modern`, as [`SampleOption::LIGHTING`] chooses.
    pub(crate) fn lit<T>(&self, source: T, modern: T) -> T {
        if self.choice(SampleOption::LIGHTING.id) == "modern" { modern } else { source }
    }

    /// Returns whether an option is on.
    pub fn is_on(&self, id: &str) -> bool {
        self.get(id) != 0.0
    }

    /// Returns the values of the right half of the picture, if it differs. The option `beside` names the
    /// difference as `option=value`.
    pub fn beside(&self) -> Option<Self> {
        let (id, text) = self.choice("beside").split_once('=')?;
        let mut other = self.clone();
        other.set_from_str(id, text).ok()?;
        Some(other)
    }

    /// Iterates over every option with its value.
    pub fn iter(&self) -> impl Iterator<Item = (&'static SampleOption, f32)> + '_ {
        self.options.iter().zip(self.values.iter().copied())
    }

    /// Sets the option with an index to a value, clamped to its range.
    pub fn set(&mut self, index: usize, value: f32) {
        let Some(option) = self.options.get(index) else { return };
        self.values[index] = match option.kind {
            OptionKind::Choice(choices) => value.round().clamp(0.0, choices.len() as f32 - 1.0),
            OptionKind::Number { min, max, .. } => value.clamp(min, max),
            OptionKind::Toggle { .. } => f32::from(u8::from(value != 0.0)),
        };
    }

    /// Sets an option from the text of command lines and files.
    ///
    /// # Errors
    ///
    /// [`OptionError`] if the sample has no such option, or the option does not allow the value.
    pub fn set_from_str(&mut self, id: &str, text: &str) -> Result<(), OptionError> {
        let index = self.index(id).ok_or_else(|| OptionError::Unknown { id: id.to_owned(), sample: self.sample })?;
        let option = &self.options[index];
        let refused = || OptionError::Value { id: option.id, given: text.to_owned(), possible: option.possible() };
        self.values[index] = option.parse(text).ok_or_else(refused)?;
        Ok(())
    }

    /// Returns the value of an option as text for [`Self::set_from_str`].
    pub fn text(option: &SampleOption, value: f32) -> String {
        match option.kind {
            OptionKind::Choice(choices) => choices.get(value as usize).map_or("", |(id, _)| id).to_owned(),
            OptionKind::Number { .. } => value.to_string(),
            OptionKind::Toggle { .. } => if value == 0.0 { "off" } else { "on" }.to_owned(),
        }
    }

    /// Returns the options that differ from the source's, as text for [`Self::set_from_str`].
    pub fn changes(&self) -> impl Iterator<Item = (&'static str, String)> + '_ {
        let changed = self.iter().filter(|(option, value)| option.default_value() != *value);
        changed.map(|(option, value)| (option.id, Self::text(option, value)))
    }

    fn index(&self, id: &str) -> Option<usize> {
        self.options.iter().position(|option| option.id == id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SAMPLES;

    #[test]
    fn every_option_reads_what_it_writes() {
        for sample in &SAMPLES {
            let mut values = SampleValues::new(sample);
            assert_eq!(values.changes().count(), 0);
            for (index, option) in sample.options.iter().enumerate() {
                let other = match option.kind {
                    OptionKind::Choice(_) => 1.0,
                    OptionKind::Number { max, .. } => max,
                    OptionKind::Toggle { default } => f32::from(u8::from(!default)),
                };
                values.set(index, other);
            }
            let mut read = SampleValues::new(sample);
            for (id, text) in values.changes() {
                read.set_from_str(id, &text).expect("what was written");
            }
            assert_eq!(read, values);
        }
    }

    #[test]
    fn whatever_is_shown_beside_is_possible() {
        for sample in &SAMPLES {
            let Some(OptionKind::Choice(choices)) =
                sample.options.iter().find(|option| option.id == "beside").map(|option| option.kind)
            else {
                continue;
            };
            for (id, _) in &choices[1..] {
                let mut values = SampleValues::new(sample);
                values.set_from_str("beside", id).expect("a choice");
                let other = values.beside().unwrap_or_else(|| panic!("{}: {id}", sample.id));
                assert_ne!(other, values, "{}: {id}", sample.id);
            }
        }
    }

    #[test]
    fn what_is_not_possible_is_refused_with_what_is() {
        let mut values = SampleValues::new(&SAMPLES[0]);
        let error = values.set_from_str("no-such", "1").expect_err("no such option").to_string();
        assert!(error.contains("no-such") && error.contains(SAMPLES[0].id), "{error}");
        let error = values.set_from_str("shadows", "maybe").expect_err("no such choice").to_string();
        assert!(error.contains("maybe") && error.contains("off"), "{error}");
        for text in ["NaN", "-1", "inf", "x", ""] {
            assert!(values.set_from_str("bias", text).is_err(), "{text}");
        }
        values.set(99, 1.0);
        assert_eq!(values, SampleValues::new(&SAMPLES[0]));
    }
}
