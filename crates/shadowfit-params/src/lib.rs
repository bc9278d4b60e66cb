//! Every parameter of a [`Technique`] and of the [tools' settings](crate::tool) as plain data: name,
//! unit, range, help and access.
//!
//! Panels, command lines and saved files are generated from this one table, so that a parameter is
//! added, renamed or given another range in one place.
//!
//! ```
//! use shadowfit_params::{self as params, Value};
//! use shadowfit_params::tool::Settings;
//!
//! let mut settings = Settings::default();
//! params::set_from_str(&mut settings, "light.elevation", "30").unwrap();
//! params::set_from_str(&mut settings, "fit.max_distance", "far_plane").unwrap();
//! params::set_from_str(&mut settings, "splits.count", "3").unwrap();
//! assert!(params::set_from_str(&mut settings, "map.resolution", "20").is_err());
//! for parameter in params::PARAMETERS {
//!     // Turns off all that can be turned off.
//!     parameter.set(&mut settings, Value::Toggle(false));
//! }
//! ```
//!
//! Angles are degrees here and radians in the settings; lengths are metres and biases texels in both.

mod field;
mod inputs;
mod rust_code;
mod table;
mod text;

pub mod device_check;
pub mod figures;
pub mod tool;

use crate::field::Field;
use crate::tool::Settings;
use shadowfit::Technique;

pub use inputs::{BoxSource, Inputs, NAMED_INPUTS, NamedInputs};
pub use rust_code::to_rust;
pub use table::{PARAMETERS, view_option};
pub use text::{ParameterError, format_value, set_from_str};

/// The far plane and the shadow distance are kept at this many times the near distance or more:
/// the setting that is changed wins and moves the others.
///
/// Two, because it is exact in binary, so that a saved file reads back the same bits, and because
/// no practical view has less depth than that.
pub const MIN_FAR_PER_NEAR: f32 = 2.0;

/// One parameter of [`Settings`]: all that tools know about it.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Stable name for files and command lines: the group's id, a dot, and the parameter's own
    /// name.
    pub id: &'static str,
    /// Group that it is shown in.
    pub group: Group,
    /// Name for people, without its unit.
    pub label: &'static str,
    /// Unit of the value as shown ("texels", "m", "deg"); empty when it has none.
    pub unit: &'static str,
    /// What it does to the picture and when to change it, in a sentence or two.
    pub help: &'static str,
    /// What values it takes.
    pub kind: Kind,
    /// How its value is read and set.
    field: Field,
    /// Why the parameter has no effect under these settings, or `None` when it has one.
    pub inert: fn(&Settings) -> Option<&'static str>,
}

impl Parameter {
    /// The value, as it stands: settings that were filled by hand may lie outside the range. `None` where
    /// the parameter does not exist under these settings: λ exists only while the practical splits are
    /// chosen, and the manual splits only while those are.
    pub fn get(&self, settings: &Settings) -> Option<Value> {
        let value = (self.field.get)(settings)?;
        Some(if self.is_angle() { value.map(f64::to_degrees) } else { value })
    }

    /// Whether it is shown in degrees, and so is an angle that the settings have in radians.
    fn is_angle(&self) -> bool {
        self.unit.starts_with("deg")
    }

    /// The value where it is a number.
    pub fn number(&self, settings: &Settings) -> Option<f64> {
        self.get(settings).and_then(Value::number)
    }

    /// Sets the value, a number clamped to the range. NaN, infinity and what is not of the parameter's
    /// [kind](Self::kind) are ignored, and so is any value while the parameter [does not exist](Self::get).
    ///
    /// The near and far planes and the shadow distance move each other, see [`MIN_FAR_PER_NEAR`].
    /// Where [`Number::decimals`] is 0, the fraction is cut off.
    pub fn set(&self, settings: &mut Settings, value: Value) {
        let value = match (&self.kind, value) {
            (Kind::Number(range), Value::Number(number)) if number.is_finite() => {
                Value::Number(number.max(range.min).min(range.max))
            }
            (Kind::Number(Number { unset: Some(_), .. }), Value::Unset) | (Kind::Toggle, Value::Toggle(_)) => value,
            (Kind::Choice(options), Value::Option(index)) if index < options.len() => value,
            _ => return,
        };
        if self.is_present(settings) {
            (self.field.set)(settings, if self.is_angle() { value.map(f64::to_radians) } else { value });
        }
    }

    /// Whether the parameter has the same value in both settings.
    pub fn is_equal(&self, a: &Settings, b: &Settings) -> bool {
        self.get(a) == self.get(b)
    }

    /// Sets the parameter to the value that it has in `from`, by the rules of its kind.
    pub fn copy(&self, settings: &mut Settings, from: &Settings) {
        if let Some(value) = self.get(from) {
            self.set(settings, value);
        }
    }

    /// Whether it exists only with some choices of another parameter.
    pub fn is_of_choice(&self) -> bool {
        self.field.is_of_variant
    }

    /// Whether the parameter [exists](Self::get) under these settings.
    pub fn is_present(&self, settings: &Settings) -> bool {
        self.get(settings).is_some()
    }
}

/// A value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number, in the unit of its [`Parameter`].
    Number(f64),
    /// No number, see [`Number::unset`].
    Unset,
    /// The index of an option.
    Option(usize),
    /// On or off.
    Toggle(bool),
}

impl Value {
    /// The number, where it is one.
    pub const fn number(self) -> Option<f64> {
        if let Self::Number(number) = self { Some(number) } else { None }
    }

