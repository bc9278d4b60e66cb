//! Opens a device of the chosen adapter.

mod faults;

use core::fmt;
use std::sync::{Arc, Mutex};

use shadowfit_adapter::{AdapterChoice, AdapterError};

use faults::{Faults, watched};

pub use faults::{DeviceFault, hush_lost_devices};

/// An open device and its adapter and queue.
#[derive(Clone, Debug)]
pub struct Gpu {
    /// Adapter that the device belongs to.
    pub adapter: wgpu::Adapter,
    /// Device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    pub(crate) faults: Arc<Mutex<Faults>>,
}

/// Features and limits that a device should have. It also works with fewer features. The defaults include
/// every feature that makes a difference.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// Features, requested if the adapter has them.
    pub features: wgpu::Features,
    /// Limits that the adapter must have. `None` for the guaranteed limits of its kind, with the largest
    /// textures and buffers that it allows.
    pub limits: Option<wgpu::Limits>,
}

impl Default for Wanted {
    fn default() -> Self {
        let features =
            wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::DEPTH_CLIP_CONTROL | wgpu::Features::PRIMITIVE_INDEX;
        Self { features, limits: None }
    }
}

/// Reason why no GPU could be opened, with advice.
#[derive(Debug)]
pub enum GpuError {
    /// The machine has no such adapter.
    Adapter(AdapterError),
    /// The adapter refused to open a device.
    Device(wgpu::RequestDeviceError),
}

impl fmt::Display for GpuError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Adapter(error) => error.fmt(f),
            Self::Device(error) => write!(f, "the graphics adapter could not be opened: {error}"),
        }
    }
}

impl core::error::Error for GpuError {}

impl From<AdapterError> for GpuError {
    fn from(error: AdapterError) -> Self {
        Self::Adapter(error)
    }
}

impl Gpu {
    /// Opens an adapter without a window.
    ///
    /// # Errors
    ///
    /// [`GpuError`] if there is no such adapter or it cannot be opened.
    pub async fn headless(choice: &AdapterChoice) -> Result<Self, GpuError> {
        let instance = Self::instance();
        #[cfg(all(target_family = "wasm", feature = "webgl"))]
        {
            // WebGL2 is the context of a canvas, here an invisible one.
            let canvas = web_sys::OffscreenCanvas::new(1, 1).ok();
            let surface = canvas.map(|canvas| instance.create_surface(wgpu::SurfaceTarget::OffscreenCanvas(canvas)));
            if let Some(Ok(surface)) = surface {
                return Self::for_surface(choice, &instance, &surface).await;
            }
        }
        let adapter = choice.find(&instance, None).await?;
        Self::of_adapter(adapter, &Wanted::default()).await
    }

    /// Opens the graphics API: Vulkan, Metal or Direct3D 12, unless `WGPU_BACKEND` names others. In browsers
    /// the features of this crate select it. If both are enabled, it is WebGPU, unless the browser lacks it.
    pub fn instance() -> wgpu::Instance {
        shadowfit_adapter::instance()
    }

    /// Opens an adapter that can draw to `surface`.
    ///
    /// # Errors
    ///
    /// [`GpuError`] if there is no such adapter or it cannot be opened.
    pub async fn for_surface(
        choice: &AdapterChoice,
        instance: &wgpu::Instance,
        surface: &wgpu::Surface<'_>,
    ) -> Result<Self, GpuError> {
        let adapter = choice.find(instance, Some(surface)).await?;
        Self::of_adapter(adapter, &Wanted::default()).await
    }

    /// Opens an adapter with the wanted features and limits that it has.
    ///
    /// # Errors
    ///
    /// [`GpuError::Device`] if it cannot be opened.
    pub async fn of_adapter(adapter: wgpu::Adapter, wanted: &Wanted) -> Result<Self, GpuError> {
        let (device, queue) = adapter
            .request_device(&wgpu::DeviceDescriptor {
                label: Some("shadowfit"),
                required_features: adapter.features() & wanted.features,
                required_limits: wanted.limits.clone().unwrap_or_else(|| usual_limits(&adapter)),
                // Maps and scenes are created and dropped often. Blocks of 128 MiB and more would be kept for
                // small leftovers.
                memory_hints: wgpu::MemoryHints::MemoryUsage,
                ..Default::default()
            })
            .await
            .map_err(GpuError::Device)?;
        let faults = watched(&device);
        Ok(Self { adapter, device, queue, faults })
    }

    /// Submits work. If the CPU draws, this may block until earlier work is drawn.
    /// [`own_time`](crate::own_time) excludes that time.
    pub fn submit(&self, commands: impl IntoIterator<Item = wgpu::CommandBuffer>) {
        let commands: Vec<wgpu::CommandBuffer> = commands.into_iter().collect();
        crate::wait::waiting(|| self.queue.submit(commands));
    }

    /// Suppresses reports of device errors until the returned value is dropped. The device's error handler
    /// would end the program, because everything created on a lost device is invalid. The result of the work
    /// shows whether it failed.
    pub(crate) fn without_reports(&self) -> Unreported {
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        Unreported { _validation: validation, _memory: memory }
    }

    /// Returns the adapter's name, for titles and reports.
    pub fn name(&self) -> String {
        self.adapter.get_info().name
    }

    /// Returns whether the device has compute shaders.
    pub fn can_compute(&self) -> bool {
        self.device.limits().max_compute_invocations_per_workgroup > 0
    }

    /// Returns whether the CPU draws the pictures.
    pub fn is_software(&self) -> bool {
        self.adapter.get_info().device_type == wgpu::DeviceType::Cpu
    }
}

fn usual_limits(adapter: &wgpu::Adapter) -> wgpu::Limits {
    let limits = adapter.limits();
    // WebGL2 has neither compute shaders nor storage buffers. All others have WebGPU's guaranteed limits.
    let guaranteed = match adapter.get_info().backend {
        wgpu::Backend::Gl => wgpu::Limits::downlevel_webgl2_defaults(),
        _ => wgpu::Limits::default(),
    };
    wgpu::Limits {
        // Scenes of millions of triangles are uploaded as a whole to GPUs that ray trace them.
        max_buffer_size: limits.max_buffer_size,
        max_storage_buffer_binding_size: limits.max_storage_buffer_binding_size,
        ..guaranteed.using_resolution(limits)
    }
}

/// Returns whether a device uses OpenGL. Its textures have no views of another format, and shaders cannot
/// load multisampled or depth textures. In browsers it also lacks vertex streams of a single element.
pub(crate) fn is_opengl(device: &wgpu::Device) -> bool {
    device.adapter_info().backend == wgpu::Backend::Gl
}

/// Error scopes, dropped in this order: the last one opened first.
pub(crate) struct Unreported {
    _validation: wgpu::ErrorScopeGuard,
    _memory: wgpu::ErrorScopeGuard,
}
