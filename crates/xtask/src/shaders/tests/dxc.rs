//! Compiles the HLSL as shader model 6 with Microsoft's compiler, which `cargo xtask test` fetches.

use std::process::Command;

use super::*;
use crate::{dxc, process};

/// Compiles a shader without a warning.
fn compile(profile: &str, entry: &str, source: &str) {
    let library = std::env::var_os(dxc::LIBRARY).map(Into::into).or_else(dxc::fetched);
    let library = library.unwrap_or_else(|| panic!("set {} to the path of libdxcompiler.so", dxc::LIBRARY));
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    std::fs::write(file.path(), source).expect("it is written");
    let script = process::root().join("crates/xtask/src/shaders/dxc.py");
    let mut command = Command::new("python3");
    let output = command.arg(script).arg(library).args([profile, entry]).arg(file.path()).output().expect("python3");
    let [text, errors] = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert!(output.status.success(), "{profile}: {text}{errors}");
}

#[test]
fn hlsl_compiles_as_shader_model_6() {
    let look_up = committed("shadowfit_lookup.hlsl");
    for settings in settings(Language::Hlsl) {
        compile("ps_6_0", "entry", &[&settings, &look_up, HLSL_LOOK_UP].concat());
    }
    compile("vs_6_0", "entry", &(committed("shadowfit_caster.hlsl") + HLSL_CASTER));
    compile("cs_6_0", "count_demand", &committed("shadowfit_demand.hlsl"));
}
