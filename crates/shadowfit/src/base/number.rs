//! Numbers in messages, written as people write them.

use core::fmt::{self, Write};

use glam::Vec3;

/// A number with up to six significant digits: plain from 0.0001 up to a million, with an exponent
/// beyond.
pub(crate) struct Number(pub(crate) f64);

/// Significant digits that are written.
const DIGITS: usize = 6;

/// Powers of ten of the first digit that are written without an exponent.
const PLAIN: core::ops::Range<i32> = -4..6;

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = Text { bytes: [0; 32], len: 0 };
        // The formatter rounds to as many digits: d.ddddde-ddd.
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

/// Three of them.
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
