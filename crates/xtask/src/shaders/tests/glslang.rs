//! Compiles the shaders with glslang (Debian's package glslang-tools).

use std::collections::BTreeMap;
use std::io::Write as _;
use std::mem::{offset_of, size_of};
use std::process::{Command, Stdio};

use shadowfit_wgpu::demand::DemandUniform;
use shadowfit_wgpu::uniforms::{CasterUniform, MapUniform, ReceiverUniform};

use super::*;

const VERSIONS: [&str; 2] = ["#version 450\n", "#version 300 es\n"];

const GLSL_LOOK_UP: &str = "
out vec4 color;
void main() {
    vec3 p = gl_FragCoord.xyz;
    color = vec4(shadowfit_factor_at(p, p, p.xy), shadowfit_factor(p, p), shadowfit_view_depth(p), shadowfit_map_index(p));
}
";
const GLSL_CASTER: &str = "
in vec3 position;
out float depth;
void main() {
    gl_Position = shadowfit_caster_position(position) + shadowfit_caster_position_gl(position);
    depth = shadowfit_clamped_depth(shadowfit_caster_depth(position));
}
";

/// Compiles a shader of a stage and returns glslang's output.
fn compiled(stage: &str, arguments: &[&str], source: &str) -> String {
    let mut command = Command::new("glslangValidator");
    command.args(["--stdin", "-S", stage]).args(arguments);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("glslangValidator starts");
    child.stdin.take().expect("its input").write_all(source.as_bytes()).expect("it reads its input");
    let output = child.wait_with_output().expect("it ends");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{stage} {arguments:?}: {text}");
    text
}

/// Returns glslang's arguments for HLSL with an entry point. Without optimisation, which takes longer than the rest.
fn hlsl(entry: &str) -> Vec<&str> {
    vec![
        "-D",
        "-V",
        "-Od",
        "--hlsl-offsets",
        "-o",
        "/dev/null",
        "--auto-map-bindings",
        "--auto-map-locations",
        "-e",
        entry,
    ]
}

#[test]
fn every_alternative_of_the_look_up_compiles() {
    let (glsl, hlsl_look_up) = (committed("shadowfit_lookup.glsl"), committed("shadowfit_lookup.hlsl"));
    for settings in settings(Language::Glsl) {
        for version in VERSIONS {
            compiled("frag", &[], &[version, &settings, &glsl, GLSL_LOOK_UP].concat());
        }
    }
    for settings in settings(Language::Hlsl) {
        compiled("frag", &hlsl("entry"), &[&settings, &hlsl_look_up, HLSL_LOOK_UP].concat());
    }
}

#[test]
fn casters_and_demand_compile() {
    for version in VERSIONS {
        compiled("vert", &[], &[version, &committed("shadowfit_caster.glsl"), GLSL_CASTER].concat());
    }
    compiled("vert", &hlsl("entry"), &(committed("shadowfit_caster.hlsl") + HLSL_CASTER));
    compiled("comp", &[], &committed("shadowfit_demand.glsl"));
    compiled("comp", &hlsl("count_demand"), &committed("shadowfit_demand.hlsl"));
}

/// Vulkan requires layouts with sets and bindings.
#[test]
fn layouts_and_registers_are_settings() {
    let layouts = "
        #define SHADOWFIT_RECEIVER_LAYOUT std140, set = 1, binding = 2
        #define SHADOWFIT_TEXTURE_LAYOUT layout(set = 1, binding = 3)
        #define SHADOWFIT_CASTER_LAYOUT std140, set = 0, binding = 4\n";
    let vulkan = ["-V", "-o", "/dev/null", "--auto-map-locations"];
    let glsl = |file: &str, entry: &str| [VERSIONS[0], layouts, &committed(file), entry].concat();
    compiled("frag", &vulkan, &glsl("shadowfit_lookup.glsl", GLSL_LOOK_UP));
    compiled("vert", &vulkan, &glsl("shadowfit_caster.glsl", GLSL_CASTER));
    let registers = "
        #define SHADOWFIT_RECEIVER_REGISTER b2, space1
        #define SHADOWFIT_TEXTURE_REGISTER t3, space1
        #define SHADOWFIT_SAMPLER_REGISTER s4, space1\n";
    compiled("frag", &hlsl("entry"), &[registers, &committed("shadowfit_lookup.hlsl"), HLSL_LOOK_UP].concat());
}

