//! A camera and a light: with the scene they make a picture.

use glam::Vec3;
use shadowfit::Camera;

/// A camera and a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Eye and lens; world space, metres.
    pub camera: Camera,
    /// Unit direction of travel of the light, world axes.
    pub direction: Vec3,
    /// Whether a path begins here: nothing is kept from the view before, and crawl is not measured.
    pub is_first: bool,
}
