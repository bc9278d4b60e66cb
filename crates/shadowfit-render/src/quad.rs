//! Filled quadrilaterals in the picture's pixels.

use glam::{Vec2, Vec4};

use crate::uniform::QuadVertex;

/// A filled convex quadrilateral with smooth edges, drawn over the picture. If two neighbouring corners are
/// equal, it is a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quad {
    /// Corners in either winding order, in pixels from the left top corner of the picture.
    pub corners: [Vec2; 4],
    /// Linear colour and alpha.
    pub color: Vec4,
}

impl Quad {
    /// Returns a rectangle: left, top, width and height, in pixels.
    pub fn rectangle([x, y, width, height]: [f32; 4], color: Vec4) -> Self {
        let [left, top, right, bottom] = [x, y, x + width, y + height];
        let corners = [Vec2::new(left, top), Vec2::new(right, top), Vec2::new(right, bottom), Vec2::new(left, bottom)];
        Self { corners, color }
    }

    /// Returns the outline of a rectangle (left, top, width and height, in pixels): four non-overlapping
    /// rectangles inside of it, `line` pixels wide. Rectangles narrower than twice that are filled.
    pub fn outline([x, y, width, height]: [f32; 4], line: f32, color: Vec4) -> [Self; 4] {
        let (across, down) = (line.min(width * 0.5), line.min(height * 0.5));
        let between = height - 2.0 * down;
        [
            Self::rectangle([x, y, width, down], color),
            Self::rectangle([x, y + height - down, width, down], color),
            Self::rectangle([x, y + down, across, between], color),
            Self::rectangle([x + width - across, y + down, across, between], color),
        ]
    }

    pub(crate) fn vertex(&self) -> QuadVertex {
        let [a, b, c, d] = self.corners;
        QuadVertex { first: [a.x, a.y, b.x, b.y], second: [c.x, c.y, d.x, d.y], color: self.color.to_array() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the area of a rectangle, in square pixels.
    fn area(quad: &Quad) -> f32 {
        let size = quad.corners[2] - quad.corners[0];
        size.x * size.y
    }

    #[test]
    fn an_outline_covers_the_border_of_its_rectangle_once() {
        let outline = |rect| Quad::outline(rect, 2.0, Vec4::ONE).map(|quad| area(&quad)).iter().sum::<f32>();
        assert_eq!(outline([10.0, 20.0, 30.0, 12.0]), 30.0 * 12.0 - 26.0 * 8.0);
        assert_eq!(outline([10.0, 20.0, 30.0, 3.0]), 30.0 * 3.0);
    }
}
