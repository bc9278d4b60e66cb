//! The samples' WGSL: every file is used, every module is valid and has its passes' entry points, and WebGL2
//! supports the modules that it receives.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use naga::ShaderStage::{Fragment, Vertex};
use naga::valid::Capabilities;
use shadowfit_classics::mapped::SampleFrame;
use shadowfit_classics::{SAMPLES, SampleDrawing, SampleValues, mapped, occlusion, sky_box};
use shadowfit_render::passes::Numbering;
use shadowfit_testing::package_folder;
use shadowfit_testing::pairs::full_product;
use shadowfit_testing::wgsl::{Shader, assert_every_file_is_used};

use super::layout;

/// Options of samples that change the WGSL. If a sample lacks an option or a choice, it keeps its source's
/// choice.
const OPTIONS: [Choices; 3] = [
    Choices { option: "shadows", choices: &["source", "off", "ours"] },
    Choices { option: "lighting", choices: &["source", "modern"] },
    Choices { option: "format", choices: &["r32f", "rgba8", "grey8", "r16f"] },
];

/// An option and its choices.
struct Choices {
    option: &'static str,
    choices: &'static [&'static str],
}

/// Returns the number of samples, and of choices of each option.
fn counts() -> [usize; 4] {
    let [shadows, lighting, format] = OPTIONS.each_ref().map(|option| option.choices.len());
    [SAMPLES.len(), shadows, lighting, format]
}

/// Returns the frame of a sample with one choice per option, all by index. Returns `None` if the sample does
/// not use a single map.
fn frame(row: &[usize]) -> Option<SampleFrame> {
    let [sample, options @ ..] = row else { panic!("a sample and its options") };
    let sample = &SAMPLES[*sample];
    let mut values = SampleValues::new(sample);
    for (Choices { option, choices }, choice) in OPTIONS.iter().zip(options) {
        let _ = values.set_from_str(option, choices[*choice]);
    }
    match sample.drawing(&values, &sample.lens(1.0)) {
        Ok(SampleDrawing::Mapped(frame)) => Some(frame),
        _ => None,
    }
}

/// Returns the frames of all samples with all combinations of choices.
pub(crate) fn frames() -> Vec<SampleFrame> {
    full_product(&counts()).iter().filter_map(|row| frame(row)).collect()
}

/// A module and its requirements.
struct Module {
    shader: Shader,
    needed: Capabilities,
}

impl Module {
    fn is_for_webgl2(&self) -> bool {
        // WebGL2 has no primitive indices.
        self.needed.is_empty()
    }
}

/// Returns the modules of frames, each text once.
fn modules_of(frames: &[SampleFrame]) -> Vec<Module> {
    let mut names = BTreeMap::new();
    for frame in frames {
        let kind = format!("{:?} {} {}", frame.map.format, frame.test.name, frame.shading.name);
        let probe = |numbering| mapped::shaders::probe(frame, numbering);
        names.insert(mapped::shaders::inset(frame.map.format), format!("inset, {kind}"));
        names.insert(mapped::shaders::shaded(frame), format!("shaded, {kind}"));
        names.insert(probe(Numbering::Vertices), format!("unrolled probe, {kind}"));
        names.insert(probe(Numbering::Primitives), format!("probe, {kind}"));
    }
    let module = |(source, name): (String, String)| {
        let is_probe = name.starts_with("probe");
        let needed = if is_probe { Capabilities::PRIMITIVE_INDEX } else { Capabilities::empty() };
        Module { shader: Shader::new(name, source), needed }
    };
    names.into_iter().map(module).collect()
}

/// Every module of the samples.
static MODULES: LazyLock<Vec<Module>> = LazyLock::new(|| {
    let others = [
        ("caster", mapped::shaders::caster()),
        ("occlusion surface", occlusion::shaders::surface()),
        ("occlusion shade", occlusion::shaders::shade()),
        ("occlusion gather", occlusion::shaders::gather()),
        ("occlusion blur", occlusion::shaders::blur()),
        ("occlusion view", occlusion::shaders::view()),
        ("sky box", sky_box::WGSL.to_owned()),
    ];
    let others =
        others.map(|(name, source)| Module { shader: Shader::new(name, source), needed: Capabilities::empty() });
    modules_of(&frames()).into_iter().chain(others).collect()
});

#[test]
fn every_wgsl_file_stands_whole_in_some_module() {
    let folder = package_folder(env!("CARGO_MANIFEST_DIR")).join("src");
    let texts: Vec<&str> = MODULES.iter().map(|module| module.shader.source.as_str()).collect();
    assert_every_file_is_used(&folder, &texts, |file| ["0", "1"].map(|group| file.replace("GROUP", group)).into());
}

#[test]
fn every_module_is_valid_and_probes_alone_need_an_optional_capability() {
    for module in &*MODULES {
        module.shader.assert_valid(module.needed);
    }
}

#[test]
fn every_module_has_the_entry_points_of_its_passes() {
    for module in &*MODULES {
        module.shader.assert_has_stages(&[Vertex, Fragment]);
    }
}

#[test]
fn modules_that_draw_can_be_translated_for_webgl2_and_their_uniforms_are_whole_vectors() {
    let drawn: Vec<&Module> = MODULES.iter().filter(|module| module.is_for_webgl2()).collect();
    assert!(drawn.len() > MODULES.len() / 2, "{} of {} modules", drawn.len(), MODULES.len());
    for module in drawn {
        module.shader.assert_translates_to_webgl2();
    }
}

#[test]
fn every_uniform_of_every_module_is_one_whose_layout_is_compared() {
    for module in &*MODULES {
        layout::assert_uniforms_are_compared(&module.shader);
    }
}
