//! The parts of the generated files that naga does not write: comments, settings, and declarations of resources.

use std::fmt::Write as _;

use super::translate::{Item, Language};
use super::{FILTERS, MAPS, filters};

/// Last line of a file with an include guard.
pub(super) const END: &str = "\n#endif\n";

/// Functions for engines, with their results.
const LOOK_UP: [(&str, &str); 4] = [
    ("shadowfit_factor_at", "the share of the light that reaches a point: 1 lit, 0 in shadow"),
    ("shadowfit_factor", "the same without rotating the discs of Vogel filters"),
    ("shadowfit_map_index", "the layer of the map that a point reads, for debug colours; -1 for none"),
    ("shadowfit_view_depth", "the view depth of a point, in metres"),
];
const CASTER: [(&str, &str); 3] = [
    ("shadowfit_caster_position", "the clip position in the map, for vertex shaders"),
    ("shadowfit_caster_depth", "the depth to interpolate, for vertex shaders without depth clamp"),
    ("shadowfit_clamped_depth", "the depth to write, for fragment shaders without depth clamp"),
];

/// Replacements that make the listed declarations shorter. Metal's functions have their resources as arguments.
const SHORTER: [(&str, &str); 7] = [
    ("( ", "("),
    (" )", ")"),
    ("constant shadowfit_Receiver& shadowfit_receiver", "constants"),
    ("constant shadowfit_Caster& shadowfit_caster", "constants"),
    ("metal::depth2d_array<float, metal::access::sample> shadowfit_texture", "texture"),
    ("metal::sampler shadowfit_sampler", "sampler"),
    ("metal::", ""),
];

/// Returns the first lines of a look-up.
pub(super) fn look_up_head(language: Language, items: &[Item]) -> String {
    let points = match language {
        Language::Glsl => "gl_FragCoord.xy",
        Language::Hlsl => "xy of SV_Position",
        Language::Msl => "xy of [[position]]",
    };
    let mut text = head(language, "lookup", "The look-up of shadow maps, for the shaders that light receivers.");
    text += "// position: world space, relative to the origin of the constants, metres. normal: unit, geometric.\n";
    let _ = writeln!(text, "// pixel: {points}.\n//");
    text += &functions(&LOOK_UP, items);
    text += "//\n// Constants: ShadowfitReceiverConstants of shadowfit.h, struct shadowfit_Receiver below.\n";
    text += match language {
        Language::Glsl => GLSL_LOOK_UP,
        Language::Hlsl => HLSL_LOOK_UP,
        Language::Msl => MSL_LOOK_UP,
    };
    text += "//\n// The sampler compares with \"less or equal\", or \"greater or equal\" for reversed depth. It filters linearly\n\
        // (SHADOWFIT_POINT: nearest), repeats, and the texture has one mip level.\n//\n\
        // Settings, to be defined before this text:\n\
        // SHADOWFIT_FILTER         one of the names below, as in the technique\n\
        // SHADOWFIT_MAPS           number of maps or more, up to 8; fewer make a shorter shader\n\
        // SHADOWFIT_BY_VIEW_DEPTH  1 if points select maps by view depth\n\
        // SHADOWFIT_REACH          radius of the filter in texels; Vogel and PCSS: 1 + the greatest softness\n\
        // SHADOWFIT_BLEND          width of the blend between maps, in texels\n";
    guard(&mut text, language, "LOOKUP");
    for (number, (name, ..)) in
        FILTERS.iter().enumerate().filter(|(_, filter)| filters(language).any(|one| one == *filter))
    {
        let _ = writeln!(text, "#define {name} {number}");
    }
    let most = MAPS.last().copied().unwrap_or_default();
    text += &default("SHADOWFIT_FILTER", "SHADOWFIT_PCF_5X5");
    text += &default("SHADOWFIT_MAPS", "4");
    text += &default("SHADOWFIT_BY_VIEW_DEPTH", "0");
    let _ = writeln!(text, "#if SHADOWFIT_MAPS > {most}\n#error SHADOWFIT_MAPS is at most {most}\n#endif\n");
    text + preamble(language)
}

