//! Checks of WGSL by naga.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use naga::back::PipelineConstants;
use naga::back::glsl;
use naga::back::pipeline_constants::process_overrides;
use naga::proc::BoundsCheckPolicies;
use naga::valid::{Capabilities, FunctionInfo, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, EntryPoint, Expression, Function, Handle, Module, ScalarKind, ShaderStage, TypeInner};

/// Parses a module. Failure messages contain `name`.
///
/// # Panics
///
/// If the source has an error.
pub fn parse(name: &str, source: &str) -> Module {
    naga::front::wgsl::parse_str(source).unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)))
}

/// A parsed module, with its name for messages. Tests that use a module several times parse it only once.
#[derive(Debug)]
pub struct Shader {
    /// Name for messages.
    pub name: String,
    /// Source.
    pub source: String,
    /// The source, parsed.
    pub module: Module,
}

impl Shader {
    /// Parses a module.
    ///
    /// # Panics
    ///
    /// If the source has an error.
    pub fn new(name: impl Into<String>, source: impl Into<String>) -> Self {
        let (name, source) = (name.into(), source.into());
        let module = parse(&name, &source);
        Self { name, source, module }
    }

    /// Validates the module and asserts that it needs only these capabilities.
    ///
    /// # Panics
    ///
    /// If the module is not valid.
    pub fn assert_valid(&self, needed: Capabilities) -> ModuleInfo {
        let validated = Validator::new(ValidationFlags::all(), needed).validate(&self.module);
        validated.unwrap_or_else(|error| panic!("{}: {}", self.name, error.emit_to_string(&self.source)))
    }

    /// Asserts that the module has an entry point for each of these stages.
    ///
    /// # Panics
    ///
    /// If it lacks one.
    pub fn assert_has_stages(&self, stages: &[ShaderStage]) {
        for stage in stages {
            let is_there = self.module.entry_points.iter().any(|entry| entry.stage == *stage);
            assert!(is_there, "{} has no {stage:?} stage", self.name);
        }
    }

    /// Asserts that WebGL2 can draw with the module: naga can translate its entry points, and the sizes of
    /// its uniform blocks are multiples of a vector.
    ///
    /// # Panics
    ///
    /// If WebGL2 cannot draw with it.
    pub fn assert_translates_to_webgl2(&self) {
        let Self { name, module, .. } = self;
        let info = self.assert_valid(Capabilities::all());
        self.translate_to_webgl2(&info).unwrap_or_else(|error| panic!("{name}: {error}"));
        for (handle, function) in module.functions.iter() {
            assert!(!mixes_integers(module, function, &info[handle]), "{name}: {:?}", function.name);
        }
        for (_, global) in module.global_variables.iter().filter(|(_, global)| global.space == AddressSpace::Uniform) {
            let size = module.types[global.ty].inner.size(module.to_ctx());
            assert_eq!(size % 16, 0, "{name}: {:?} has {size} bytes", global.name);
        }
    }

    /// Translates every entry point into the shading language of WebGL2.
    ///
    /// # Errors
    ///
    /// Returns the error of the first entry point that naga cannot translate.
    pub fn translate_to_webgl2(&self, info: &ModuleInfo) -> Result<(), String> {
        self.module.entry_points.iter().try_for_each(|entry| translated(&self.module, info, entry))
    }

    /// Returns the names of the structs of the module's uniforms.
    ///
    /// # Panics
    ///
    /// If a uniform's type has no name.
    pub fn uniform_structs(&self) -> BTreeSet<String> {
        let Self { name, module, .. } = self;
        let uniforms = module.global_variables.iter().filter(|(_, global)| global.space == AddressSpace::Uniform);
        let named = |ty: Handle<naga::Type>| module.types[ty].name.clone();
        uniforms
            .map(|(_, global)| named(global.ty).unwrap_or_else(|| panic!("{name}: a uniform without a name")))
            .collect()
    }
}

/// Validates a module that needs only these capabilities, and returns it parsed.
///
/// # Panics
///
/// If the module is not valid.
pub fn assert_valid(name: &str, source: &str, needed: Capabilities) -> Module {
    let shader = Shader::new(name, source);
    shader.assert_valid(needed);
    shader.module
}

/// Asserts that WebGL2 can draw with a module, as [`Shader::assert_translates_to_webgl2`].
///
/// # Panics
///
/// If WebGL2 cannot draw with it.
pub fn assert_translates_to_webgl2(name: &str, source: &str) {
    Shader::new(name, source).assert_translates_to_webgl2();
}

/// Translates an entry point into the shading language of WebGL2, with the defaults of the module's
/// constants.
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
        .map_err(|error| format!("{}: {error}", entry.name))
        .map(|_| ())
}

/// Returns whether a function selects among integers by several conditions at once. The shading language of
/// WebGL2 cannot do this, but naga translates it without an error.
fn mixes_integers(module: &Module, function: &Function, info: &FunctionInfo) -> bool {
    function.expressions.iter().any(|(_, expression)| {
        let Expression::Select { condition, accept, .. } = *expression else { return false };
        let inner = |expression: Handle<Expression>| info[expression].ty.inner_with(&module.types);
        let is_vector = matches!(inner(condition), TypeInner::Vector { .. });
        is_vector && !matches!(inner(accept).scalar_kind(), Some(ScalarKind::Float))
    })
}

/// Returns the names of the structs of a module's uniforms, as [`Shader::uniform_structs`].
///
/// # Panics
///
/// If a uniform's type has no name.
pub fn uniform_structs(name: &str, source: &str) -> BTreeSet<String> {
    Shader::new(name, source).uniform_structs()
}

/// Asserts that one of the texts contains each WGSL file below a folder as a whole. `filled` returns the versions of a file
/// with its placeholders filled in.
///
/// # Panics
///
/// If the folder has no file, or a file is part of no text.
pub fn assert_every_file_is_used(folder: &Path, texts: &[&str], filled: impl Fn(&str) -> Vec<String>) {
    let files = files(folder);
    assert!(!files.is_empty(), "{} has no WGSL file", folder.display());
    for (path, file) in files {
        let is_used = filled(&file).iter().any(|file| texts.iter().any(|text| text.contains(file.as_str())));
        assert!(is_used, "{} is part of no module that this test knows", path.display());
    }
}

/// Returns every WGSL file below a folder with its text.
///
/// # Panics
///
/// If a file cannot be read.
pub fn files(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut folders = vec![folder.to_owned()];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten() {
            let path = entry.expect("a file or a folder").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "wgsl") {
                let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
                files.push((path, text));
            }
        }
    }
    files
}
