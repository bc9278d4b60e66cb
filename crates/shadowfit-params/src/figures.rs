//! The live figures of a tool as plain numbers, filled in by the measuring code, and the colours of maps,
//! errors and pixels per texel in pictures, legends and tables.

mod legend;

use glam::Vec3;
use shadowfit::BoundSource;
use shadowfit::FittedMap;
use shadowfit::diagnostics::{DepthRounding, depth_rounding};
use shadowfit::settings::{MAX_MAPS, MapFormat};

pub use legend::{EDGE_COLORS, ERROR_COLORS, PIXELS_PER_TEXEL_COLORS, pixels_per_texel_color};

/// Tints of the maps, the nearest first, as sRGB bytes of red, green and blue.
///
/// The colours of M. Okabe and K. Ito ("Color universal design", 2008), which people with any one kind of
/// colour blindness can tell apart. Grey replaces their black, which would hide the picture. The order keeps
/// neighbours, and the first four, as different as possible for all of them.
pub const MAP_TINTS: [[u8; 3]; MAX_MAPS] = [
    [213, 94, 0],
    [0, 114, 178],
    [204, 121, 167],
    [240, 228, 66],
    [0, 158, 115],
    [230, 159, 0],
    [86, 180, 233],
    [187, 187, 187],
];

/// Returns [`MAP_TINTS`] as linear red, green and blue, 0..=1, for shaders.
pub fn linear_map_tints() -> [Vec3; MAX_MAPS] {
    MAP_TINTS.map(linear_color)
}

/// Returns a colour of sRGB bytes as linear red, green and blue, 0..=1, for shaders.
pub fn linear_color(srgb: [u8; 3]) -> Vec3 {
    Vec3::from(srgb.map(|byte| linear(f32::from(byte) / 255.0)))
}

/// Applies the sRGB transfer function (IEC 61966-2-1) to an encoded value, 0..=1, and returns the linear
/// value, 0..=1.
fn linear(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { libm::powf((encoded + 0.055) / 1.055, 2.4) }
}

/// Live figures of one frame. `None` means not measured, never zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// Figures of the maps, the nearest first; `None` for missing maps.
    pub maps: [Option<MapFigures>; MAX_MAPS],
    /// Index of the map that the picture's centre reads, 0..8.
    pub map_ahead: Option<u32>,
    /// Screen pixels per texel of that map, along the worse axis, at the picture's centre.
    pub pixels_per_texel: Option<f32>,
    /// Time of a whole frame, in milliseconds.
    pub frame_ms: Option<f32>,
    /// GPU time of the shadow passes of all maps, in milliseconds.
    pub shadow_pass_ms: Option<f32>,
    /// GPU time of the scene pass, in milliseconds.
    pub scene_pass_ms: Option<f32>,
    /// GPU time of the edge passes, in milliseconds; also `None` if edges are filtered.
    pub edges_ms: Option<f32>,
    /// Pixels whose edges were traced, in per cent of the facing pixels within the shadow distance, 0..=100;
    /// also `None` if edges are filtered.
    pub traced: Option<f32>,
    /// Draw calls of the shadow passes of all maps.
    pub shadow_draws: Option<u32>,
    /// Triangles drawn into all maps.
    pub shadow_triangles: Option<u64>,
    /// Texels of the maps that were drawn in this frame, without kept texels.
    pub shadow_texels: Option<u64>,
    /// GPU time of judging the picture against rays, in milliseconds: the probe pass, and the judging passes
    /// if the GPU judges.
    pub judge_ms: Option<f32>,
    /// The last picture that was judged against rays.
    pub judged: Option<JudgedFigures>,
    /// The same for the other technique of a comparison.
    pub judged_other: Option<JudgedFigures>,
}

/// Figures of a picture that was judged against rays. Shares are in per cent, 0..=100, of the facing pixels
/// within the shadow distance; `None` means not measured, never zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JudgedFigures {
    /// Pixels whose verdict, lit or not, differs from the truth, edges included.
    pub wrong: f32,
    /// Lit in truth and dark in the picture, away from edges: acne.
    pub false_shadow: f32,
    /// Dark in truth and lit in the picture, away from edges, though the caster is in the map.
    pub false_light: f32,
    /// Dark in truth and lit in the picture, because the caster is not in the map.
    pub hole: f32,
    /// Wrong within the zone around true edges that the map's texels explain: aliasing.
    pub edge: f32,
    /// Error of the sunlight, in per cent of the sunlight without shadows: the mean of |factor − truth| · N·L divided by
    /// the mean of N·L.
    pub light_error: f32,
    /// Mean ꟻLIP error of the shaded picture against the same picture with true shadows, 0 to 1.
    pub flip: Option<f32>,
    /// Pixels that no map covers.
    pub uncovered: f32,
    /// Quantiles 50%, 95% and 99% of the pixels per texel along the worse axis.
    pub pixels_per_texel: Option<[f32; 3]>,
    /// Pixels near edges whose verdict changed only because the maps changed, in per cent of the compared
    /// pixels.
    pub crawl: Option<f32>,
    /// How long ago the picture was drawn, in seconds.
    pub age: f32,
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
}

