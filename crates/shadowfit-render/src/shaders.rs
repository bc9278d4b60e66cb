//! The shader modules, composed of the pieces in `shaders/` and the shadow map's own WGSL.

use core::fmt::Write as _;

use shadowfit_params::figures::{EDGE_COLORS, ERROR_COLORS, PIXELS_PER_TEXEL_COLORS, linear_color};
use shadowfit_wgpu::exact_edges::exact_factor_wgsl;
use shadowfit_wgpu::{ShadowMapDescriptor, WgslOptions, caster_wgsl, receiver_wgsl, stored_wgsl};

use crate::Overlay;
use crate::unrolled::Numbering;

/// Bind group of the map's matrix in the shadow pass.
pub const CASTER_GROUP: u32 = 0;

/// Bind group of the frame, and the binding of the picture's factors in it.
const FRAME_GROUP: u32 = 0;
const FACTORS_BINDING: u32 = 1;

/// Bind group of the shadow map in the shaded pass.
pub const SHADOW_GROUP: u32 = 1;

/// Inputs of a frame's shaders: [`FrameUniform`](crate::FrameUniform) in group 0, with the tone curve.
pub const FRAME: &str = concat!(
    include_str!("shaders/powers.wgsl"),
    include_str!("shaders/tone_map.wgsl"),
    include_str!("shaders/frame.wgsl")
);
/// Powers by squaring.
pub const POWERS: &str = include_str!("shaders/powers.wgsl");
/// The sRGB transfer function and its inverse.
pub const SRGB: &str = include_str!("shaders/srgb.wgsl");
/// The tone curve.
pub const TONE_MAP: &str = include_str!("shaders/tone_map.wgsl");
/// Reflectance of a surface; needs [`POWERS`].
pub const REFLECTANCE: &str = include_str!("shaders/reflectance.wgsl");
const MATERIAL: &str = include_str!("shaders/material.wgsl");
const OVERLAY: &str = include_str!("shaders/overlay.wgsl");
const JUDGED: &str = include_str!("shaders/judged.wgsl");
const MARK: &str = include_str!("shaders/mark.wgsl");
/// The vertex stage of passes that fill a picture.
pub const SCREEN: &str = include_str!("shaders/screen.wgsl");

/// Returns the sky pass.
pub fn sky() -> String {
    [FRAME, include_str!("shaders/sky.wgsl")].concat()
}

/// Returns the shadow pass: group 0 is the shadow map's, group 1 the material's.
pub fn caster(shadow_map: &ShadowMapDescriptor) -> String {
    let color = if shadow_map.format.is_depth() { "" } else { include_str!("shaders/caster_color.wgsl") };
    let shadow_map = caster_wgsl(shadow_map, &WgslOptions::group(CASTER_GROUP));
    [&shadow_map, &material(1), include_str!("shaders/caster.wgsl"), color].concat()
}

/// Returns the shaded pass: frame, shadow map and material are groups 0, 1 and 2.
pub fn scene(shadow_map: &ShadowMapDescriptor) -> String {
    [
        FRAME,
        &receiver_wgsl(shadow_map, &WgslOptions::group(SHADOW_GROUP)),
        &exact_factor_wgsl(&WgslOptions::group(FRAME_GROUP), FACTORS_BINDING),
        &material(2),
        REFLECTANCE,
        include_str!("shaders/scene.wgsl"),
    ]
    .concat()
}

/// Returns the probe pass, with the groups of the shaded pass.
pub fn probe(shadow_map: &ShadowMapDescriptor, numbering: Numbering) -> String {
    let entries = match numbering {
        Numbering::Primitives => include_str!("shaders/probe_primitive.wgsl"),
        Numbering::Vertices => include_str!("shaders/probe_vertex.wgsl"),
    };
    [numbering.directive(), &scene(shadow_map), include_str!("shaders/probe.wgsl"), entries].concat()
}

/// Returns the pass that draws surfaces for tracing edges, with the groups of the shaded pass.
pub fn surfaces(shadow_map: &ShadowMapDescriptor) -> String {
    [&scene(shadow_map), include_str!("shaders/surfaces.wgsl")].concat()
}

/// Returns the pass that clears a part of a picture.
pub fn clear() -> String {
    [SCREEN, include_str!("shaders/clear.wgsl")].concat()
}

/// Returns the pass that encodes a picture: its linear colours are group 0.
pub fn encode() -> String {
    [SCREEN, SRGB, include_str!("shaders/encode.wgsl")].concat()
}

/// Returns the pass that draws world-space lines.
pub fn lines() -> String {
    [FRAME, include_str!("shaders/lines.wgsl")].concat()
}