const GLSL_LOOK_UP: &str = "\
// Uniform block: shadowfit_ReceiverBlock. Layout: SHADOWFIT_RECEIVER_LAYOUT, such as `std140, binding = 1`.
// Texture: sampler2DArrayShadow shadowfit_texture. Layout: SHADOWFIT_TEXTURE_LAYOUT, such as `layout(binding = 0)`.
//
// OpenGL: draw the maps with shadowfit_caster_position_gl. Row 0 of a layer is then the map's top, as in other
// interfaces, and look-ups need no change.
";

const HLSL_LOOK_UP: &str = "\
// Constant buffer: SHADOWFIT_RECEIVER_REGISTER (b0). Texture: SHADOWFIT_TEXTURE_REGISTER (t0). Sampler:
// SHADOWFIT_SAMPLER_REGISTER (s0). Each may name a space as well, such as `b0, space1`.
";

const MSL_LOOK_UP: &str = "\
// From the engine's entry point: `constants`, a constant buffer; `texture`, a depth2d_array<float>; `sampler`.
";

/// Returns the declarations of the resources of a look-up.
pub(super) fn look_up_resources(language: Language) -> &'static str {
    match language {
        Language::Glsl => {
            "
#ifndef SHADOWFIT_RECEIVER_LAYOUT
#define SHADOWFIT_RECEIVER_LAYOUT std140
#endif
#ifndef SHADOWFIT_TEXTURE_LAYOUT
#define SHADOWFIT_TEXTURE_LAYOUT
#endif
layout(SHADOWFIT_RECEIVER_LAYOUT) uniform shadowfit_ReceiverBlock { shadowfit_Receiver shadowfit_receiver; };
SHADOWFIT_TEXTURE_LAYOUT uniform highp sampler2DArrayShadow shadowfit_texture;
"
        }
        Language::Hlsl => {
            "
#ifndef SHADOWFIT_RECEIVER_REGISTER
#define SHADOWFIT_RECEIVER_REGISTER b0
#endif
#ifndef SHADOWFIT_TEXTURE_REGISTER
#define SHADOWFIT_TEXTURE_REGISTER t0
#endif
#ifndef SHADOWFIT_SAMPLER_REGISTER
#define SHADOWFIT_SAMPLER_REGISTER s0
#endif
cbuffer shadowfit_ReceiverBlock : register(SHADOWFIT_RECEIVER_REGISTER) { shadowfit_Receiver shadowfit_receiver; }
Texture2DArray<float> shadowfit_texture : register(SHADOWFIT_TEXTURE_REGISTER);
SamplerComparisonState shadowfit_sampler : register(SHADOWFIT_SAMPLER_REGISTER);
"
        }
        Language::Msl => "",
    }
}

/// Returns the first lines of the shadow pass.
pub(super) fn caster_head(language: Language, items: &[Item]) -> String {
    let mut text = head(language, "caster", "The positions of casters, for the shaders that draw the maps.");
    text += "// position: world space, relative to the origin of the constants, metres.\n//\n";
    text += &functions(&CASTER, items);
    text += "//\n// Constants: ShadowfitCasterConstants of shadowfit.h, struct shadowfit_Caster below.\n";
    text += match language {
        Language::Glsl => {
            "\
// Uniform block: shadowfit_CasterBlock. Layout: SHADOWFIT_CASTER_LAYOUT, such as `std140, binding = 0`.
//
// OpenGL: use shadowfit_caster_position_gl, which turns the map over. Front faces are then clockwise. Viewports and
// scissor rectangles stay as the library gives them. Clip depth is -1 to 1 (SHADOWFIT_DEPTH_NEGATIVE_ONE_TO_ONE) unless
// glClipControl makes it 0 to 1. With -1 to 1, pass depth * 0.5 + 0.5 to shadowfit_clamped_depth.
"
        }
        Language::Hlsl => {
            "// Constant buffer: SHADOWFIT_CASTER_REGISTER (b0), which may name a space as well, such as `b0, space1`.\n"
        }
        Language::Msl => "// `constants` is a constant buffer of the engine's entry point.\n",
    };
    guard(&mut text, language, "CASTER");
    text + preamble(language)
}

