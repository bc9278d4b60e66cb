//! Makes a module that browsers load of what the compiler built: `bindgen MODULE.wasm FOLDER`. A program of its own, so
//! that the other tasks need not build the library that does it.

use anyhow::{Context, Result};
use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let (module, folder) = arguments.next().zip(arguments.next()).context("bindgen MODULE.wasm FOLDER")?;
    Bindgen::new().input_path(module).web(true)?.typescript(false).remove_name_section(true).generate(folder)
}
