//! Memory that frames take, and devices that have little.

use rustix::process::{Resource, Rlimit};
use shadowfit_params::tool::{ErrorMarks, ViewMode};
use shadowfit_render::{AdapterChoice, Gpu};
use shadowfit_scene::builtin::default_scene;

use super::*;
use crate::monkey::memory;

/// Frames until all is there that a view is drawn with, and frames after them.
const FRAMES: [u32; 2] = [6, 20];
/// Bytes that the latter may take for all views together: what drivers and allocators keep.
const MOST: u64 = 100_000_000;

#[test]
fn a_view_that_stays_takes_no_more_memory_with_each_frame() {
    let gpu = pollster::block_on(Gpu::headless(AdapterChoice::Software)).expect("the software adapter");
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
    let mut growth = 0;
    for (mode, marks) in views.into_iter().chain([(ViewMode::Final, ErrorMarks::Outline)]) {
        draw(mode, marks, FRAMES[0]);
        // A system that does not tell has nothing to be tested.
        let Some(before) = memory() else { return };
        draw(mode, marks, FRAMES[1]);
        let grown = memory().expect("memory as before").saturating_sub(before);
        println!("{mode:?} {marks:?}: {:.1} MB", grown as f64 / 1e6);
        growth += grown;
    }
    assert!(growth < MOST, "{FRAMES:?} frames of each view took {:.1} MB more", growth as f64 / 1e6);
}

/// Leaves the process, which is that of one test, as much memory as it has now, and so many bytes more.
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
    let gpu = pollster::block_on(Gpu::headless(AdapterChoice::Software)).expect("the software adapter");
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
    // Other memory than that of the GPU is no concern here.
    set_limit(None);
    assert!(stage.scene().notes.iter().any(|note| note.contains("halved")), "{:?}", stage.scene().notes);
    let target = stage.target([96, 54]);
    stage.draw(&target);
    assert_eq!((stage.problem(), stage.gpu().take_faults()), (None, Vec::new()));
}
