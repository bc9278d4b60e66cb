//! The light: its axes, the texel lines across it, and what lies over an outline toward it.

mod axes;
pub(crate) mod grid;
mod outline;

pub(crate) use axes::{Light, LightAxes, Roll, is_same_direction, is_vertical};
pub(crate) use outline::{Outline, Scratch};
