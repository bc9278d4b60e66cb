//! The shadowfit viewer as a library: a [`Stage`] that holds scene, camera and settings, and fits, draws and
//! judges with `shadowfit-study`; the artefact demonstrations; a window; and a headless mode that renders the
//! same views to files. `examples/viewer` is its thin main. In a browser it is the module of a page, whose
//! files are in `web`: see `src/web.rs`.
//!
//! Each room of the crate uses only rooms below it:
//!
//! ```text
//!   room           subject                                             uses
//!   window         main: window, surface, events                       all below except mains
//!   headless       main: pictures, scripts, check of the device        all below except mains
//!   web            main: the module of a page                          all below except mains
//!   viewer         frames, commands, opening, saving                   all below
//!   interface      bars, panel, pictures, timeline                     keep, stage, scene_source
//!   background     loading, tuning, measuring, check of the device     stage, scene_source, platform
//!   arguments      command line                                        play, scene_source, platform
//!   keep           saved state, links, undo, text in pictures          stage, scene_source, platform
//!   play           scripts, playback, random actions                   scene_source, platform
//!   stage          scene, camera, techniques, artefacts, judge         platform
//!   scene_source   built-in scene, sample or file                      platform
//!   platform       files, storage, dialogs, by window or page          -
//! ```

#![cfg_attr(target_family = "wasm", allow(dead_code, reason = "a page has no command line and no headless mode"))]

mod arguments;
mod background;
#[cfg(test)]
mod docs_tests;
#[cfg(any(test, fuzzing))]
#[doc(hidden)]
pub mod fuzzed;
#[cfg(not(target_family = "wasm"))]
mod headless;
mod interface;
mod keep;
mod platform;
mod play;
mod scene_source;
mod stage;
mod viewer;
#[cfg(target_family = "wasm")]
mod web;
#[cfg(not(target_family = "wasm"))]
mod window;

#[cfg(not(target_family = "wasm"))]
use std::process::ExitCode;

pub use arguments::Arguments;
#[cfg(not(target_family = "wasm"))]
pub use headless::{PICTURES, render_pictures};
pub use shadowfit_egui::Artefact;
pub use stage::{Shown, Stage, StageError};

/// Runs the viewer with the process's arguments: the window, with `--headless` the pictures, or with
/// `--check` the device check, whose failure is exit code 1. Errors are printed to the standard error, with
/// exit code 2.
#[cfg(not(target_family = "wasm"))]
pub fn main() -> ExitCode {
    let arguments = arguments::parse();
    shadowfit_render::hush_lost_devices();
    let result = match &arguments.headless {
        _ if arguments.check => headless::device_check::run(&arguments.adapter()),
        Some(folder) => headless::run(&arguments, folder).map(|()| true),
        None => window::run(&arguments).map(|()| true),
    };
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            platform::output::tell(format_args!("error: {error:#}"));
            ExitCode::from(2)
        }
    }
}
