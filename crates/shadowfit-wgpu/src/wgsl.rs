//! WGSL for casters and receivers, assembled from the pieces in `wgsl/`. All names start with a prefix, so
//! that the text can be pasted into any shader, even for several suns.

mod culling_region;
mod fading;

use shadowfit::DepthConvention;
use shadowfit::settings::{FilterKind, MapFormat, MapSelection, Softness};

use crate::{MAX_MAPS, ShadowMapDescriptor, ShadowMapError};

pub use culling_region::CullingRegion;

/// Look-ups over the disc of [`FilterKind::Pcss`].
const PCSS_TAPS: u32 = 16;

/// Bind group and name prefix of the WGSL in an engine's shader.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WgslOptions<'a> {
    /// Bind group that the WGSL reads; any number.
    pub group: u32,
    /// Prefix of all names, before an underscore: with `sun` the function `shadowfit_factor` is called
    /// `sun_factor`, and constants begin with `SUN_`. Prefixes in one shader must differ in more than case. A
    /// prefix that is not an identifier makes the WGSL invalid; [`Self::with_prefix`] refuses it.
    pub prefix: &'a str,
}

impl WgslOptions<'_> {
    /// The default prefix.
    pub const PREFIX: &'static str = "shadowfit";

    /// Returns options with bind group `group` and the prefix `shadowfit`.
    pub const fn group(group: u32) -> Self {
        Self { group, prefix: Self::PREFIX }
    }

    /// Returns these options with another prefix: ASCII letters, digits and underscores, with a letter first.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError::Prefix`] for any other prefix.
    pub fn with_prefix(self, prefix: &str) -> Result<WgslOptions<'_>, ShadowMapError> {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if prefix.starts_with(|c: char| c.is_ascii_alphabetic()) && prefix.chars().all(is_word) {
            Ok(WgslOptions { group: self.group, prefix })
        } else {
            Err(ShadowMapError::Prefix(prefix.to_owned()))
        }
    }

    /// Returns the pieces with group, bindings and names filled in.
    pub(crate) fn fill(&self, pieces: &str, first_binding: u32) -> String {
        let mut text = pieces
            .replace("GROUP", &self.group.to_string())
            .replace("MAX_MAPS", &MAX_MAPS.to_string())
            .replace("MAX_REGION_PLANES", &CullingRegion::MAX_PLANES.to_string());
        for binding in 0..3 {
            text = text.replace(&format!("BINDING_{binding}"), &first_binding.saturating_add(binding).to_string());
        }
        if self.prefix == Self::PREFIX {
            return text;
        }
        text.replace("shadowfit_", &format!("{}_", self.prefix))
            .replace("SHADOWFIT_", &format!("{}_", self.prefix.to_ascii_uppercase()))
    }
}

/// Returns the WGSL for the shadow pass:
///
/// | function | use |
/// |---|---|
/// | `shadowfit_caster_position(position) -> vec4<f32>` | for vertex shaders: returns the clip position |
/// | `shadowfit_caster_color(depth) -> vec4<f32>` | for fragment shaders, only with colour formats: returns the colour for the [`color_target`](crate::ShadowMap::color_target), from z of `@builtin(position)` or the clamped depth |
/// | `shadowfit_caster_depth(position) -> f32` | for vertex shaders if [the fragment shader clamps](crate::ShadowMap::clamps_in_fragment): returns a varying with the default interpolation |
/// | `shadowfit_clamped_depth(depth) -> f32` | for fragment shaders in this case: returns the value for `@builtin(frag_depth)` from that varying |
///
/// `position` is in world space, metres, relative to the origin of [`crate::ShadowMap::prepare`].
///
/// It reads binding [`ShadowMapDescriptor::first_binding`] of the group. [`crate::ShadowMap::render`] and
/// [`crate::ShadowMap::begin_pass`] bind the map's [`caster_group`](crate::ShadowMap::caster_group) at the
/// group that is passed to them.
pub fn caster_wgsl(descriptor: &ShadowMapDescriptor, options: &WgslOptions<'_>) -> String {
    let color = match descriptor.format {
        MapFormat::Depth32Float | MapFormat::Depth24Unorm | MapFormat::Depth16Unorm => "",
        MapFormat::R32Float | MapFormat::R16Float | MapFormat::R8Grey => include_str!("wgsl/color_float.wgsl"),
        MapFormat::Rgba8Packed => include_str!("wgsl/color_packed.wgsl"),
    };
    options.fill(&[include_str!("wgsl/caster.wgsl"), color].concat(), descriptor.first_binding)
}

