//! Parts that the samples with a lamp share: the map's matrices, our shadow test, and the shadows option.

pub mod test;

use glam::UVec2;
use shadowfit::bias::FilterRadius;
use shadowfit::diagnostics::DepthStorage;
use shadowfit::spot::{SpotBias, SpotFit, SpotLight};
use shadowfit::{DepthConvention, FitError, PerspectiveCamera};

use crate::mapped::{LightImage, LightPlace, MapRead, SampleFormat, SampleLight, SampleMapSettings, ShadowTest};
use crate::options::{OptionKind, SampleOption, SampleValues};

/// Option for the shadows of a lamp.
pub(crate) const SHADOWS: SampleOption = SampleOption {
    id: "shadows",
    label: "Shadows",
    help: "As the source, none, or ours: the same light with a map of the same size, with 32-bit depths, our bias and \
        a filter of 3 × 3 look-ups.",
    kind: OptionKind::Choice(&[("source", "as the source"), ("off", "none"), ("ours", "our map")]),
};

/// A lamp with its map, relative to a camera's eye.
pub(crate) struct Lamp {
    fit: SpotFit,
}

impl Lamp {
    /// Creates the lamp with a map of a size in texels.
    pub(crate) fn new(light: &SpotLight, map: [u32; 2], camera: &PerspectiveCamera) -> Result<Self, FitError> {
        let fit = light.fit(UVec2::from(map), DepthConvention::ZeroToOne)?.relative_to(camera.eye);
        Ok(Self { fit })
    }

    /// Returns the light of a frame.
    pub(crate) fn light(&self, image: LightImage) -> SampleLight {
        let place = LightPlace::At(self.fit.position);
        SampleLight { clip_from_world: self.fit.clip_from_world, place, image }
    }

    /// Returns map and test of a frame by the option [`SHADOWS`]. `map` and `test` are the source's.
    pub(crate) fn shadows(
        &self,
        values: &SampleValues,
        map: SampleMapSettings,
        test: ShadowTest,
        lit_outside: bool,
    ) -> Result<(SampleMapSettings, ShadowTest), FitError> {
        Ok(match values.choice(SHADOWS.id) {
            "off" => (map, ShadowTest::OFF),
            "ours" => (self.our_map(), self.our_test(lit_outside)?),
            _ => (map, test),
        })
    }

    /// Returns the map that our test reads, as large as the source's.
    fn our_map(&self) -> SampleMapSettings {
        let size = self.fit.resolution.to_array();
        SampleMapSettings { compares_linearly: true, ..SampleMapSettings::new(size, SampleFormat::Depth32) }
    }

    /// Returns our test, with the least bias that avoids acne on planes. Each look-up is compared with the
    /// plane's depth there, so the bias only covers the reach of one look-up.
    fn our_test(&self, lit_outside: bool) -> Result<ShadowTest, FitError> {
        let bias = SpotBias::automatic_receiver_plane(FilterRadius::HARDWARE_2X2, DepthStorage::Float32, &self.fit)?;
        let rise = self.fit.texel_size * self.fit.depth_scale() as f32;
        let numbers = [bias.constant_depth, bias.distance_depth, bias.constant_offset, bias.receiver_plane];
        Ok(ShadowTest {
            further: [rise.x, rise.y, f32::from(u8::from(lit_outside)), 0.0],
            reads: MapRead::Compared,
            reach: 2.0,
            ..ShadowTest::nearest("ours", include_str!("test.wgsl"), numbers)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SAMPLES, SampleDrawing, SampleValues};

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
