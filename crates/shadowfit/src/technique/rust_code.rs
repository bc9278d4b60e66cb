//! A technique as Rust code, to be pasted into an engine.
//!
//! Every struct is destructured without `..` here, so that a new field does not compile until it is
//! written too.

use core::fmt::{self, Write};

use glam::{UVec2, Vec3};

use super::Technique;
use crate::DepthConvention;
use crate::settings::{
    BiasSettings, CasterPolicy, FilterKind, FitKind, FitSettings, HoldSettings, MapChoice, MapFormat, NeedSource,
    ReceiverSource, RectangleKind, SoftRadius, Softness, SplitScheme, Stabilise,
};

impl Technique {
    /// Writes the statement `let technique = Technique { … };`, which makes this technique. Fields
    /// with their default value are left out. It needs `use shadowfit::{*, glam::{UVec2, Vec3},
    /// settings::*};`.
    ///
    /// # Errors
    ///
    /// Only those of `out`.
    pub fn write_rust(&self, out: &mut dyn Write) -> fmt::Result {
        out.write_str("let technique = ")?;
        self.write(&mut Code { out, depth: 0 })?;
        out.write_str(";\n")
    }

    /// The statement of [`Self::write_rust`].
    ///
    /// ```
    /// use shadowfit::Technique;
    /// use shadowfit::settings::FilterKind;
    ///
    /// let technique = Technique::default().with_count(3).with_filter(FilterKind::Pcf3x3);
    /// let code = "\
    /// let technique = Technique {
    ///     count: 3,
    ///     filter: FilterKind::Pcf3x3,
    ///     ..Technique::default()
    /// };
    /// ";
    /// assert_eq!(technique.to_rust(), code);
    /// ```
    #[cfg(feature = "alloc")]
    pub fn to_rust(&self) -> alloc::string::String {
        let mut code = alloc::string::String::new();
        // Writing to a string never fails.
        let _ = self.write_rust(&mut code);
        code
    }
}

/// Code that is being written.
struct Code<'a> {
    out: &'a mut dyn Write,
    /// How many brackets are open.
    depth: usize,
}

/// What can be written as an expression.
trait Expression: PartialEq {
    fn write(&self, code: &mut Code) -> fmt::Result;
}

impl<'a> Code<'a> {
    /// Begins a line inside all open brackets.
    fn line(&mut self) -> fmt::Result {
        self.out.write_str("\n")?;
        (0..self.depth).try_for_each(|_| self.out.write_str("    "))
    }

    /// A struct of which only the fields that differ from the default are written.
    fn fields<'c>(&'c mut self, name: &'static str) -> Fields<'c, 'a> {
        Fields { code: self, name, is_begun: false, is_complete: true, result: Ok(()) }
    }
}

/// A struct that is being written.
struct Fields<'c, 'a> {
    code: &'c mut Code<'a>,
    name: &'static str,
    /// Whether a field was written.
    is_begun: bool,
    /// Whether no field was left out.
    is_complete: bool,
    result: fmt::Result,
}

impl Fields<'_, '_> {
    fn field<T: Expression>(mut self, name: &str, value: &T, default: &T) -> Self {
        if value == default {
            self.is_complete = false;
        } else if self.result.is_ok() {
            self.result = self.write(name, value);
        }
        self
    }

    fn write(&mut self, name: &str, value: &impl Expression) -> fmt::Result {
        if !self.is_begun {
            write!(self.code.out, "{} {{", self.name)?;
            self.code.depth += 1;
            self.is_begun = true;
        }
        self.code.line()?;
        write!(self.code.out, "{name}: ")?;
        value.write(self.code)?;
        self.code.out.write_str(",")
    }

    fn end(self) -> fmt::Result {
        let Self { code, name, is_begun, is_complete, result } = self;
        result?;
        if !is_begun {
            return write!(code.out, "{name}::default()");
        }
        if !is_complete {
            code.line()?;
            write!(code.out, "..{name}::default()")?;
        }
        code.depth -= 1;
        code.line()?;
        code.out.write_str("}")
    }
}

impl Expression for Technique {
    fn write(&self, code: &mut Code) -> fmt::Result {
        let Self {
            count,
            fit,
            splits,
            choice,
            blend,
            overlap,
            stabilise,
            hold,
            receivers,
            filter,
            softness,
            fade,
            bias,
            need,
            format,
        } = self;
        let default = Self::default();
        code.fields("Technique")
            .field("count", count, &default.count)
            .field("fit", fit, &default.fit)
            .field("splits", splits, &default.splits)
            .field("choice", choice, &default.choice)
            .field("blend", blend, &default.blend)
            .field("overlap", overlap, &default.overlap)
            .field("stabilise", stabilise, &default.stabilise)
            .field("hold", hold, &default.hold)
            .field("receivers", receivers, &default.receivers)
            .field("filter", filter, &default.filter)
            .field("softness", softness, &default.softness)
            .field("fade", fade, &default.fade)
            .field("bias", bias, &default.bias)
            .field("need", need, &default.need)
            .field("format", format, &default.format)
            .end()
    }
}

