//! Directions toward the sun: one for a hard sun, or many spread evenly over its disc.
//!
//! The spread is Vogel's spiral (H. Vogel, "A better way to construct the sunflower head", 1979) on
//! the cap of the sphere: it has no rows, so that no straight shadow edge falls between two of them.

use core::f64::consts::TAU;

use glam::DVec3;

/// Turn between consecutive directions, in radians: the golden angle.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// A sun as rays see it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sun {
    to_light: DVec3,
    across: [DVec3; 2],
    /// One minus the cosine of the angular radius, without loss of digits.
    cap: f64,
    rays: u32,
}

impl Sun {
    /// `to_light` is the unit direction toward the centre, `radius` the angular radius in radians.
    pub(crate) fn new(to_light: DVec3, radius: f64, rays: u32) -> Self {
        let is_soft = radius > 0.0 && rays > 1;
        let (first, second) =
            if to_light.is_normalized() { to_light.any_orthonormal_pair() } else { (DVec3::NAN, DVec3::NAN) };
        let half = (radius * 0.5).sin();
        Self { to_light, across: [first, second], cap: 2.0 * half * half, rays: if is_soft { rays } else { 1 } }
    }

    /// The unit direction toward the sun's centre.
    pub(crate) fn centre(&self) -> DVec3 {
        self.to_light
    }

    /// Number of rays of a point.
    pub(crate) fn rays(&self) -> u32 {
        self.rays
    }

    /// Unit directions of a pixel's rays; for a hard sun only that toward the centre.
    pub(crate) fn directions(&self, pixel: usize) -> impl Iterator<Item = DVec3> {
        let sun = *self;
        let turn = turn_of(pixel);
        (0..sun.rays).map(move |ray| if sun.rays == 1 { sun.to_light } else { sun.direction(ray, turn) })
    }

    fn direction(&self, ray: u32, turn: f64) -> DVec3 {
        // Equal parts of the cap's area are equal parts of its height.
        let height = self.cap * (f64::from(ray) + 0.5) / f64::from(self.rays);
        let radius = (height * (2.0 - height)).sqrt();
        let (sin, cos) = (f64::from(ray) * GOLDEN_ANGLE + turn).sin_cos();
        self.to_light * (1.0 - height) + (self.across[0] * cos + self.across[1] * sin) * radius
    }
}

/// How far a pixel's pattern is turned, in radians, so that neighbouring pixels have different errors.
fn turn_of(pixel: usize) -> f64 {
    // Fibonacci hashing: the upper bits of the product with 2^64 over the golden ratio.
    let hash = (pixel as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let hash = (hash ^ (hash >> 32)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    (hash >> 11) as f64 / (1u64 << 53) as f64 * TAU
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hard_sun_has_one_ray_and_a_soft_one_as_many_as_asked_within_its_radius() {
        let to_light = DVec3::new(0.3, 0.8, -0.2).normalize();
        assert_eq!(Sun::new(to_light, 0.0, 64).directions(5).collect::<Vec<_>>(), [to_light]);
        let sun = Sun::new(to_light, 0.1, 64);
        let directions: Vec<DVec3> = sun.directions(5).collect();
        assert_eq!(directions.len(), 64);
        assert!(directions.iter().all(|d| d.is_normalized() && d.angle_between(to_light) < 0.1));
        // The mean points at the centre: the spread is even.
        let mean = directions.iter().sum::<DVec3>() / 64.0;
        assert!(mean.angle_between(to_light) < 0.1 * 0.02, "{}", mean.angle_between(to_light));
    }

    #[test]
    fn equal_discs_hold_equal_shares_of_the_rays() {
        let sun = Sun::new(DVec3::Y, 0.2, 400);
        let within = |angle: f64| sun.directions(0).filter(|d| d.angle_between(DVec3::Y) < angle).count();
        // Half of the cap's area lies within about its radius over the square root of 2.
        assert!(within(0.2 / 2.0f64.sqrt()).abs_diff(200) <= 1);
    }

    #[test]
    fn pixels_have_turned_patterns() {
        let sun = Sun::new(DVec3::Y, 0.2, 8);
        assert_ne!(sun.directions(0).collect::<Vec<_>>(), sun.directions(1).collect::<Vec<_>>());
        assert_eq!(sun.directions(7).collect::<Vec<_>>(), sun.directions(7).collect::<Vec<_>>());
    }
}
