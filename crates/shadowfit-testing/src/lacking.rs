//! Tests that cannot run on a device.

use crate::subpixel_step;

/// Ends the running test, because the adapter lacks a requirement of the test: a feature that WebGPU
/// guarantees but OpenGL does not, or the precision of GPUs. The runner of a bundle counts such tests as
/// refused, by the first word of the message.
///
/// # Panics
///
/// Always.
pub fn lacking(info: &wgpu::AdapterInfo, what: &str) -> ! {
    panic!("LACKING: {} lacks {what}", shadowfit_adapter::label(info))
}

/// Ends the running test if the adapter [rounds](subpixel_step) corners more coarsely than to 1/256 pixel.
/// For tests whose edges or pixel counts depend on it.
///
/// # Panics
///
/// On such adapters.
pub fn require_fine_steps(info: &wgpu::AdapterInfo) {
    if subpixel_step(info) > 1.0 / 256.0 {
        lacking(info, "256 steps in a pixel");
    }
}

/// Ends the running test if the adapter lacks the precision for triangles of tens of kilometres.
/// `SwiftShader` drops the two triangles of a ground of 100 km, so that the sky shows there, and misplaces
/// the end of a shadow on a ground of 30 km by metres.
///
/// # Panics
///
/// On such adapters.
pub fn require_large_triangles(info: &wgpu::AdapterInfo) {
    if info.name.contains("SwiftShader") {
        lacking(info, "triangles of tens of kilometres");
    }
}
