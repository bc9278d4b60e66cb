//! The WGSL of the four passes. Each is composed of its own file and the shared pieces. A file with a CPU
//! twin has the twin's name.

use shadowfit_rays::{RayWgslOptions, rays_wgsl};

use super::uniform::TallyRecord;
use crate::maps::MIN_FACING;

const TYPES: &str = include_str!("shaders/types.wgsl");
const SURFACE: &str = include_str!("shaders/surface.wgsl");
const TRACER: &str = include_str!("shaders/tracer.wgsl");

/// Returns the WGSL of rays that count only the occluders held by the receiver's map.
fn rays() -> String {
    rays_wgsl(&RayWgslOptions::group(0).with_counts(TRACER))
}

/// Returns the first pass, entry point `trace`: truth, the map that is read, and pixels per texel.
pub fn truth() -> String {
    let constants = format!("const MIN_FACING: f32 = {MIN_FACING};\n");
    [TYPES, SURFACE, &rays(), &constants, include_str!("shaders/truth.wgsl")].concat()
}

/// Returns the second pass, entry point `rows`: distances to transitions along the rows.
pub fn rows() -> String {
    [TYPES, include_str!("shaders/distances.wgsl")].concat()
}

/// Returns the third pass, entry point `classify`: edge zone and classes.
pub fn classes() -> String {
    [TYPES, SURFACE, &rays(), include_str!("shaders/judge.wgsl")].concat()
}

/// Returns the fourth pass, entry point `sum`: the sums of the picture.
pub fn tally() -> String {
    let (bins, error_one) = (TallyRecord::BINS, TallyRecord::ERROR_ONE);
    let constants = format!("const BINS: u32 = {bins}u;\nconst ERROR_ONE: u32 = {error_one}u;\n");
    [TYPES, &constants, include_str!("shaders/tally.wgsl")].concat()
}
