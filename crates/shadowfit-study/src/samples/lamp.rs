//! What the samples with a lamp share: its map's matrices, our test of it, and what the options say.

use glam::{DVec3, UVec2};
use shadowfit::bias::Reach;
use shadowfit::diagnostics::DepthStorage;
use shadowfit::{DepthConvention, FitError, PerspectiveCamera, SpotBias, SpotFit, SpotLight};
use shadowfit_render::samples::{
    CasterFaces, LightImage, LightPlace, SampleFormat, SampleLight, SampleMapSettings, ShadowTest, StoredDepth,
};

use super::options::{OptionKind, SampleOption};

/// What shadows of a lamp can be.
pub(super) const SHADOWS: SampleOption = SampleOption {
    id: "shadows",
    label: "Shadows",
    help: "As the source, none, or ours: the same light with a map of 2048² 32-bit depths, our bias and a filter of 3 × 3 \
           look-ups.",
    kind: OptionKind::Choice(&[("source", "as the source"), ("off", "none"), ("ours", "modern maps")]),
};

/// Look-ups of our filter, each way.
const LOOK_UPS: u32 = 3;

/// Width and height of our map, as the recommended technique has them for a sun.
const OUR_MAP: u32 = 2048;

/// A lamp with our map of it, relative to a camera's eye.
pub(super) struct Lamp {
    fit: SpotFit,
}

impl Lamp {
    pub(super) fn new(light: &SpotLight, camera: &PerspectiveCamera) -> Result<Self, FitError> {
        let fit = light.fit(UVec2::splat(OUR_MAP), DepthConvention::ZeroToOne)?.relative_to(camera.eye);
        Ok(Self { fit })
    }

    /// The light that a frame has.
    pub(super) fn light(&self, image: LightImage) -> SampleLight {
        let place = LightPlace::At(self.fit.position);
        SampleLight { clip_from_world: self.fit.clip_from_world, place, image }
    }

    /// The map that our test reads.
    pub(super) fn our_map(&self) -> SampleMapSettings {
        SampleMapSettings {
            size: self.fit.resolution.to_array(),
            format: SampleFormat::Depth32,
            depth: StoredDepth::Plain,
            clear: 1,
            faces: CasterFaces::All,
            compares_linearly: true,
        }
    }

    /// Our test, with the bias that its filter needs.
    pub(super) fn our_test(&self, lit_outside: bool) -> Result<ShadowTest, FitError> {
        let bias = SpotBias::automatic(Reach::kernel(LOOK_UPS), DepthStorage::Float32, &self.fit)?;
        Ok(ShadowTest::Ours { bias, lit_outside })
    }
}

/// A square image of 90° that a headlight throws from its place in the street.
pub(super) fn headlight(target: DVec3, near: f32) -> SpotLight {
    SpotLight::toward(HEADLIGHT, target, core::f32::consts::FRAC_PI_2, 1.0, near, 100.0)
}

/// Where the headlight is, in the street's units.
const HEADLIGHT: DVec3 = DVec3::new(-18.0, 5.0, -2.0);

#[cfg(test)]
mod tests {
    use super::super::SAMPLES;
    use super::*;
    use crate::samples::{SampleDrawing, SampleValues};

    #[test]
    fn the_direction_of_a_lamps_sample_is_that_of_its_axis() {
        let mut lamps = 0;
        for sample in &SAMPLES {
            let Ok(SampleDrawing::Mapped(frame)) = sample.drawing(&SampleValues::new(sample), &sample.lens(1.0)) else {
                continue;
            };
            if !matches!(frame.light.place, LightPlace::At(_)) {
                continue;
            }
            lamps += 1;
            let axis = frame.light.clip_from_world.row(3).truncate();
            assert!(axis.abs_diff_eq(sample.direction, 1e-5), "{}: {axis}", sample.id);
        }
        assert!(lamps >= 3, "{lamps}");
    }
}
