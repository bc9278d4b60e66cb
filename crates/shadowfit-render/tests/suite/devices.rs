//! The software adapter, opened with less than it has.

use shadowfit_render::Gpu;

/// The software adapter, whatever GPU is present, with these features and limits.
pub(crate) fn software_gpu(features: wgpu::Features, limits: wgpu::Limits) -> Gpu {
    let instance = Gpu::instance();
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let is_software = |adapter: &wgpu::Adapter| adapter.get_info().device_type == wgpu::DeviceType::Cpu;
    let adapter = adapters.into_iter().find(is_software).expect("this test draws on the software adapter");
    let descriptor =
        wgpu::DeviceDescriptor { required_features: features, required_limits: limits, ..Default::default() };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).expect("a device");
    Gpu { adapter, device, queue }
}
