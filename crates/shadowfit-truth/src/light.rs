//! The light that truth is traced to, and the rays from a point toward it.
//!
//! A sun has a direction and is infinitely far away. A spot has a position, and objects beyond it cast no
//! shadow.

use glam::{DMat4, DVec3};

use crate::spiral;
use crate::sun::Sun;

/// Default number of rays in the cone of a sun.
const SUN_RAYS: u32 = 64;

/// A light. World space, right-handed, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TruthLight {
    /// An infinitely distant light.
    Sun {
        /// Unit direction toward the light, world axes.
        to_light: DVec3,
        /// Angular radius, in radians; 0 for hard shadows.
        radius: f64,
        /// Rays in its cone. Used only if the radius is greater than 0.
        rays: u32,
    },
    /// A point light with hard shadows: a headlight or a lamp.
    Spot {
        /// Position of the light.
        position: DVec3,
        /// Matrix clip from world of the light's perspective, with x and y in -1..=1 and depth in 0..=1 after
        /// division by w, plain or reversed, and w above 0 in front of the light. Points outside of the
        /// image, nearer than its near plane or beyond its far plane are not judged. `None` for a light that
        /// shines in all directions.
        image: Option<DMat4>,
    },
}

/// A straight line from a point to the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightRay {
    /// Unit direction toward the light, world axes. Zero if the point is at the light's position.
    pub direction: DVec3,
    /// Distance to the light, in metres. Infinite for a sun.
    pub length: f64,
}

impl TruthLight {
    /// Returns a sun with hard shadows. `to_light` is the unit direction toward it, world axes.
    pub fn sun(to_light: DVec3) -> Self {
        Self::Sun { to_light, radius: 0.0, rays: SUN_RAYS }
    }

    /// Returns the ray from a world point to the light. For a sun with a radius, it leads to the sun's
    /// centre.
    pub fn ray_from(&self, point: DVec3) -> LightRay {
        match self {
            Self::Sun { to_light, .. } => LightRay { direction: *to_light, length: f64::INFINITY },
            Self::Spot { position, .. } => LightRay::between(point, *position),
        }
    }

    /// Returns whether the light shines toward a world point if nothing blocks it: whether the point is
    /// inside of a spot's image, borders included. A light without an image shines toward every point.
    pub fn shines_toward(&self, point: DVec3) -> bool {
        let Self::Spot { image: Some(clip_from_world), .. } = self else { return true };
        let clip = *clip_from_world * point.extend(1.0);
        let is_within = clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && (0.0..=clip.w).contains(&clip.z);
        clip.w > 0.0 && is_within
    }

    /// Returns the same light with this number of rays. A spot is returned unchanged.
    pub(crate) fn with_rays(self, number: u32) -> Self {
        match self {
            Self::Sun { to_light, radius, .. } => Self::Sun { to_light, radius, rays: number },
            spot @ Self::Spot { .. } => spot,
        }
    }

    /// Prepares the light's rays.
    pub(crate) fn rays(&self) -> LightRays {
        match *self {
            Self::Sun { to_light, radius, rays } => LightRays::Sun(Sun::new(to_light, radius, rays)),
            Self::Spot { position, .. } => LightRays::Spot(position),
        }
    }
}

impl LightRay {
    fn between(from: DVec3, to: DVec3) -> Self {
        let way = to - from;
        Self { direction: way.normalize_or_zero(), length: way.length() }
    }
}

/// A light that is prepared for many points.
#[derive(Clone, Copy, Debug)]
pub(crate) enum LightRays {
    Sun(Sun),
    /// The light's position.
    Spot(DVec3),
}

impl LightRays {
    /// Returns the number of rays per point.
    pub(crate) fn count(&self) -> u32 {
        match self {
            Self::Sun(sun) => sun.rays(),
            Self::Spot(_) => 1,
        }
    }

    /// Returns the rays of a pixel that start at `origin`, world space. A single ray leads to the light's
    /// centre.
    pub(crate) fn from(&self, origin: DVec3, pixel: usize) -> impl Iterator<Item = LightRay> {
        let (rays, turn) = (*self, spiral::turn_of(pixel));
        (0..rays.count()).map(move |ray| match rays {
            Self::Sun(sun) => LightRay { direction: sun.direction(ray, turn), length: f64::INFINITY },
            Self::Spot(position) => LightRay::between(origin, position),
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::dcamera::rh::{proj::directx::perspective, view::look_to_mat4};

    use super::*;

    /// Returns a light that shines straight down from 3 m over the origin, 90 degrees wide, from 1 m to 5 m.
    fn image() -> DMat4 {
        let view = look_to_mat4(DVec3::Y * 3.0, DVec3::NEG_Y, DVec3::X);
        perspective(90f64.to_radians(), 1.0, 1.0, 5.0) * view
    }

    #[test]
    fn a_spots_rays_end_at_its_position_and_a_suns_have_no_end() {
        let spot = TruthLight::Spot { position: DVec3::new(1.0, 4.0, 3.0), image: None };
        let point = DVec3::new(1.0, 0.0, 0.0);
        let LightRay { direction, length } = spot.ray_from(point);
        assert!(direction.abs_diff_eq(DVec3::new(0.0, 0.8, 0.6), 1e-15) && length == 5.0, "{direction} {length}");
        assert_eq!(spot.rays().from(point, 7).collect::<Vec<_>>(), [spot.ray_from(point)]);
        let at_it = spot.ray_from(DVec3::new(1.0, 4.0, 3.0));
        assert_eq!(at_it, LightRay { direction: DVec3::ZERO, length: 0.0 });
        let sun = TruthLight::sun(DVec3::Y);
        assert_eq!(sun.ray_from(point), LightRay { direction: DVec3::Y, length: f64::INFINITY });
        assert_eq!(sun.rays().count(), 1);
    }

    #[test]
    fn a_spot_shines_inside_of_its_image_alone_whichever_way_its_depth_runs() {
        let reverse = DMat4::from_cols_array_2d(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, -1.0, 0.0],
            [0.0, 0.0, 1.0, 1.0],
        ]);
        for image in [image(), reverse * image()] {
            let spot = TruthLight::Spot { position: DVec3::Y * 3.0, image: Some(image) };
            // At the ground, 3 m below the light, the image reaches 3 m to each side.
            for (point, is_inside) in [
                (DVec3::ZERO, true),
                (DVec3::new(2.99, 0.0, -2.99), true),
                (DVec3::new(3.01, 0.0, 0.0), false),
                (DVec3::new(0.0, 0.0, -3.01), false),
                (DVec3::Y * 1.99, true),
                (DVec3::Y * 2.01, false),
                (DVec3::Y * -1.99, true),
                (DVec3::Y * -2.01, false),
                (DVec3::Y * 5.0, false),
                (DVec3::NAN, false),
            ] {
                assert_eq!(spot.shines_toward(point), is_inside, "{point}");
            }
        }
        let lamp = TruthLight::Spot { position: DVec3::Y * 3.0, image: None };
        assert!(lamp.shines_toward(DVec3::Y * 5.0) && TruthLight::sun(DVec3::Y).shines_toward(DVec3::Y * 5.0));
    }
}
