//! The device for tests that draw.

use std::sync::{LazyLock, Mutex, PoisonError};

use shadowfit_adapter::{ADAPTER_VARIABLE, AdapterChoice};

/// An open device of the tests' adapter.
#[derive(Clone, Debug)]
pub struct TestGpu {
    /// Adapter of the device.
    pub adapter: wgpu::Adapter,
    /// Device.
    pub device: wgpu::Device,
    /// Queue of the device.
    pub queue: wgpu::Queue,
}

/// A device, or a value that holds one, for exclusive use by one test. It returns to a list when the test's
/// thread ends, so keep it in a thread-local variable.
///
/// Two tests must not share a device at the same time: wgpu may run a callback in the thread of another test
/// that polls the device. The first test would then find its work finished before its callback has run.
#[derive(Debug)]
pub struct Lent<T: Clone + 'static> {
    gpu: T,
    free: &'static Mutex<Vec<T>>,
}

impl<T: Clone> Lent<T> {
    /// Takes a device from the list, or opens one if the list is empty.
    pub fn new(free: &'static Mutex<Vec<T>>, open: impl FnOnce() -> T) -> Self {
        let taken = free.lock().unwrap_or_else(PoisonError::into_inner).pop();
        Self { gpu: taken.unwrap_or_else(open), free }
    }

    /// Returns a handle of the device, for use in this thread.
    pub fn get(&self) -> T {
        self.gpu.clone()
    }
}

impl<T: Clone> Drop for Lent<T> {
    fn drop(&mut self) {
        self.free.lock().unwrap_or_else(PoisonError::into_inner).push(self.gpu.clone());
    }
}

/// Returns the adapter that the environment variable [`ADAPTER_VARIABLE`] selects. Without it, tests draw on
/// the software adapter even if there is a GPU, because its pictures are nearly the same on every machine.
pub fn adapter_choice() -> &'static AdapterChoice {
    static CHOICE: LazyLock<AdapterChoice> =
        LazyLock::new(|| AdapterChoice::from_env().unwrap_or(AdapterChoice::Software));
    &CHOICE
}

/// Returns the text of [`adapter_choice`], for the option `--adapter` of programs that tests start.
pub fn adapter_name() -> &'static str {
    static NAME: LazyLock<String> = LazyLock::new(|| adapter_choice().to_string());
    &NAME
}

/// Returns the step, in pixels, to which an adapter rounds the corners of triangles. Vulkan guarantees 1/16,
/// and graphics APIs do not report the actual value. Drivers use 1/256, except `SwiftShader`.
pub fn subpixel_step(info: &wgpu::AdapterInfo) -> f32 {
    if info.name.contains("SwiftShader") { 1.0 / 16.0 } else { 1.0 / 256.0 }
}

/// Returns the step, in texels, to which an adapter rounds the position for the weights of a linear filter.
/// Vulkan guarantees 1/16. Drivers use 1/256, except `SwiftShader`: its positions have 16 bits, which is
/// 1/128 texel for a texture of 512 texels.
pub fn filter_step(info: &wgpu::AdapterInfo) -> f32 {
    if info.name.contains("SwiftShader") { 1.0 / 128.0 } else { 1.0 / 256.0 }
}

/// Returns the tests' device with depth clamp and the default limits of WebGPU, or the adapter's own limits
/// if they are lower. Successive tests of a process share the device. A test that loses the device, measures
/// its memory or replaces its error handler must open its own with [`open_test_gpu`]. Call this in the test's
/// own thread.
///
/// # Panics
///
/// If the machine lacks the adapter of [`ADAPTER_VARIABLE`]. `cargo xtask test` skips tests that draw on
/// machines without any adapter.
pub fn test_gpu() -> TestGpu {
    static FREE: Mutex<Vec<TestGpu>> = Mutex::new(Vec::new());
    std::thread_local! {
        static LENT: Lent<TestGpu> =
            Lent::new(&FREE, || open_test_gpu(wgpu::Features::DEPTH_CLIP_CONTROL, wgpu::Limits::default()));
    }
    LENT.with(Lent::get)
}

/// Opens the tests' adapter again, with the requested features that it has, and with these limits or its own
/// lower ones.
///
/// # Panics
///
/// If the machine lacks the adapter of [`ADAPTER_VARIABLE`].
pub fn open_test_gpu(features: wgpu::Features, required_limits: wgpu::Limits) -> TestGpu {
    let instance = shadowfit_adapter::instance();
    let adapter = pollster::block_on(adapter_choice().find(&instance, None));
    let adapter =
        adapter.unwrap_or_else(|error| panic!("this test draws. {ADAPTER_VARIABLE}={}: {error}", adapter_name()));
    let descriptor = wgpu::DeviceDescriptor {
        required_features: adapter.features() & features,
        required_limits: required_limits.or_worse_values_from(&adapter.limits()),
        ..Default::default()
    };
    let device = pollster::block_on(adapter.request_device(&descriptor));
    let (device, queue) = device.unwrap_or_else(|error| panic!("{}: {error}", adapter.get_info().name));
    TestGpu { adapter, device, queue }
}

/// Returns the tests' device as the renderer opens it. Successive tests share it, as with [`test_gpu`]. A
/// test that needs its own calls [`open_renderer_gpu`].
///
/// # Panics
///
/// If the machine lacks the adapter of [`ADAPTER_VARIABLE`].
#[cfg(feature = "render")]
pub fn renderer_gpu() -> shadowfit_render::Gpu {
    static FREE: Mutex<Vec<shadowfit_render::Gpu>> = Mutex::new(Vec::new());
    std::thread_local! {
        static LENT: Lent<shadowfit_render::Gpu> = Lent::new(&FREE, open_renderer_gpu);
    }
    LENT.with(Lent::get)
}

/// Opens the tests' adapter again, as the renderer does.
///
/// # Panics
///
/// If the machine lacks the adapter of [`ADAPTER_VARIABLE`].
#[cfg(feature = "render")]
pub fn open_renderer_gpu() -> shadowfit_render::Gpu {
    opened(adapter_choice())
}

/// Returns the software adapter as the renderer opens it, for golden pictures. It ignores
/// [`ADAPTER_VARIABLE`], since golden pictures must be the same on every machine.
///
/// # Panics
///
/// If the machine has no software adapter.
#[cfg(feature = "render")]
pub fn golden_gpu() -> shadowfit_render::Gpu {
    static FREE: Mutex<Vec<shadowfit_render::Gpu>> = Mutex::new(Vec::new());
    std::thread_local! {
        static LENT: Lent<shadowfit_render::Gpu> = Lent::new(&FREE, || opened(&AdapterChoice::Software));
    }
    LENT.with(Lent::get)
}

#[cfg(feature = "render")]
fn opened(choice: &AdapterChoice) -> shadowfit_render::Gpu {
    let gpu = pollster::block_on(shadowfit_render::Gpu::headless(choice));
    gpu.unwrap_or_else(|error| panic!("this test draws. {ADAPTER_VARIABLE}={choice}: {error}"))
}
