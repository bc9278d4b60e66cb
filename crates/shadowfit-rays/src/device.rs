//! What all buffers and passes here need of a device.

use core::future::Future;
use core::pin::pin;
use core::task::{Context, Poll, Waker};

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

/// Does work that may find the device out of memory, or unable to do it. WebGPU in browsers reports errors later, to the
/// device's own handler.
pub(crate) fn caught<T>(device: &wgpu::Device, work: impl FnOnce() -> T) -> Result<T, RayError> {
    if device.adapter_info().backend == wgpu::Backend::BrowserWebGpu {
        return Ok(work());
    }
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let result = work();
    match now(validation.pop()).or(now(memory.pop())) {
        Some(error) => Err(RayError::Device(error.to_string())),
        None => Ok(result),
    }
}

/// The result of a future that is ready, as those of errors are outside of browsers.
fn now<T>(future: impl Future<Output = Option<T>>) -> Option<T> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => result,
        Poll::Pending => None,
    }
}

/// A layout whose bindings are counted from 0.
pub(crate) fn layout(
    device: &wgpu::Device,
    visibility: wgpu::ShaderStages,
    types: &[wgpu::BindingType],
) -> wgpu::BindGroupLayout {
    let entry = |(binding, ty): (u32, &wgpu::BindingType)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: *ty,
        count: None,
    };
    let entries: Vec<_> = (0..).zip(types).map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(LABEL), entries: &entries })
}

/// A bind group of such a layout.
pub(crate) fn group(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let resources = (0u32..).zip(resources);
    let entries: Vec<_> =
        resources.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() }).collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(LABEL), layout, entries: &entries })
}

/// A storage buffer that is bound as a whole.
pub(crate) const fn storage(read_only: bool) -> wgpu::BindingType {
    wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    }
}