#[test]
fn wrong_settings_do_not_compile() {
    let source =
        [VERSIONS[0], "#define SHADOWFIT_MAPS 9\n", &committed("shadowfit_lookup.glsl"), GLSL_LOOK_UP].concat();
    assert!(std::panic::catch_unwind(|| compiled("frag", &[], &source)).is_err());
}

/// Offsets of fields, in bytes, by their names.
type Layout = BTreeMap<String, usize>;

/// Returns the layout of a struct. A list that lacks a field does not compile.
macro_rules! layout {
    ($rust:ident: $($field:ident),+) => {{
        let _ = |value: $rust| { let $rust { $($field: _),+ } = value; };
        Layout::from([$((stringify!($field).to_owned(), offset_of!($rust, $field))),+])
    }};
}

fn caster_layout() -> Layout {
    layout!(CasterUniform: clip_from_world, clamps_in_fragment, padding_0, padding_1, padding_2)
}

/// Returns the layout with the fields of each map.
fn receiver_layout() -> Layout {
    let mut layout = layout!(ReceiverUniform: to_light, map_count, view, fade_near, fade_width, least_disc, greatest_disc,
        frame_shift, is_off, padding_0, padding_1, maps);
    let map = layout!(MapUniform: uv_from_world, depth_per_texel_u, constant_depth, depth_per_texel_v, slope_depth, size,
        normal_offset, receiver_plane, far, blend_near, layer, padding_0, texel_offset, disc, penumbra, padding_1,
        padding_2);
    let maps = layout.remove("maps").unwrap_or_default();
    for index in 0..shadowfit_wgpu::MAX_MAPS {
        let first = maps + index * size_of::<MapUniform>();
        layout.extend(map.iter().map(|(name, at)| (format!("maps[{index}].{name}"), first + at)));
    }
    layout
}

fn demand_layout() -> Layout {
    layout!(DemandUniform: world_from_pixel, view, direction, far_depth, x, cell, y, shape, corner, size, step, pixels,
        exponent, near, far, bins_per_octave, pixel_width)
}

/// Returns the offsets of all fields of uniform blocks, by their names without the number that makes them unique.
fn reflected(stage: &str, arguments: &[&str], source: &str) -> Layout {
    let arguments = [&["-l", "-q", "--reflect-all-block-variables"], arguments].concat();
    let text = compiled(stage, &arguments, source);
    let field = |line: &str| {
        let (name, rest) = line.split_once(": offset ")?;
        let offset = rest.split(',').next()?.parse().ok()?;
        Some((name.trim_end_matches('_').to_owned(), offset))
    };
    // Arrays of structs appear with their indices, and once without.
    text.lines().filter_map(field).filter(|(name, _)| !name.contains("maps.")).collect()
}

#[test]
fn constants_have_the_layout_of_the_rust_structs() {
    for (language, is_hlsl) in [("glsl", false), ("hlsl", true)] {
        let arguments = |entry| if is_hlsl { hlsl(entry) } else { Vec::new() };
        let file = |name: &str| committed(&format!("shadowfit_{name}.{language}"));
        let [version, look_up, caster] =
            if is_hlsl { ["", HLSL_LOOK_UP, HLSL_CASTER] } else { [VERSIONS[0], GLSL_LOOK_UP, GLSL_CASTER] };
        let found = reflected("frag", &arguments("entry"), &[version, &file("lookup"), look_up].concat());
        assert_eq!(block(&found, "shadowfit_receiver."), receiver_layout(), "{language}");
        let found = reflected("vert", &arguments("entry"), &[version, &file("caster"), caster].concat());
        assert_eq!(block(&found, "shadowfit_caster."), caster_layout(), "{language}");
        let found = reflected("comp", &arguments("count_demand"), &file("demand"));
        assert_eq!(block(&found, "demand."), demand_layout(), "{language}");
    }
}

/// Returns the fields of the block with a prefix.
fn block(found: &Layout, prefix: &str) -> Layout {
    found.iter().filter_map(|(name, at)| Some((name.strip_prefix(prefix)?.to_owned(), *at))).collect()
}
