//! The tests' adapter, opened with fewer features and limits than it has.

#[cfg(feature = "gles")]
use shadowfit_render::AdapterChoice;
use shadowfit_render::{Gpu, Wanted};
use shadowfit_testing::renderer_gpu;

/// Opens the tests' adapter with these features and limits.
pub(crate) fn test_gpu(features: wgpu::Features, limits: wgpu::Limits) -> Gpu {
    opened(renderer_gpu().adapter, features, limits)
}

/// Opens OpenGL ES 3.0 by Mesa with the limits of WebGL2. By default wgpu prefers OpenGL, and Mesa later
/// versions. Environment variables must select old versions for both.
#[cfg(feature = "gles")]
pub(crate) fn webgl2_gpu() -> Gpu {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::GL;
    let found = pollster::block_on(AdapterChoice::Software.find(&wgpu::Instance::new(descriptor), None));
    let adapter = found.unwrap_or_else(|error| panic!("this test draws on OpenGL, and {error}"));
    let gpu = opened(adapter, wgpu::Features::empty(), wgpu::Limits::downlevel_webgl2_defaults());
    let version = gpu.adapter.get_info().driver_info;
    let advice = "set MESA_GL_VERSION_OVERRIDE to 3.2 and MESA_GLES_VERSION_OVERRIDE to 3.0";
    assert!(version.contains("OpenGL ES 3.0"), "this test needs OpenGL ES 3.0, and has {version}: {advice}");
    gpu
}

fn opened(adapter: wgpu::Adapter, features: wgpu::Features, limits: wgpu::Limits) -> Gpu {
    pollster::block_on(Gpu::of_adapter(adapter, &Wanted { features, limits: Some(limits) })).expect("a device")
}
