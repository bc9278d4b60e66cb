//! Tests of import, pose and bounds through the public interface.
//!
//! `small_*` create their own files. `assets` and `hostile` load a collection of real, unusual and broken
//! files from `../shared/assets` beside the workspace, and report if it is missing.

mod assets;
mod build;
mod hostile;
mod progress;
mod small_broken;
mod small_extensions;
mod small_far;
mod small_images;
mod small_instances;
mod small_motion;
mod small_odd;
mod small_shared;
mod small_surface;
mod small_view;
