//! The error type of all fits, and how it writes numbers.
//!
//! Every variant carries the offending value and says what to do, since that value was usually computed far
//! from the call that reports it.

use core::fmt;
use core::fmt::Write;

use glam::{UVec2, Vec3};

use crate::base::DepthConvention;

/// Reason why a frustum or a fit failed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum FitError {
    /// An input is NaN or infinite.
    NotFinite {
        /// Name of the input.
        input: &'static str,
        /// Its value.
        value: f64,
    },
    /// A number is outside the valid range of the input, or outside the range of f32 matrices.
    OutOfRange {
        /// Name of the input.
        input: &'static str,
        /// Its value.
        value: f64,
        /// Least value accepted.
        min: f64,
        /// Greatest value accepted.
        max: f64,
    },
    /// A direction is zero, so short that its digits are lost, or so long that its square
    /// overflows f32.
    BadDirection {
        /// Name of the direction.
        input: &'static str,
        /// Its length.
        length: f64,
    },
    /// The camera's `up` is parallel to its `forward`, which leaves its roll undefined.
    ParallelUp {
        /// The camera's forward direction.
        forward: Vec3,
        /// The camera's up direction.
        up: Vec3,
    },
    /// A `world_from_clip` matrix cannot be divided by w at one of the clip corners, or maps two of them to
    /// one point. Corners up to 3 are on the near plane, the others on the far plane. The plane is at
    /// infinity if w is zero, and behind the eye if w is negative.
    SingularMatrix {
        /// Index of the corner in [`ViewFrustum::corners`](crate::ViewFrustum::corners).
        corner: usize,
        /// The w of the matrix at this corner.
        w: f64,
    },
    /// A plane of a camera's matrix leaves no view that can be shadowed.
    UnusablePlane {
        /// The plane, or planes.
        plane: &'static str,
        /// Its fault, and the remedy.
        why: &'static str,
    },
    /// The far plane is infinite and the maximum shadow distance is `f32::MAX`, so shadows would have no end.
    Endless,
    /// The depth of a perspective matrix runs opposite to the stated convention.
    OtherDepth {
        /// The stated convention.
        named: DepthConvention,
        /// Whether the matrix has reversed depth: near at 1, far at 0. If not, its depth is 0..1 or -1..1,
        /// which a matrix does not distinguish.
        is_reversed: bool,
    },
    /// The frustum has no volume, or its box in the light's axes has no extent.
    EmptyFrustum {
        /// Extent of the frustum's box, in metres: in the light's axes when a fit reports it, in
        /// the world's axes when a frustum does.
        size: Vec3,
    },
    /// The near distance is not below the far distance. A view that begins beyond a positive shadow distance
    /// is not an error of a fit: it has no shadows.
    NearNotBelowFar {
        /// Near distance, in metres.
        near: f32,
        /// Far distance, in metres.
        far: f32,
    },
    /// The input has no view.
    NoView,
    /// The caller's storage is too small; see [`Scratch::required`](crate::Scratch::required).
    ScratchTooSmall {
        /// Number of elements given.
        given: usize,
        /// Least number of elements that the call needs.
        required: usize,
    },
    /// The input's number of elements does not match the data that it belongs to.
    CountMismatch {
        /// Name of the number.
        input: &'static str,
        /// Its value.
        given: usize,
        /// The expected value.
        expected: usize,
    },
    /// A matrix is not an orthographic view-projection of the stated light.
    NotOrthographic {
        /// The fault of the matrix.
        why: &'static str,
    },
    /// The map does not lie on the world's texel grid.
    NotOnGrid,
    /// The technique has a kind of maps that this build of the crate leaves out.
    MissingFeature {
        /// The feature that adds this kind of maps.
        feature: &'static str,
    },
    /// A filter needs the distances of casters, but the maps clamp depths
    /// ([`CasterPolicy::DepthClamp`](crate::settings::CasterPolicy::DepthClamp)), which loses them.
    ClampedCasters,
    /// The shadow map has no texels.
    ZeroResolution {
        /// The requested resolution, in texels.
        resolution: UVec2,
    },
}

