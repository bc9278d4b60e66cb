//! A camera and a light, which make a picture of a scene.

use glam::Vec3;
use shadowfit::Camera;

/// A camera and a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Eye and lens; world space, metres.
    pub camera: Camera,
    /// Unit direction of travel of the light, world axes.
    pub direction: Vec3,
    /// Whether a path starts here: no state is kept from the previous view, and crawl is not measured.
    pub is_first: bool,
}
