//! Lamps of samples: their maps by the core's spot light, and the map that takes the source's place for comparison.

use glam::{DVec3, UVec2};
use shadowfit::bias::Reach;
use shadowfit::settings::MapFormat;
use shadowfit::{DepthConvention, FitError, PerspectiveCamera, SpotBias, SpotFit, SpotLight};
use shadowfit_render::samples::{
    CasterFaces, LightImage, LightPlace, SampleFormat, SampleLight, SampleMapSettings, ShadowTest, StoredDepth,
};

/// A lamp: where it stands, what it looks at, and its perspective.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lamp {
    pub(super) position: DVec3,
    pub(super) target: DVec3,
    /// Angle of its image from the lower to the upper side, in radians.
    pub(super) fov_y: f32,
    pub(super) aspect: f32,
    pub(super) near: f32,
    pub(super) far: f32,
}

impl Lamp {
    /// Its map of a size in texels, for positions relative to a camera's eye.
    pub(super) fn fit(&self, size: [u32; 2], camera: &PerspectiveCamera) -> Result<SpotFit, FitError> {
        let Self { position, target, fov_y, aspect, near, far } = *self;
        let light = SpotLight::toward(position, target, fov_y, aspect, near, far);
        Ok(light.fit(UVec2::from(size), DepthConvention::ZeroToOne)?.relative_to(camera.eye))
    }

    /// It, as samples are drawn, with the picture that it throws.
    pub(super) fn light(&self, fit: &SpotFit, image: LightImage) -> SampleLight {
        SampleLight { clip_from_world: fit.clip_from_world, place: LightPlace::At(self.position), image }
    }
}

/// The map that takes the source's place: 32-bit depths, compared by a linear sampler.
pub(super) const fn our_map(size: [u32; 2]) -> SampleMapSettings {
    SampleMapSettings {
        size,
        format: SampleFormat::Depth32,
        depth: StoredDepth::Plain,
        clear: 1,
        faces: CasterFaces::All,
        compares_linearly: true,
    }
}

/// The test that reads it, with the least bias that clears planes: each look-up is compared with the plane's own depth, so
/// that the bias covers the reach of one.
pub(super) fn our_test(fit: &SpotFit, lit_outside: bool) -> Result<ShadowTest, FitError> {
    let bias = SpotBias::automatic_receiver_plane(Reach::HARDWARE_2X2, MapFormat::Depth32Float, fit)?;
    Ok(ShadowTest::Ours { bias, rise: fit.texel_size * fit.depth_scale() as f32, lit_outside })
}
