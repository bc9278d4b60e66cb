//! Lists the graphics adapters of this machine, or the one that `--adapter NAME` or `--hardware` chooses.
//!
//! ```sh
//! cargo run -p shadowfit-adapter --example adapters
//! cargo run -p shadowfit-adapter --example adapters -- --adapter nvidia
//! cargo run -p shadowfit-adapter --example adapters -- --hardware   # the name of the GPU, a discrete one if there is one
//! ```

use std::io::{ErrorKind, Write};
use std::process::ExitCode;

use shadowfit_adapter::{AdapterChoice, adapters, instance, label};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let lines = match arguments[..] {
        [] => Ok(infos().iter().map(label).collect()),
        ["--hardware"] => hardware(&infos()).map(|name| vec![name]),
        ["--adapter", name] => chosen(name).map(|label| vec![label]),
        _ => Err("usage: adapters [--adapter NAME | --hardware]".into()),
    };
    match lines.and_then(|lines| print(&lines)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            let _ = writeln!(std::io::stderr(), "error: {error}");
            ExitCode::from(2)
        }
    }
}

fn infos() -> Vec<wgpu::AdapterInfo> {
    pollster::block_on(adapters(&instance())).iter().map(wgpu::Adapter::get_info).collect()
}

fn chosen(name: &str) -> Result<String, String> {
    let choice: AdapterChoice = name.parse().map_err(|error| format!("{error}"))?;
    let adapter = pollster::block_on(choice.find(&instance(), None)).map_err(|error| error.to_string())?;
    Ok(label(&adapter.get_info()))
}

/// Returns the name of the GPU that is probably the fastest one: discrete before integrated before others. An adapter
/// without a name cannot be chosen by it.
fn hardware(infos: &[wgpu::AdapterInfo]) -> Result<String, String> {
    let rank = |info: &&wgpu::AdapterInfo| match info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu | wgpu::DeviceType::Other | wgpu::DeviceType::Cpu => 2,
    };
    let is_gpu = |info: &&wgpu::AdapterInfo| !AdapterChoice::Software.matches(info) && !info.name.trim().is_empty();
    let found = infos.iter().filter(is_gpu).min_by_key(rank);
    found.map(|info| info.name.clone()).ok_or_else(|| {
        let list = infos.iter().fold(String::new(), |text, info| text + "\n  " + &label(info));
        format!("no graphics adapter of this machine is a GPU with a name. It has:{list}")
    })
}

/// Prints lines. A closed pipe is not an error: `head`, for example, closes its end early.
fn print(lines: &[String]) -> Result<(), String> {
    let text = lines.iter().fold(String::new(), |text, line| text + line + "\n");
    match std::io::stdout().write_all(text.as_bytes()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(format!("cannot write to the standard output: {error}"))
        }
        Ok(()) | Err(_) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gpu_is_a_discrete_one_if_there_is_one_and_has_a_name() {
        use wgpu::DeviceType::{Cpu, DiscreteGpu, IntegratedGpu, Other};
        let found = |adapters: &[(&str, wgpu::DeviceType)]| {
            let info = |(name, kind): &(&str, wgpu::DeviceType)| wgpu::AdapterInfo {
                name: (*name).to_owned(),
                ..wgpu::AdapterInfo::new(*kind, wgpu::Backend::Vulkan)
            };
            hardware(&adapters.iter().map(info).collect::<Vec<_>>())
        };
        let mesa = ("llvmpipe", Cpu);
        assert_eq!(found(&[mesa, ("Iris", IntegratedGpu), ("Arc", DiscreteGpu)]), Ok("Arc".to_owned()));
        assert_eq!(found(&[("Unknown", Other), ("Iris", IntegratedGpu), mesa]), Ok("Iris".to_owned()));
        assert_eq!(found(&[("", DiscreteGpu), ("Unknown", Other), mesa]), Ok("Unknown".to_owned()));
        let error = found(&[(" ", DiscreteGpu), mesa]).expect_err("no GPU with a name");
        assert!(error.ends_with("\n  llvmpipe (Vulkan, software)"), "{error}");
    }
}
