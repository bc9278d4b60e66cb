//! Tests that a device refuses.

/// Ends the running test, because the adapter lacks something that every WebGPU device has, as OpenGL does. The runner of a
/// bundle counts such tests as refused, by the first word of the message.
///
/// # Panics
///
/// Always.
pub fn lacking(info: &wgpu::AdapterInfo, what: &str) -> ! {
    panic!("LACKING: {} lacks {what}", shadowfit_adapter::label(info))
}