/// Returns the declarations of the resources of the shadow pass.
pub(super) fn caster_resources(language: Language) -> &'static str {
    match language {
        Language::Glsl => {
            "
#ifndef SHADOWFIT_CASTER_LAYOUT
#define SHADOWFIT_CASTER_LAYOUT std140
#endif
layout(SHADOWFIT_CASTER_LAYOUT) uniform shadowfit_CasterBlock { shadowfit_Caster shadowfit_caster; };
"
        }
        Language::Hlsl => {
            "
#ifndef SHADOWFIT_CASTER_REGISTER
#define SHADOWFIT_CASTER_REGISTER b0
#endif
cbuffer shadowfit_CasterBlock : register(SHADOWFIT_CASTER_REGISTER) { shadowfit_Caster shadowfit_caster; }
"
        }
        Language::Msl => "",
    }
}

/// Returns the functions of the shadow pass that only one language has.
pub(super) fn caster_extra(language: Language) -> &'static str {
    if language != Language::Glsl {
        return "";
    }
    "
// Returns gl_Position, with y turned over: OpenGL's first row of texels is at the bottom.
vec4 shadowfit_caster_position_gl(vec3 position) {
    vec4 clip = shadowfit_caster_position(position);
    return vec4(clip.x, -clip.y, clip.zw);
}
"
}

/// Returns the first lines of the demand shader.
pub(super) fn demand_head(language: Language) -> String {
    let mut text = head(language, "demand", "Counts the visible demand of a depth buffer. A whole compute shader.");
    text += "// Constants: ShadowfitDemandConstants of shadowfit.h, struct Demand below.\n\
        // Workgroups: the view's counted points, in squares of 32 x 32. Clear `counts` to 0 before. Its first cells are\n\
        // the demand grid, the others the depth histogram.\n//\n// ";
    text += match language {
        Language::Glsl => {
            "\
OpenGL 4.3. Uniform block: SHADOWFIT_DEMAND_BINDING (0). Depth texture without comparison: SHADOWFIT_DEPTH_BINDING
// (0). Counts: SHADOWFIT_COUNTS_BINDING (0). Row 0 of OpenGL's depth buffers is the bottom: fill the constants for a
// negative row stride.
#version 430 core
"
        }
        Language::Hlsl => {
            "\
Entry point: count_demand. Constants: SHADOWFIT_DEMAND_REGISTER (b0). Depth texture: SHADOWFIT_DEPTH_REGISTER
// (t0). Counts: SHADOWFIT_COUNTS_REGISTER (u0).
"
        }
        Language::Msl => {
            "\
Kernel: count_demand, Metal 2.0. Constants: buffer 0. Depth texture: texture 1. Counts: buffer 2. Threadgroup
// memory: 1024 bytes at indices 0 and 1 each.
"
        }
    };
    let settings: &[(&str, &str)] = match language {
        Language::Glsl => {
            &[("SHADOWFIT_DEMAND_BINDING", "0"), ("SHADOWFIT_DEPTH_BINDING", "0"), ("SHADOWFIT_COUNTS_BINDING", "0")]
        }
        Language::Hlsl => &[
            ("SHADOWFIT_DEMAND_REGISTER", "b0"),
            ("SHADOWFIT_DEPTH_REGISTER", "t0"),
            ("SHADOWFIT_COUNTS_REGISTER", "u0"),
        ],
        Language::Msl => &[],
    };
    text.push('\n');
    text.extend(settings.iter().map(|(name, value)| default(name, value)));
    text += preamble(language);
    text.push('\n');
    text
}

