//! The device that tests draw with.

use std::sync::{Mutex, PoisonError};

/// An open device of the software adapter.
#[derive(Clone, Debug)]
pub struct TestGpu {
    /// Adapter of the device.
    pub adapter: wgpu::Adapter,
    /// Device.
    pub device: wgpu::Device,
    /// Queue of the device.
    pub queue: wgpu::Queue,
}

/// A device, or a value that holds one, that one test has to itself. It goes back to a list when the test's thread ends: keep
/// it in a thread-local variable.
///
/// Two tests must not share a device at the same time: wgpu may run a callback in the thread of another test that polls the
/// device. The first test then finds its work done before its callback has run.
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

/// Returns the software adapter's device with depth clamp and the default limits of WebGPU. Tests that run after each other
/// in a process use the same device: a test that loses the device, measures its memory or replaces its error handler opens
/// its own with [`open_software_gpu`]. Call it in the test's own thread.
///
/// Tests use the software adapter even beside a real GPU, because its pictures are nearly the same on every machine.
///
/// # Panics
///
/// If the machine has no software adapter. `cargo xtask test` leaves out the tests that draw on such machines.
pub fn software_gpu() -> TestGpu {
    static FREE: Mutex<Vec<TestGpu>> = Mutex::new(Vec::new());
    std::thread_local! {
        static LENT: Lent<TestGpu> =
            Lent::new(&FREE, || open_software_gpu(wgpu::Features::DEPTH_CLIP_CONTROL, wgpu::Limits::default()));
    }
    LENT.with(Lent::get)
}

/// Opens the software adapter again, with these features, if the adapter has them, and these limits.
///
/// # Panics
///
/// If the machine has no software adapter.
pub fn open_software_gpu(features: wgpu::Features, required_limits: wgpu::Limits) -> TestGpu {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    descriptor.backends = wgpu::Backends::from_env().unwrap_or(wgpu::Backends::PRIMARY);
    let instance = wgpu::Instance::new(descriptor);
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let is_software = |adapter: &wgpu::Adapter| adapter.get_info().device_type == wgpu::DeviceType::Cpu;
    let adapter = adapters.into_iter().find(is_software).expect("a software adapter, such as Mesa's lavapipe");
    let descriptor = wgpu::DeviceDescriptor {
        required_features: adapter.features() & features,
        required_limits,
        ..Default::default()
    };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).expect("a device");
    TestGpu { adapter, device, queue }
}

/// Returns the software adapter as the renderer opens it, lent to one test after another like [`software_gpu`]. A test that
/// must not share it calls [`open_renderer_gpu`].
///
/// # Panics
///
/// If the machine has no software adapter.
#[cfg(feature = "render")]
pub fn renderer_gpu() -> shadowfit_render::Gpu {
    static FREE: Mutex<Vec<shadowfit_render::Gpu>> = Mutex::new(Vec::new());
    std::thread_local! {
        static LENT: Lent<shadowfit_render::Gpu> = Lent::new(&FREE, open_renderer_gpu);
    }
    LENT.with(Lent::get)
}

/// Opens the software adapter again, as the renderer does, or the fastest one if `SHADOWFIT_ADAPTER` is `any`: for single
/// tests that are right on every GPU and slow on the software adapter.
///
/// # Panics
///
/// If the machine has no such adapter.
#[cfg(feature = "render")]
pub fn open_renderer_gpu() -> shadowfit_render::Gpu {
    use shadowfit_render::{AdapterChoice, Gpu};
    let is_any = std::env::var_os("SHADOWFIT_ADAPTER").is_some_and(|adapter| adapter == "any");
    let choice = if is_any { AdapterChoice::Any } else { AdapterChoice::Software };
    pollster::block_on(Gpu::headless(choice)).unwrap_or_else(|error| panic!("this test draws, and {error}"))
}
