//! Parameter values as text, for command lines and saved files.

use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::{String, ToString};
use core::fmt;

use super::{Kind, Number, PARAMETERS, Parameter, Value, parameter, technique_parameters};
use crate::tool::Settings;

/// Sets one parameter from text: a number in the parameter's unit, an option's id, or `true`, `on`, `false`,
/// `off`. Spaces around the value are ignored.
///
/// Unlike [`Parameter::set`], this returns an error for a number outside its range and for a fraction where
/// whole numbers are required. A file or command line has no slider that would show the clamped value.
///
/// # Errors
///
/// [`ParameterError`], with `settings` unchanged: the id is unknown, the parameter does not take the value,
/// or the parameter [does not exist](Parameter::get) under these settings.
pub fn set_from_str(settings: &mut Settings, id: &str, value: &str) -> Result<(), ParameterError> {
    let parameter = parameter(id).ok_or_else(|| ParameterError::UnknownId { id: id.to_owned() })?;
    set_value(settings, parameter, value).map_err(ParameterError::from)
}

/// Sets a parameter as [`set_from_str`] does, without allocating.
///
/// # Errors
///
/// [`RejectedValue`], with `settings` unchanged: the parameter does not take the value, or [does not
/// exist](Parameter::get) under these settings.
pub fn set_value<'a>(
    settings: &mut Settings,
    parameter: &'static Parameter,
    value: &'a str,
) -> Result<(), RejectedValue<'a>> {
    let value = value.trim();
    let rejected = |reason| RejectedValue { parameter, value, reason };
    let parsed = parse(parameter, value).map_err(rejected)?;
    // Unset is always valid for a parameter that does not exist.
    if !parameter.is_present(settings) && parsed != Value::Unset {
        let reason = (parameter.inert)(settings).unwrap_or_default();
        return Err(rejected(RejectionReason::NotPresent(reason)));
    }
    parameter.set(settings, parsed);
    Ok(())
}

/// Parses a text as a value of the parameter.
fn parse(parameter: &Parameter, text: &str) -> Result<Value, RejectionReason> {
    match &parameter.kind {
        Kind::Number(Number { unset: Some(unset), .. }) if unset.option.id == text => Ok(Value::Unset),
        Kind::Number(Number { min, max, decimals, .. }) => {
            let number: f64 = text.parse().map_err(|_| RejectionReason::NotANumber)?;
            if !(*min..=*max).contains(&number) {
                Err(RejectionReason::OutOfRange)
            } else if *decimals == 0 && libm::trunc(number) != number {
                Err(RejectionReason::NotANumber)
            } else {
                Ok(Value::Number(number))
            }
        }
        Kind::Choice(options) => {
            let index = options.iter().position(|option| option.id == text);
            index.map(Value::Option).ok_or(RejectionReason::UnknownOption)
        }
        Kind::Toggle => match text {
            "true" | "on" => Ok(Value::Toggle(true)),
            "false" | "off" => Ok(Value::Toggle(false)),
            _ => Err(RejectionReason::UnknownOption),
        },
    }
}

/// Returns a parameter's value as text that [`set_from_str`] reads, without its unit.
///
/// A number gets the fewest decimals that restore the setting to the bit. A number outside its range, which
/// no text restores, is written with all its digits. A parameter that [does not exist](Parameter::get) under
/// these settings gives an empty string.
pub fn format_value(settings: &Settings, parameter: &Parameter) -> String {
    match (parameter.get(settings), &parameter.kind) {
        (Some(Value::Number(value)), Kind::Number(range)) => number_text(settings, parameter, value, range),
        (Some(Value::Unset), Kind::Number(range)) => range.unset.map_or("", |unset| unset.option.id).to_owned(),
        (Some(Value::Option(index)), Kind::Choice(options)) => {
            options.get(index).map_or("", |option| option.id).to_owned()
        }
        (Some(Value::Toggle(on)), _) => on.to_string(),
        _ => String::new(),
    }
}

