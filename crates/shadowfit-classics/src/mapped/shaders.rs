//! The shader modules of mapped frames, assembled from pieces: map access, one shadow test, one shading.

use shadowfit_render::passes::Numbering;
use shadowfit_render::shaders::{SRGB, material};

use super::{SampleFormat, SampleFrame};

const SAMPLE: &str = include_str!("sample.wgsl");
const STORED: &str = include_str!("stored.wgsl");

/// Returns the pass that draws casters into a map. Group 0 is the sample's uniform.
pub fn caster() -> String {
    [SAMPLE, include_str!("caster.wgsl")].concat()
}

/// Returns the picture's module. Sample, map and material are groups 0, 1 and 2.
pub fn shaded(frame: &SampleFrame) -> String {
    [&tested(frame), &frame.shading.wgsl.concat(), include_str!("shaded.wgsl")].concat()
}

/// Returns the module of a picture's probe, with the picture's groups.
pub fn probe(frame: &SampleFrame, numbering: Numbering) -> String {
    let entries = match numbering {
        Numbering::Primitives => include_str!("probe_primitive.wgsl"),
        Numbering::Vertices => include_str!("probe_vertex.wgsl"),
    };
    [numbering.directive(), &tested(frame), entries].concat()
}

/// Returns the module of the map's inset. Sample and map are groups 0 and 1.
pub fn inset(format: SampleFormat) -> String {
    [SAMPLE, map(format), STORED, include_str!("inset.wgsl")].concat()
}

/// Returns the pieces that decide whether a visible point is lit.
fn tested(frame: &SampleFrame) -> String {
    let (map, test) = (map(frame.map.format), frame.test.wgsl);
    [&material(2), SRGB, SAMPLE, include_str!("point.wgsl"), map, STORED, include_str!("light_image.wgsl"), test]
        .concat()
}

const fn map(format: SampleFormat) -> &'static str {
    match format {
        SampleFormat::R32Float | SampleFormat::R16Float | SampleFormat::Grey8 => include_str!("map_red.wgsl"),
        SampleFormat::Rgba8Packed => include_str!("map_packed.wgsl"),
        SampleFormat::Depth32 => include_str!("map_depth.wgsl"),
    }
}
