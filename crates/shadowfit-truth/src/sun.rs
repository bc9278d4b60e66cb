//! Directions toward the sun: one for a hard sun, or many that are spread evenly over its disc.
//!
//! The directions form Vogel's spiral on the cap of the sphere.

use glam::DVec3;

use crate::spiral;

/// A sun prepared for rays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sun {
    to_light: DVec3,
    across: [DVec3; 2],
    /// One minus the cosine of the angular radius, computed without cancellation.
    cap: f64,
    rays: u32,
}

impl Sun {
    /// Prepares a sun. `to_light` is the unit direction toward its centre, `radius` the angular radius in
    /// radians.
    pub(crate) fn new(to_light: DVec3, radius: f64, rays: u32) -> Self {
        let is_soft = radius > 0.0 && rays > 1;
        let (first, second) =
            if to_light.is_normalized() { to_light.any_orthonormal_pair() } else { (DVec3::NAN, DVec3::NAN) };
        let half = (radius * 0.5).sin();
        Self { to_light, across: [first, second], cap: 2.0 * half * half, rays: if is_soft { rays } else { 1 } }
    }

    /// Returns the number of rays per point.
    pub(crate) fn rays(&self) -> u32 {
        self.rays
    }

    /// Returns the unit direction of the ray with an index below [`Self::rays`]. The spiral is turned by
    /// `turn` radians. A hard sun has one ray, toward its centre.
    pub(crate) fn direction(&self, ray: u32, turn: f64) -> DVec3 {
        if self.rays == 1 {
            return self.to_light;
        }
        // Parts of equal area on the cap have equal heights.
        let height = self.cap * (f64::from(ray) + 0.5) / f64::from(self.rays);
        let radius = (height * (2.0 - height)).sqrt();
        let (sin, cos) = spiral::sin_cos(ray, turn);
        self.to_light * (1.0 - height) + (self.across[0] * cos + self.across[1] * sin) * radius
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directions(sun: &Sun, pixel: usize) -> Vec<DVec3> {
        (0..sun.rays()).map(|ray| sun.direction(ray, spiral::turn_of(pixel))).collect()
    }

    #[test]
    fn a_hard_sun_has_one_ray_and_a_soft_one_as_many_as_asked_within_its_radius() {
        let to_light = DVec3::new(0.3, 0.8, -0.2).normalize();
        assert_eq!(directions(&Sun::new(to_light, 0.0, 64), 5), [to_light]);
        let directions = directions(&Sun::new(to_light, 0.1, 64), 5);
        assert_eq!(directions.len(), 64);
        assert!(directions.iter().all(|d| d.is_normalized() && d.angle_between(to_light) < 0.1));
        // The spread is even, so the mean points at the centre.
        let mean = directions.iter().sum::<DVec3>() / 64.0;
        assert!(mean.angle_between(to_light) < 0.1 * 0.02, "{}", mean.angle_between(to_light));
    }

    #[test]
    fn equal_discs_hold_equal_shares_of_the_rays() {
        let directions = directions(&Sun::new(DVec3::Y, 0.2, 400), 0);
        let within = |angle: f64| directions.iter().filter(|d| d.angle_between(DVec3::Y) < angle).count();
        // Half of the cap's area lies within its radius divided by √2, approximately.
        assert!(within(0.2 / 2.0f64.sqrt()).abs_diff(200) <= 1);
    }

    #[test]
    fn pixels_have_turned_patterns() {
        let sun = Sun::new(DVec3::Y, 0.2, 8);
        assert_ne!(directions(&sun, 0), directions(&sun, 1));
        assert_eq!(directions(&sun, 7), directions(&sun, 7));
    }
}
