//! Cut-out images of twigs, ferns and grass, drawn leaf by leaf, for the cards of plants.

use glam::{Vec2, Vec3};

use crate::Image;
use crate::parts::dice::Dice;

/// Pixels along a side of the images. On a card of half a metre, a pixel is 2 mm wide.
const SIZE: u32 = 256;
/// Straight pieces of a leaf's midrib.
const PIECES: usize = 6;
/// Change of alpha per pixel across an outline, of 255: an edge about 1.5 pixels wide.
const EDGE: f32 = 170.0;

/// A leaf in image units: (0, 0) is the middle of the lower edge, (0, 1) the middle of the upper edge.
struct Leaf {
    /// Start.
    base: Vec2,
    /// End.
    tip: Vec2,
    /// Sideways displacement of its middle.
    bow: Vec2,
    /// Half of its greatest width.
    half: f32,
    /// Share of its length at which it is widest.
    widest: f32,
    /// Linear colour.
    color: Vec3,
}

impl Leaf {
    /// Returns the point of the midrib at a share of the leaf's length.
    fn rib(&self, t: f32) -> Vec2 {
        self.base.lerp(self.tip, t) + self.bow * 4.0 * t * (1.0 - t)
    }

    /// Returns the half width at a share of the leaf's length: a round end at the base, a pointed one at the
    /// tip.
    fn half_width(&self, t: f32) -> f32 {
        let toward = if t < self.widest { t / self.widest } else { (1.0 - t) / (1.0 - self.widest) };
        let power = if t < self.widest { 0.6 } else { 0.85 };
        self.half * toward.max(0.0).powf(power)
    }
}

