//! The shader modules of the classic samples, put together from the pieces in `shaders/samples/`: how a map is read, one
//! shadow test, one shading.

use super::{FRAME, MATERIAL, POWERS, REFLECTANCE, SCREEN, TONE_MAP, in_group};
use crate::samples::{SampleFormat, ShadingKind, TestKind};

const SAMPLE: &str = include_str!("samples/sample.wgsl");
const POINT: &str = include_str!("samples/point.wgsl");
const SRGB: &str = include_str!("samples/srgb.wgsl");
const OCCLUSION_UNIFORM: &str = include_str!("samples/occlusion_uniform.wgsl");
const OCCLUSION_FORMULA: &str = include_str!("samples/occlusion_formula.wgsl");
const OCCLUSION_PART: &str = include_str!("samples/occlusion_part.wgsl");
const OCCLUSION_BUFFERS: &str = include_str!("samples/occlusion_buffers.wgsl");
const STORED: &str = include_str!("samples/stored.wgsl");
const LIGHT_IMAGE: &str = include_str!("samples/light_image.wgsl");

/// The pieces as they lie in the folder, for tests that look for files which no module uses.
pub const PIECES: [(&str, &str); 35] = [
    ("sample.wgsl", SAMPLE),
    ("point.wgsl", POINT),
    ("srgb.wgsl", SRGB),
    ("stored.wgsl", STORED),
    ("light_image.wgsl", LIGHT_IMAGE),
    ("caster.wgsl", include_str!("samples/caster.wgsl")),
    ("map_red.wgsl", map_file(SampleFormat::R32Float)),
    ("map_packed.wgsl", map_file(SampleFormat::Rgba8Packed)),
    ("map_depth.wgsl", map_file(SampleFormat::Depth32)),
    ("test_none.wgsl", test_file(TestKind::Off)),
    ("test_xna.wgsl", test_file(TestKind::Xna)),
    ("test_real_shadow.wgsl", test_file(TestKind::RealShadow)),
    ("test_comparison.wgsl", test_file(TestKind::Comparison)),
    ("test_terrain.wgsl", test_file(TestKind::Terrain)),
    ("test_ours.wgsl", test_file(TestKind::Ours)),
    ("shade_xna.wgsl", shading_file(ShadingKind::Xna)),
    ("shade_projective.wgsl", shading_file(ShadingKind::Projective)),
    ("shade_headlight.wgsl", shading_file(ShadingKind::Headlight)),
    ("shade_comparison.wgsl", shading_file(ShadingKind::Comparison)),
    ("shade_terrain.wgsl", shading_file(ShadingKind::Terrain)),
    ("shade_modern.wgsl", shading_file(ShadingKind::Modern)),
    ("shaded.wgsl", include_str!("samples/shaded.wgsl")),
    ("probe.wgsl", include_str!("samples/probe.wgsl")),
    ("inset.wgsl", include_str!("samples/inset.wgsl")),
    ("occlusion_uniform.wgsl", OCCLUSION_UNIFORM),
    ("occlusion_formula.wgsl", OCCLUSION_FORMULA),
    ("occlusion_part.wgsl", OCCLUSION_PART),
    ("occlusion_surface.wgsl", include_str!("samples/occlusion_surface.wgsl")),
    ("occlusion_buffers.wgsl", OCCLUSION_BUFFERS),
    ("occlusion_normals.wgsl", include_str!("samples/occlusion_normals.wgsl")),
    ("occlusion_depth.wgsl", include_str!("samples/occlusion_depth.wgsl")),
    ("occlusion_blur.wgsl", include_str!("samples/occlusion_blur.wgsl")),
    ("occlusion_shade.wgsl", include_str!("samples/occlusion_shade.wgsl")),
    ("occlusion_view.wgsl", include_str!("samples/occlusion_view.wgsl")),
    ("sky_box.wgsl", include_str!("samples/sky_box.wgsl")),
];

/// The pass that draws casters into a map; group 0 is the sample's uniform.
pub fn caster() -> String {
    [SAMPLE, include_str!("samples/caster.wgsl")].concat()
}

/// The picture: sample, map and material are groups 0, 1 and 2. A test that compares by a sampler needs the depth
/// format.
pub fn shaded(format: SampleFormat, test: TestKind, shading: ShadingKind) -> String {
    let modern = if shading == ShadingKind::Modern { [POWERS, TONE_MAP, REFLECTANCE].concat() } else { String::new() };
    [&tested(format, test), &modern, shading_file(shading), include_str!("samples/shaded.wgsl")].concat()
}

