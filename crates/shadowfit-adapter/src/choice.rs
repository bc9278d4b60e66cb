//! The choice of an adapter, and the search for it.

use core::fmt;
use core::str::FromStr;

use crate::error::{AdapterError, label};

/// Which adapter to open.
///
/// A machine with several graphics APIs lists the same GPU once for each. OpenGL comes last in [`adapters`], so a name
/// finds the GPU through Vulkan, Metal or Direct3D 12 first. Set `WGPU_BACKEND=gl` to choose OpenGL.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AdapterChoice {
    /// The fastest adapter.
    #[default]
    Any,
    /// A software rasteriser (Mesa's llvmpipe, `SwiftShader`, WARP), even if a GPU is present.
    Software,
    /// The first adapter with this text in its name. Upper and lower case are equal.
    Named(String),
}

/// The text of an [`AdapterChoice`] is empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EmptyName;

impl fmt::Display for EmptyName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of the graphics adapter is empty. Use `any`, `software` or a part of a name")
    }
}

impl core::error::Error for EmptyName {}

/// Reads `any`, `software`, or a part of an adapter's name.
impl FromStr for AdapterChoice {
    type Err = EmptyName;

    fn from_str(text: &str) -> Result<Self, EmptyName> {
        match text.trim() {
            "" => Err(EmptyName),
            text if text.eq_ignore_ascii_case("any") => Ok(Self::Any),
            text if text.eq_ignore_ascii_case("software") => Ok(Self::Software),
            text => Ok(Self::Named(text.to_owned())),
        }
    }
}

/// Writes the text that [`FromStr`] reads.
impl fmt::Display for AdapterChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Any => "any",
            Self::Software => "software",
            Self::Named(part) => part,
        })
    }
}

/// Environment variable that chooses the adapter of programs and tests: `software`, `any` or a part of a name.
pub const ADAPTER_VARIABLE: &str = "SHADOWFIT_ADAPTER";

impl AdapterChoice {
    /// Returns the choice of the environment variable [`ADAPTER_VARIABLE`]. An empty variable counts as unset.
    pub fn from_env() -> Option<Self> {
        std::env::var_os(ADAPTER_VARIABLE)?.to_string_lossy().parse().ok()
    }

    /// Returns the chosen adapter. It can draw to `surface`, if one is given.
    ///
    /// # Errors
    ///
    /// [`AdapterError`] if the machine has no such adapter.
    pub async fn find(
        &self,
        instance: &wgpu::Instance,
        surface: Option<&wgpu::Surface<'_>>,
    ) -> Result<wgpu::Adapter, AdapterError> {
        if *self == Self::Any {
            return fastest(instance, surface).await;
        }
        let mut adapters = adapters(instance).await;
        let can_present = |adapter: &wgpu::Adapter| surface.is_none_or(|surface| adapter.is_surface_supported(surface));
        let infos: Vec<_> = adapters.iter().map(|adapter| (adapter.get_info(), can_present(adapter))).collect();
        match infos.iter().position(|(info, can_present)| *can_present && self.matches(info)) {
            Some(index) => Ok(adapters.swap_remove(index)),
            None => Err(self.error(&infos)),
        }
    }

    /// Returns the error of a choice that fits none of the adapters that can draw to the window. Each adapter of the machine
    /// comes with a flag for that.
    fn error(&self, infos: &[(wgpu::AdapterInfo, bool)]) -> AdapterError {
        if let Some((info, _)) = infos.iter().find(|(info, _)| self.matches(info)) {
            let able = infos.iter().filter(|(_, can_present)| *can_present).map(|(info, _)| label(info)).collect();
            return AdapterError::CannotPresent { adapter: label(info), able };
        }
        let present = infos.iter().map(|(info, _)| label(info)).collect();
        match self {
            Self::Any => AdapterError::None("none is present".into()),
            Self::Software => AdapterError::NoSoftware { present },
            Self::Named(name) => AdapterError::NoSuchName { name: name.clone(), present },
        }
    }

    /// Returns whether an adapter fits this choice.
    pub fn matches(&self, info: &wgpu::AdapterInfo) -> bool {
        match self {
            Self::Any => true,
            Self::Software => info.device_type == wgpu::DeviceType::Cpu,
            Self::Named(part) => info.name.to_lowercase().contains(&part.to_lowercase()),
        }
    }
}

