//! The software adapter, opened with less than it has.

use shadowfit_render::{Gpu, Wanted};

/// The software adapter, whatever GPU is present, with these features and limits.
pub(crate) fn software_gpu(features: wgpu::Features, limits: wgpu::Limits) -> Gpu {
    opened(wgpu::Backends::PRIMARY, features, limits)
}

/// OpenGL ES 3.0 with the limits of WebGL2, by Mesa. wgpu prefers OpenGL, and Mesa later versions, unless both are told to
/// be old by environment variables.
#[cfg(feature = "gles")]
pub(crate) fn webgl2_gpu() -> Gpu {
    let gpu = opened(wgpu::Backends::GL, wgpu::Features::empty(), wgpu::Limits::downlevel_webgl2_defaults());
    let version = gpu.adapter.get_info().driver_info;
    let advice = "set MESA_GL_VERSION_OVERRIDE to 3.2 and MESA_GLES_VERSION_OVERRIDE to 3.0";
    assert!(version.contains("OpenGL ES 3.0"), "this test needs OpenGL ES 3.0, and has {version}: {advice}");
    gpu
}

fn opened(backends: wgpu::Backends, features: wgpu::Features, limits: wgpu::Limits) -> Gpu {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    let instance = wgpu::Instance::new(descriptor);
    let adapters = pollster::block_on(instance.enumerate_adapters(backends));
    let is_software = |adapter: &wgpu::Adapter| adapter.get_info().device_type == wgpu::DeviceType::Cpu;
    let adapter = adapters.into_iter().find(is_software).expect("this test draws on the software adapter");
    pollster::block_on(Gpu::of_adapter(adapter, &Wanted { features, limits: Some(limits) })).expect("a device")
}
