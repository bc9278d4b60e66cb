//! Sheets that carry cut-out leaves: strips of quads that bend.

use glam::{Vec2, Vec3};

use crate::Primitive;

/// Cards under construction.
pub struct Cards {
    /// Cards built so far.
    pub primitive: Primitive,
    /// Quads along each card.
    quads: usize,
}

/// A card: a strip from its stem, at the image's lower edge, to its tip.
#[derive(Clone, Copy, Debug)]
pub struct Card {
    /// Middle of the end at the stem.
    pub base: Vec3,
    /// From the stem to the tip, in metres, before it bends.
    pub reach: Vec3,
    /// Across, half of the width, in metres.
    pub half: Vec3,
    /// Displacement of the tip by bending, in metres.
    pub droop: Vec3,
}

impl Cards {
    /// Starts without cards. Each card will consist of `quads` quads: one quad is flat, two let it bend.
    pub fn new(material: impl Into<usize>, quads: usize) -> Self {
        Self { primitive: Primitive { material: material.into(), ..Primitive::default() }, quads }
    }

    /// Adds a card. Its normals lean toward `out` (unit) by the share `lean`, which makes a crown of flat
    /// cards look round.
    pub fn add(&mut self, card: &Card, out: Vec3, lean: f32) {
        let first = self.primitive.positions.len() as u32;
        for step in 0..=self.quads {
            let t = step as f32 / self.quads as f32;
            let middle = card.base + card.reach * t + card.droop * t * t;
            let along = card.reach + card.droop * 2.0 * t;
            let flat = card.half.cross(along).normalize();
            let side = if flat.dot(out) < 0.0 { -out } else { out };
            let normal = (flat * (1.0 - lean) + side * lean).normalize();
            for (u, sign) in [(0.0, -1.0), (1.0, 1.0)] {
                self.primitive.positions.push(middle + card.half * sign);
                self.primitive.normals.push(normal);
                self.primitive.uvs.push(Vec2::new(u, 1.0 - t));
            }
        }
        for step in 0..self.quads as u32 {
            let a = first + step * 2;
            self.primitive.indices.extend([a, a + 1, a + 3, a, a + 3, a + 2]);
        }
    }
}
