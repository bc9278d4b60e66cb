//! Every view, artefact, filter, format and sample on devices that lack common features. The device refuses
//! nothing, and impossible requests give a message.

use shadowfit::Technique;
use shadowfit::settings::{Edges, FilterKind, MapFormat};
use shadowfit_classics::SAMPLES;
use shadowfit_params::tool::{ErrorMarks, InsetMaps, ViewMode};
use shadowfit_render::{Gpu, RenderTarget, Wanted};
use shadowfit_scene::builtin::default_scene;
use shadowfit_viewer::{Artefact, Stage};

use crate::support::test_gpu;

/// Size of the pictures, in pixels.
const SIZE: [u32; 2] = [64, 36];

/// Returns the devices by their missing parts: a single feature, or all features with lower and lower limits.
fn classes() -> [(&'static str, Wanted); 6] {
    let all = Wanted::default().features;
    let without = |feature| Wanted { features: all - feature, limits: None };
    let bare = |limits| Wanted { features: wgpu::Features::empty(), limits: Some(limits) };
    [
        ("timestamps", without(wgpu::Features::TIMESTAMP_QUERY)),
        ("depth clamp", without(wgpu::Features::DEPTH_CLIP_CONTROL)),
        ("the primitive index", without(wgpu::Features::PRIMITIVE_INDEX)),
        ("every feature", bare(wgpu::Limits::default())),
        ("WebGPU's limits", bare(wgpu::Limits::downlevel_defaults())),
        ("compute and WebGL2's limits", bare(wgpu::Limits::downlevel_webgl2_defaults())),
    ]
}

struct Class {
    lacks: &'static str,
    stage: Stage,
    target: RenderTarget,
}

impl Class {
    fn new(lacks: &'static str, wanted: &Wanted) -> Self {
        let gpu = pollster::block_on(Gpu::of_adapter(test_gpu().adapter, wanted)).expect("a device with less");
        gpu.keep_faults();
        let mut stage = Stage::new(gpu, default_scene(), 4).expect("the default scene");
        stage.wait_for_rays();
        stage.settings.technique.fit.resolution = glam::UVec2::splat(256);
        let target = stage.target(SIZE);
        Self { lacks, stage, target }
    }

    /// Draws a picture, which must not be of a single colour. Returns the stage's message about it.
    fn draw(&mut self, what: &str) -> Option<String> {
        self.stage.draw(&self.target);
        let pixels = self.target.read(self.stage.gpu()).expect("a device that works");
        let said = self.stage.problem().map(str::to_owned);
        let lacks = self.lacks;
        assert_eq!(self.stage.gpu().take_faults(), [], "without {lacks}: {what}: {said:?}");
        assert!(pixels.chunks_exact(4).any(|pixel| pixel != &pixels[..4]), "without {lacks}: {what} is of one colour");
        said
    }

    /// Draws a picture that every device must be able to draw.
    fn draw_well(&mut self, what: &str) {
        assert_eq!(self.draw(what), None, "without {}: {what}", self.lacks);
    }
}

/// Classes that lack a single feature.
const SINGLE: usize = 3;

/// The weakest class: WebGL2's limits.
const LEAST: usize = 5;

/// Returns a function that selects two classes for each item: the class with the least limits, and one other
/// class from `first` on. Most shaders are the same on all classes.
fn in_turn(first: usize) -> impl Fn(usize, usize) -> bool {
    move |class, thing| class == LEAST || first + thing % (LEAST - first) == class
}

#[test]
fn every_view_and_artefact_is_shown_with_the_least_limits_and_on_another_class_of_device() {
    assert_shown(in_turn(0));
}

#[test]
#[ignore = "the full product of views and devices: cargo xtask test --all"]
fn every_view_and_artefact_is_shown_on_every_class_of_device() {
    assert_shown(|_, _| true);
}

/// Asserts that classes of devices show the selected views and artefacts, and everything else. `is_shown`
/// gets both indices.
fn assert_shown(is_shown: impl Fn(usize, usize) -> bool) {
    for (number, (lacks, wanted)) in classes().into_iter().enumerate() {
        let mut class = Class::new(lacks, &wanted);
        let modes = ViewMode::ALL.into_iter().enumerate().filter(|(view, _)| is_shown(number, *view));
        for (_, mode) in modes {
            class.stage.settings.view.mode = mode;
            class.draw_well(&format!("{mode:?}"));
        }
        class.stage.settings.view.mode = ViewMode::Final;
        class.stage.settings.view.inset = InsetMaps::All;
        class.draw_well("all maps in the inset");
        class.stage.settings.view.marks = ErrorMarks::Outline;
        class.draw_well("marks");
        class.stage.compare_with(Technique::preset("stable-4"));
        class.draw_well("two techniques");
        class.stage.compare_with(None);
        let artefacts = [Artefact::Acne, Artefact::Aliasing, Artefact::ClippingHole].into_iter().enumerate();
        for (_, artefact) in artefacts.filter(|(artefact, _)| is_shown(number, *artefact)) {
            class.stage.show_artefact(artefact);
            class.draw_well(&format!("{artefact:?}"));
            class.stage.fix_artefact(artefact);
            class.draw_well(&format!("{artefact:?} cured"));
        }
    }
}

#[test]
fn every_filter_and_format_is_drawn_with_the_least_limits_and_on_another_bare_class_of_device_or_refused_in_words() {
    assert_drawn_or_refused(in_turn(SINGLE));
}

#[test]
#[ignore = "the full product of filters, formats and devices: cargo xtask test --all"]
fn every_filter_and_format_is_drawn_on_every_bare_class_of_device_or_refused_in_words() {
    assert_drawn_or_refused(|_, _| true);
}

/// Asserts that bare classes of devices draw the selected filters and formats. `is_drawn` gets both indices.
fn assert_drawn_or_refused(is_drawn: impl Fn(usize, usize) -> bool) {
    for (number, (lacks, wanted)) in classes().into_iter().enumerate().skip(SINGLE) {
        let mut class = Class::new(lacks, &wanted);
        let filters = FilterKind::ALL.into_iter().enumerate().filter(|(filter, _)| is_drawn(number, *filter));
        for (_, filter) in filters {
            class.stage.settings.technique.filter = filter;
            class.draw_well(&format!("{filter:?}"));
        }
        class.stage.settings.technique.filter = FilterKind::default();
        let formats = MapFormat::ALL.into_iter().enumerate().filter(|(format, _)| is_drawn(number, *format));
        for (_, format) in formats {
            class.stage.settings.technique.format = format;
            // Not every device can render to colours.
            if let Some(said) = class.draw(&format!("{format:?}")) {
                assert!(said.contains(&format!("{format:?}")), "without {lacks}: {said}");
            }
        }
        class.stage.settings.technique.format = MapFormat::default();
        class.stage.settings.technique.edges = Edges::Traced { samples: Edges::USUAL_SAMPLES };
        let said = class.draw("traced edges");
        let can_trace = wanted.limits.is_none_or(|limits| limits.max_storage_buffers_per_shader_stage >= 5);
        match said {
            Some(said) => {
                let is_told = said.contains("Edges are filtered") || said.contains("use shadow maps alone");
                assert!(!can_trace && is_told, "without {lacks}: {said}");
            }
            None => assert!(can_trace, "without {lacks} edges are traced"),
        }
    }
}

#[test]
fn every_sample_is_drawn_on_a_bare_class_of_device() {
    assert_drawn(|class, sample| sample % SINGLE == class);
}

#[test]
#[ignore = "the full product of samples and devices: cargo xtask test --all"]
fn every_sample_is_drawn_on_every_bare_class_of_device() {
    assert_drawn(|_, _| true);
}

/// Asserts that bare classes of devices draw the selected samples. `is_drawn` gets both indices.
fn assert_drawn(is_drawn: impl Fn(usize, usize) -> bool) {
    for (number, (lacks, wanted)) in classes().into_iter().skip(SINGLE).enumerate() {
        let mut class = Class::new(lacks, &wanted);
        let samples = SAMPLES.iter().enumerate().filter(|(sample, _)| is_drawn(number, *sample));
        for (_, sample) in samples {
            class.stage.set_scene(sample.scene()).expect("the sample's scene");
            class.stage.set_sample(sample, None);
            class.draw(sample.title);
        }
    }
}