impl Expression for FitSettings {
    fn write(&self, code: &mut Code) -> fmt::Result {
        let Self {
            kind,
            rectangle,
            max_distance,
            margin,
            border,
            casters,
            caster_extension,
            up,
            max_texel_ratio,
            least_texel,
            resolution,
            depth,
        } = self;
        let default = Self::default();
        code.fields("FitSettings")
            .field("kind", kind, &default.kind)
            .field("rectangle", rectangle, &default.rectangle)
            .field("max_distance", max_distance, &default.max_distance)
            .field("margin", margin, &default.margin)
            .field("border", border, &default.border)
            .field("casters", casters, &default.casters)
            .field("caster_extension", caster_extension, &default.caster_extension)
            .field("up", up, &default.up)
            .field("max_texel_ratio", max_texel_ratio, &default.max_texel_ratio)
            .field("least_texel", least_texel, &default.least_texel)
            .field("resolution", resolution, &default.resolution)
            .field("depth", depth, &default.depth)
            .end()
    }
}

impl Expression for HoldSettings {
    fn write(&self, code: &mut Code) -> fmt::Result {
        let Self { margin, growth, waste, horizon } = self;
        let default = Self::default();
        code.fields("HoldSettings")
            .field("margin", margin, &default.margin)
            .field("growth", growth, &default.growth)
            .field("waste", waste, &default.waste)
            .field("horizon", horizon, &default.horizon)
            .end()
    }
}

impl Expression for BiasSettings {
    fn write(&self, code: &mut Code) -> fmt::Result {
        let Self { constant, slope, normal_offset, receiver_plane, depth_steps } = self;
        let default = Self::default();
        code.fields("BiasSettings")
            .field("constant", constant, &default.constant)
            .field("slope", slope, &default.slope)
            .field("normal_offset", normal_offset, &default.normal_offset)
            .field("receiver_plane", receiver_plane, &default.receiver_plane)
            .field("depth_steps", depth_steps, &default.depth_steps)
            .end()
    }
}

impl Expression for Softness {
    fn write(&self, code: &mut Code) -> fmt::Result {
        let Self { radius, floor, ceiling } = self;
        let default = Self::default();
        code.fields("Softness")
            .field("radius", radius, &default.radius)
            .field("floor", floor, &default.floor)
            .field("ceiling", ceiling, &default.ceiling)
            .end()
    }
}

impl Expression for SoftRadius {
    fn write(&self, code: &mut Code) -> fmt::Result {
        match self {
            Self::Metres(metres) => call("SoftRadius::Metres", metres, code),
            Self::SunAngle(radians) => call("SoftRadius::SunAngle", radians, code),
        }
    }
}

impl Expression for SplitScheme {
    fn write(&self, code: &mut Code) -> fmt::Result {
        match self {
            Self::Uniform | Self::Logarithmic | Self::FromBoxes | Self::FromHistogram => {
                write!(code.out, "SplitScheme::{self:?}")
            }
            Self::Practical(lambda) => call("SplitScheme::Practical", lambda, code),
            Self::Manual(ends) => call("SplitScheme::Manual", ends, code),
        }
    }
}

/// A function or variant with one argument.
fn call(name: &str, argument: &impl Expression, code: &mut Code) -> fmt::Result {
    write!(code.out, "{name}(")?;
    argument.write(code)?;
    code.out.write_str(")")
}

impl<T: Expression> Expression for Option<T> {
    fn write(&self, code: &mut Code) -> fmt::Result {
        if let Some(value) = self { call("Some", value, code) } else { code.out.write_str("None") }
    }
}

impl<T: Expression, const N: usize> Expression for [T; N] {
    fn write(&self, code: &mut Code) -> fmt::Result {
        code.out.write_str("[")?;
        code.depth += 1;
        for value in self {
            code.line()?;
            value.write(code)?;
            code.out.write_str(",")?;
        }
        code.depth -= 1;
        code.line()?;
        code.out.write_str("]")
    }
}

impl Expression for f32 {
    fn write(&self, code: &mut Code) -> fmt::Result {
        let name = match *self {
            Self::MAX => "f32::MAX",
            Self::MIN => "f32::MIN",
            Self::INFINITY => "f32::INFINITY",
            Self::NEG_INFINITY => "f32::NEG_INFINITY",
            value if value.is_nan() => "f32::NAN",
            // The shortest digits that give the same bits.
            value => return write!(code.out, "{value:?}"),
        };
        code.out.write_str(name)
    }
}

impl Expression for u32 {
    fn write(&self, code: &mut Code) -> fmt::Result {
        write!(code.out, "{self}")
    }
}

impl Expression for UVec2 {
    fn write(&self, code: &mut Code) -> fmt::Result {
        let Self { x, y } = self;
        write!(code.out, "UVec2::new({x}, {y})")
    }
}

impl Expression for Vec3 {
    fn write(&self, code: &mut Code) -> fmt::Result {
        let [x, y, z] = self.to_array();
        code.out.write_str("Vec3::new(")?;
        x.write(code)?;
        code.out.write_str(", ")?;
        y.write(code)?;
        code.out.write_str(", ")?;
        z.write(code)?;
        code.out.write_str(")")
    }
}

/// Enums without payloads, whose variants are written as `Debug` names them.
macro_rules! plain {
    ($($name:ident),+) => {
        $(impl Expression for $name {
            fn write(&self, code: &mut Code) -> fmt::Result {
                write!(code.out, concat!(stringify!($name), "::{:?}"), self)
            }
        })+
    };
}

plain!(
    FitKind,
    RectangleKind,
    CasterPolicy,
    DepthConvention,
    MapChoice,
    Stabilise,
    ReceiverSource,
    NeedSource,
    FilterKind,
    MapFormat
);