    /// The same with its number changed, where it is one.
    fn map(self, change: fn(f64) -> f64) -> Self {
        if let Self::Number(number) = self { Self::Number(change(number)) } else { self }
    }
}

/// The parameters that make up a [`Technique`], in the order that they are shown.
pub fn technique_parameters() -> impl Iterator<Item = &'static Parameter> {
    PARAMETERS.iter().filter(|parameter| parameter.group.is_technique())
}

/// Sets one parameter of a technique from text, as [`set_from_str`] does.
///
/// # Errors
///
/// As [`set_from_str`]; [`ParameterError::NotOfTechnique`] for the id of a parameter that is not
/// part of a technique.
pub fn set_technique_from_str(technique: &mut Technique, id: &str, value: &str) -> Result<(), ParameterError> {
    if parameter(id).is_some_and(|parameter| !parameter.group.is_technique()) {
        return Err(ParameterError::NotOfTechnique { id: id.to_owned() });
    }
    let mut settings = Settings::default().with_technique(*technique);
    set_from_str(&mut settings, id, value)?;
    *technique = settings.technique;
    Ok(())
}

/// What values a parameter takes.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A number in a range, or no number.
    Number(Number),
    /// One of a few named options, in the order that they are shown.
    Choice(&'static [ChoiceOption]),
    /// On or off.
    Toggle,
}

/// A range of numbers, in the unit of their [`Parameter`].
#[derive(Clone, Copy, Debug)]
pub struct Number {
    /// Least value.
    pub min: f64,
    /// Greatest value.
    pub max: f64,
    /// A fine step for keys and dragging; not a grid, values between steps are kept.
    pub step: f64,
    /// Whether a slider over the range should be logarithmic.
    pub logarithmic: bool,
    /// Decimals worth showing; 0 for whole numbers.
    pub decimals: usize,
    /// Whether there need be no number, and what that means.
    pub unset: Option<Unset>,
}

/// A number that need not be there.
#[derive(Clone, Copy, Debug)]
pub struct Unset {
    /// Name and description of having no number.
    pub option: ChoiceOption,
    /// The number that a panel starts from when one is asked for.
    pub initial: f64,
}

/// An option of a [`Kind::Choice`].
#[derive(Clone, Copy, Debug)]
pub struct ChoiceOption {
    /// Stable name for files and command lines.
    pub id: &'static str,
    /// Name for people.
    pub label: &'static str,
    /// What it does to the picture.
    pub help: &'static str,
}

/// A group of parameters, shown under one heading.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// How each map is fitted.
    Fit,
    /// How many maps there are, and where one ends and the next begins.
    Splits,
    /// What keeps the maps stable while the camera moves.
    Stabilise,
    /// What a shadow map stores and how it is read.
    Map,
    /// How wide soft filters are.
    Softness,
    /// Biases against self-shadowing.
    Bias,
    /// What of the scene a fit is given.
    Input,
    /// The sun.
    Light,
    /// Lens and speed of the camera.
    Camera,
    /// What is drawn.
    View,
}

impl Group {
    /// All groups, in the order that they are shown.
    pub const ALL: [Self; 10] = [
        Self::Fit,
        Self::Splits,
        Self::Stabilise,
        Self::Map,
        Self::Softness,
        Self::Bias,
        Self::Input,
        Self::Light,
        Self::Camera,
        Self::View,
    ];

    /// Whether its parameters are part of the [`Technique`]; the others belong to the tools.
    pub const fn is_technique(self) -> bool {
        !matches!(self, Self::Input | Self::Light | Self::Camera | Self::View)
    }

    /// Stable name; the ids of the group's parameters begin with it and a dot.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Fit => "fit",
            Self::Splits => "splits",
            Self::Stabilise => "stabilise",
            Self::Map => "map",
            Self::Softness => "softness",
            Self::Bias => "bias",
            Self::Input => "input",
            Self::Light => "light",
            Self::Camera => "camera",
            Self::View => "view",
        }
    }

    /// Name for people.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Fit => "Fit",
            Self::Splits => "Maps and splits",
            Self::Stabilise => "Stabilise",
            Self::Map => "Shadow map",
            Self::Softness => "Soft edges",
            Self::Bias => "Bias",
            Self::Input => "Input",
            Self::Light => "Light",
            Self::Camera => "Camera",
            Self::View => "View",
        }
    }

    /// What the group's parameters have in common, in a sentence.
    pub const fn help(self) -> &'static str {
        match self {
            Self::Fit => "Which part of the scene a shadow map covers.",
            Self::Splits => "How many maps share the view, and at which distances one ends and the next begins.",
            Self::Stabilise => "Whether maps stay where they are while the camera moves, so that edges do not crawl.",
            Self::Map => "How large a shadow map is, what it stores and how it is read.",
            Self::Softness => "How wide the edges of shadows are with filters whose width is no number of texels.",
            Self::Bias => {
                "How far the comparison is moved so that a surface does not shadow itself. Too little leaves \
                 acne, too much detaches shadows from their casters."
            }
            Self::Input => "What a fit is told of the scene: an engine hands in what it has.",
            Self::Light => "Where the sun stands.",
            Self::Camera => "The lens and the speed of the camera.",
            Self::View => "What is drawn over or instead of the picture.",
        }
    }

    /// The parameters of this group, in the order that they are shown.
    pub fn parameters(self) -> impl Iterator<Item = &'static Parameter> {
        PARAMETERS.iter().filter(move |parameter| parameter.group == self)
    }
}

/// The parameter of that id, or `None` when there is none.
pub fn parameter(id: &str) -> Option<&'static Parameter> {
    PARAMETERS.iter().find(|parameter| parameter.id == id)
}
