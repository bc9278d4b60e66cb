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
/// | 16 to 31 | log2 of pixels per texel along the worse axis, times 256, plus 32768; 65535 where no map is read |
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
    /// Pixels per texel along the worse axis, to 0.14%; infinite where none is read or from 2^127 on,
    /// and not a number where the pixel is not judged.
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
            pixels_per_texel: if class == Class::NotJudged { f32::NAN } else { footprint((bits >> 16) as u16) },
        }
    }
}

/// Steps of an octave in the texture.
const OCTAVE: f32 = 256.0;
/// The step that stands for one pixel per texel.
const ONE: f32 = 32768.0;
/// The last octave: no more than f32 holds.
const MOST_OCTAVE: f32 = 127.0;

/// Pixels per texel from their bits.
fn footprint(bits: u16) -> f32 {
    let octaves = (f32::from(bits) - ONE) / OCTAVE;
    if octaves >= MOST_OCTAVE { f32::INFINITY } else { octaves.exp2() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_taken_apart_as_documented() {
        let pixel = GpuPixel::from_bits(4 | 16 | (3 << 8) | ((32768 + 512) << 16));
        let wanted = GpuPixel {
            class: Class::Hole,
            is_lit: false,
            is_in_edge_zone: true,
            choice: Some(2),
            pixels_per_texel: 4.0,
        };
        assert_eq!(pixel, wanted);
        let nothing = GpuPixel::from_bits(0);
        assert_eq!((nothing.class, nothing.choice), (Class::NotJudged, None));
        assert!(nothing.pixels_per_texel.is_nan());
        for class in [Class::Right, Class::FalseShadow, Class::FalseLight, Class::Hole, Class::Edge] {
            assert_eq!(GpuPixel::from_bits(class as u32 | 8).class, class);
        }
    }

    #[test]
    fn footprints_are_octaves_from_their_middle() {
        assert_eq!([32768, 33024, 32640, 65535].map(footprint), [1.0, 2.0, 0.5f32.sqrt(), f32::INFINITY]);
    }
}
