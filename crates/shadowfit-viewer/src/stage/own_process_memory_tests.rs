//! Memory use of frames, and devices with little memory. Each test runs in a separate process, because it
//! measures or limits the memory of the process.

use rustix::process::{Resource, Rlimit};
use shadowfit::settings::FilterKind;
use shadowfit::{PRESETS, Technique};
use shadowfit_params::tool::{ErrorMarks, ViewMode};
use shadowfit_render::{Gpu, Wanted};
use shadowfit_scene::builtin::default_scene;
use shadowfit_testing::{adapter_choice, open_renderer_gpu};

use super::*;
use crate::platform::memory;

/// Frames until a view has all its maps and pipelines, and number of later frames.
const FRAMES: [u32; 2] = [6, 20];
/// Greatest memory growth by drivers and allocators over the later frames, in bytes. Compiling a shader in
/// each frame would take ten times this.
const MOST: u64 = 10_000_000;

#[test]
fn a_view_that_stays_takes_no_more_memory_with_each_frame() {
    let gpu = open_renderer_gpu();
    let mut stage = Stage::new(gpu, default_scene(), 1).expect("the default scene");
    stage.wait_for_rays();
    stage.settings.technique.fit.resolution = glam::UVec2::splat(256);
    let target = stage.target([96, 54]);
    let mut draw = |mode, marks, frames| {
        (stage.settings.view.mode, stage.settings.view.marks) = (mode, marks);
        for _ in 0..frames {
            stage.draw(&target);
            assert_eq!(stage.problem(), None);
            stage.gpu().device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
        }
    };
    let views = ViewMode::ALL.map(|mode| (mode, ErrorMarks::Off));
    for (mode, marks) in views.into_iter().chain([(ViewMode::Final, ErrorMarks::Outline)]) {
        assert_flat(&format!("{mode:?} {marks:?}"), |frames| draw(mode, marks, frames));
    }
}

#[test]
fn a_technique_that_stays_takes_no_more_memory_with_each_frame() {
    let gpu = open_renderer_gpu();
    let mut stage = Stage::new(gpu, default_scene(), 1).expect("the default scene");
    stage.wait_for_rays();
    let target = stage.target([96, 54]);
    let filters = [FilterKind::Vogel16, FilterKind::Pcss].map(|filter| {
        let mut technique = Technique::preset("exact-4").expect("a preset");
        technique.filter = filter;
        (format!("exact-4 {filter:?}"), technique)
    });
    let presets = PRESETS.iter().map(|preset| (preset.name.to_owned(), preset.technique()));
    for (name, technique) in presets.chain(filters) {
        stage.settings.technique = technique;
        stage.settings.technique.fit.resolution = glam::UVec2::splat(256);
        assert_flat(&name, |frames| {
            for _ in 0..frames {
                stage.draw(&target);
                stage.gpu().device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
            }
        });
    }
}

/// Asserts that the later frames take no more memory than the first ones. Skipped on systems that do not
/// report memory.
fn assert_flat(what: &str, mut draw: impl FnMut(u32)) {
    draw(FRAMES[0]);
    let Some(before) = memory() else { return };
    draw(FRAMES[1]);
    let grown = memory().expect("memory as before").saturating_sub(before);
    println!("{what}: {:.1} MB", grown as f64 / 1e6);
    assert!(grown < MOST, "{what}: {FRAMES:?} frames took {:.1} MB more", grown as f64 / 1e6);
}

