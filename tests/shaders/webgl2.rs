//! Modules that draw are ones that WebGL2 can draw with: naga writes them in its shading language, whose uniform blocks
//! are of whole vectors.

use naga::back::PipelineConstants;
use naga::back::glsl;
use naga::back::pipeline_constants::process_overrides;
use naga::proc::BoundsCheckPolicies;
use naga::valid::{Capabilities, FunctionInfo, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, EntryPoint, Expression, Function, Handle, Module, ScalarKind, TypeInner};

use super::{modules, parse};

/// Whether WebGL2 is never given a module: those for shaders that compute, load depths, or know their primitive.
fn is_for_others(name: &str) -> bool {
    let begins = ["probe", "Vulkan", "mark rows of four samples"].iter().any(|kind| name.starts_with(kind));
    begins || ["Depth32Float Pcss", "Depth16Unorm Pcss", "compute", "piece"].iter().any(|part| name.contains(part))
}

/// The shading language of WebGL2 for an entry point, with the defaults of the module's constants.
fn translated(module: &Module, info: &ModuleInfo, entry: &EntryPoint) -> Result<(), String> {
    let constants = PipelineConstants::default();
    let (module, info) = process_overrides(module, info, Some((entry.stage, &entry.name)), &constants)
        .map_err(|error| format!("{}: {error}", entry.name))?;
    let options =
        glsl::Options { version: glsl::Version::Embedded { version: 300, is_webgl: true }, ..glsl::Options::default() };
    let pipeline =
        glsl::PipelineOptions { shader_stage: entry.stage, entry_point: entry.name.clone(), multiview: None };
    let mut text = String::new();
    glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, BoundsCheckPolicies::default())
        .and_then(|mut writer| writer.write())
        .map_err(|error| format!("{}: {error}", entry.name))?;
    Ok(())
}

/// Whether a function chooses among whole numbers by several conditions at once, for which the language has no word: naga
/// translates it all the same.
fn mixes_integers(module: &Module, function: &Function, info: &FunctionInfo) -> bool {
    function.expressions.iter().any(|(_, expression)| {
        let Expression::Select { condition, accept, .. } = *expression else { return false };
        let inner = |expression: Handle<Expression>| info[expression].ty.inner_with(&module.types);
        let is_vector = matches!(inner(condition), TypeInner::Vector { .. });
        is_vector && !matches!(inner(accept).scalar_kind(), Some(ScalarKind::Float))
    })
}

#[test]
fn what_draws_can_be_translated_for_webgl2_and_its_uniforms_are_whole_vectors() {
    let modules = modules();
    let drawn: Vec<_> = modules.iter().filter(|(name, _)| !is_for_others(name)).collect();
    assert!(drawn.len() > modules.len() / 4, "{} of {} modules", drawn.len(), modules.len());
    for (name, source) in drawn {
        let module = parse(name, source);
        let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).expect("it is valid");
        for entry in &module.entry_points {
            translated(&module, &info, entry).unwrap_or_else(|error| panic!("{name}: {error}"));
        }
        for (handle, function) in module.functions.iter() {
            assert!(!mixes_integers(&module, function, &info[handle]), "{name}: {:?}", function.name);
        }
        for (_, global) in module.global_variables.iter().filter(|(_, global)| global.space == AddressSpace::Uniform) {
            let size = module.types[global.ty].inner.size(module.to_ctx());
            assert_eq!(size % 16, 0, "{name}: {:?} has {size} bytes", global.name);
        }
    }
}
