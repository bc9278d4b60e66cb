//! The WGSL of the three passes, each put together from its file and the shared pieces.

const TYPES: &str = include_str!("shaders/types.wgsl");
const SURFACE: &str = include_str!("shaders/surface.wgsl");
const RAYS: &str = include_str!("shaders/rays.wgsl");

/// First pass, entry point `trace`: truth, the map that is read, and pixels per texel.
pub fn truth() -> String {
    [TYPES, SURFACE, RAYS, include_str!("shaders/truth.wgsl")].concat()
}

/// Second pass, entry point `rows`: distances to transitions along the rows.
pub fn rows() -> String {
    [TYPES, include_str!("shaders/rows.wgsl")].concat()
}

/// Third pass, entry point `classify`: edge zone and classes.
pub fn classes() -> String {
    [TYPES, SURFACE, RAYS, include_str!("shaders/classes.wgsl")].concat()
}