/// Opens the graphics APIs: Vulkan, Metal or Direct3D 12, unless `WGPU_BACKEND` names others. A browser
/// offers WebGPU, which is preferred, and WebGL2, if wgpu's features enable them.
pub fn instance() -> wgpu::Instance {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    let of_browser = wgpu::Backends::BROWSER_WEBGPU | wgpu::Backends::GL;
    let usual = if cfg!(target_family = "wasm") { of_browser } else { wgpu::Backends::PRIMARY };
    descriptor.backends = wgpu::Backends::from_env().unwrap_or(usual);
    wgpu::Instance::new(descriptor)
}

/// Lists the adapters of this machine, OpenGL last.
pub async fn adapters(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    let mut adapters = instance.enumerate_adapters(wgpu::Backends::all()).await;
    adapters.sort_by_key(|adapter| adapter.get_info().backend == wgpu::Backend::Gl);
    adapters
}

async fn fastest(
    instance: &wgpu::Instance,
    surface: Option<&wgpu::Surface<'_>>,
) -> Result<wgpu::Adapter, AdapterError> {
    instance
        .request_adapter(&wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: surface,
            ..Default::default()
        })
        .await
        .map_err(|error| AdapterError::None(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn info(name: &str, device_type: wgpu::DeviceType) -> wgpu::AdapterInfo {
        wgpu::AdapterInfo { name: name.into(), ..wgpu::AdapterInfo::new(device_type, wgpu::Backend::Vulkan) }
    }

    #[test]
    fn words_and_names_are_read_and_written() {
        for (text, choice, written) in [
            ("any", AdapterChoice::Any, "any"),
            (" Software\n", AdapterChoice::Software, "software"),
            ("NVIDIA h200", AdapterChoice::Named("NVIDIA h200".into()), "NVIDIA h200"),
        ] {
            assert_eq!(text.parse(), Ok(choice.clone()));
            assert_eq!(choice.to_string(), written);
        }
        assert_eq!("  ".parse::<AdapterChoice>(), Err(EmptyName));
    }

    #[test]
    fn a_name_matches_any_part_in_any_case() {
        let gpu = info("NVIDIA H200", wgpu::DeviceType::DiscreteGpu);
        let mesa = info("llvmpipe (LLVM 15.0.6, 256 bits)", wgpu::DeviceType::Cpu);
        let matches = |text: &str| [&gpu, &mesa].map(|info| text.parse::<AdapterChoice>().unwrap().matches(info));
        assert_eq!(matches("h200"), [true, false]);
        assert_eq!(matches("LLVMPipe"), [false, true]);
        assert_eq!(matches("software"), [false, true]);
        assert_eq!(matches("any"), [true, true]);
        assert_eq!(matches("radeon"), [false, false]);
    }

    #[test]
    fn a_name_without_an_adapter_lists_the_adapters_of_the_machine() {
        let infos = [info("NVIDIA H200", wgpu::DeviceType::DiscreteGpu), info("llvmpipe", wgpu::DeviceType::Cpu)];
        let infos = [false, true].map(|can_present| infos.clone().map(|info| (info, can_present))).concat();
        let error = AdapterChoice::Named("radeon".into()).error(&infos).to_string();
        assert!(error.contains("\"radeon\""), "{error}");
        assert!(error.contains("NVIDIA H200 (Vulkan, discrete GPU)"), "{error}");
        assert!(error.contains("llvmpipe (Vulkan, software)"), "{error}");
    }

    #[test]
    fn an_adapter_that_cannot_draw_to_the_window_is_said_to_be_there() {
        let (gpu, mesa) = (info("NVIDIA H200", wgpu::DeviceType::DiscreteGpu), info("llvmpipe", wgpu::DeviceType::Cpu));
        let infos = [(gpu, false), (mesa.clone(), true)];
        let error = AdapterChoice::Named("nvidia".into()).error(&infos).to_string();
        let expected = "NVIDIA H200 (Vulkan, discrete GPU) cannot draw to this window. These adapters can:\n  \
                        llvmpipe (Vulkan, software)";
        assert_eq!(error, expected);
        let error = AdapterChoice::Software.error(&[(mesa, false)]).to_string();
        assert_eq!(error, "llvmpipe (Vulkan, software) cannot draw to this window. No adapter of this machine can");
    }

    #[test]
    fn gpu_a_name_that_no_adapter_has_is_an_error_with_the_adapters_of_this_machine() {
        let instance = instance();
        let all = pollster::block_on(adapters(&instance));
        let choice = AdapterChoice::Named("no adapter has this name".into());
        let error = pollster::block_on(choice.find(&instance, None)).expect_err("no such adapter").to_string();
        assert!(!all.is_empty() && error.contains("no adapter has this name"), "{error}");
        for adapter in all {
            assert!(error.contains(&adapter.get_info().name), "{error}");
        }
    }
}
