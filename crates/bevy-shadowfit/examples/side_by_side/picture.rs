//! A picture of the window for documents.

use std::path::PathBuf;

use bevy::prelude::*;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured, save_to_disk};

use crate::figures::Measured;

/// Saves a picture after a number of frames, once it has its figures, and ends.
pub(crate) fn plugin(app: &mut App, file: PathBuf, after: u32) {
    let mut frames = 0;
    let mut is_taken = false;
    let take = move |measured: Res<Measured>, mut commands: Commands| {
        frames += 1;

        // The labels of the frame before have shown the figures already.
        if is_taken || frames <= after || !measured.is_current() {
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