#[test]
fn gpu_techniques_leave_no_objects_behind() {
    let instance = Gpu::instance();
    let adapter = pollster::block_on(adapter_choice().find(&instance, None)).expect("the tests' adapter");
    let opened = pollster::block_on(Gpu::of_adapter(adapter, &Wanted::default()));
    let mut stage = Stage::new(opened.expect("a device"), default_scene(), 1).expect("the default scene");
    stage.wait_for_rays();
    let target = stage.target([96, 54]);
    let mut objects = || {
        for preset in &PRESETS {
            stage.settings.technique = preset.technique();
            stage.settings.technique.fit.resolution = glam::UVec2::splat(256);
            for _ in 0..3 {
                stage.draw(&target);
            }
        }
        stage.gpu().device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
        let hub = instance.generate_report().expect("a native instance").hub;
        [
            ("render pipelines", hub.render_pipelines),
            ("compute pipelines", hub.compute_pipelines),
            ("shader modules", hub.shader_modules),
            ("bind groups", hub.bind_groups),
            ("buffers", hub.buffers),
            ("textures", hub.textures),
            ("views", hub.texture_views),
        ]
        .map(|(what, report)| (what, report.num_allocated))
    };
    let first = objects();
    println!("{first:?}");
    let second = objects();
    println!("{second:?}");
    assert_eq!(objects(), second);
}

/// Limits the memory of this process, which runs a single test, to its current size plus `bytes`.
fn leave(bytes: u64) {
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux tells");
    let line = status.lines().find_map(|line| line.strip_prefix("VmSize:")).expect("a size");
    let kilobytes: u64 = line.trim().trim_end_matches(" kB").parse().expect("a number");
    set_limit(Some(kilobytes * 1024 + bytes));
}

fn set_limit(current: Option<u64>) {
    let maximum = rustix::process::getrlimit(Resource::As).maximum;
    rustix::process::setrlimit(Resource::As, Rlimit { current, maximum }).expect("a limit");
}

fn stage() -> Stage {
    let gpu = open_renderer_gpu();
    gpu.keep_faults();
    let mut stage = Stage::new(gpu, default_scene(), 1).expect("the default scene");
    stage.settings.technique = shadowfit::Technique::preset("stable-4").expect("a preset");
    stage
}

#[test]
fn gpu_maps_that_there_is_no_memory_for_are_drawn_smaller_and_told() {
    let mut stage = stage();
    let target = stage.target([96, 54]);
    stage.draw(&target);
    leave(1 << 30);
    stage.settings.technique = stage.settings.technique.with_count(8);
    stage.settings.technique.fit.resolution = glam::UVec2::splat(8192);
    for _ in 0..2 {
        stage.draw(&target);
        let problem = stage.problem().unwrap_or_default().to_owned();
        assert!(problem.contains("out of memory") && problem.contains("They are drawn with"), "{problem}");
    }
    let drawn = stage.maps([96, 54])[0].projection.resolution;
    assert!(drawn.x < 8192 && drawn.x >= 256, "{drawn}");
    stage.compare_with(Some(stage.settings.technique));
    stage.draw(&target);
    assert!(stage.is_comparing() && stage.problem().is_some_and(|problem| problem.contains("out of memory")));
    stage.compare_with(None);
    stage.settings.technique.fit.resolution = drawn;
    stage.draw(&target);
    assert_eq!(stage.problem(), None, "what is offered is drawn");
    assert_eq!(stage.gpu().take_faults(), []);
}

#[test]
fn gpu_a_scene_that_there_is_no_memory_for_gets_smaller_textures_and_a_note() {
    let mut stage = stage();
    let mut scene = default_scene();
    let image = scene.images[0].clone();
    let rgba = vec![128; 4 * 4096 * 4096];
    for _ in 0..8 {
        scene.images.push(shadowfit_scene::Image { width: 4096, height: 4096, rgba: rgba.clone(), ..image.clone() });
        let mut material = scene.materials.iter().find(|m| m.base_color_texture.is_some()).expect("an image").clone();
        material.base_color_texture.as_mut().expect("an image").image = scene.images.len() - 1;
        scene.materials.push(material);
    }
    leave(400 << 20);
    stage.set_scene(scene).expect("smaller textures");
    // Only the GPU's memory is tested here.
    set_limit(None);
    assert!(stage.scene().notes.iter().any(|note| note.contains("halved")), "{:?}", stage.scene().notes);
    let target = stage.target([96, 54]);
    stage.draw(&target);
    assert_eq!((stage.problem(), stage.gpu().take_faults()), (None, Vec::new()));
}
