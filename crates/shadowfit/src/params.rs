//! Every parameter of a [`Technique`] and of the [tools' settings](crate::tool) as plain data: name,
//! unit, range, help and access.
//!
//! Panels, command lines and saved files are generated from this one table, so that a parameter is
//! added, renamed or given another range in one place.
//!
//! ```
//! use shadowfit::params::{self, Kind};
//! use shadowfit::tool::Settings;
//!
//! let mut settings = Settings::default();
//! params::set_from_str(&mut settings, "light.elevation", "30").unwrap();
//! params::set_from_str(&mut settings, "fit.max_distance", "far_plane").unwrap();
//! params::set_from_str(&mut settings, "splits.count", "3").unwrap();
//! assert!(params::set_from_str(&mut settings, "map.resolution", "20").is_err());
//! for parameter in params::PARAMETERS {
//!     if let Kind::Toggle(toggle) = &parameter.kind {
//!         toggle.set(&mut settings, false);
//!     }
//! }
//! ```
//!
//! Angles are degrees here and radians in the settings; lengths are metres and biases texels in both.

mod table;
mod text;

use crate::Technique;
use crate::tool::Settings;

pub use table::PARAMETERS;
pub use text::{ParameterError, format_value, set_from_str};

/// The far plane and the shadow distance are kept at this many times the near distance or more:
/// the setting that is changed wins and moves the others.
///
/// Two, because it is exact in binary, so that a saved file reads back the same bits, and because
/// no practical view has less depth than that.
pub const MIN_FAR_PER_NEAR: f32 = 2.0;

/// One parameter of [`Settings`].
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
    /// Range or options, and access to the value.
    pub kind: Kind,
    /// Why the parameter has no effect under these settings, or `None` when it has one.
    pub inert: fn(&Settings) -> Option<&'static str>,
}

impl Parameter {
    /// Whether the parameter has the same value in both settings.
    pub fn is_equal(&self, a: &Settings, b: &Settings) -> bool {
        match &self.kind {
            Kind::Number(number) => number.get(a) == number.get(b),
            Kind::Optional(optional) => optional.get(a) == optional.get(b),
            Kind::Choice(choice) => choice.get(a) == choice.get(b),
            Kind::Toggle(toggle) => toggle.get(a) == toggle.get(b),
        }
    }

    /// Sets the parameter to the value that it has in `from`, by the rules of its kind.
    pub fn copy(&self, settings: &mut Settings, from: &Settings) {
        match &self.kind {
            Kind::Number(number) => number.set(settings, number.get(from)),
            Kind::Optional(optional) => optional.set(settings, optional.get(from)),
            Kind::Choice(choice) => choice.set(settings, choice.get(from)),
            Kind::Toggle(toggle) => toggle.set(settings, toggle.get(from)),
        }
    }

    /// Whether the parameter exists under these settings: λ exists only while the practical splits are
    /// chosen, the manual splits only while those are, and a single map's own height only while it has
    /// a width of its own. Setting a parameter that does not exist changes nothing.
    pub fn is_present(&self, settings: &Settings) -> bool {
        match &self.kind {
            Kind::Optional(optional) => (optional.present)(settings),
            Kind::Number(_) | Kind::Choice(_) | Kind::Toggle(_) => true,
        }
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
pub fn set_technique_from_str<'a>(
    technique: &mut Technique,
    id: &'a str,
    value: &'a str,
) -> Result<(), ParameterError<'a>> {
    if parameter(id).is_some_and(|parameter| !parameter.group.is_technique()) {
        return Err(ParameterError::NotOfTechnique { id });
    }
    let mut settings = Settings::default().with_technique(*technique);
    set_from_str(&mut settings, id, value)?;
    *technique = settings.technique;
    Ok(())
}

/// What values a parameter takes.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    /// A number in a range.
    Number(Number),
    /// A number in a range, or no value.
    Optional(Optional),
    /// One of a few named options.
    Choice(Choice),
    /// On or off.
    Toggle(Toggle),
}