impl core::error::Error for FitError {}

const ENDLESS: &str = "the far plane is infinite, so shadows have no end; set a maximum shadow distance, in metres";

impl fmt::Display for FitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotFinite { input, value } => {
                write!(f, "{input} is {}; give a finite number", Number(value))
            }
            Self::OutOfRange { input, value, min, max } => {
                write!(f, "{input} is {}; give a value from {} to {}", Number(value), Number(min), Number(max))
            }
            Self::BadDirection { input, length } => {
                write!(f, "{input} has length {}; give a vector of about unit length", Number(length))
            }
            Self::ParallelUp { forward, up } => write!(
                f,
                "the camera's up {} is parallel to its forward {}; tilt one of them",
                Numbers(up),
                Numbers(forward)
            ),
            Self::SingularMatrix { corner, w } => write_singular(f, corner, w),
            Self::UnusablePlane { plane, why } => write!(f, "the camera's matrix has no usable {plane}: {why}"),
            Self::Endless => f.write_str(ENDLESS),
            Self::OtherDepth { named, is_reversed } => write_depth(f, named, is_reversed),
            Self::EmptyFrustum { size } => write_empty(f, size),
            Self::NearNotBelowFar { near, far } => write_near(f, near, far),
            Self::NoView => f.write_str("there is no view to fit to; give at least one frustum"),
            Self::ScratchTooSmall { given, required } => {
                write!(f, "the scratch memory has {given} elements and needs {required}; see Scratch::required")
            }
            Self::CountMismatch { input, given, expected } => {
                write!(f, "{input} is {given}; give {expected} as before, or rebuild")
            }
            Self::NotOrthographic { why } => {
                write!(f, "the matrix is not an orthographic view-projection of this light: {why}")
            }
            Self::NotOnGrid => f.write_str(NOT_ON_GRID),
            Self::MissingFeature { feature } => {
                write!(f, "this build of shadowfit has no {feature}; enable the feature `{feature}`")
            }
            Self::ClampedCasters => f.write_str(CLAMPED),
            Self::ZeroResolution { resolution: UVec2 { x, y } } => {
                write!(f, "the map's resolution is {x} × {y}; give at least one texel each way")
            }
        }
    }
}

const CLAMPED: &str = "the filter Pcss, and any soft filter with traced edges, needs the distance of each caster, \
                       which depth clamp loses; choose another caster policy, such as PerObject, or another filter";

const NOT_ON_GRID: &str =
    "the map is not snapped to a grid; stabilise it by snapping or hysteresis, or use the sphere fit";

fn write_empty(f: &mut fmt::Formatter<'_>, size: Vec3) -> fmt::Result {
    write!(
        f,
        "the frustum is empty: its box is {} m; check the field of view, the aspect ratio and the corners",
        Numbers(size)
    )
}

fn write_near(f: &mut fmt::Formatter<'_>, near: f32, far: f32) -> fmt::Result {
    let [near, far] = [near, far].map(|depth| Number(f64::from(depth)));
    write!(
        f,
        "near {near} m is not below far {far} m; raise the far plane or the maximum shadow distance, or lower the near \
         plane"
    )
}

fn write_singular(f: &mut fmt::Formatter<'_>, corner: usize, w: f64) -> fmt::Result {
    let plane = if corner < 4 { "near" } else { "far" };
    let place = if w == 0.0 {
        "lies at infinity"
    } else if w < 0.0 {
        "lies behind the eye"
    } else {
        "coincides with another plane"
    };
    write!(
        f,
        "the camera's {plane} plane {place}: world_from_clip gives w = {} at clip corner {corner}; pass the inverse of \
         clip_from_world, with its depth convention",
        Number(w)
    )
}

