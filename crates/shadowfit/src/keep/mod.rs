//! What can be kept of the maps of the last frame: the texels of a map that moved, and the direction of the light.

pub mod light_steps;
pub mod scroll;
pub(crate) mod texel_rect;
pub(crate) mod wrap;