/// Returns the WGSL for shaders that cull casters:
///
/// | function | result |
/// |---|---|
/// | `shadowfit_draws_box(region, moves, min, max) -> bool` | whether a caster in a box must be drawn into a region: `region` is its number, `moves` whether the caster moves |
/// | `shadowfit_draws_sphere(region, moves, centre, radius) -> bool` | whether a caster in a sphere must be drawn |
/// | `shadowfit_draws_oriented_box(region, moves, centre, half_axes) -> bool` | whether a caster in an oriented box must be drawn; `half_axes` are the vectors from its centre to the centres of three faces |
///
/// Shapes are in world axes, in metres, relative to the origin of the frame. The functions are GPU versions
/// of the tests of [`shadowfit::CasterVolume`].
///
/// It reads a storage buffer of [`CullingRegion`]s at binding 0 of the group; see
/// [`SunShadows::culling_regions`](crate::SunShadows::culling_regions).
pub fn culling_wgsl(options: &WgslOptions<'_>) -> String {
    options.fill(include_str!("wgsl/culling.wgsl"), 0)
}

/// Returns the WGSL for shaders that light receivers, in any stage:
///
/// | function | result |
/// |---|---|
/// | `shadowfit_factor_at(position, normal, pixel) -> f32` | the filtered share of the light that reaches a point: 1 lit, 0 in shadow, 1 outside every map, and 0 everywhere while the light is [off](crate::SunShadows::turn_off). `pixel` is xy of the fragment's `@builtin(position)`. Filters with a disc of look-ups rotate the disc from pixel to pixel. Other filters ignore `pixel`. Pass half of it to rotate the disc per 2 × 2 pixels, which costs less, and is grainier |
/// | `shadowfit_factor(position, normal) -> f32` | the same share without rotating the discs, whose look-ups then show as bands instead of noise |
/// | `shadowfit_map_index(position) -> i32` | the index of the map with the greatest weight in the factor, for debug colours; -1 outside every map |
/// | `shadowfit_view_depth(position) -> f32` | the view depth in metres, for selection by view depth and for the fade: the distance from [`MapView::eye`](crate::MapView::eye) along [`MapView::forward`](crate::MapView::forward) |
///
/// `position` is in world space, metres, relative to the origin of [`crate::ShadowMap::prepare`]. `normal` is
/// the unit geometric normal of the visible side, with at least 10 bits per axis.
/// [`ShadowMapDescriptor::selection`] decides which map a point reads, by the rules of
/// [`shadowfit::selection`]. The WGSL uses two bindings from [`ShadowMapDescriptor::first_binding`] on, or
/// three for depth formats, and no derivatives. With [cross-fades](ShadowMapDescriptor::cross_fades), the
/// factor blends two sets of maps while one of them fades out.
pub fn receiver_wgsl(descriptor: &ShadowMapDescriptor, options: &WgslOptions<'_>) -> String {
    let (texture, load) = texture(descriptor.format);
    let texel = if loads_texels(descriptor) { [load, include_str!("wgsl/texel.wgsl")].concat() } else { String::new() };
    let look_up = match (descriptor.format.is_depth(), descriptor.filter) {
        (true, _) => [include_str!("wgsl/compare_depth.wgsl"), ""],
        (false, FilterKind::Point) => {
            [include_str!("wgsl/compare_float.wgsl"), include_str!("wgsl/compare_float_point.wgsl")]
        }
        (false, _) => [include_str!("wgsl/compare_float.wgsl"), include_str!("wgsl/compare_float_2x2.wgsl")],
    };
    let closer = if descriptor.depth == DepthConvention::Reversed { ">=" } else { "<=" };
    let pieces = [
        include_str!("wgsl/receiver.wgsl"),
        texture,
        &texel,
        &look_up.concat(),
        include_str!("wgsl/look_up.wgsl"),
        &filter(descriptor.filter),
        &selection(descriptor),
        include_str!("wgsl/turn.wgsl"),
        include_str!("wgsl/factor.wgsl"),
    ];
    let one_set = pieces.concat().replace("COMPARE", closer);
    let text = if descriptor.cross_fades { fading::two_sets(&one_set) } else { one_set };
    options.fill(&text, descriptor.first_binding)
}