/// A number in a range, in the unit of its [`Parameter`].
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
    read: fn(&Settings) -> f64,
    write: fn(&mut Settings, f64),
}

impl Number {
    /// The value, as it stands: settings that were filled by hand may lie outside the range.
    pub fn get(&self, settings: &Settings) -> f64 {
        (self.read)(settings)
    }

    /// Sets the value, clamped to the range; NaN and infinity are ignored.
    ///
    /// The near and far planes and the shadow distance move each other, see [`MIN_FAR_PER_NEAR`].
    /// Where [`Self::decimals`] is 0, the fraction is cut off.
    pub fn set(&self, settings: &mut Settings, value: f64) {
        if value.is_finite() {
            (self.write)(settings, value.max(self.min).min(self.max));
        }
    }
}

/// A number in a range, or no value.
#[derive(Clone, Copy, Debug)]
pub struct Optional {
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
    /// Name and description of having no value. `None` where only another parameter removes the
    /// value, see [`Parameter::is_present`].
    pub unset: Option<ChoiceOption>,
    /// The number that a panel starts from when the value is turned on.
    pub initial: f64,
    present: fn(&Settings) -> bool,
    read: fn(&Settings) -> Option<f64>,
    write: fn(&mut Settings, Option<f64>),
}

impl Optional {
    /// The value, as it stands: settings that were filled by hand may lie outside the range.
    pub fn get(&self, settings: &Settings) -> Option<f64> {
        (self.read)(settings)
    }

    /// Sets the value, clamped to the range, or removes it. NaN and infinity are ignored, and so is
    /// any value while the parameter [does not exist](Parameter::is_present).
    ///
    /// The near and far planes and the shadow distance move each other, see
    /// [`MIN_FAR_PER_NEAR`].
    pub fn set(&self, settings: &mut Settings, value: Option<f64>) {
        if (self.present)(settings) && value.is_none_or(f64::is_finite) {
            (self.write)(settings, value.map(|value| value.max(self.min).min(self.max)));
        }
    }
}

/// One of a few named options.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// The options, in the order that they are shown.
    pub options: &'static [ChoiceOption],
    read: fn(&Settings) -> usize,
    write: fn(&mut Settings, usize),
}

impl Choice {
    /// Index of the current option.
    pub fn get(&self, settings: &Settings) -> usize {
        (self.read)(settings)
    }

    /// Sets the option; an index beyond the last is ignored.
    pub fn set(&self, settings: &mut Settings, index: usize) {
        if index < self.options.len() {
            (self.write)(settings, index);
        }
    }
}

/// An option of a [`Choice`].
#[derive(Clone, Copy, Debug)]
pub struct ChoiceOption {
    /// Stable name for files and command lines.
    pub id: &'static str,
    /// Name for people.
    pub label: &'static str,
    /// What it does to the picture.
    pub help: &'static str,
}

/// On or off.
#[derive(Clone, Copy, Debug)]
pub struct Toggle {
    read: fn(&Settings) -> bool,
    write: fn(&mut Settings, bool),
}

impl Toggle {
    /// Whether it is on.
    pub fn get(&self, settings: &Settings) -> bool {
        (self.read)(settings)
    }

    /// Turns it on or off.
    pub fn set(&self, settings: &mut Settings, on: bool) {
        (self.write)(settings, on);
    }
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
    /// The sun.
    Light,
    /// Lens and speed of the camera.
    Camera,
    /// What is drawn.
    View,
}

impl Group {
    /// All groups, in the order that they are shown.
    pub const ALL: [Self; 9] = [
        Self::Fit,
        Self::Splits,
        Self::Stabilise,
        Self::Map,
        Self::Softness,
        Self::Bias,
        Self::Light,
        Self::Camera,
        Self::View,
    ];

    /// Whether its parameters are part of the [`Technique`]; the others belong to the tools.
    pub const fn is_technique(self) -> bool {
        !matches!(self, Self::Light | Self::Camera | Self::View)
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
