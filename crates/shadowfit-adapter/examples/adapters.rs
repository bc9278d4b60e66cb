//! Lists the graphics adapters of this machine, or the one that `--adapter NAME` or `--hardware` chooses.
//!
//! ```sh
//! cargo run -p shadowfit-adapter --example adapters
//! cargo run -p shadowfit-adapter --example adapters -- --adapter nvidia
//! cargo run -p shadowfit-adapter --example adapters -- --hardware   # the name of the first GPU
//! ```

use std::process::ExitCode;

use shadowfit_adapter::{AdapterChoice, adapters, instance, label};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        [] => all(),
        ["--hardware"] => hardware(),
        ["--adapter", name] => chosen(name),
        _ => refuse("usage: adapters [--adapter NAME | --hardware]"),
    }
}

fn all() -> ExitCode {
    for adapter in pollster::block_on(adapters(&instance())) {
        println!("{}", label(&adapter.get_info()));
    }
    ExitCode::SUCCESS
}

fn chosen(name: &str) -> ExitCode {
    let found = name
        .parse::<AdapterChoice>()
        .map_err(|error| error.to_string())
        .and_then(|choice| pollster::block_on(choice.find(&instance(), None)).map_err(|error| error.to_string()));
    match found {
        Ok(adapter) => println!("{}", label(&adapter.get_info())),
        Err(error) => return refuse(&error),
    }
    ExitCode::SUCCESS
}

/// Prints the name of the first adapter that is no software rasteriser.
fn hardware() -> ExitCode {
    let infos: Vec<_> = pollster::block_on(adapters(&instance())).iter().map(wgpu::Adapter::get_info).collect();
    match infos.iter().find(|info| !AdapterChoice::Software.matches(info)) {
        Some(info) => println!("{}", info.name),
        None => return refuse("this machine has no GPU: all its graphics adapters are software rasterisers"),
    }
    ExitCode::SUCCESS
}

fn refuse(error: &str) -> ExitCode {
    eprintln!("error: {error}");
    ExitCode::from(2)
}
