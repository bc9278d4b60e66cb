//! The system around the viewer, with the same names in a window and in a browser. Only this module and the
//! mains differ between the two.

pub(crate) mod output;
#[cfg(target_family = "wasm")]
pub(crate) mod page;
#[cfg(not(target_family = "wasm"))]
mod window;

#[cfg(target_family = "wasm")]
pub(crate) use page::{
    StateFile, TemporaryFolder, busy, choose_file, load_gltf, memory, read, save_file, temporary_folder,
};
#[cfg(not(target_family = "wasm"))]
pub(crate) use window::{
    StateFile, TemporaryFolder, busy, choose_file, load_gltf, memory, read, save_file, temporary_folder,
};

/// Whether the viewer runs in a browser, which has no threads and cannot wait for the GPU within a frame.
pub(crate) const IS_PAGE: bool = cfg!(target_family = "wasm");

/// Progress of a step that keeps the viewer busy, for a bar that the page draws meanwhile.
#[cfg_attr(not(target_family = "wasm"), expect(dead_code, reason = "a window draws the bar itself"))]
#[derive(Clone, Copy, Debug)]
pub(crate) struct BusyBar {
    /// Share finished at the start, 0..=1.
    pub(crate) from: f32,
    /// Share finished at the end of the step.
    pub(crate) to: f32,
    /// Expected duration of the step, in seconds.
    pub(crate) seconds: f32,
}
