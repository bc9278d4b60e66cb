//! What the texture of classes says about a pixel.

use crate::Class;

/// A pixel of the texture of classes, an `R32Uint`:
///
/// | bits | what |
/// |---|---|
/// | 0 to 2 | [`Class`] as a number |
/// | 3 | the light arrives in truth |
/// | 4 | in the edge zone |
/// | 8 to 11 | the map that is read, plus 1; 0 for none |
/// | 16 to 31 | pixels per texel along the worse axis, a half float; 65504 for more, and where no map is read |
///
/// All bits of a pixel that is not judged are 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GpuPixel {
    /// Verdict.
    pub class: Class,
    /// Whether the light arrives in truth.
    pub is_lit: bool,
    /// Whether the pixel lies in the edge zone.
    pub is_in_edge_zone: bool,
    /// The map that is read: its place among the maps.
    pub choice: Option<u8>,
    /// Pixels per texel along the worse axis, 65504 at most.
    pub pixels_per_texel: f32,
}

impl GpuPixel {
    /// Takes a pixel's bits apart. A number that is no class means a pixel that is not judged.
    pub fn from_bits(bits: u32) -> Self {
        let class = match bits & 7 {
            1 => Class::Right,
            2 => Class::FalseShadow,
            3 => Class::FalseLight,
            4 => Class::Hole,
            5 => Class::Edge,
            _ => Class::NotJudged,
        };
        Self {
            class,
            is_lit: bits & 8 != 0,
            is_in_edge_zone: bits & 16 != 0,
            choice: ((bits >> 8 & 15) as u8).checked_sub(1),
            pixels_per_texel: half((bits >> 16) as u16),
        }
    }
}

/// The value of a half float that is neither negative nor infinite.
fn half(bits: u16) -> f32 {
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), f32::from(bits & 1023));
    if exponent == 0 { fraction * (-24f32).exp2() } else { (1024.0 + fraction) * ((exponent - 25) as f32).exp2() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_taken_apart_as_documented() {
        let pixel = GpuPixel::from_bits(4 | 16 | (3 << 8) | (0x3E00 << 16));
        let wanted = GpuPixel {
            class: Class::Hole,
            is_lit: false,
            is_in_edge_zone: true,
            choice: Some(2),
            pixels_per_texel: 1.5,
        };
        assert_eq!(pixel, wanted);
        let nothing = GpuPixel::from_bits(0);
        assert_eq!((nothing.class, nothing.choice, nothing.pixels_per_texel), (Class::NotJudged, None, 0.0));
        for class in [Class::Right, Class::FalseShadow, Class::FalseLight, Class::Hole, Class::Edge] {
            assert_eq!(GpuPixel::from_bits(class as u32 | 8).class, class);
        }
    }

    #[test]
    fn halves_have_their_values() {
        assert_eq!([0x3C00, 0x7BFF, 0x0001, 0x3555].map(half), [1.0, 65504.0, 5.960_464_5e-8, 0.333_251_95]);
    }
}