/// Live figures of one map. `None` means not measured, never zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MapFigures {
    /// Range of view depths of this map, in metres. Maps that are read by view depth are selected by it.
    /// `None` without such a range, as for a [window](shadowfit::Windows).
    pub view_depths: Option<[f32; 2]>,
    /// Width and height of the map's area across the light, in metres.
    pub extent: [f32; 2],
    /// Causes of the planes -x, +x, -y, +y, far and near of the map's box, see
    /// [`LightProjection::bounds_from`](shadowfit::LightProjection::bounds_from).
    pub bounds_from: [BoundSource; 6],
    /// Whether no receiver is in view, see [`LightProjection::is_empty`](shadowfit::LightProjection::is_empty).
    pub is_empty: bool,
    /// Size of one texel across the light, in metres, along u and v.
    pub texel_size: [f32; 2],
    /// Extent of the map along the light, in metres.
    pub depth_range: f32,
    /// The map's constant bias compared with the rounding of its depths, in metres.
    pub rounding: DepthRounding,
    /// Casters after culling.
    pub casters: Option<u32>,
    /// Draw calls of the map's shadow pass.
    pub draws: Option<u32>,
    /// Triangles drawn into the map.
    pub triangles: Option<u64>,
    /// Texels of the map that were drawn in this frame.
    pub texels: Option<u64>,
    /// GPU time of the map's shadow passes, in milliseconds.
    pub pass_ms: Option<f32>,
    /// Share of the map's area outside the part that it serves, 0..=1.
    pub waste: Option<f32>,
}

impl MapFigures {
    /// Returns the figures of a fitted map that is stored in `format`, with nothing drawn yet. `end` is the
    /// view depth at which shadows end, in metres, since the last map has no end of its own.
    pub fn new(map: &FittedMap, end: f32, format: MapFormat) -> Self {
        let FittedMap { projection: fit, bias, depths, .. } = map;
        let view_depths = depths.map(|range| [range.near as f32, range.far.map_or(end, |far| end.min(far as f32))]);
        let is_window = fit.bounds_from[0] == BoundSource::Window;
        Self {
            view_depths: view_depths.filter(|[near, far]| near < far && !is_window),
            extent: (fit.texel_size * fit.resolution.as_vec2()).to_array(),
            bounds_from: fit.bounds_from,
            is_empty: fit.is_empty,
            texel_size: fit.texel_size.to_array(),
            depth_range: fit.depth_range,
            rounding: depth_rounding(fit, bias, format),
            casters: None,
            draws: None,
            triangles: None,
            texels: None,
            pass_ms: None,
            waste: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{UVec2, Vec2};

    use super::*;
    use shadowfit::selection::DepthRange;
    use shadowfit::{Bias, LightProjection};

    #[test]
    fn tints_are_linear_by_the_srgb_curve() {
        let tints = linear_map_tints();
        // Exact values of the curve for the bytes 0, 94 and 213.
        for (value, expected) in tints[0].to_array().into_iter().zip([0.665_387_3, 0.111_932_4, 0.0]) {
            assert!((value - expected).abs() < 1e-6, "{value} is not {expected}");
        }
        assert_eq!(linear(1.0), 1.0);
    }

    #[test]
    fn the_last_map_ends_with_the_shadows_and_an_empty_one_has_no_depths() {
        let figures = |depths: Option<DepthRange>| {
            MapFigures::new(&FittedMap { depths, ..FittedMap::default() }, 80.0, MapFormat::default())
        };
        assert_eq!(figures(Some(DepthRange::new(0.5, Some(5.0)))).view_depths, Some([0.5, 5.0]));
        assert_eq!(figures(Some(DepthRange::new(40.0, None))).view_depths, Some([40.0, 80.0]));
        assert_eq!(figures(Some(DepthRange::new(80.0, None))).view_depths, None);
        assert_eq!(figures(None).view_depths, None);
    }

    #[test]
    fn a_window_has_an_extent_and_no_view_depths() {
        let map = |bounds_from| {
            let (texel_size, resolution) = (Vec2::new(0.5, 0.25), UVec2::new(8, 12));
            let fit =
                LightProjection { bounds_from: [bounds_from; 6], texel_size, resolution, ..LightProjection::default() };
            let map = FittedMap::new(fit, Bias::default()).with_depths(DepthRange::new(1.0, Some(9.0)));
            MapFigures::new(&map, 80.0, MapFormat::default())
        };
        let (window, other) = (map(BoundSource::Window), map(BoundSource::View));
        assert_eq!((window.view_depths, window.extent), (None, [4.0, 3.0]));
        assert_eq!((other.view_depths, other.extent), (Some([1.0, 9.0]), [4.0, 3.0]));
    }
}
