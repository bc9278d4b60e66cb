//! Errors of the search for an adapter. They list the adapters of the machine.

use core::fmt;

/// Why no adapter was found, with the remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum AdapterError {
    /// The machine has no adapter. Holds wgpu's reason.
    None(String),
    /// The machine has no software rasteriser.
    NoSoftware {
        /// [Labels](label) of the adapters of this machine.
        present: Vec<String>,
    },
    /// No adapter has the name.
    NoSuchName {
        /// Part of a name.
        name: String,
        /// [Labels](label) of the adapters of this machine.
        present: Vec<String>,
    },
    /// The machine has the adapter, but it cannot draw to the window.
    CannotPresent {
        /// [Label](label) of the adapter.
        adapter: String,
        /// Labels of the adapters that can draw to the window.
        able: Vec<String>,
    },
}

impl fmt::Display for AdapterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let hint = "On Debian or Ubuntu `apt-get install mesa-vulkan-drivers libvulkan1` installs a software adapter.";
        match self {
            Self::None(reason) => write!(f, "no graphics adapter was found ({reason}). {hint}"),
            Self::NoSoftware { present } => {
                write!(f, "no software graphics adapter was found. {hint} {}", on_machine(present))
            }
            Self::NoSuchName { name, present } => {
                write!(f, "no graphics adapter has {name:?} in its name. {}", on_machine(present))
            }
            Self::CannotPresent { adapter, able } if able.is_empty() => {
                write!(f, "{adapter} cannot draw to this window. No adapter of this machine can")
            }
            Self::CannotPresent { adapter, able } => {
                write!(f, "{adapter} cannot draw to this window. These adapters can:{}", lines(able))
            }
        }
    }
}

impl core::error::Error for AdapterError {}

fn on_machine(present: &[String]) -> String {
    if present.is_empty() {
        return "This machine has no adapter.".into();
    }
    format!("This machine has:{}", lines(present))
}

fn lines(labels: &[String]) -> String {
    labels.iter().fold(String::new(), |text, label| text + "\n  " + label)
}

/// Returns the name of an adapter with its API and its kind, such as `NVIDIA H200 (Vulkan, discrete GPU)`.
pub fn label(info: &wgpu::AdapterInfo) -> String {
    let api = match info.backend {
        wgpu::Backend::Noop => "no API",
        wgpu::Backend::Vulkan => "Vulkan",
        wgpu::Backend::Metal => "Metal",
        wgpu::Backend::Dx12 => "Direct3D 12",
        wgpu::Backend::Gl => "OpenGL",
        wgpu::Backend::BrowserWebGpu => "WebGPU",
    };
    let kind = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => "discrete GPU",
        wgpu::DeviceType::IntegratedGpu => "integrated GPU",
        wgpu::DeviceType::VirtualGpu => "virtual GPU",
        wgpu::DeviceType::Cpu => "software",
        wgpu::DeviceType::Other => "unknown kind",
    };
    format!("{} ({api}, {kind})", info.name)
}