/// The probe of a picture, with its groups; it needs the primitive index, whose directive must come first.
pub fn probe(format: SampleFormat, test: TestKind) -> String {
    ["enable primitive_index;\n", &tested(format, test), include_str!("samples/probe.wgsl")].concat()
}

/// The map's inset: sample and map are groups 0 and 1.
pub fn inset(format: SampleFormat) -> String {
    [SAMPLE, map_file(format), STORED, include_str!("samples/inset.wgsl")].concat()
}

/// View-space positions and normals: the frame, [`OcclusionUniform`](crate::samples::OcclusionUniform) and the material
/// are groups 0, 1 and 2.
pub fn occlusion_surface() -> String {
    let surface = include_str!("samples/occlusion_surface.wgsl");
    [&occlusion_part(), surface].concat()
}

/// The picture whose ambient light occlusion darkens: those groups, and occlusion in group 3.
pub fn occlusion_shade() -> String {
    [&occlusion_part(), SRGB, include_str!("samples/occlusion_shade.wgsl")].concat()
}

/// What passes over parts of the scene share.
fn occlusion_part() -> String {
    let material = MATERIAL.replace("MATERIAL_GROUP", "2");
    [FRAME, &material, OCCLUSION_PART, &in_group(OCCLUSION_UNIFORM, 1)].concat()
}

/// Ambient occlusion in screen space by either method: the uniform is group 0, what was drawn of surfaces group 1.
pub fn occlusion_gather() -> String {
    let (normals, depth) =
        (include_str!("samples/occlusion_normals.wgsl"), include_str!("samples/occlusion_depth.wgsl"));
    [SCREEN, &in_group(OCCLUSION_UNIFORM, 0), OCCLUSION_BUFFERS, OCCLUSION_FORMULA, normals, depth].concat()
}

/// The formulas of occlusion alone, without bindings or entry points.
pub fn occlusion_formula() -> &'static str {
    OCCLUSION_FORMULA
}

/// The blur of occlusion, with the groups of what finds it.
pub fn occlusion_blur() -> String {
    let blur = include_str!("samples/occlusion_blur.wgsl");
    [SCREEN, &in_group(OCCLUSION_UNIFORM, 0), OCCLUSION_BUFFERS, blur].concat()
}

/// Occlusion alone, in group 0.
pub fn occlusion_view() -> String {
    [SCREEN, include_str!("samples/occlusion_view.wgsl")].concat()
}

/// The sky box: uniform, cube and sampler are group 0.
pub fn sky_box() -> String {
    include_str!("samples/sky_box.wgsl").to_owned()
}

/// What knows whether a visible point is lit.
fn tested(format: SampleFormat, test: TestKind) -> String {
    let material = MATERIAL.replace("MATERIAL_GROUP", "2");
    [&material, SRGB, SAMPLE, POINT, map_file(format), STORED, LIGHT_IMAGE, test_file(test)].concat()
}

const fn map_file(format: SampleFormat) -> &'static str {
    match format {
        SampleFormat::R32Float | SampleFormat::R16Float | SampleFormat::Grey8 => {
            include_str!("samples/map_red.wgsl")
        }
        SampleFormat::Rgba8Packed => include_str!("samples/map_packed.wgsl"),
        SampleFormat::Depth32 => include_str!("samples/map_depth.wgsl"),
    }
}

const fn test_file(test: TestKind) -> &'static str {
    match test {
        TestKind::Off => include_str!("samples/test_none.wgsl"),
        TestKind::Xna => include_str!("samples/test_xna.wgsl"),
        TestKind::RealShadow => include_str!("samples/test_real_shadow.wgsl"),
        TestKind::Comparison => include_str!("samples/test_comparison.wgsl"),
        TestKind::Terrain => include_str!("samples/test_terrain.wgsl"),
        TestKind::Ours => include_str!("samples/test_ours.wgsl"),
    }
}

const fn shading_file(shading: ShadingKind) -> &'static str {
    match shading {
        ShadingKind::Xna => include_str!("samples/shade_xna.wgsl"),
        ShadingKind::Projective => include_str!("samples/shade_projective.wgsl"),
        ShadingKind::Headlight => include_str!("samples/shade_headlight.wgsl"),
        ShadingKind::Comparison => include_str!("samples/shade_comparison.wgsl"),
        ShadingKind::Terrain => include_str!("samples/shade_terrain.wgsl"),
        ShadingKind::Modern => include_str!("samples/shade_modern.wgsl"),
    }
}
