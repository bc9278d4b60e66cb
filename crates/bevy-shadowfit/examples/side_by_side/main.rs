//! Bevy's own cascades and shadowfit's side by side: one scene, one camera pose, two lights, one window.
//!
//! The left half shows Bevy's cascades, the right half the plugin's. Each half displays two figures measured
//! against ray-traced truth: how many pixels the texels of the maps cover on screen, and how many pixels are
//! lit wrongly.
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
//! | L K, I O | rotate the sun, raise and lower it |
//! | F, B, P | next fit, bias and splits of the right half |
//! | M | next size of the maps of both halves |
//! | T | start and stop a camera path |
//!
//! The figures are measured in the background, with a CPU simulation of Bevy's shader. The example `report`
//! measures the images that Bevy draws.

mod figures;
mod flight;
mod halves;
mod scene;
#[path = "../shared/sun_maps.rs"]
mod sun_maps;

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Result;
use bevy::light::DirectionalLightShadowMap;
use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured, save_to_disk};
use bevy::window::WindowResolution;
use bevy_shadowfit::ShadowfitPlugin;
use clap::Parser;

use figures::Measured;
use scene::{Content, Shown};

/// Width and height of the window, in pixels.
const WINDOW_SIZE: [u32; 2] = [1280, 720];

/// Shows Bevy's cascades and shadowfit's side by side.
#[derive(Clone, Debug, Parser)]
struct Arguments {
    /// glTF file [default: the built-in courtyard]
    scene: Option<PathBuf>,
    /// Save an image of the window to a PNG file, then exit
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,
    /// Frames before the image, which also waits for its figures
    #[arg(long, value_name = "N", default_value_t = 20, requires = "picture")]
    after: u32,
}

fn main() -> Result<AppExit> {
    let arguments = Arguments::parse();
    let content = Content::load(arguments.scene.as_deref())?;
    let title = format!("{} - Bevy's cascades and shadowfit's", content.scene.name);
    let window = Window { title, resolution: WindowResolution::from(WINDOW_SIZE), ..default() };
    let mut app = App::new();
    app.add_plugins(DefaultPlugins.set(WindowPlugin { primary_window: Some(window), ..default() }))
        .add_plugins(ShadowfitPlugin)
        .insert_resource(DirectionalLightShadowMap { size: 2048 })
        .insert_resource(ClearColor(Color::srgb(0.53, 0.70, 0.88)))
        .insert_resource(GlobalAmbientLight { color: Color::srgb(0.75, 0.85, 1.0), brightness: 900.0, ..default() })
        .insert_resource(flight::Flight::new(&content))
        .insert_resource(Shown(Arc::new(content)))
        .add_systems(Startup, (halves::spawn, scene::spawn))
        .add_systems(Update, (halves::divide, halves::choose, halves::write, flight::fly))
        .add_systems(Last, figures::measure);
    if let Some(file) = arguments.picture {
        take_picture(&mut app, file, arguments.after);
    }
    Ok(app.run())
}

/// Saves an image after a number of frames, once the halves have their figures, and exits the app.
fn take_picture(app: &mut App, file: PathBuf, after: u32) {
    let (mut frames, mut is_taken) = (0, false);
    let take = move |measured: Query<&Measured>, mut commands: Commands| {
        frames += 1;
        // The text of the previous frame already contained the figures.
        if is_taken || frames <= after || !measured.iter().all(|measured| measured.is_current) {
            return;
        }
        is_taken = true;
        let mut save = save_to_disk(file.clone());
        commands.spawn(Screenshot::primary_window()).observe(
            move |captured: On<ScreenshotCaptured>, mut exit: MessageWriter<AppExit>| {
                save(captured);
                exit.write(AppExit::Success);
            },
        );
    };
    app.add_systems(First, take);
}
