//! The picture of a sky. Colours depend on directions alone, so the faces of its cube join without a seam.

use glam::{UVec2, Vec2, Vec3};
use rayon::prelude::*;

use super::face::direction_of;

/// Colour overhead, in display values like all colours here.
const ZENITH: Vec3 = Vec3::new(0.20, 0.38, 0.70);
/// Colour halfway up.
const SKY: Vec3 = Vec3::new(0.42, 0.61, 0.85);
/// Colour at the horizon.
const HAZE: Vec3 = Vec3::new(0.80, 0.86, 0.90);
/// Colour below the horizon.
const GROUND: Vec3 = Vec3::new(0.40, 0.38, 0.34);
/// Colours of sunlit and shaded clouds.
const CLOUD: [Vec3; 2] = [Vec3::new(0.97, 0.97, 0.96), Vec3::new(0.66, 0.71, 0.79)];
/// Colour of the light around the sun.
const GLOW: Vec3 = Vec3::new(1.0, 0.93, 0.78);
/// Colour of the sun's disc, brighter than everything else.
const SUN: Vec3 = Vec3::new(1.0, 1.0, 0.98);
/// Upper limit of all other colours.
const BRIGHTEST: f32 = 0.985;

/// Cosines of the angles to the sun's middle at which its light begins and is full. Larger than the real
/// radius of 0.27°, so that the disc has a shape in few texels.
const SUN_COSINES: [f32; 2] = [0.999_62, 0.999_73];

/// Height of the cloud layer above the eye, in sizes of a large cloud, and curvature that keeps it from the
/// horizon.
const CLOUD_HEIGHT: f32 = 1.5;
const CLOUD_CURVE: f32 = 0.14;

/// A sky's cube map.
#[derive(Clone, Debug)]
pub struct SkyPicture {
    /// Width and height of a face, in texels.
    pub size: u32,
    /// +x, -x, +y, -y, +z, -z: `size * size` texels each, rows from the top, in display values and opaque.
    pub faces: [Vec<[u8; 4]>; 6],
}

impl SkyPicture {
    /// Draws the sky, with its sun in a direction (world axes, y up, any length), and faces of at least 1×1
    /// texels. The sun is overhead if the direction is 0 or not finite.
    pub fn new(to_light: Vec3, size: u32) -> Self {
        let to_light = to_light.try_normalize().unwrap_or(Vec3::Y);
        let size = size.max(1);
        let mut faces: [Vec<[u8; 4]>; 6] = Default::default();
        faces.par_iter_mut().enumerate().for_each(|(index, face)| *face = texels(index, to_light, size));
        Self { size, faces }
    }

    /// Returns the direction of a texel's middle (world axes, greatest component ±1).
    pub fn direction(&self, face: usize, texel: UVec2) -> Vec3 {
        direction_of(face, (texel.as_vec2() + 0.5) / self.size as f32)
    }
}

fn texels(face: usize, to_light: Vec3, size: u32) -> Vec<[u8; 4]> {
    let place = |index: u32| UVec2::new(index % size, index / size);
    (0..size * size)
        .map(|index| {
            let texel = place(index);
            let direction = direction_of(face, (texel.as_vec2() + 0.5) / size as f32).normalize();
            // Dithers by up to half a step, so that slow gradients have no bands.
            let dither = random(texel.as_ivec2()) - 0.5;
            let [r, g, b] = (color(direction, to_light) * 255.0 + dither).round().to_array().map(|c| c as u8);
            [r, g, b, 255]
        })
        .collect()
}

/// Returns the colour along a unit direction, in display values.
fn color(direction: Vec3, to_light: Vec3) -> Vec3 {
    let cosine = direction.dot(to_light);
    let glow = (0.35 * cosine.max(0.0).powi(12) + 0.65 * cosine.max(0.0).powi(160)).min(1.0);
    let height = direction.y;
    let above = sky(height).lerp(GLOW, 0.8 * glow);
    let (cover, shade) = clouds(direction, to_light);
    let cloud = CLOUD[1].lerp(CLOUD[0], shade).lerp(GLOW, 0.5 * glow);
    let clear = above.lerp(cloud, cover);
    let below = HAZE.lerp(GROUND, smooth(0.0, 0.35, -height).sqrt()).lerp(GLOW, 0.3 * glow);
    // The horizon is hazy: the two colours blend across it.
    let open = clear.lerp(below, smooth(0.004, -0.012, height)).min(Vec3::splat(BRIGHTEST));
    open.lerp(SUN, smooth(SUN_COSINES[0], SUN_COSINES[1], cosine))
}

/// Returns the colour of the clear sky from the sine of the height.
fn sky(height: f32) -> Vec3 {
    let height = height.max(0.0);
    let haze = (-height * 7.0).exp();
    SKY.lerp(ZENITH, smooth(0.05, 0.9, height)).lerp(HAZE, haze)
}

/// Returns how much of the sky a cloud covers along a direction, and its brightness, 0..=1.
fn clouds(direction: Vec3, to_light: Vec3) -> (f32, f32) {
    if direction.y <= 0.0 {
        return (0.0, 0.0);
    }
    let at = Vec2::new(direction.x, direction.z) * (CLOUD_HEIGHT / (direction.y + CLOUD_CURVE));
    let toward_sun = Vec2::new(to_light.x, to_light.z) * 0.15;
    let [here, sunward] = [at, at + toward_sun].map(fractal);
    let cover = smooth(0.48, 0.66, here) * smooth(0.02, 0.22, direction.y);
    // A cloud is darker where it is thicker, and where more of it lies toward the sun.
    let shade = 0.85 + 3.0 * (here - sunward) - 0.9 * smooth(0.55, 0.95, here);
    (0.95 * cover, shade.clamp(0.0, 1.0))
}

/// Returns noise of five octaves, 0..=1, each rotated to hide the lattice.
fn fractal(at: Vec2) -> f32 {
    let turn = Vec2::from_angle(0.65);
    let (mut at, mut sum, mut weight) = (at + Vec2::new(3.1, 7.7), 0.0, 0.5);
    for _ in 0..5 {
        sum += weight * noise(at);
        at = turn.rotate(at) * 2.03;
        weight *= 0.5;
    }
    sum / (1.0 - 2.0 * weight)
}

/// Returns smooth noise over a lattice of random numbers, 0..=1.
fn noise(at: Vec2) -> f32 {
    let cell = at.floor();
    let part = at - cell;
    let part = part * part * part * (part * (part * 6.0 - 15.0) + 10.0);
    let corner = |x, y| random(cell.as_ivec2() + glam::IVec2::new(x, y));
    let [top, bottom] = [0, 1].map(|y| corner(0, y) + (corner(1, y) - corner(0, y)) * part.x);
    top + (bottom - top) * part.y
}

/// Returns a number in 0..1 for a lattice point (the finaliser of PCG, O'Neill 2014, over both coordinates).
fn random(at: glam::IVec2) -> f32 {
    let mut hash = (at.x as u32).wrapping_mul(0x9e37_79b9) ^ (at.y as u32).wrapping_mul(0x85eb_ca6b);
    for _ in 0..2 {
        hash = hash.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        hash = ((hash >> ((hash >> 28) + 4)) ^ hash).wrapping_mul(277_803_737);
        hash ^= hash >> 22;
    }
    (hash >> 8) as f32 / 16_777_216.0
}

/// Returns 0 up to `from`, 1 beyond `to`, and smooth values between. `from` may be greater than `to`.
fn smooth(from: f32, to: f32, x: f32) -> f32 {
    let x = ((x - from) / (to - from)).clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
