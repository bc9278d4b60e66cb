//! Bevy's own cascades and shadowfit's side by side: one scene, one camera pose, two lights, one window.
//!
//! The left half shows Bevy's cascades, the right half those of the plugin. Over each half stand two figures against
//! ray-traced truth: how many pixels the texels of the maps cover on screen, and how many pixels are lit wrongly.
//!
//! ```text
//! cargo run --release --example side_by_side
//! cargo run --release --example side_by_side -- scene.glb
//! cargo run --release --example side_by_side -- --picture side_by_side.png --after 20
//! ```
//!
//! | keys | |
//! |---|---|
//! | W A S D, Q E | fly, down and up; faster with Shift |
//! | arrows, mouse drag | look |
//! | L K, I O | turn the sun, raise and lower it |
//! | F, B, P | next fit of the right half, whose bias, whose splits |
//! | M | next size of the maps of both halves |
//! | T | starts and stops a camera path |
//!
//! The figures are measured in the background: their light comes from a simulation of Bevy's look-up ([`lookup`]). The
//! example `report` measures the pictures that Bevy draws.

mod content;
mod figures;
mod flight;
mod halves;
mod labels;
mod lookup;
mod measure;
mod meshes;
mod picture;
mod rays;

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use bevy::light::DirectionalLightShadowMap;
use bevy::prelude::*;
use bevy::window::WindowResolution;
use bevy_shadowfit::ShadowfitPlugin;
use clap::Parser;

use content::Content;

/// Width and height of the window, in pixels.
const WINDOW_SIZE: [u32; 2] = [1280, 720];

/// Shows Bevy's cascades and shadowfit's side by side.
#[derive(Clone, Debug, Parser)]
struct Arguments {
    /// glTF file; the built-in courtyard without it
    scene: Option<PathBuf>,
    /// Save a picture of the window to a PNG file, then end
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Frames before the picture, which also waits for its figures
    #[arg(long, value_name = "N", default_value_t = 20, requires = "picture")]
    after: u32,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let content = match Content::load(arguments.scene.as_deref()) {
        Ok(content) => Arc::new(content),
        Err(error) => {
            eprintln!("error: {error}");
            return ExitCode::FAILURE;
        }
    };
    match app(&arguments, content).run() {
        AppExit::Success => ExitCode::SUCCESS,
        AppExit::Error(_) => ExitCode::FAILURE,
    }
}

fn app(arguments: &Arguments, content: Arc<Content>) -> App {
    let window = Window {
        title: format!("{} - Bevy's cascades and shadowfit's", content.scene.name),
        resolution: WindowResolution::from(WINDOW_SIZE),
        ..default()
    };
    let mut app = App::new();
    app.add_plugins(DefaultPlugins.set(WindowPlugin { primary_window: Some(window), ..default() }))
        .add_plugins(ShadowfitPlugin)
        .insert_resource(DirectionalLightShadowMap { size: 2048 })
        .insert_resource(ClearColor(Color::srgb(0.53, 0.70, 0.88)))
        .insert_resource(GlobalAmbientLight { color: Color::srgb(0.75, 0.85, 1.0), brightness: 900.0, ..default() });
    flight::plugin(&mut app, &content);
    halves::plugin(&mut app, &content);
    labels::plugin(&mut app);
    figures::plugin(&mut app, content.clone());
    meshes::plugin(&mut app, content);
    if let Some(file) = &arguments.picture {
        picture::plugin(&mut app, file.clone(), arguments.after);
    }
    app
}
