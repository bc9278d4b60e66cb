//! A sample on the software adapter: its pictures, its map, and its figures compared with rays.

use shadowfit::PerspectiveCamera;
use shadowfit_classics::{Sample, SampleDrawer, SampleFigures, SampleOutcome, SampleValues, SampleVariant};
use shadowfit_render::passes::material_layout;
use shadowfit_render::{Gpu, RenderTarget};
use shadowfit_study::PreparedScene;

use crate::support::test_gpu;

/// A sample, ready to be drawn with one sample per pixel.
pub(super) struct Bench {
    pub(super) gpu: Gpu,
    pub(super) sample: &'static Sample,
    pub(super) scene: PreparedScene,
    drawer: SampleDrawer,
}

impl Bench {
    pub(super) fn new(id: &str) -> Self {
        let gpu = test_gpu();
        let sample = Sample::find(id).unwrap_or_else(|| panic!("there is no sample {id}"));
        let scene = PreparedScene::new(&gpu, &material_layout(&gpu.device), sample.scene()).expect("a scene");
        let drawer = SampleDrawer::new(&gpu, 1);
        Self { gpu, sample, scene, drawer }
    }

    pub(super) fn variant(&self, id: &str) -> &'static SampleVariant {
        let found = self.sample.variants.iter().find(|variant| variant.id == id);
        found.unwrap_or_else(|| panic!("{} has no variant {id}", self.sample.id))
    }

    /// Returns the values of a variant, or of the sample itself, with further options.
    pub(super) fn values(&self, variant: Option<&SampleVariant>, options: &[(&str, &str)]) -> SampleValues {
        let mut values = SampleValues::of_variant(self.sample, variant).expect("a variant");
        for (id, text) in options {
            values.set_from_str(id, text).unwrap_or_else(|error| panic!("{error}"));
        }
        values
    }

    /// Draws these values from a variant's camera. Returns four bytes per pixel.
    pub(super) fn picture(
        &mut self,
        variant: Option<&SampleVariant>,
        values: &SampleValues,
        size: [u32; 2],
    ) -> Vec<[u8; 4]> {
        let target = RenderTarget::new(&self.gpu.device, size, 1);
        let camera = self.sample.seen_by(variant, size[0] as f32 / size[1] as f32);
        self.draw(values, &camera, &target)
    }

    /// Draws these values through a camera.
    pub(super) fn draw(
        &mut self,
        values: &SampleValues,
        camera: &PerspectiveCamera,
        target: &RenderTarget,
    ) -> Vec<[u8; 4]> {
        let drawn = self.drawer.draw(&self.gpu, &mut self.scene, self.sample, values, camera, target);
        assert_eq!(drawn.expect("a picture"), SampleOutcome::Drawn { message: None });
        target.read(&self.gpu).expect("pixels").as_chunks().0.to_vec()
    }

    /// Returns the map of the last drawn picture as floats. Its format must have one channel of 32 bits.
    pub(super) fn map_of_floats(&self) -> Vec<f32> {
        let bytes = self.map_bytes();
        bytes.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect()
    }

    /// Returns the bytes of the map of the last drawn picture.
    pub(super) fn map_bytes(&self) -> Vec<u8> {
        self.drawer.read_map(&self.gpu).expect("a map").expect("a frame was drawn")
    }

    /// Returns the figures compared with rays, from a variant's camera in the original window size.
    pub(super) fn figures(&self, variant: Option<&SampleVariant>, values: &SampleValues) -> SampleFigures {
        let [width, height] = self.sample.size;
        let camera = self.sample.seen_by(variant, width as f32 / height as f32);
        SampleFigures::measure(self.gpu.clone(), self.sample, values, &camera, 0.0).expect("figures")
    }
}

/// Returns the number of different values.
pub(super) fn distinct<T: Ord>(values: impl IntoIterator<Item = T>) -> usize {
    values.into_iter().collect::<std::collections::BTreeSet<T>>().len()
}
