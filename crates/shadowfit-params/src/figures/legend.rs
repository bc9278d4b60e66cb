//! Colours of the classes of wrong pixels, and of pixels per texel.

/// Colours of the classes of wrong pixels, as sRGB bytes: false shadow, false light, hole, edge.
///
/// Colours of M. Okabe and K. Ito ("Color universal design", 2008), which people with any one kind of colour
/// blindness can tell apart.
pub const ERROR_COLORS: [[u8; 3]; 4] = [[213, 94, 0], [86, 180, 233], [204, 121, 167], [240, 228, 66]];

/// Colours of facing pixels that the maps could not decide, as sRGB bytes: traced pixels, and pixels left to
/// the filter. From the same set.
pub const EDGE_COLORS: [[u8; 3]; 2] = [[230, 159, 0], [86, 180, 233]];

/// Pixels per texel and their colours, as sRGB bytes, one octave apart: blue where texels are finer than
/// pixels, red where they are visible, nearly white at one pixel per texel.
///
/// The diverging scale "`RdBu`" with seven classes of C. Brewer (colorbrewer2.org), reversed.
pub const PIXELS_PER_TEXEL_COLORS: [(f32, [u8; 3]); 7] = [
    (0.125, [33, 102, 172]),
    (0.25, [103, 169, 207]),
    (0.5, [209, 229, 240]),
    (1.0, [247, 247, 247]),
    (2.0, [253, 219, 199]),
    (4.0, [239, 138, 98]),
    (8.0, [178, 24, 43]),
];

/// Returns the colour of a number of pixels per texel, as sRGB bytes, interpolated between
/// [`PIXELS_PER_TEXEL_COLORS`] along the logarithm and clamped to both ends.
pub fn pixels_per_texel_color(pixels_per_texel: f32) -> [u8; 3] {
    let scale = PIXELS_PER_TEXEL_COLORS;
    let last = scale.len() - 1;
    // NaN counts as the least value.
    let place = (libm::log2f(pixels_per_texel.max(scale[0].0) / scale[0].0)).min(last as f32);
    let below = (place as usize).min(last - 1);
    let share = place - below as f32;
    let [from, to] = [scale[below].1, scale[below + 1].1];
    core::array::from_fn(|channel| {
        let [from, to] = [from, to].map(|color| f32::from(color[channel]));
        (from + (to - from) * share + 0.5) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_per_texel_take_the_colour_of_their_octave_and_stay_within_the_scale() {
        for (pixels, color) in PIXELS_PER_TEXEL_COLORS {
            assert_eq!(pixels_per_texel_color(pixels), color);
        }
        assert_eq!(pixels_per_texel_color(100.0), [178, 24, 43]);
        assert_eq!(pixels_per_texel_color(0.0), [33, 102, 172]);
        assert_eq!(pixels_per_texel_color(f32::NAN), [33, 102, 172]);
        // Half an octave above 1: halfway between [247, 247, 247] and [253, 219, 199].
        assert_eq!(pixels_per_texel_color(core::f32::consts::SQRT_2), [250, 233, 223]);
    }
}
