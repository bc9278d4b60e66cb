//! Trunks, branches and roots: bent tubes that taper, with bark around them.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use crate::Primitive;
use crate::parts::build::SMOOTH;
use crate::parts::shapes::tube;
use crate::parts::solid::Solid;

/// Closed limbs with their own texture coordinates, in metres: around the limb to its back and back again,
/// and along it.
#[derive(Default)]
pub struct Limbs {
    solid: Solid,
    uvs: Vec<Vec2>,
}

impl Limbs {
    /// Adds a limb along `path`. `radius(turn, share)` returns the radius at an angle around it and a share
    /// of its path.
    pub fn add(&mut self, path: &[Vec3], segments: usize, radius: impl Fn(f32, f32) -> f32) {
        let last = path.len() - 1;
        let along = |ring: usize| (path[(ring + 1).min(last)] - path[ring.saturating_sub(1)]).normalize();
        let mut aside = along(0).any_orthonormal_vector();
        let mut length = 0.0;
        let girth = radius(0.0, 0.0) * PI;
        let mut rings = Vec::with_capacity(path.len());
        for (ring, &centre) in path.iter().enumerate() {
            let axis = along(ring);
            aside = (aside - axis * aside.dot(axis)).normalize();
            let across = axis.cross(aside);
            length += if ring == 0 { 0.0 } else { centre.distance(path[ring - 1]) };
            let point = |index: usize| {
                let turn = index as f32 / segments as f32 * TAU;
                centre + (aside * turn.cos() + across * turn.sin()) * radius(turn, ring as f32 / last as f32)
            };
            rings.push((0..segments).map(point).collect::<Vec<_>>());
            // The bark is mirrored on half of the circumference, so that there is no seam.
            let around = |index: usize| 1.0 - (index as f32 / segments as f32 * 2.0 - 1.0).abs();
            self.uvs.extend((0..segments).map(|index| Vec2::new(around(index) * girth, -length)));
        }
        let (first, end) = (radius(0.0, 0.0), radius(0.0, 1.0));
        let poles = [path[0] - along(0) * first * 0.3, path[last] + along(last) * end * 0.8];
        self.uvs.extend([Vec2::ZERO, Vec2::new(0.0, -length - end)]);
        self.solid = std::mem::take(&mut self.solid).with(tube(&rings, poles[0], poles[1]));
    }

    /// Returns all limbs in one primitive.
    pub fn primitive(&self, material: impl Into<usize>) -> Primitive {
        self.solid.primitive_with(material.into(), SMOOTH, |vertex, _| self.uvs[vertex])
    }
}
