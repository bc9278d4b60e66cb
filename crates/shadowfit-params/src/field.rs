//! Access to a parameter's value: reading, setting, and writing it as Rust code.

use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::{String, ToString as _};
use alloc::vec::Vec;

use glam::UVec2;
use shadowfit::Technique;
use shadowfit::settings::{
    Edges, FitKind, Hysteresis, MapSelection, RectangleKind, Shape, SoftRadius, SplitScheme, Stabilise,
};
use shadowfit::{Cascades, Maps, SingleMap, Windows};

use crate::Value;
use crate::tool::Settings;

/// The part of the settings that a parameter edits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    /// Returns the value, angles in radians; `None` if these settings lack the part.
    pub(crate) get: fn(&Settings) -> Option<Value>,
    /// Sets a valid value, angles in radians. Does nothing if these settings lack the part.
    pub(crate) set: fn(&mut Settings, Value),
    /// The part as Rust code; `None` if it is not part of a technique.
    pub(crate) code: Option<Code>,
    /// Whether some settings lack the part.
    pub(crate) is_of_variant: bool,
}

/// A part of a technique as Rust code. Several parameters may share one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Code {
    /// Path in a [`Technique`], such as `fit.max_distance`.
    pub(crate) path: &'static str,
    /// Returns the value as a Rust expression.
    pub(crate) expression: fn(&Technique) -> String,
}

/// A value that is displayed as it is stored.
pub(crate) trait Plain {
    fn value(&self) -> Value;

    /// Takes a value of the same kind. Ignores any other.
    fn assign(&mut self, value: Value);
}

impl Plain for f32 {
    fn value(&self) -> Value {
        Value::Number(f64::from(*self))
    }

    fn assign(&mut self, value: Value) {
        if let Value::Number(number) = value {
            *self = number as Self;
        }
    }
}

impl Plain for u32 {
    fn value(&self) -> Value {
        Value::Number(f64::from(*self))
    }

    fn assign(&mut self, value: Value) {
        if let Value::Number(number) = value {
            *self = number as Self;
        }
    }
}

impl Plain for Option<u32> {
    fn value(&self) -> Value {
        self.map_or(Value::Unset, |number| number.value())
    }

    fn assign(&mut self, value: Value) {
        *self = value.number().map(|number| number as u32);
    }
}

impl Plain for Option<f32> {
    fn value(&self) -> Value {
        self.map_or(Value::Unset, |number| number.value())
    }

    fn assign(&mut self, value: Value) {
        *self = value.number().map(|number| number as f32);
    }
}

impl Plain for bool {
    fn value(&self) -> Value {
        Value::Toggle(*self)
    }

    fn assign(&mut self, value: Value) {
        if let Value::Toggle(on) = value {
            *self = on;
        }
    }
}

/// A value that can be written as Rust code.
pub(crate) trait Expression {
    fn expression(&self) -> String;
}

impl Expression for f32 {
    fn expression(&self) -> String {
        match *self {
            Self::MAX => "f32::MAX".to_owned(),
            Self::MIN => "f32::MIN".to_owned(),
            Self::INFINITY => "f32::INFINITY".to_owned(),
            Self::NEG_INFINITY => "f32::NEG_INFINITY".to_owned(),
            value if value.is_nan() => "f32::NAN".to_owned(),
            // The shortest digits that restore the same bits.
            value => format!("{value:?}"),
        }
    }
}

impl Expression for u32 {
    fn expression(&self) -> String {
        self.to_string()
    }
}

impl Expression for Option<f32> {
    fn expression(&self) -> String {
        self.map_or_else(|| "None".to_owned(), |value| format!("Some({})", value.expression()))
    }
}

impl Expression for UVec2 {
    fn expression(&self) -> String {
        format!("UVec2::new({}, {})", self.x, self.y)
    }
}

impl Expression for SplitScheme {
    fn expression(&self) -> String {
        match self {
            Self::Practical(lambda) => format!("SplitScheme::Practical({})", lambda.expression()),
            Self::Manual(ends) => format!("SplitScheme::Manual([{}])", ends.map(|end| end.expression()).join(", ")),
            _ => format!("SplitScheme::{self:?}"),
        }
    }
}

impl Expression for SoftRadius {
    fn expression(&self) -> String {
        match self {
            Self::Metres(metres) => format!("SoftRadius::Metres({})", metres.expression()),
            Self::SunAngle(radians) => format!("SoftRadius::SunAngle({})", radians.expression()),
        }
    }
}

impl Expression for Edges {
    fn expression(&self) -> String {
        format!("Edges::{self:?}")
    }
}

impl Expression for FitKind {
    fn expression(&self) -> String {
        format!("FitKind::{self:?}")
    }
}

impl Expression for RectangleKind {
    fn expression(&self) -> String {
        format!("RectangleKind::{self:?}")
    }
}

impl Expression for MapSelection {
    fn expression(&self) -> String {
        match self {
            Self::Coverage { blend } => format!("MapSelection::Coverage {{ blend: {} }}", blend.expression()),
            Self::ViewDepth { overlap } => format!("MapSelection::ViewDepth {{ overlap: {} }}", overlap.expression()),
        }
    }
}

impl Expression for Stabilise {
    fn expression(&self) -> String {
        match self {
            Self::Off => "Stabilise::Off".to_owned(),
            Self::Snap { max_oversize } => format!("Stabilise::Snap {{ max_oversize: {} }}", max_oversize.expression()),
            Self::Hysteresis(hold) => format!("Stabilise::Hysteresis({})", hold.expression()),
        }
    }
}

