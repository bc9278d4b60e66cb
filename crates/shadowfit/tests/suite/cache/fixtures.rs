//! Maps for the tests of the cache, and for its fuzz target.

use shadowfit::cache::{CacheSettings, Culling};
use shadowfit::glam::{DVec3, UVec2, Vec3};
use shadowfit::{Aabb, Boxes, FitInput, FittedMaps, PerspectiveCamera, ShadowFitter, Technique};

/// Width and height of the maps, in texels.
pub(crate) const SIDE: u32 = 2048;

/// Returns settings for the technique's maps, drawn with depth clamp.
pub(crate) fn settings(caching: bool, culling: Culling) -> CacheSettings {
    CacheSettings { caching, culling, depth_clamp: true, layer: UVec2::splat(SIDE), ..CacheSettings::default() }
}

/// Returns four windows for an eye at the world's origin that looks along -z, with shadows up to a distance
/// in metres.
pub(crate) fn fitted(direction: Vec3, far: f32, boxes: &[Aabb]) -> FittedMaps {
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
