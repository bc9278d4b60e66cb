//! Coloured lines in the world, for frusta and boxes seen from outside.

use glam::{DVec3, Vec3, Vec4};

use crate::uniform::LineVertex;

/// A straight line between two points of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Ends, world space, in metres.
    pub ends: [DVec3; 2],
    /// Linear colour and alpha.
    pub color: Vec4,
}

impl Line {
    pub(crate) fn vertices(&self, eye: DVec3) -> [LineVertex; 2] {
        self.ends.map(|end| LineVertex { position: (end - eye).as_vec3().to_array(), color: self.color.to_array() })
    }
}

/// Returns the twelve edges of a box, given by eight corners relative to `origin`: four around one face in
/// order, then the four opposite them.
pub fn box_lines(origin: DVec3, corners: &[Vec3; 8], color: Vec4) -> [Line; 12] {
    let edge = |from: usize, to: usize| Line {
        ends: [origin + corners[from].as_dvec3(), origin + corners[to].as_dvec3()],
        color,
    };
    core::array::from_fn(|index| match index {
        0..4 => edge(index, (index + 1) % 4),
        4..8 => edge(index, 4 + (index + 1) % 4),
        _ => edge(index - 8, index - 4),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_cube_has_twelve_edges_of_length_one() {
        let corners = [
            Vec3::ZERO,
            Vec3::X,
            Vec3::new(1.0, 1.0, 0.0),
            Vec3::Y,
            Vec3::Z,
            Vec3::new(1.0, 0.0, 1.0),
            Vec3::ONE,
            Vec3::new(0.0, 1.0, 1.0),
        ];
        for line in box_lines(DVec3::new(5.0, 6.0, 7.0), &corners, Vec4::ONE) {
            assert_eq!(line.ends[0].distance(line.ends[1]), 1.0);
        }
    }
}
