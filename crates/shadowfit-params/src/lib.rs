//! All parameters of a [`Technique`] and of the [tools' settings](crate::tool) as plain data: name, unit,
//! range, help and access.
//!
//! Panels, command lines and saved files are generated from this table, so that a parameter is added, renamed
//! or given another range in one place.
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
//!     // Turns off every toggle.
//!     parameter.set(&mut settings, Value::Toggle(false));
//! }
//! ```
//!
//! Angles are degrees here and radians in the settings; lengths are metres and biases texels in both.
//!
//! The crate needs an allocator but not the standard library. [`set_value`] does not allocate.
#![no_std]

extern crate alloc;
#[cfg(test)]
extern crate std;

mod field;
mod inputs;
mod rust_code;
mod table;
mod text;

pub mod device_check;
pub mod figures;
pub mod tool;

use alloc::borrow::ToOwned;

use crate::field::Field;
use crate::tool::Settings;
use shadowfit::Technique;

pub use inputs::{BoxSource, Inputs, NAMED_INPUTS, NamedInputs};
pub use rust_code::to_rust;
pub use table::{PARAMETERS, view_option};
pub use text::{ParameterError, RejectedValue, RejectionReason, format_value, set_from_str, set_value};

/// Least ratio of the far plane and of the shadow distance to the near distance. The setting that is changed
/// wins and moves the others.
///
/// Two is exact in binary, so that a saved file restores the same bits, and no practical view has a smaller
/// depth range.
pub const MIN_FAR_PER_NEAR: f32 = 2.0;

/// One parameter of [`Settings`], with everything that tools know about it.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Stable name for files and command lines: the group's id, a dot, and the parameter's own name.
    pub id: &'static str,
    /// Group of the parameter.
    pub group: Group,
    /// Name for people, without its unit.
    pub label: &'static str,
    /// Unit of the displayed value ("texels", "m", "deg"); empty if it has none.
    pub unit: &'static str,
    /// Effect on the picture and when to change the value, in a sentence or two.
    pub help: &'static str,
    /// Kind of values that the parameter takes.
    pub kind: Kind,
    /// Access to the value.
    field: Field,
    /// Returns why the parameter has no effect under these settings, or `None` if it has one.
    pub inert: fn(&Settings) -> Option<&'static str>,
}

impl Parameter {
    /// Returns the value, which may lie outside the range if code has set it directly. `None` if the
    /// parameter does not exist under these settings: λ exists only with the practical splits, and the manual
    /// splits only with their own scheme.
    pub fn get(&self, settings: &Settings) -> Option<Value> {
        let value = (self.field.get)(settings)?;
        Some(if self.is_angle() { value.map(f64::to_degrees) } else { value })
    }

    /// Returns whether the value is shown in degrees and stored in radians.
    fn is_angle(&self) -> bool {
        self.unit.starts_with("deg")
    }

    /// Returns the value if it is a number.
    pub fn number(&self, settings: &Settings) -> Option<f64> {
        self.get(settings).and_then(Value::number)
    }

    /// Sets the value, clamping a number to the range. Ignores NaN, infinity, a value of another
    /// [kind](Self::kind), and any value while the parameter [does not exist](Self::get).
    ///
    /// The near and far planes and the shadow distance move each other, see [`MIN_FAR_PER_NEAR`].
    /// If [`Number::decimals`] is 0, the fraction is cut off.
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

    /// Returns whether the parameter has the same value in both settings.
    pub fn is_equal(&self, a: &Settings, b: &Settings) -> bool {
        self.get(a) == self.get(b)
    }

    /// Copies the parameter's value from other settings, as [`Self::set`] does.
    pub fn copy(&self, settings: &mut Settings, from: &Settings) {
        if let Some(value) = self.get(from) {
            self.set(settings, value);
        }
    }

    /// Returns whether the parameter exists only with some choices of another parameter.
    pub fn is_of_choice(&self) -> bool {
        self.field.is_of_variant
    }

    /// Returns whether the parameter [exists](Self::get) under these settings.
    pub fn is_present(&self, settings: &Settings) -> bool {
        self.get(settings).is_some()
    }
}

/// A value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number in the unit of its [`Parameter`].
    Number(f64),
    /// No number, see [`Number::unset`].
    Unset,
    /// The index of an option.
    Option(usize),
    /// On or off.
    Toggle(bool),
}

impl Value {
    /// Returns the number, if there is one.
    pub const fn number(self) -> Option<f64> {
        if let Self::Number(number) = self { Some(number) } else { None }
    }

