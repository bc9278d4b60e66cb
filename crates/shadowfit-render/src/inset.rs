//! Shadow maps shown in the picture.

use glam::Vec3;

use crate::uniform::InsetVertex;

/// A shadow map that is shown in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inset {
    /// Left, top, width and height, in pixels.
    pub rectangle: [f32; 4],
    /// Stored depths that are shown as black and white.
    pub depth_range: [f32; 2],
    /// Index of the map that is shown.
    pub map: u32,
    /// Linear colour of its border, one pixel wide, inside the rectangle.
    pub border: Vec3,
}

impl Inset {
    pub(crate) fn vertex(&self) -> InsetVertex {
        let Self { rectangle, depth_range, map, border } = *self;
        InsetVertex { rectangle, depth_range, map, border: border.to_array() }
    }
}