/// Returns the replacements in naga's demand shader.
pub(super) fn demand_changes(language: Language) -> &'static [(&'static str, &'static str)] {
    match language {
        Language::Glsl => &[
            (
                "layout(std140) uniform Demand_block_0Compute",
                "layout(std140, binding = SHADOWFIT_DEMAND_BINDING) uniform shadowfit_DemandBlock",
            ),
            ("uniform sampler2D", "layout(binding = SHADOWFIT_DEPTH_BINDING) uniform sampler2D"),
            (
                "layout(std430) buffer type_9_block_1Compute",
                "layout(std430, binding = SHADOWFIT_COUNTS_BINDING) buffer shadowfit_CountsBlock",
            ),
            ("_group_0_binding_0_cs", "demand"),
            ("_group_0_binding_1_cs", "depths"),
            ("_group_0_binding_2_cs", "counts"),
        ],
        Language::Hlsl => &[
            ("cbuffer demand : register(b0)", "cbuffer shadowfit_DemandBlock : register(SHADOWFIT_DEMAND_REGISTER)"),
            ("register(t1)", "register(SHADOWFIT_DEPTH_REGISTER)"),
            ("register(u2)", "register(SHADOWFIT_COUNTS_REGISTER)"),
            // glslang cannot assign to whole arrays. A workgroup has a thread for each element.
            (
                "    if (slot == 0) {\n        keys = (uint[256])0;\n        tallies = (uint[256])0;\n    }\n",
                "    keys[slot] = 0u;\n    tallies[slot] = 0u;\n",
            ),
        ],
        Language::Msl => &[
            ("type_9", "Counts"),
            ("type_10", "Slots"),
            ("struct count_demandInput {\n};\n", ""),
            ("using metal::uint;\n\n", ""),
        ],
    }
}

/// Returns the first comment of a file.
fn head(language: Language, name: &str, purpose: &str) -> String {
    format!(
        "// shadowfit_{name}.{}: {purpose}\n// Generated from the WGSL of shadowfit-wgpu by `cargo xtask generate`; the WGSL \
         has the comments.\n//\n",
        language.ending()
    )
}

/// Returns a list of functions, with their declarations in the language.
fn functions(functions: &[(&str, &str)], items: &[Item]) -> String {
    let mut text = String::new();
    for (name, result) in functions {
        let Some(item) = items.iter().find(|item| item.name == *name) else { continue };
        let declaration = item.text.split(['{', '\n']).next().filter(|line| line.contains(')'));
        let declaration = declaration.unwrap_or_else(|| item.text.split(" {").next().unwrap_or_default());
        let mut declaration = declaration.split_whitespace().collect::<Vec<_>>().join(" ");
        for (long, short) in SHORTER {
            declaration = declaration.replace(long, short);
        }
        let _ = writeln!(text, "// {declaration}\n//     {result}");
    }
    text
}

/// Begins the include guard.
fn guard(text: &mut String, language: Language, name: &str) {
    let guard = format!("SHADOWFIT_{name}_{}", language.ending().to_ascii_uppercase());
    let _ = writeln!(text, "\n#ifndef {guard}\n#define {guard}\n");
}

/// Returns the lines that give a setting its default.
fn default(name: &str, value: &str) -> String {
    format!("#ifndef {name}\n#define {name} {value}\n#endif\n")
}

/// Returns the lines that the text of a language needs first.
fn preamble(language: Language) -> &'static str {
    match language {
        Language::Glsl => "#ifdef GL_ES\nprecision highp float;\nprecision highp int;\n#endif\n",
        Language::Hlsl => "",
        Language::Msl => "#include <metal_stdlib>\n#include <simd/simd.h>\nusing metal::uint;\n",
    }
}