/// Returns the WGSL for debug views of the maps. Put it after the WGSL of [`receiver_wgsl`].
/// `shadowfit_stored(map, texel) -> f32` returns the depth of a map, by its index (`i32`, as in
/// `shadowfit_map_index`), at a texel (`vec2<i32>`). Shaders of the backend [`wgpu::Backend::Gl`] cannot read
/// depth textures as numbers, and find the depth by 31 comparisons. Drivers may round the compared number to
/// the format of the map, and may return the smallest normal number instead of zero.
pub fn stored_wgsl(descriptor: &ShadowMapDescriptor, options: &WgslOptions<'_>, backend: wgpu::Backend) -> String {
    let maps = descriptor.maps.clamp(1, MAX_MAPS as u32);
    let texel_offset = |entry: u32| {
        let map = format!("shadowfit_receiver.maps[{entry}]");
        format!(
            "    if {entry}u < shadowfit_receiver.map_count && {map}.layer == layer {{\n        return {map}.texel_offset;\n    }}\n"
        )
    };
    let offsets = format!(
        "
// Returns the position of a map's first texel in its layer.
fn shadowfit_texel_offset(layer: u32) -> vec2<f32> {{
{}    return vec2<f32>(0.0);
}}
",
        (0..maps).map(texel_offset).collect::<String>()
    );
    let is_reversed = descriptor.depth == DepthConvention::Reversed;
    let compared = include_str!("wgsl/texel_compared.wgsl").replace("IS_REVERSED", &is_reversed.to_string());
    let load = match (loads_texels(descriptor), backend) {
        (true, _) => "",
        (false, wgpu::Backend::Gl) => &compared,
        (false, _) => texture(descriptor.format).1,
    };
    let one_set = [load, &offsets, include_str!("wgsl/stored.wgsl")].concat();
    let text = if descriptor.cross_fades { fading::stored(&one_set) } else { one_set };
    options.fill(&text, descriptor.first_binding)
}

/// Returns WGSL that reads the texels of layers: `shadowfit_load(layer, texel) -> f32`, after the look-up's
/// declarations.
#[cfg(feature = "rays")]
pub(crate) fn loads_wgsl(descriptor: &ShadowMapDescriptor, options: &WgslOptions<'_>) -> String {
    let (texture, load) = texture(descriptor.format);
    options.fill(&[texture, load].concat(), descriptor.first_binding)
}

/// Returns whether the look-up reads single texels.
fn loads_texels(descriptor: &ShadowMapDescriptor) -> bool {
    !descriptor.format.is_depth() || descriptor.filter == FilterKind::Pcss
}

/// Returns the WGSL that declares the texture of a format, and the WGSL that reads one of its texels.
fn texture(format: MapFormat) -> (&'static str, &'static str) {
    match format {
        MapFormat::Depth32Float | MapFormat::Depth24Unorm | MapFormat::Depth16Unorm => {
            (include_str!("wgsl/texture_depth.wgsl"), include_str!("wgsl/texel_depth.wgsl"))
        }
        MapFormat::R32Float | MapFormat::R16Float | MapFormat::R8Grey => {
            (include_str!("wgsl/texture_color.wgsl"), include_str!("wgsl/texel_float.wgsl"))
        }
        MapFormat::Rgba8Packed => (include_str!("wgsl/texture_color.wgsl"), include_str!("wgsl/texel_packed.wgsl")),
    }
}

