//! How a pixel of the texture of classes is encoded.

use crate::class::Class;

/// A pixel of the texture of classes, an `R32Uint`:
///
/// | bits | what |
/// |---|---|
/// | 0 to 2 | [`Class`] as a number |
/// | 3 | the light reaches it in truth |
/// | 4 | in the edge zone |
/// | 8 to 11 | index of the map that is read, plus 1; 0 for none |
/// | 16 to 31 | log2 of pixels per texel along the worse axis, times 256, plus 32768; 65535 where no map is read |
///
/// All bits of a pixel that is not judged are 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GpuPixel {
    /// Class of the pixel.
    pub class: Class,
    /// Whether the light reaches it in truth.
    pub is_lit: bool,
    /// Whether the pixel lies in the edge zone.
    pub is_in_edge_zone: bool,
    /// Index of the map that is read. `None` where no map covers the point or the pixel is not judged.
    pub map_index: Option<u8>,
    /// Pixels per texel along the worse axis, to 0.14%. Infinite where no map is read and from 2^127
    /// on; not a number where the pixel is not judged.
    pub pixels_per_texel: f32,
}

impl GpuPixel {
    /// Decodes a pixel's bits. Bits that stand for no class are those of a pixel that is not judged.
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
            map_index: ((bits >> 8 & 15) as u8).checked_sub(1),
            pixels_per_texel: if class == Class::NotJudged { f32::NAN } else { decode_octaves((bits >> 16) as u16) },
        }
    }
}

/// Steps of an octave in the texture.
const OCTAVE: f32 = 256.0;
/// The step that stands for one pixel per texel.
const ONE: f32 = 32768.0;
/// Octaves from here on are beyond what f32 holds.
const MAX_OCTAVE: f32 = 127.0;

/// Pixels per texel from their bits.
fn decode_octaves(bits: u16) -> f32 {
    let octaves = (f32::from(bits) - ONE) / OCTAVE;
    if octaves >= MAX_OCTAVE { f32::INFINITY } else { octaves.exp2() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_decoded_as_documented() {
        let pixel = GpuPixel::from_bits(4 | 16 | (3 << 8) | ((32768 + 512) << 16));
        let wanted = GpuPixel {
            class: Class::Hole,
            is_lit: false,
            is_in_edge_zone: true,
            map_index: Some(2),
            pixels_per_texel: 4.0,
        };
        assert_eq!(pixel, wanted);
        let nothing = GpuPixel::from_bits(0);
        assert_eq!((nothing.class, nothing.map_index), (Class::NotJudged, None));
        assert!(nothing.pixels_per_texel.is_nan());
        for class in [Class::Right, Class::FalseShadow, Class::FalseLight, Class::Hole, Class::Edge] {
            assert_eq!(GpuPixel::from_bits(class as u32 | 8).class, class);
        }
    }

    #[test]
    fn pixels_per_texel_are_octaves_from_their_middle() {
        assert_eq!([32768, 33024, 32640, 65535].map(decode_octaves), [1.0, 2.0, 0.5f32.sqrt(), f32::INFINITY]);
    }
}