impl Expression for Maps {
    fn expression(&self) -> String {
        match self {
            Self::Windows(windows) => windows.expression(),
            Self::Cascades(cascades) => cascades.expression(),
            Self::Single(one) => one.expression(),
        }
    }
}

/// Implements [`Expression`] for structs: lists the fields that differ from the default, and takes the others
/// from it.
macro_rules! literals {
    ($($kind:ident { $($field:ident),+ })+) => {$(
        impl Expression for $kind {
            fn expression(&self) -> String {
                let default = Self::default();
                let fields = [$((stringify!($field), self.$field.expression(), default.$field.expression())),+];
                literal(stringify!($kind), &fields)
            }
        }
    )+};
}

literals! {
    Windows { count, blend, max_depth_oversize }
    Cascades { count, shape, splits, selection, stabilise }
    SingleMap { shape, stabilise }
    Shape { kind, rectangle, max_texel_ratio }
    Hysteresis { margin, max_growth, max_oversize, look_ahead }
}

/// Writes a struct from the names of its fields, their values and their defaults.
fn literal(kind: &str, fields: &[(&str, String, String)]) -> String {
    let mut differing: Vec<String> = fields
        .iter()
        .filter(|(_, value, default)| value != default)
        .map(|(name, value, _)| format!("{name}: {value}"))
        .collect();
    if differing.is_empty() {
        return format!("{kind}::default()");
    }
    if differing.len() < fields.len() {
        differing.push(format!("..{kind}::default()"));
    }
    format!("{kind} {{ {} }}", differing.join(", "))
}

/// Makes the Rust code of a part of a technique from its path, such as `code!(fit.max_distance)`.
macro_rules! code {
    (@path $first:ident $(.$rest:ident)*) => { concat!(stringify!($first) $(, ".", stringify!($rest))*) };
    ($first:ident $(.$rest:ident)*) => {
        Some($crate::field::Code {
            path: $crate::field::code!(@path $first $(.$rest)*),
            expression: |technique| $crate::field::Expression::expression(&technique.$first $(.$rest)*),
        })
    };
}

/// Makes a [`Field`] for a value that is displayed as it is stored:
///
/// - `field!(technique.bias.constant)`: a value that always exists;
/// - `field!(technique.maps, Maps::Windows(windows) => windows.blend)`: a value of one variant.
macro_rules! field {
    (technique $(.$path:ident)+) => {
        $crate::field::Field { code: $crate::field::code!($($path).+), ..$crate::field::field!(@ technique $(.$path)+) }
    };
    (technique $(.$path:ident)+, $variant:pat => $part:expr) => {{
        use $crate::field::Plain as _;
        $crate::field::Field {
            get: |s| match &s.technique $(.$path)+ {
                $variant => Some($part.value()),
                _ => None,
            },
            set: |s, value| {
                if let $variant = &mut s.technique $(.$path)+ {
                    $part.assign(value);
                }
            },
            code: $crate::field::code!($($path).+),
            is_of_variant: true,
        }
    }};
    ($group:ident $(.$path:ident)+) => { $crate::field::field!(@ $group $(.$path)+) };
    (@ $group:ident $(.$path:ident)+) => {{
        use $crate::field::Plain as _;
        $crate::field::Field {
            get: |s| Some(s.$group $(.$path)+.value()),
            set: |s, value| s.$group $(.$path)+.assign(value),
            code: None,
            is_of_variant: false,
        }
    }};
}

/// Makes a [`Field`] for a choice between variants, in the order of the parameter's options:
///
/// - `choice!(technique.format: MapFormat [Depth32Float, R8Grey])`: all variants of a part of a technique;
/// - `choice!(technique.maps, Maps::Single(one) => one.shape.kind in [FitKind::Sphere])`: a list of variants
///   for a value that exists in one variant only;
/// - `choice!(view.mode in ViewMode::ALL)`: a list of variants.
macro_rules! choice {
    (technique $(.$path:ident)+: $kind:ident [$($variant:ident),+ $(,)?]) => {
        $crate::field::Field {
            code: Some($crate::field::Code {
                path: $crate::field::code!(@path $($path).+),
                expression: |technique| alloc::format!(concat!(stringify!($kind), "::{:?}"), technique $(.$path)+),
            }),
            ..$crate::field::choice!(technique $(.$path)+ in [$($kind::$variant),+])
        }
    };
    (technique $(.$path:ident)+, $variant:pat => $part:ident in $variants:expr) => {
        $crate::field::Field {
            get: |s| match &s.technique $(.$path)+ {
                $variant => $variants.iter().position(|variant| variant == $part).map($crate::Value::Option),
                _ => None,
            },
            set: |s, value| {
                if let $variant = &mut s.technique $(.$path)+
                    && let $crate::Value::Option(index) = value
                    && let Some(variant) = $variants.get(index)
                {
                    *$part = *variant;
                }
            },
            code: $crate::field::code!($($path).+),
            is_of_variant: true,
        }
    };
    ($group:ident $(.$path:ident)+ in $variants:expr) => {
        $crate::field::Field {
            get: |s| $variants.iter().position(|variant| *variant == s.$group $(.$path)+).map($crate::Value::Option),
            set: |s, value| {
                if let $crate::Value::Option(index) = value
                    && let Some(variant) = $variants.get(index)
                {
                    s.$group $(.$path)+ = *variant;
                }
            },
            code: None,
            is_of_variant: false,
        }
    };
}

pub(crate) use {choice, code, field};