/// Returns the shaded pass of an overlay, with its groups. A judged picture is group 3.
pub fn overlay(shadow_map: &ShadowMapDescriptor, overlay: Overlay) -> String {
    let judged = if overlay.is_judged() { in_group(JUDGED, 3) + &error_colors() } else { String::new() };
    let colors = match overlay {
        Overlay::PixelsPerTexel => octave_color(),
        Overlay::Traced => edge_colors(),
        _ => String::new(),
    };
    [&scene(shadow_map), OVERLAY, &judged, &colors, overlay.wgsl()].concat()
}

/// Returns a material's textures and colours, with bindings in a group.
pub fn material(group: u32) -> String {
    MATERIAL.replace("MATERIAL_GROUP", &group.to_string())
}

/// Returns a piece with its bindings in a group.
pub fn in_group(piece: &str, group: u32) -> String {
    piece.replace("GROUP", &group.to_string())
}

/// Returns the linear colour of a class of wrong pixels.
fn error_colors() -> String {
    by_number("error_color", "Linear colour of a class of wrong pixels.", (2..).zip(ERROR_COLORS))
}

/// Returns the linear colour of pixels that were traced, 0, or left to the filter, 1.
fn edge_colors() -> String {
    by_number("edge_color", "Linear colour of pixels that were traced, or left to the filter.", (0..).zip(EDGE_COLORS))
}

/// Returns a function that maps numbers to linear colours, and other numbers to black.
fn by_number(name: &str, comment: &str, colors: impl Iterator<Item = (u32, [u8; 3])>) -> String {
    let mut text = format!("\n// {comment}\nfn {name}(kind: u32) -> vec3<f32> {{\n");
    for (number, color) in colors.map(|(number, color)| (number, linear_color(color))) {
        let [r, g, b] = color.to_array();
        let _infallible = writeln!(text, "    if kind == {number}u {{ return vec3<f32>({r:?}, {g:?}, {b:?}); }}");
    }
    text + "    return vec3<f32>(0.0);\n}\n"
}

/// Returns the function of colours by octaves of pixels per texel, 0 at one pixel per texel. Colours are
/// encoded, because the scale is interpolated in encoded colours.
fn octave_color() -> String {
    let mut text =
        "\n// Encoded colour of a number of octaves from one pixel per texel.\nfn octave_color(octaves: f32) -> vec3<f32> {\n"
            .to_owned();
    let encoded = |color: [u8; 3]| {
        let [r, g, b] = color.map(|byte| f32::from(byte) / 255.0);
        format!("vec3<f32>({r:?}, {g:?}, {b:?})")
    };
    let [first, ..] = PIXELS_PER_TEXEL_COLORS;
    let _infallible = writeln!(text, "    var color = {};", encoded(first.1));
    for [(from, _), (_, color)] in PIXELS_PER_TEXEL_COLORS.array_windows() {
        let (from, color) = (from.log2(), encoded(*color));
        let _infallible = writeln!(text, "    color = mix(color, {color}, saturate(octaves - ({from:?})));");
    }
    text + "    return color;\n}\n"
}

/// Returns the first pass of marks: a judged picture is group 0, depth of `samples` per pixel and marks are
/// group 1.
pub fn mark_rows(samples: u32) -> String {
    let depth = match samples {
        1 => include_str!("shaders/mark_depth.wgsl"),
        _ => include_str!("shaders/mark_depth_multisampled.wgsl"),
    };
    [SCREEN, &in_group(JUDGED, 0), &in_group(MARK, 1), depth, include_str!("shaders/mark_rows.wgsl")].concat()
}

/// Returns the second pass of marks: marks and the result of the first pass are group 0.
pub fn marks() -> String {
    [SCREEN, &in_group(MARK, 0), &error_colors(), include_str!("shaders/marks.wgsl")].concat()
}

/// Returns the pass of filled quadrilaterals.
pub fn quads() -> String {
    [FRAME, include_str!("shaders/quads.wgsl")].concat()
}

/// Returns the pass of a block of texels' depths: the block is group 0, the shadow map group 1.
pub fn block(shadow_map: &ShadowMapDescriptor, backend: wgpu::Backend) -> String {
    let options = WgslOptions::group(SHADOW_GROUP);
    let (receiver, stored) = (receiver_wgsl(shadow_map, &options), stored_wgsl(shadow_map, &options, backend));
    [SCREEN, &receiver, &stored, include_str!("shaders/block.wgsl")].concat()
}

/// Returns the pass of the shadow map's insets: frame and shadow map are groups 0 and 1.
pub fn inset(shadow_map: &ShadowMapDescriptor, backend: wgpu::Backend) -> String {
    let options = WgslOptions::group(SHADOW_GROUP);
    let (receiver, stored) = (receiver_wgsl(shadow_map, &options), stored_wgsl(shadow_map, &options, backend));
    [FRAME, &receiver, &stored, include_str!("shaders/inset.wgsl")].concat()
}

/// Returns the pass of texture levels.
pub fn mip() -> String {
    include_str!("shaders/mip.wgsl").to_owned()
}