/// Returns the WGSL of a filter, which combines several look-ups.
fn filter(filter: FilterKind) -> String {
    let disc = |taps: u32, file: &str| {
        let constants = format!(
            "const SHADOWFIT_TAPS: u32 = {taps}u;\nconst SHADOWFIT_LOOK_UP_SQUARE: f32 = {:?};\n\n",
            Softness::LOOK_UP_SQUARE
        );
        [&constants, include_str!("wgsl/disc.wgsl"), &disc_taps(taps), file].concat()
    };
    match filter {
        FilterKind::Point | FilterKind::Hardware2x2 => include_str!("wgsl/filter_single.wgsl").to_owned(),
        FilterKind::Pcf3x3 => include_str!("wgsl/filter_tent_3x3.wgsl").to_owned(),
        FilterKind::Pcf5x5 => include_str!("wgsl/filter_tent_5x5.wgsl").to_owned(),
        FilterKind::Pcf7x7 => include_str!("wgsl/filter_tent_7x7.wgsl").to_owned(),
        FilterKind::Vogel8 => disc(8, include_str!("wgsl/filter_vogel.wgsl")),
        FilterKind::Vogel16 => disc(16, include_str!("wgsl/filter_vogel.wgsl")),
        FilterKind::Vogel32 => disc(32, include_str!("wgsl/filter_vogel.wgsl")),
        FilterKind::Pcss => disc(PCSS_TAPS, include_str!("wgsl/filter_pcss.wgsl")),
    }
}

/// Returns one of several positions in the unit disc. Each is rotated from the previous one by the golden
/// angle, at radii that give each the same area (H. Vogel, "A better way to construct the sunflower head",
/// 1979).
pub(crate) fn in_disc(index: u32, count: u32) -> [f32; 2] {
    let golden = core::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    let (radius, angle) = (((f64::from(index) + 0.5) / f64::from(count)).sqrt(), f64::from(index) * golden);
    [(radius * angle.cos()) as f32, (radius * angle.sin()) as f32]
}

/// Returns WGSL with one statement per look-up over a disc, so that the positions are constants.
fn disc_taps(taps: u32) -> String {
    let tap = |index: u32| {
        let [x, y] = in_disc(index, taps);
        format!("    sum += shadowfit_disc_tap(disc, vec2<f32>({x:?}, {y:?}), projected);\n")
    };
    format!(
        "
// Returns the sum of the look-ups over a disc that lies inside its map.
fn shadowfit_disc_taps(disc: shadowfit_Disc, projected: shadowfit_Projected) -> f32 {{
    var sum = 0.0;
{}    return sum;
}}

",
        (0..taps).map(tap).collect::<String>()
    )
}

/// Returns the WGSL that selects a point's maps, and that returns a map by its index in the order. It has one
/// branch per map, because software rasterisers take twenty times as long for a loop over an array of
/// uniforms.
fn selection(descriptor: &ShadowMapDescriptor) -> String {
    let maps = descriptor.maps.clamp(1, MAX_MAPS as u32);
    let map = |entry: u32| format!("shadowfit_receiver.maps[{entry}]");
    let try_map = |entry: u32| {
        let map = map(entry);
        format!(
            "    if shadowfit_is_open(selection, {entry}, view_depth, {map}.far, {map}.blend_near) {{
        let free = shadowfit_free({entry}u, {map}, position);
        selection = shadowfit_try(selection, {entry}, view_depth, {map}.far, {map}.blend_near, free);
    }}
"
        )
    };
    let entry = |entry: u32| format!("    if entry == {entry} {{\n        return {};\n    }}\n", map(entry));
    let rule = match descriptor.selection {
        MapSelection::Coverage { .. } => include_str!("wgsl/selection_coverage.wgsl"),
        MapSelection::ViewDepth { .. } => include_str!("wgsl/selection_view_depth.wgsl"),
    };
    let (reach, blend) = (descriptor.softness.filter_radius(descriptor.filter), descriptor.selection.blend());
    format!(
        "
const SHADOWFIT_REACH: f32 = {reach:?};
const SHADOWFIT_BLEND: f32 = {blend:?};

{rule}
// Returns the maps that a point reads. There are none beyond the shadow distance.
fn shadowfit_select(position: vec3<f32>) -> shadowfit_Selection {{
    let view_depth = shadowfit_view_depth(position);
    var selection = shadowfit_Selection(-1, -1, 1.0, -1, 0.0);
{}    selection.first = select(selection.first, selection.clamped, selection.first < 0);
    if shadowfit_faded(position) >= 1.0 {{
        return shadowfit_Selection(-1, -1, 1.0, -1, 0.0);
    }}
    return selection;
}}

// Returns the map at an index in the order.
fn shadowfit_entry(entry: i32) -> shadowfit_Map {{
{}    return {};
}}
",
        (0..maps).map(try_map).collect::<String>(),
        (1..maps).map(entry).collect::<String>(),
        map(0),
    )
}
