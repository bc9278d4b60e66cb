//! Encoding of a pixel in the texture of classes.

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
/// If a pixel is not judged, all its bits are 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GpuPixel {
    /// Class of the pixel.
    pub class: Class,
    /// Whether the light reaches the pixel in truth.
    pub is_lit: bool,
    /// Whether the pixel lies in the edge zone.
    pub is_in_edge_zone: bool,
    /// Index of the map that is read. `None` if no map covers the point or the pixel is not judged.
    pub map_index: Option<u8>,
    /// Pixels per texel along the worse axis, to 0.14%. Infinite if no map is read and for values from 2^127
    /// on; NaN if the pixel is not judged.
    pub pixels_per_texel: f32,
}

impl GpuPixel {
    /// Decodes a pixel's bits. Bits without a class decode to a pixel that is not judged.
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

    /// Encodes a pixel as the passes do, for textures that are filled from the CPU. Map indices from 15 on do
    /// not fit and are encoded as 14.
    pub fn to_bits(self) -> u32 {
        if self.class == Class::NotJudged {
            return 0;
        }
        let map = self.map_index.map_or(0, |index| u32::from(index).min(MOST_MAP_INDEX) + 1);
        let octaves = if map == 0 { NO_OCTAVES } else { encode_octaves(self.pixels_per_texel) };
        let flags = u32::from(self.is_lit) << 3 | u32::from(self.is_in_edge_zone) << 4;
        self.class as u32 | flags | map << 8 | u32::from(octaves) << 16
    }
}

/// Greatest map index that the texture can encode.
const MOST_MAP_INDEX: u32 = 14;
/// Encoding of pixels per texel if no map is read.
const NO_OCTAVES: u16 = u16::MAX;

/// Steps per octave in the texture.
const OCTAVE: f32 = 256.0;
/// Step that encodes one pixel per texel.
const ONE: f32 = 32768.0;
/// First octave that decodes to infinity, because f32 cannot hold its values.
const MAX_OCTAVE: f32 = 127.0;

/// Decodes pixels per texel.
fn decode_octaves(bits: u16) -> f32 {
    let octaves = (f32::from(bits) - ONE) / OCTAVE;
    if octaves >= MAX_OCTAVE { f32::INFINITY } else { octaves.exp2() }
}

/// Encodes pixels per texel, which must be at least 0. NaN is encoded as infinity.
fn encode_octaves(pixels_per_texel: f32) -> u16 {
    if pixels_per_texel.is_nan() {
        return NO_OCTAVES;
    }
    let steps = (pixels_per_texel.log2() * OCTAVE).round() + ONE;
    steps.clamp(0.0, f32::from(u16::MAX)) as u16
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

    #[test]
    fn what_is_encoded_is_decoded_to_the_same() {
        let pixel = GpuPixel {
            class: Class::FalseLight,
            is_lit: false,
            is_in_edge_zone: true,
            map_index: Some(3),
            pixels_per_texel: 0.125,
        };
        let others = [
            GpuPixel { class: Class::Right, is_lit: true, is_in_edge_zone: false, ..pixel },
            GpuPixel { map_index: Some(0), pixels_per_texel: f32::INFINITY, ..pixel },
            GpuPixel { map_index: None, pixels_per_texel: f32::INFINITY, ..pixel },
        ];
        for pixel in others.into_iter().chain([pixel]) {
            assert_eq!(GpuPixel::from_bits(pixel.to_bits()), pixel);
        }
        assert_eq!(pixel.to_bits(), 3 | 16 | (4 << 8) | ((32768 - 3 * 256) << 16));
        assert_eq!(GpuPixel { class: Class::NotJudged, ..pixel }.to_bits(), 0);
        let near = GpuPixel { pixels_per_texel: 7.3, ..pixel };
        let decoded = GpuPixel::from_bits(near.to_bits()).pixels_per_texel;
        assert!((decoded / 7.3 - 1.0).abs() < 0.0014, "{decoded}");
    }
}
