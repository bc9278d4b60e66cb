//! The WGSL of the four passes, each put together from its file and the shared pieces.

use super::uniform::TallyRecord;
use crate::maps::MIN_FACING;

const TYPES: &str = include_str!("shaders/types.wgsl");
const SURFACE: &str = include_str!("shaders/surface.wgsl");
const RAYS: &str = include_str!("shaders/rays.wgsl");

/// First pass, entry point `trace`: truth, the map that is read, and pixels per texel.
pub fn truth() -> String {
    let constants = format!("const MIN_FACING: f32 = {MIN_FACING};\n");
    [TYPES, SURFACE, RAYS, &constants, include_str!("shaders/truth.wgsl")].concat()
}

/// Second pass, entry point `rows`: distances to transitions along the rows.
pub fn rows() -> String {
    [TYPES, include_str!("shaders/rows.wgsl")].concat()
}

/// Third pass, entry point `classify`: edge zone and classes.
pub fn classes() -> String {
    [TYPES, SURFACE, RAYS, include_str!("shaders/classes.wgsl")].concat()
}

/// Fourth pass, entry point `sum`: the sums of the picture.
pub fn tally() -> String {
    let (bins, error_one) = (TallyRecord::BINS, TallyRecord::ERROR_ONE);
    let constants = format!("const BINS: u32 = {bins}u;\nconst ERROR_ONE: u32 = {error_one}u;\n");
    [TYPES, &constants, include_str!("shaders/tally.wgsl")].concat()
}
