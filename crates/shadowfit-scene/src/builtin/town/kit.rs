//! Parts of one mesh, sorted by paint while they are added.

use glam::{Affine3A, Vec2, Vec3};

use super::palette::Paint;
use crate::Primitive;
use crate::parts::{Builder, CRISP, SMOOTH, Solid, plank, prism};

/// Least and greatest upward share of a normal that belongs to a roof's slope.
const SLOPES: std::ops::Range<f32> = 0.15..0.98;

/// Solids of one mesh under construction, one per paint.
#[derive(Clone, Default)]
pub(super) struct Kit(Vec<(Paint, Solid)>);

impl Kit {
    /// Adds a solid to the others of its paint.
    pub(super) fn add(&mut self, paint: Paint, solid: Solid) {
        match self.0.iter_mut().find(|part| part.0 == paint) {
            Some(part) => part.1 = std::mem::take(&mut part.1).with(solid),
            None => self.0.push((paint, solid)),
        }
    }

    /// Adds a box with sharp edges between two corners.
    pub(super) fn plank(&mut self, paint: Paint, low: impl Into<Vec3>, high: impl Into<Vec3>) {
        self.add(paint, plank(low, high));
    }

    /// Adds all parts of another kit, transformed.
    pub(super) fn add_all(&mut self, other: Self, transform: Affine3A) {
        for (paint, solid) in other.0 {
            self.add(paint, solid.transformed(transform));
        }
    }

    /// Adds a mesh of all parts and returns its index.
    pub(super) fn mesh(self, builder: &mut Builder, name: &str) -> usize {
        let primitives = self.0.into_iter().map(|(paint, solid)| drawable(paint, &solid)).collect();
        builder.mesh(name, primitives)
    }
}

/// Returns the drawable form of a solid. The image of a roof runs along the eaves and down the slope.
fn drawable(paint: Paint, solid: &Solid) -> Primitive {
    if !paint.is_roof() {
        let crease = if paint.is_round() { SMOOTH } else { CRISP };
        return solid.primitive(paint.into(), crease);
    }
    solid.primitive_with(paint.into(), CRISP, |vertex, normal| {
        let at = solid.positions[vertex];
        let (along, down) = if normal.x.abs() > normal.z.abs() {
            (at.z, at.x * normal.x.signum())
        } else {
            (at.x, at.z * normal.z.signum())
        };
        Vec2::new(along, if SLOPES.contains(&normal.y) { down / normal.y } else { -at.y })
    })
}

/// Returns a prism along x about x = 0, from a convex outline in z and y that is counter-clockwise when z points right.
pub(super) fn across(outline: &[(f32, f32)], length: f32) -> Solid {
    let turn = Affine3A::from_rotation_y(-std::f32::consts::FRAC_PI_2);
    prism(outline, length).transformed(turn)
}
