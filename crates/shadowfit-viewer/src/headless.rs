//! Rendering without a window: the picture set, and scripts.

mod album;
pub(crate) mod device_check;
mod progress;
mod sample;
mod script;
mod timings;

use std::path::Path;

use anyhow::{Context, Result};
use egui::{Pos2, RawInput, Rect, vec2};
use shadowfit_render::Gpu;
use shadowfit_scene::Scene;
use shadowfit_study::make_folder;

use crate::arguments::{Arguments, check_animation};
use crate::platform::output;
use crate::scene_source::SceneSource;
use crate::stage::Stage;
pub use album::{PICTURES, render_pictures};
use progress::Progress;

/// Samples per pixel of headless pictures.
const SAMPLES: u32 = 4;
/// Time of a frame of a script, in seconds.
const FRAME: f32 = 1.0 / 60.0;
/// Format of headless frames.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Renders the requested pictures, and prints each name when its file is written. Notes of the import go to
/// the standard error. No state is restored or saved.
pub(crate) fn run(arguments: &Arguments, folder: &Path) -> Result<()> {
    make_folder(folder)?;
    if arguments.script.is_some() {
        return script::play(arguments, folder);
    }
    if let Some(SceneSource::Sample { sample, variant }) = arguments.source()? {
        return sample::run(arguments, sample, variant, folder);
    }
    let scene = load_scene(arguments)?;
    if let Some(file) = &arguments.scene {
        scene.warnings(file).for_each(output::tell);
    }
    let gpu = pollster::block_on(Gpu::headless(&arguments.adapter()))?;
    let mut stage = Stage::new(gpu, scene, SAMPLES)?;
    let mut settings = stage.settings;
    stage.choose_camera(arguments.settings(), &mut settings);
    arguments.apply(&mut settings)?;
    stage.restore_settings(&settings);
    stage.animation = arguments.animation;
    stage.set_home();
    let mut progress = Progress::begin(PICTURES, &stage.scene().name, &stage, folder)?;
    let gpu = stage.gpu().clone();
    let size = arguments.size();
    gpu.unless_lost(|| render_pictures(&mut stage, folder, size, &mut |path| progress.wrote(path)))
        .context("the graphics device was lost; start again, with smaller pictures if it was too slow")??;
    progress.end()
}

/// Loads the scene in the arguments.
///
/// # Errors
///
/// If the file cannot be loaded, or has no scene or animation of the requested index.
fn load_scene(arguments: &Arguments) -> Result<Scene> {
    let scene = pollster::block_on(arguments.source()?.unwrap_or_default().load(&|_, _| ()))?;
    check_animation(arguments.animation, scene.animations.len(), &scene.name)?;
    Ok(scene)
}

/// Returns egui's input for a window of a size in pixels, at a time in seconds.
fn input(size: [u32; 2], clock: f64) -> RawInput {
    RawInput {
        screen_rect: Some(Rect::from_min_size(Pos2::ZERO, vec2(size[0] as f32, size[1] as f32))),
        time: Some(clock),
        ..Default::default()
    }
}