fn number_text(settings: &Settings, parameter: &Parameter, value: f64, range: &Number) -> String {
    /// More than any value in any range needs: f32 has 9 significant decimal digits, and the least positive
    /// values of the ranges are hundredths.
    const MOST_DECIMALS: usize = 17;
    let restores = |text: &String| {
        let Ok(parsed) = text.parse() else { return false };
        let mut restored = *settings;
        parameter.set(&mut restored, Value::Number(parsed));
        parameter.number(&restored) == Some(value) && (range.min..=range.max).contains(&parsed)
    };
    let texts = (0..=MOST_DECIMALS).map(|decimals| format!("{value:.decimals$}"));
    texts.into_iter().find(restores).unwrap_or_else(|| value.to_string())
}

/// A value that a parameter does not take. Its text names the parameter and the valid values.
#[derive(Clone, Copy, Debug)]
pub struct RejectedValue<'a> {
    /// The parameter.
    pub parameter: &'static Parameter,
    /// The rejected value.
    pub value: &'a str,
    /// Reason of the rejection.
    pub reason: RejectionReason,
}

/// Reason why a parameter does not take a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RejectionReason {
    /// The value is not a number, or not a whole number where one is required.
    NotANumber,
    /// The number lies outside the parameter's range, or is NaN.
    OutOfRange,
    /// The value is not an option of the parameter.
    UnknownOption,
    /// The parameter does not exist with the value of another parameter. The text names the setting to change
    /// first.
    NotPresent(&'static str),
}

impl core::error::Error for RejectedValue<'_> {}

impl fmt::Display for RejectedValue<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { parameter, value, reason } = *self;
        match reason {
            RejectionReason::NotANumber => write!(f, "{} is {value:?}; give ", parameter.id)?,
            RejectionReason::OutOfRange => {
                write!(f, "{} is {value}, which is out of range; give ", parameter.id)?;
            }
            RejectionReason::UnknownOption => {
                write!(f, "{} is {value:?}, which is not one of its options; give ", parameter.id)?;
            }
            RejectionReason::NotPresent(reason) => return write!(f, "{} cannot be set: {reason}", parameter.id),
        }
        allowed(f, parameter)
    }
}

/// Reason why a parameter could not be set from text.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum ParameterError {
    /// No parameter has that id.
    UnknownId {
        /// The requested id.
        id: String,
    },
    /// The parameter is not part of a [`Technique`](shadowfit::Technique).
    NotOfTechnique {
        /// The requested id.
        id: String,
    },
    /// The parameter does not take the value.
    Rejected {
        /// The parameter.
        parameter: &'static Parameter,
        /// The rejected value.
        value: String,
        /// Reason of the rejection.
        reason: RejectionReason,
    },
}

impl core::error::Error for ParameterError {}

impl From<RejectedValue<'_>> for ParameterError {
    fn from(RejectedValue { parameter, value, reason }: RejectedValue<'_>) -> Self {
        Self::Rejected { parameter, value: value.to_owned(), reason }
    }
}

impl fmt::Display for ParameterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownId { id } => {
                write!(f, "there is no parameter {id:?}; there are ")?;
                list(f, PARAMETERS.iter().map(|parameter| parameter.id))
            }
            Self::NotOfTechnique { id } => {
                write!(f, "{id} is not a parameter of a technique, which has ")?;
                list(f, technique_parameters().map(|parameter| parameter.id))
            }
            Self::Rejected { parameter, value, reason } => RejectedValue { parameter, value, reason: *reason }.fmt(f),
        }
    }
}

fn allowed(f: &mut fmt::Formatter<'_>, parameter: &Parameter) -> fmt::Result {
    match &parameter.kind {
        Kind::Number(Number { min, max, decimals, unset, .. }) => {
            let whole = if *decimals == 0 { "whole " } else { "" };
            write!(f, "a {whole}number from {min} to {max}")?;
            if !parameter.unit.is_empty() {
                write!(f, " {}", parameter.unit)?;
            }
            unset.map_or(Ok(()), |unset| write!(f, ", or {}", unset.option.id))
        }
        Kind::Choice(options) => {
            f.write_str("one of ")?;
            list(f, options.iter().map(|option| option.id))
        }
        Kind::Toggle => f.write_str("true or false"),
    }
}

/// Writes words separated by commas.
fn list(f: &mut fmt::Formatter<'_>, words: impl Iterator<Item = &'static str>) -> fmt::Result {
    for (number, word) in words.enumerate() {
        f.write_str(if number == 0 { "" } else { ", " })?;
        f.write_str(word)?;
    }
    Ok(())
}
