//! Parameter values as text, for command lines and saved files.

use core::fmt;

use super::{Kind, Number, Optional, PARAMETERS, Parameter, parameter, technique_parameters};
use crate::tool::Settings;

/// Sets one parameter from text: a number in the parameter's unit, an option's id, or `true`,
/// `on`, `false`, `off`. Spaces around the value are ignored.
///
/// Unlike [`Number::set`], a number outside its range and a fraction where whole numbers are meant
/// are errors, since a file or command line has no slider that would show what became of them.
///
/// # Errors
///
/// [`ParameterError`], with `settings` untouched: the id is unknown, the value is not one that the
/// parameter takes, or the parameter [does not exist](Parameter::is_present) under these settings.
pub fn set_from_str<'a>(settings: &mut Settings, id: &'a str, value: &'a str) -> Result<(), ParameterError<'a>> {
    let parameter = parameter(id).ok_or(ParameterError::UnknownId { id })?;
    let value = value.trim();
    match &parameter.kind {
        Kind::Number(number) => number.set(settings, parse(parameter, value, number.into())?),
        Kind::Optional(optional) => {
            let is_unset = optional.unset.is_some_and(|unset| unset.id == value);
            let parsed = if is_unset { None } else { Some(parse(parameter, value, optional.into())?) };
            if parsed.is_some() && !parameter.is_present(settings) {
                let reason = (parameter.inert)(settings).unwrap_or_default();
                return Err(ParameterError::NotPresent { parameter, reason });
            }
            optional.set(settings, parsed);
        }
        Kind::Choice(choice) => {
            let index = choice.options.iter().position(|option| option.id == value);
            choice.set(settings, index.ok_or(ParameterError::UnknownOption { parameter, value })?);
        }
        Kind::Toggle(toggle) => match value {
            "true" | "on" => toggle.set(settings, true),
            "false" | "off" => toggle.set(settings, false),
            _ => return Err(ParameterError::UnknownOption { parameter, value }),
        },
    }
    Ok(())
}

/// A number that a parameter takes.
fn parse<'a>(parameter: &'static Parameter, value: &'a str, numbers: Numbers) -> Result<f64, ParameterError<'a>> {
    let parsed: f64 = value.parse().map_err(|_| ParameterError::NotANumber { parameter, value })?;
    if !(numbers.min..=numbers.max).contains(&parsed) {
        Err(ParameterError::OutOfRange { parameter, value })
    } else if numbers.is_whole && libm::trunc(parsed) != parsed {
        Err(ParameterError::NotANumber { parameter, value })
    } else {
        Ok(parsed)
    }
}

/// Which numbers a parameter takes.
#[derive(Clone, Copy)]
struct Numbers {
    min: f64,
    max: f64,
    is_whole: bool,
}

impl From<&Number> for Numbers {
    fn from(&Number { min, max, decimals, .. }: &Number) -> Self {
        Self { min, max, is_whole: decimals == 0 }
    }
}

impl From<&Optional> for Numbers {
    fn from(&Optional { min, max, decimals, .. }: &Optional) -> Self {
        Self { min, max, is_whole: decimals == 0 }
    }
}

/// Writes a parameter's value as [`set_from_str`] reads it, without its unit.
///
/// A number gets the fewest decimals that restore the setting to the bit; one outside its range,
/// which no text restores, is written with all its digits. A parameter that [does not
/// exist](Parameter::is_present) under these settings is written as an empty string.
///
/// # Errors
///
/// Only those of `out`.
pub fn format_value(settings: &Settings, parameter: &Parameter, out: &mut dyn fmt::Write) -> fmt::Result {
    if !parameter.is_present(settings) {
        return Ok(());
    }
    match &parameter.kind {
        Kind::Number(number) => {
            let set = |settings: &mut Settings, value| number.set(settings, value);
            write_number(settings, number.get(settings), number.into(), (&set, &|s| Some(number.get(s))), out)
        }
        Kind::Optional(optional) => match (optional.get(settings), optional.unset) {
            (Some(value), _) => {
                let set = |settings: &mut Settings, value| optional.set(settings, Some(value));
                write_number(settings, value, optional.into(), (&set, &|s| optional.get(s)), out)
            }
            (None, Some(unset)) => out.write_str(unset.id),
            (None, None) => Ok(()),
        },
        Kind::Choice(choice) => out.write_str(choice.options.get(choice.get(settings)).map_or("", |option| option.id)),
        Kind::Toggle(toggle) => out.write_str(if toggle.get(settings) { "true" } else { "false" }),
    }
}

/// How a parameter's number is written and read back.
type Access<'a> = (&'a dyn Fn(&mut Settings, f64), &'a dyn Fn(&Settings) -> Option<f64>);

