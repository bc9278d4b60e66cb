//! Device requirements of all buffers and passes.

use crate::error::RayError;

/// Threads per workgroup, as in the WGSL.
pub(crate) const WORKGROUP_THREADS: u32 = 256;
/// Number of storage buffers that the scene binds.
pub(crate) const BUFFERS: usize = 5;
/// Label of the scene's bind group and of its layout.
pub(crate) const LABEL: &str = "shadowfit rays";

/// Returns an error for a device that cannot trace rays.
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

/// Returns the greatest size of a storage buffer, in bytes.
pub(crate) fn buffer_limit(device: &wgpu::Device) -> u64 {
    let limits = device.limits();
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
}

/// Runs work that the device may reject or lack memory for.
pub(crate) fn caught<T>(device: &wgpu::Device, work: impl FnOnce() -> T) -> Result<T, RayError> {
    shadowfit_gpu::catch_errors(device, work).map_err(|error| RayError::Device(error.to_string()))
}
