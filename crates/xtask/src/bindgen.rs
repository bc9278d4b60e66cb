//! Converts a compiled module for browsers: `bindgen MODULE.wasm FOLDER`. It is a separate program, so that
//! the other tasks need not build the converter library.

use anyhow::{Context, Result};
use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let (module, folder) = arguments.next().zip(arguments.next()).context("bindgen MODULE.wasm FOLDER")?;
    Bindgen::new().input_path(module).web(true)?.typescript(false).remove_name_section(true).generate(folder)
}
