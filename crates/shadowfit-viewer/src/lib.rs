//! The shadowfit viewer as a library: a [`Stage`] that holds scene, camera and settings, and fits, draws and judges
//! through `shadowfit-study`; the artefact demonstrations; a window around it, and a headless mode that renders the
//! same views to files. `examples/viewer` is its thin main. In a browser it is the module of a page, whose files lie in
//! `web`: see `src/web.rs`.

#![cfg_attr(target_family = "wasm", allow(dead_code, reason = "a page has no command line and no headless mode"))]

mod artefact;
mod cli;
mod device_check;
#[cfg(test)]
mod docs_tests;
mod effect;
mod export;
mod files;
mod fitted;
#[cfg(not(target_family = "wasm"))]
mod frame_log;
#[cfg(any(test, fuzzing))]
#[doc(hidden)]
pub mod fuzzed;
#[cfg(all(feature = "gamepad", not(target_family = "wasm")))]
mod gamepad;
#[cfg(not(target_family = "wasm"))]
mod headless;
mod input;
mod interface;
mod link;
mod loading;
mod monkey;
mod narration;
mod output;
mod outside;
mod playback;
mod sample_figures;
mod saved;
mod script;
mod source;
mod stage;
#[cfg(not(target_family = "wasm"))]
mod store;
#[cfg(not(target_family = "wasm"))]
mod timings;
mod tuning;
mod undo;
mod view_search;
mod viewer;
#[cfg(target_family = "wasm")]
mod web;
#[cfg(not(target_family = "wasm"))]
mod window;

#[cfg(not(target_family = "wasm"))]
use std::process::ExitCode;

pub use cli::Arguments;
#[cfg(not(target_family = "wasm"))]
pub use headless::{PICTURES, render_pictures};
pub use shadowfit_egui::Artefact;
pub use stage::{Shown, Stage, StageError};

/// Runs the viewer with the process's arguments: the window, with `--headless` the pictures, or with `--check` the check of
/// the graphics device, whose failure is exit code 1. Errors are printed to the standard error, with exit code 2.
#[cfg(not(target_family = "wasm"))]
pub fn main() -> ExitCode {
    let arguments = cli::parse();
    shadowfit_render::hush_lost_devices();
    let result = match &arguments.headless {
        _ if arguments.check => device_check::run(&arguments.adapter()),
        Some(folder) => headless::run(&arguments, folder).map(|()| true),
        None => window::run(&arguments).map(|()| true),
    };
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            output::tell(format_args!("error: {error:#}"));
            ExitCode::from(2)
        }
    }
}