/// Finds the point of the midrib nearest to `at`. Returns its share of the length, and the signed distance.
fn nearest(ribs: &[Vec2; PIECES + 1], at: Vec2) -> (f32, f32) {
    let mut nearest = (0.0, f32::MAX);
    for piece in 0..PIECES {
        let (a, b) = (ribs[piece], ribs[piece + 1]);
        let along = b - a;
        let t = ((at - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        let away = at - a - along * t;
        if away.length_squared() < nearest.1 * nearest.1 {
            let side = if along.perp_dot(away) < 0.0 { -1.0 } else { 1.0 };
            nearest = ((piece as f32 + t) / PIECES as f32, side * away.length());
        }
    }
    nearest
}

/// An image of leaves under construction.
struct Sheet {
    /// Linear colours.
    colors: Vec<Vec3>,
    /// Coverage, 0..=255.
    alphas: Vec<f32>,
}

impl Sheet {
    /// Starts with gaps only. Their colour bleeds into filtered edges.
    fn new(gap: Vec3) -> Self {
        let pixels = (SIZE * SIZE) as usize;
        Self { colors: vec![gap; pixels], alphas: vec![0.0; pixels] }
    }

    /// Draws a leaf over earlier ones.
    fn draw(&mut self, leaf: &Leaf) {
        let ribs = std::array::from_fn(|piece| leaf.rib(piece as f32 / PIECES as f32));
        let edge = Vec2::splat(leaf.half + 2.0 / SIZE as f32);
        let low = ribs.iter().fold(Vec2::INFINITY, |low, rib| low.min(*rib)) - edge;
        let high = ribs.iter().fold(Vec2::NEG_INFINITY, |high, rib| high.max(*rib)) + edge;
        let pixel = |value: f32| (value * SIZE as f32).clamp(0.0, SIZE as f32) as u32;
        for y in pixel(1.0 - high.y)..pixel(1.0 - low.y) {
            for x in pixel(low.x + 0.5)..pixel(high.x + 0.5) {
                let at = (Vec2::new(x as f32, y as f32) + 0.5) / SIZE as f32;
                let (t, side) = nearest(&ribs, Vec2::new(at.x - 0.5, 1.0 - at.y));
                let half = leaf.half_width(t);
                let alpha = (127.5 + (half - side.abs()) * SIZE as f32 * EDGE).clamp(0.0, 255.0);
                let index = (y * SIZE + x) as usize;
                if alpha > 0.0 {
                    self.colors[index] = shaded(leaf, t, side);
                }
                self.alphas[index] = self.alphas[index].max(alpha);
            }
        }
    }

    /// Returns the finished image.
    fn image(&self, name: &str) -> Image {
        let encode = |value: f32| (value.clamp(0.0, 1.0).powf(1.0 / 2.2) * 255.0) as u8;
        let pixel = |(color, alpha): (&Vec3, &f32)| {
            let [r, g, b] = color.to_array().map(encode);
            [r, g, b, *alpha as u8]
        };
        let rgba = self.colors.iter().zip(&self.alphas).flat_map(pixel).collect();
        Image { name: name.to_owned(), width: SIZE, height: SIZE, rgba }
    }
}

/// Returns the colour of a leaf: a pale midrib, side veins, one half slightly darker than the other.
fn shaded(leaf: &Leaf, t: f32, side: f32) -> Vec3 {
    let across = side.abs() / leaf.half;
    let vein = ((t * 26.0 - across * 5.0).fract() - 0.5).abs();
    let mut light = if side < 0.0 { 0.90 } else { 1.05 };
    if leaf.half > 0.03 && vein > 0.42 {
        light *= 0.88;
    }
    if across < 0.10 {
        light *= 1.35;
    }
    leaf.color * (light * (0.86 + 0.22 * t))
}

/// Returns a green between `a` and `b`, lighter or darker.
fn green(dice: &mut Dice, a: Vec3, b: Vec3) -> Vec3 {
    a.lerp(b, dice.roll()) * dice.between(0.8, 1.2)
}

/// Draws a twig with broad pointed leaves like a beech's.
pub fn twig() -> Image {
    let mut dice = Dice::new(71);
    let [deep, fresh] = [Vec3::new(0.075, 0.19, 0.026), Vec3::new(0.20, 0.34, 0.05)];
    let mut sheet = Sheet::new(deep.lerp(fresh, 0.4));
    let stem = Vec3::new(0.12, 0.075, 0.035);
    let bow = Vec2::new(0.03, 0.0);
    let rib = Leaf { base: Vec2::ZERO, tip: Vec2::new(0.0, 0.80), bow, half: 0.010, widest: 0.05, color: stem };
    let count = 12;
    for index in 0..count {
        let t = 0.08 + 0.92 * index as f32 / count as f32;
        let side = if index % 2 == 0 { 1.0 } else { -1.0 };
        let base = rib.rib(t);
        // The twig's first leaves point sideways, its last ones forward.
        let turn = side * (1.15 - 0.6 * t + dice.between(-0.16, 0.16));
        let length = 0.27 + 0.09 * (t * 3.0).sin() + dice.between(-0.03, 0.03);
        let ahead = Vec2::new(turn.sin(), turn.cos());
        let bow = ahead.perp() * side * -0.035;
        let color = green(&mut dice, deep, fresh);
        sheet.draw(&Leaf { base, tip: base + ahead * length, bow, half: 0.225 * length, widest: 0.42, color });
    }
    let base = rib.rib(0.97);
    let color = green(&mut dice, deep, fresh);
    sheet.draw(&Leaf { base, tip: Vec2::new(0.02, 0.99), bow: Vec2::ZERO, half: 0.05, widest: 0.45, color });
    sheet.draw(&rib);
    sheet.image("twig")
}

/// Draws a fern's frond: leaflets at both sides of a rib, shorter toward the tip.
pub fn fern() -> Image {
    let mut dice = Dice::new(72);
    let [deep, fresh] = [Vec3::new(0.06, 0.17, 0.03), Vec3::new(0.15, 0.31, 0.05)];
    let mut sheet = Sheet::new(deep.lerp(fresh, 0.5));
    let rib = Leaf {
        base: Vec2::ZERO,
        tip: Vec2::new(0.0, 0.985),
        bow: Vec2::ZERO,
        half: 0.011,
        widest: 0.04,
        color: Vec3::new(0.14, 0.20, 0.04),
    };
    let count = 24;
    for index in 0..count * 2 {
        let t = 0.10 + 0.88 * (index / 2) as f32 / count as f32;
        let side = if index % 2 == 0 { 1.0 } else { -1.0 };
        let length = 0.47 * (1.0 - t).powf(0.8) * (t * 6.0).min(1.0) + 0.02;
        let turn = side * (1.22 + dice.between(-0.05, 0.05));
        let base = rib.rib(t);
        let tip = base + Vec2::new(turn.sin(), turn.cos()) * length;
        let color = green(&mut dice, deep, fresh);
        sheet.draw(&Leaf { base, tip, bow: Vec2::new(0.0, 0.02 * length), half: 0.0165, widest: 0.3, color });
    }
    sheet.draw(&rib);
    sheet.image("fern")
}

/// Draws a tuft of grass: long bent blades from one root, from `fresh` to `dry` linear colours.
pub fn grass(fresh: Vec3, dry: Vec3) -> Image {
    let mut dice = Dice::new(73);
    let mut sheet = Sheet::new(fresh.lerp(dry, 0.5));
    let count = 26;
    for index in 0..count {
        let lean = (index as f32 + 0.5) / count as f32 * 2.0 - 1.0 + dice.between(-0.1, 0.1);
        let base = Vec2::new(lean * 0.16, -0.02);
        let height = 0.97 - 0.42 * lean.abs() - dice.between(0.0, 0.28);
        let tip = Vec2::new((lean * 0.46 + dice.between(-0.06, 0.06)).clamp(-0.48, 0.48), height);
        let bow = Vec2::new(-lean * 0.07, 0.05);
        let color = green(&mut dice, fresh, dry);
        sheet.draw(&Leaf { base, tip, bow, half: dice.between(0.009, 0.016), widest: 0.12, color });
    }
    sheet.image("grass")
}