    /// Returns the value with its number changed, if it has one.
    fn map(self, change: fn(f64) -> f64) -> Self {
        if let Self::Number(number) = self { Self::Number(change(number)) } else { self }
    }
}

/// Returns the parameters of a [`Technique`], in display order.
pub fn technique_parameters() -> impl Iterator<Item = &'static Parameter> {
    PARAMETERS.iter().filter(|parameter| parameter.group.is_technique())
}

/// Sets one parameter of a technique from text, like [`set_from_str`].
///
/// # Errors
///
/// The errors of [`set_from_str`], and [`ParameterError::NotOfTechnique`] if the parameter is not part of a
/// technique.
pub fn set_technique_from_str(technique: &mut Technique, id: &str, value: &str) -> Result<(), ParameterError> {
    if parameter(id).is_some_and(|parameter| !parameter.group.is_technique()) {
        return Err(ParameterError::NotOfTechnique { id: id.to_owned() });
    }
    let mut settings = Settings::default().with_technique(*technique);
    set_from_str(&mut settings, id, value)?;
    *technique = settings.technique;
    Ok(())
}

/// Kind of values that a parameter takes.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A number in a range, or unset.
    Number(Number),
    /// One of a few named options, in display order.
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
    /// Fine step for keys and dragging. Values between steps are allowed.
    pub step: f64,
    /// Whether a slider over the range should be logarithmic.
    pub logarithmic: bool,
    /// Displayed decimals; 0 for whole numbers.
    pub decimals: usize,
    /// Meaning of having no number; `None` if a number is required.
    pub unset: Option<Unset>,
}

/// The unset state of an optional number.
#[derive(Clone, Copy, Debug)]
pub struct Unset {
    /// Name and description of the unset state.
    pub option: ChoiceOption,
    /// Initial number when the user sets one in a panel.
    pub initial: f64,
}

/// An option of a [`Kind::Choice`].
#[derive(Clone, Copy, Debug)]
pub struct ChoiceOption {
    /// Stable name for files and command lines.
    pub id: &'static str,
    /// Name for people.
    pub label: &'static str,
    /// Effect on the picture.
    pub help: &'static str,
}

/// A group of parameters under one heading.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Group {
    /// The fit of each map.
    Fit,
    /// The number of maps and the splits between them.
    Splits,
    /// Stability of the maps while the camera moves.
    Stabilise,
    /// Contents of a shadow map, and its filter.
    Map,
    /// Width of soft filters.
    Softness,
    /// Biases against self-shadowing.
    Bias,
    /// Scene data for a fit.
    Input,
    /// The sun.
    Light,
    /// Lens and speed of the camera.
    Camera,
    /// The displayed picture.
    View,
}

impl Group {
    /// All groups, in display order.
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

    /// Returns whether the group's parameters are part of the [`Technique`]. All others belong to the tools.
    pub const fn is_technique(self) -> bool {
        !matches!(self, Self::Input | Self::Light | Self::Camera | Self::View)
    }

    /// Returns the stable name. The ids of the group's parameters begin with it and a dot.
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

    /// Returns the name for people.
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

    /// Returns the common purpose of the group's parameters, in a sentence.
    pub const fn help(self) -> &'static str {
        match self {
            Self::Fit => "Part of the scene that a shadow map covers.",
            Self::Splits => "Number of maps for the view, and the distances at which one ends and the next begins.",
            Self::Stabilise => "Whether maps keep their place while the camera moves, so that edges do not crawl.",
            Self::Map => "Size, contents and filter of a shadow map.",
            Self::Softness => "Width of shadow edges with soft filters, in metres or by the sun's size.",
            Self::Bias => {
                "Offset of the depth comparison that prevents a surface from shadowing itself. Too little leaves acne, \
                 too much detaches shadows from their casters."
            }
            Self::Input => "Scene data for the fit; an engine passes the data that it has.",
            Self::Light => "Position of the sun.",
            Self::Camera => "Lens and speed of the camera.",
            Self::View => "Views and overlays of the picture.",
        }
    }

    /// Returns the parameters of this group, in display order.
    pub fn parameters(self) -> impl Iterator<Item = &'static Parameter> {
        PARAMETERS.iter().filter(move |parameter| parameter.group == self)
    }
}

/// Returns the parameter with this id, or `None` if there is none.
pub fn parameter(id: &str) -> Option<&'static Parameter> {
    PARAMETERS.iter().find(|parameter| parameter.id == id)
}
