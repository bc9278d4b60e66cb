//! Translates WGSL into other shading languages with naga, and makes the names of the result stable.
//!
//! naga numbers repeated names through a whole module (`position`, `position_1`, ...). A function's text would then
//! depend on the functions before it, so numbers are removed, or counted in each function alone.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context, Result, anyhow, ensure};
use naga::back::{glsl, hlsl, msl};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, ResourceBinding, ShaderStage};

/// A shading language of the generated files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Language {
    Glsl,
    Hlsl,
    Msl,
}

impl Language {
    /// All languages.
    pub(super) const ALL: [Self; 3] = [Self::Glsl, Self::Hlsl, Self::Msl];

    /// Returns the ending of file names.
    pub(super) const fn ending(self) -> &'static str {
        match self {
            Self::Glsl => "glsl",
            Self::Hlsl => "hlsl",
            Self::Msl => "metal",
        }
    }
}

/// A struct, constant or function of a generated text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Item {
    pub(super) name: String,
    pub(super) text: String,
}

/// Returns naga's translation of a module with one entry point.
///
/// # Errors
/// If the module is invalid, the language cannot express it, or its text depends on the version.
pub(super) fn translate(wgsl: &str, language: Language) -> Result<String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|error| anyhow!(error.emit_to_string(wgsl)))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(&module)
        .map_err(|error| anyhow!(error.emit_to_string(wgsl)))?;
    match language {
        Language::Glsl => write_glsl(&module, &info),
        Language::Hlsl => {
            let text = write_hlsl(&module, &info, hlsl::ShaderModel::V5_1)?;
            let model_6 = write_hlsl(&module, &info, hlsl::ShaderModel::V6_0)?;
            ensure!(text == model_6, "shader models 5.1 and 6.0 need two texts");
            Ok(text)
        }
        Language::Msl => write_msl(&module, &info),
    }
}

/// Returns GLSL 4.5, whose text is also ES 3.0 except for version, precision and interface. ES 3.0 has no compute shaders.
fn write_glsl(module: &Module, info: &ModuleInfo) -> Result<String> {
    let entry = module.entry_points.first().context("no entry point")?;
    let write = |version| {
        let options = glsl::Options { version, writer_flags: glsl::WriterFlags::empty(), ..glsl::Options::default() };
        let pipeline =
            glsl::PipelineOptions { shader_stage: entry.stage, entry_point: entry.name.clone(), multiview: None };
        let mut text = String::new();
        glsl::Writer::new(&mut text, module, info, &options, &pipeline, Default::default())?.write()?;
        Ok::<_, glsl::Error>(text)
    };
    let text = write(glsl::Version::Desktop(450))?;
    if entry.stage != ShaderStage::Compute {
        let es = write(glsl::Version::Embedded { version: 300, is_webgl: false })?;
        ensure!(items(&text)? == items(&es)?, "GLSL 4.5 and ES 3.0 need two texts");
    }
    Ok(text)
}

fn write_hlsl(module: &Module, info: &ModuleInfo, shader_model: hlsl::ShaderModel) -> Result<String> {
    let options =
        hlsl::Options { shader_model, restrict_indexing: false, force_loop_bounding: false, ..Default::default() };
    let mut text = String::new();
    hlsl::Writer::new(&mut text, &options, &hlsl::PipelineOptions::default()).write(module, info, None)?;
    Ok(text)
}

/// Returns Metal 2.0, with buffers and textures of an entry point at the numbers of their bindings.
fn write_msl(module: &Module, info: &ModuleInfo) -> Result<String> {
    let bound = module.global_variables.iter().filter_map(|(_, global)| global.binding);
    let slot = |binding: ResourceBinding| {
        let slot = u8::try_from(binding.binding).ok();
        let target = msl::BindTarget { buffer: slot, texture: slot, mutable: true, ..Default::default() };
        (binding, target)
    };
    let resources = msl::EntryPointResources { resources: bound.map(slot).collect(), ..Default::default() };
    let options = msl::Options {
        lang_version: (2, 0),
        per_entry_point_map: module.entry_points.iter().map(|entry| (entry.name.clone(), resources.clone())).collect(),
        force_loop_bounding: false,
        ..msl::Options::default()
    };
    Ok(msl::write_string(module, info, &options, &msl::PipelineOptions::default())?.0)
}

