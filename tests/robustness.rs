//! Robustness of the viewer: real scenes, broken files, absurd flags and absurd settings. Everything ends in
//! a picture or a message, never in a panic.

mod command_line_gpu;
mod device_classes_gpu;
mod docs_gpu;
mod files_gpu;
mod lost_device_gpu;
mod scenes_gpu;
mod settings_gpu;
