//! Tests that a device refuses.

use crate::subpixel_step;

/// Ends the running test, because the adapter lacks something that the test needs: a feature that every WebGPU device has, but
/// OpenGL does not, or the precision of GPUs. The runner of a bundle counts such tests as refused, by the first word of the
/// message.
///
/// # Panics
///
/// Always.
pub fn lacking(info: &wgpu::AdapterInfo, what: &str) -> ! {
    panic!("LACKING: {} lacks {what}", shadowfit_adapter::label(info))
}

/// Ends the running test if its edges or counts need corners that are rounded to 1/256 pixel, as GPUs do, and the adapter
/// [rounds](subpixel_step) more coarsely.
///
/// # Panics
///
/// On such adapters.
pub fn require_fine_steps(info: &wgpu::AdapterInfo) {
    if subpixel_step(info) > 1.0 / 256.0 {
        lacking(info, "256 steps in a pixel");
    }
}

/// Ends the running test if it draws triangles of tens of kilometres, and the adapter lacks the precision for them. `SwiftShader`
/// leaves out the two triangles of a ground of 100 km, so that the picture shows the sky there, and moves the end of a shadow on
/// a ground of 30 km by metres.
///
/// # Panics
///
/// On such adapters.
pub fn require_large_triangles(info: &wgpu::AdapterInfo) {
    if info.name.contains("SwiftShader") {
        lacking(info, "triangles of tens of kilometres");
    }
}