fn write_number(
    settings: &Settings,
    value: f64,
    Numbers { min, max, .. }: Numbers,
    (set, get): Access<'_>,
    out: &mut dyn fmt::Write,
) -> fmt::Result {
    /// More than any value in any range needs: f32 has 9 significant decimal digits, and the least
    /// positive values of the ranges are hundredths.
    const MOST_DECIMALS: usize = 17;
    for decimals in 0..=MOST_DECIMALS {
        let mut text = ShortText::default();
        if fmt::Write::write_fmt(&mut text, format_args!("{value:.decimals$}")).is_err() {
            break;
        }
        let mut restored = *settings;
        if let Ok(parsed) = text.as_str().parse() {
            set(&mut restored, parsed);
            if get(&restored) == Some(value) && (min..=max).contains(&parsed) {
                return out.write_str(text.as_str());
            }
        }
    }
    write!(out, "{value}")
}

/// A text buffer on the stack: five digits, a point and 17 decimals fit.
#[derive(Default)]
struct ShortText {
    bytes: [u8; 32],
    len: usize,
}

impl ShortText {
    fn as_str(&self) -> &str {
        self.bytes.get(..self.len).and_then(|bytes| core::str::from_utf8(bytes).ok()).unwrap_or("")
    }
}

impl fmt::Write for ShortText {
    fn write_str(&mut self, s: &str) -> fmt::Result {
        let end = self.len + s.len();
        self.bytes.get_mut(self.len..end).ok_or(fmt::Error)?.copy_from_slice(s.as_bytes());
        self.len = end;
        Ok(())
    }
}

/// Why a parameter could not be set from text.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub enum ParameterError<'a> {
    /// No parameter has that id.
    UnknownId {
        /// The id that was asked for.
        id: &'a str,
    },
    /// The value is not a number, or not a whole one where that is needed.
    NotANumber {
        /// The parameter.
        parameter: &'static Parameter,
        /// What was given.
        value: &'a str,
    },
    /// The parameter is not part of a [`Technique`](shadowfit::Technique).
    NotOfTechnique {
        /// The id that was asked for.
        id: &'a str,
    },
    /// The number lies outside the parameter's range, or is NaN.
    OutOfRange {
        /// The parameter.
        parameter: &'static Parameter,
        /// What was given.
        value: &'a str,
    },
    /// The value is none of the parameter's options.
    UnknownOption {
        /// The parameter.
        parameter: &'static Parameter,
        /// What was given.
        value: &'a str,
    },
    /// Another parameter's value means that this one does not exist.
    NotPresent {
        /// The parameter.
        parameter: &'static Parameter,
        /// What to set first.
        reason: &'static str,
    },
}

impl core::error::Error for ParameterError<'_> {}

impl fmt::Display for ParameterError<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::UnknownId { id } => {
                write!(f, "there is no parameter {id:?}; there are ")?;
                list(f, PARAMETERS.iter().map(|parameter| parameter.id))
            }
            Self::NotOfTechnique { id } => {
                write!(f, "{id} is no part of a technique, which is made of ")?;
                list(f, technique_parameters().map(|parameter| parameter.id))
            }
            Self::NotANumber { parameter, value } => {
                write!(f, "{} is {value:?}; give ", parameter.id)?;
                allowed(f, parameter)
            }
            Self::OutOfRange { parameter, value } => {
                write!(f, "{} is {value}, which is out of range; give ", parameter.id)?;
                allowed(f, parameter)
            }
            Self::UnknownOption { parameter, value } => {
                write!(f, "{} is {value:?}, which is none of its options; give ", parameter.id)?;
                allowed(f, parameter)
            }
            Self::NotPresent { parameter, reason } => {
                write!(f, "{} cannot be set: {reason}", parameter.id)
            }
        }
    }
}

fn allowed(f: &mut fmt::Formatter<'_>, parameter: &Parameter) -> fmt::Result {
    match &parameter.kind {
        Kind::Number(number) => allowed_numbers(f, parameter, number.into()),
        Kind::Optional(optional) => {
            allowed_numbers(f, parameter, optional.into())?;
            optional.unset.map_or(Ok(()), |unset| write!(f, ", or {}", unset.id))
        }
        Kind::Choice(choice) => {
            f.write_str("one of ")?;
            list(f, choice.options.iter().map(|option| option.id))
        }
        Kind::Toggle(_) => f.write_str("true or false"),
    }
}

fn allowed_numbers(f: &mut fmt::Formatter<'_>, parameter: &Parameter, numbers: Numbers) -> fmt::Result {
    let Numbers { min, max, is_whole } = numbers;
    write!(f, "a {}number from {min} to {max}", if is_whole { "whole " } else { "" })?;
    if parameter.unit.is_empty() { Ok(()) } else { write!(f, " {}", parameter.unit) }
}

fn list(f: &mut fmt::Formatter<'_>, words: impl Iterator<Item = &'static str>) -> fmt::Result {
    for (index, word) in words.enumerate() {
        if index > 0 {
            f.write_str(", ")?;
        }
        f.write_str(word)?;
    }
    Ok(())
}
