//! Maps for the tests of the cache.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{Aabb, Boxes, FitInput, FittedMaps, PerspectiveCamera, ShadowFitter, Technique};

/// Width and height of the maps, in texels.
pub(super) const SIDE: u32 = 2048;

/// Four windows of an eye at the world's origin that looks along -z, with shadows up to a distance in metres.
pub(super) fn fitted(direction: Vec3, far: f32, boxes: &[Aabb]) -> FittedMaps {
    let camera = PerspectiveCamera {
        eye: DVec3::new(0.0, 2.0, 0.0),
        forward: Vec3::NEG_Z,
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 1.5,
        near: 0.1,
        far: 500.0,
    };
    let views = [camera.frustum().expect("a camera")];
    let boxes = Boxes::world(boxes);
    let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, direction) };
    let technique = Technique::preset("windows-4").expect("a preset").with_resolution(SIDE, SIDE);
    let mut fitter = ShadowFitter::new(&technique.with_max_distance(far));
    *fitter.fit(&input).expect("maps")
}
