//! What all buffers and passes here need of a device.

use crate::error::RayError;

/// Threads of a workgroup, as in the WGSL.
pub(crate) const WORKGROUP_THREADS: u32 = 256;
/// Storage buffers that the scene binds.
pub(crate) const BUFFERS: usize = 5;
/// Label of the scene's bind group and of its layout.
pub(crate) const LABEL: &str = "shadowfit rays";

/// Refuses a device that cannot trace rays.
pub(crate) fn check(limits: &wgpu::Limits) -> Result<(), RayError> {
    let (buffers, threads) =
        (limits.max_storage_buffers_per_shader_stage, limits.max_compute_invocations_per_workgroup);
    let (needed_buffers, needed_threads) = (BUFFERS as u32, WORKGROUP_THREADS);
    if buffers >= needed_buffers && threads >= needed_threads {
        Ok(())
    } else {
        Err(RayError::Unsupported { buffers, threads, needed_buffers, needed_threads })
    }
}

/// Bytes that a storage buffer may have.
pub(crate) fn buffer_limit(device: &wgpu::Device) -> u64 {
    let limits = device.limits();
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
}

/// Does work that the device may refuse or lack memory for.
pub(crate) fn caught<T>(device: &wgpu::Device, work: impl FnOnce() -> T) -> Result<T, RayError> {
    shadowfit_gpu::catch_errors(device, work).map_err(|error| RayError::Device(error.to_string()))
}