/// Returns the structs, constants and functions of a text whose names contain the prefix of our names, and naga's
/// helpers. Leaves out the entry point and the declarations of resources.
///
/// # Errors
/// If the text ends within an item.
pub(super) fn items(text: &str) -> Result<Vec<Item>> {
    let mut items = Vec::new();
    let mut item = String::new();
    for line in text.lines() {
        if item.is_empty() && (line.is_empty() || line.starts_with(['#', '/'])) {
            continue;
        }
        item.push_str(&tidy(line.trim_end()));
        item.push('\n');
        let depth = |open, close| item.matches(open).count() == item.matches(close).count();
        if line.ends_with([';', '}']) && depth('{', '}') && depth('(', ')') {
            let text = std::mem::take(&mut item);
            let name = name_of(&text).to_owned();
            if is_ours(&name) {
                items.push(Item { name, text });
            }
        }
    }
    ensure!(item.is_empty(), "an item without an end: {item}");
    // naga appends an underscore to the first use of a keyword, and only numbers to later ones.
    let keywords: BTreeSet<String> = words(text).filter_map(|word| Some(word.strip_suffix('_')?.to_owned())).collect();
    let block = if text.contains("shadowfit_Receiver") { "shadowfit_receiver" } else { "shadowfit_caster" };
    for item in &mut items {
        let renamed = if item.text.contains('(') { without_numbers(&item.text, &keywords) } else { item.text.clone() };
        item.text = replaced(&renamed, |word| ours(word, block));
    }
    Ok(items)
}

/// Removes the second pair of parentheses around a condition, which compilers warn about.
pub(super) fn tidy(line: &str) -> String {
    let inner = line.trim_start().strip_prefix("if ((").and_then(|rest| rest.strip_suffix(")) {"));
    let Some(inner) = inner else { return line.to_owned() };
    let mut depth = 1;
    for c in inner.chars() {
        depth += i32::from(c == '(') - i32::from(c == ')');
        if depth == 0 {
            return line.to_owned();
        }
    }
    let indent = &line[..line.len() - line.trim_start().len()];
    format!("{indent}if ({inner}) {{")
}

/// Returns the last word before the part of an item that follows its name.
fn name_of(text: &str) -> &str {
    let head = text.split(['(', '=', '{', ';']).next().unwrap_or_default();
    head.split(|c: char| !is_of_word(c)).rfind(|word| !word.is_empty()).unwrap_or_default()
}

fn is_ours(name: &str) -> bool {
    let is_resource = ["shadowfit_sampler", "shadowfit_texture"].contains(&name);
    !is_resource && ["shadowfit_", "SHADOWFIT_", "Naga", "naga_", "type_"].iter().any(|part| name.contains(part))
}

/// Returns our name for naga's name of a resource, a helper or the type of an array. `block` is the constant block.
fn ours(word: &str, block: &str) -> Option<String> {
    match word {
        _ if word.starts_with("_group_0_binding_0") => Some(block.to_owned()),
        _ if word.starts_with("_group_0_binding_1") => Some("shadowfit_texture".to_owned()),
        _ if word.starts_with("type_") => Some("shadowfit_Maps".to_owned()),
        _ if word.starts_with("Naga") || word.starts_with("naga_") => Some(format!("shadowfit_{word}")),
        _ => None,
    }
}

/// Returns a function's text with each numbered name replaced by the name without its number, or with the least free
/// number.
fn without_numbers(text: &str, keywords: &BTreeSet<String>) -> String {
    let mut used: BTreeSet<String> =
        words(text).filter(|word| base_of(word).is_none()).map(ToOwned::to_owned).collect();
    let mut names: BTreeMap<&str, String> = BTreeMap::new();
    for word in words(text) {
        let Some(base) = base_of(word).filter(|_| !names.contains_key(word)) else { continue };
        let plain = if keywords.contains(base) { format!("{base}_") } else { base.to_owned() };
        let numbered = (1..).map(|number| format!("{base}_{number}"));
        let free = std::iter::once(plain).chain(numbered).find(|name| !used.contains(name)).unwrap_or_default();
        used.insert(free.clone());
        names.insert(word, free);
    }
    replaced(text, |word| names.get(word).cloned())
}

/// Returns the name before the number that naga appended, if it did.
fn base_of(word: &str) -> Option<&str> {
    let (base, number) = word.rsplit_once('_')?;
    let is_numbered = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    (is_numbered && !base.is_empty() && !base.starts_with('_') && base != "type").then_some(base)
}

/// Replaces words, except fields after a dot.
pub(super) fn replaced(text: &str, new: impl Fn(&str) -> Option<String>) -> String {
    let mut result = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(begin) = rest.find(is_of_word) {
        let is_field = rest[..begin].ends_with('.');
        let word_end = rest[begin..].find(|c| !is_of_word(c)).map_or(rest.len(), |length| begin + length);
        let word = &rest[begin..word_end];
        result.push_str(&rest[..begin]);
        result.push_str(&new(word).filter(|_| !is_field).unwrap_or_else(|| word.to_owned()));
        rest = &rest[word_end..];
    }
    result + rest
}

/// Returns the words of a text in order.
pub(super) fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c| !is_of_word(c)).filter(|word| !word.is_empty())
}

fn is_of_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}
