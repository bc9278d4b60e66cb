//! Plants that several scenes share.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use super::cards::{Card, Cards};
use crate::Primitive;
use crate::parts::dice::Dice;
use crate::parts::shapes::modulated_lathe;
use crate::parts::solid::Solid;

/// Builds the crown of a cypress with lumps that wind around it. `width` is a factor on 0.85 m. The crown
/// starts at a height of `low` metres and is `tall` metres high, with `steps` rings and `segments` around.
pub fn cypress(width: f32, [low, tall]: [f32; 2], steps: usize, segments: usize) -> Solid {
    let ring = |step: usize| {
        let t = step as f32 / steps as f32;
        let girth = (t * (1.0 - t).powf(0.75)).max(0.0) * width + 0.12 * (1.0 - t);
        (if step == steps { 0.0 } else { 0.85 * girth }, low + tall * t)
    };
    let outline: Vec<(f32, f32)> = (0..=steps).map(ring).collect();
    modulated_lathe(&outline, segments, |turn, y| {
        1.0 + 0.10 * (5.0 * turn + 3.1 * y).sin() * (2.3 * y).cos() + 0.06 * (9.0 * turn - 4.7 * y).sin()
    })
}

/// Returns the outline of a rounded lump about the origin, for lathes: a half circle whose radius at each
/// height is raised to `power` (below 1 is blunter), stretched to a radius and a half height in metres.
pub fn egg(radius: f32, half_height: f32, power: f32) -> Vec<(f32, f32)> {
    const STEPS: usize = 8;
    let ring = |step: usize| {
        let (sin, cos) = (step as f32 / STEPS as f32 * PI).sin_cos();
        (if step == 0 || step == STEPS { 0.0 } else { radius * sin.powf(power) }, -half_height * cos)
    };
    (0..=STEPS).map(ring).collect()
}

/// A tuft of grass: cards that share one root. All lengths are in metres.
#[derive(Clone, Copy, Debug)]
pub struct Tuft {
    /// Number of cards.
    pub cards: usize,
    /// Least and greatest height of a card.
    pub height: [f32; 2],
    /// Depth of the root in the ground.
    pub sunk: f32,
    /// Farthest distance of a card from the root.
    pub spread: f32,
    /// Displacement of the tips by the wind.
    pub wind: Vec3,
    /// Greatest displacement of tips outwards or inwards.
    pub bend: f32,
    /// Share by which normals lean upwards.
    pub lean: f32,
}

impl Tuft {
    /// Builds the tuft with a material.
    pub fn primitive(&self, material: impl Into<usize>, dice: &mut Dice) -> Primitive {
        let mut cards = Cards::new(material, 2);
        for index in 0..self.cards {
            let turn = index as f32 / self.cards as f32 * TAU * 0.5 + dice.between(-0.2, 0.2);
            let across = Vec3::new(turn.cos(), 0.0, -turn.sin());
            let out = Vec3::new(turn.sin(), 0.0, turn.cos());
            let tall = dice.between(self.height[0], self.height[1]);
            let base = Vec3::Y * -self.sunk + out * dice.between(-self.spread, self.spread);
            let droop = self.wind + out * dice.between(-self.bend, self.bend);
            cards.add(&Card { base, reach: Vec3::Y * tall, half: across * 0.5 * tall, droop }, Vec3::Y, self.lean);
        }
        cards.primitive
    }
}