fn write_depth(f: &mut fmt::Formatter<'_>, named: DepthConvention, is_reversed: bool) -> fmt::Result {
    let (near, far) = (named.near(), named.far());
    let (has, advice) = if is_reversed {
        ("reversed depth (near 1, far 0)", "DepthConvention::Reversed")
    } else {
        ("plain depth (it grows away from the eye)", "DepthConvention::ZeroToOne, or NegativeOneToOne for OpenGL")
    };
    write!(f, "the camera's matrix has {has}, not near {near}, far {far} as stated; use {advice}")
}

/// A number written with up to six significant digits. It is plain from 0.0001 up to a million, and has an
/// exponent beyond.
pub(crate) struct Number(pub(crate) f64);

/// Number of significant digits.
const DIGITS: usize = 6;

/// Powers of ten of the first digit that need no exponent.
const PLAIN: core::ops::Range<i32> = -4..6;

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = Text { bytes: [0; 32], len: 0 };
        // The formatter rounds to this number of digits: d.ddddde-ddd.
        let written = write!(text, "{:.*e}", DIGITS - 1, self.0);
        let Some((mantissa, exponent)) = text.as_str().split_once('e').filter(|_| written.is_ok()) else {
            return write!(f, "{}", self.0); // NaN and infinity
        };
        let (sign, mantissa) = mantissa.strip_prefix('-').map_or(("", mantissa), |rest| ("-", rest));
        let significant = mantissa.trim_end_matches('0').trim_end_matches('.');
        let power: i32 = exponent.parse().map_err(|_| fmt::Error)?;
        if self.0 == 0.0 {
            return f.write_str("0");
        }
        f.write_str(sign)?;
        if !PLAIN.contains(&power) {
            return write!(f, "{significant}e{power}");
        }
        if power < 0 {
            f.write_str("0.")?;
            (1..-power).try_for_each(|_| f.write_char('0'))?;
        }
        let digits = significant.bytes().filter(u8::is_ascii_digit);
        let mut count = 0;
        for digit in digits {
            if power >= 0 && count == power + 1 {
                f.write_char('.')?;
            }
            f.write_char(char::from(digit))?;
            count += 1;
        }
        (count..=power).try_for_each(|_| f.write_char('0'))
    }
}

/// Three numbers, written as a vector.
pub(crate) struct Numbers(pub(crate) Vec3);

impl fmt::Display for Numbers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.0.to_array().map(|v| Number(f64::from(v)));
        write!(f, "({x}, {y}, {z})")
    }
}

/// Text that needs no allocator.
struct Text {
    bytes: [u8; 32],
    len: usize,
}

impl Text {
    fn as_str(&self) -> &str {
        core::str::from_utf8(&self.bytes[..self.len]).unwrap_or_default()
    }
}

impl Write for Text {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let free = self.bytes.get_mut(self.len..self.len + text.len()).ok_or(fmt::Error)?;
        free.copy_from_slice(text.as_bytes());
        self.len += text.len();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::string::ToString as _;

    use super::*;

    #[test]
    fn numbers_are_written_as_people_write_them() {
        for (number, text) in [
            (9.0, "9"),
            (0.0, "0"),
            (-0.0, "0"),
            (-1.0, "-1"),
            (0.1_f64, "0.1"),
            (f64::from(0.1_f32), "0.1"),
            (1.0 / 3.0, "0.333333"),
            (2048.0, "2048"),
            (123_456.0, "123456"),
            (999_999.4, "999999"),
            (999_999.6, "1e6"),
            (-1_234_567.0, "-1.23457e6"),
            (0.000_1, "0.0001"),
            (0.000_123_456_7, "0.000123457"),
            (0.000_012_5, "1.25e-5"),
            (1e18, "1e18"),
            (f64::from(f32::MAX), "3.40282e38"),
            (f64::MIN_POSITIVE, "2.22507e-308"),
            (12.5, "12.5"),
            (100.25, "100.25"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(Number(number).to_string(), text);
        }
        assert_eq!(Numbers(Vec3::new(0.0, -1.5, 1e-20)).to_string(), "(0, -1.5, 1e-20)");
    }
}
