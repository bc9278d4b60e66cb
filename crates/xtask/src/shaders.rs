//! Writes the shaders of engines that do not use wgpu, for `cargo xtask generate`: GLSL, HLSL and MSL from the WGSL of
//! `shadowfit-wgpu`, in `crates/shadowfit-capi/shaders`.
//!
//! One look-up file per language serves all presets. It is merged from the WGSL of every filter, every rule that selects
//! a map, and every number of maps. Preprocessor conditions choose among them.

mod merge;
#[cfg(test)]
mod tests;
mod text;
mod translate;

use anyhow::{Context, Result, ensure};
use shadowfit::DepthConvention;
use shadowfit::settings::{FilterKind, MapSelection};
use shadowfit_wgpu::{ShadowMapDescriptor, WgslOptions, caster_wgsl, receiver_wgsl};

use merge::Axis;
use translate::{Item, Language};

/// Folder of the files, relative to the workspace's folder.
const FOLDER: &str = "crates/shadowfit-capi/shaders";

/// Filters by the names of the preprocessor, and whether depth is reversed. The numbers of the names are the indices.
/// Only percentage-closer soft shadows compare depths in the shader, so only they depend on the direction.
const FILTERS: [(&str, FilterKind, bool); 10] = [
    ("SHADOWFIT_POINT", FilterKind::Point, false),
    ("SHADOWFIT_PCF_2X2", FilterKind::Hardware2x2, false),
    ("SHADOWFIT_PCF_3X3", FilterKind::Pcf3x3, false),
    ("SHADOWFIT_PCF_5X5", FilterKind::Pcf5x5, false),
    ("SHADOWFIT_PCF_7X7", FilterKind::Pcf7x7, false),
    ("SHADOWFIT_VOGEL_8", FilterKind::Vogel8, false),
    ("SHADOWFIT_VOGEL_16", FilterKind::Vogel16, false),
    ("SHADOWFIT_VOGEL_32", FilterKind::Vogel32, false),
    ("SHADOWFIT_PCSS", FilterKind::Pcss, false),
    ("SHADOWFIT_PCSS_REVERSED", FilterKind::Pcss, true),
];

/// Numbers of maps that have their own text. The presets have these numbers.
const MAPS: [u32; 3] = [1, 4, 8];

/// Entry points that keep the functions. The files leave them out.
const LOOK_UP_ENTRY: &str = "
@fragment
fn unused(@builtin(position) p: vec4<f32>) -> @location(0) vec4<f32> {
    return vec4<f32>(shadowfit_factor_at(p.xyz, p.xyz, p.xy), shadowfit_factor(p.xyz, p.xyz),
        f32(shadowfit_map_index(p.xyz)), shadowfit_view_depth(p.xyz));
}
";
const CASTER_ENTRY: &str = "
@vertex
fn unused(@location(0) p: vec3<f32>) -> @builtin(position) vec4<f32> {
    return shadowfit_caster_position(p) * shadowfit_clamped_depth(shadowfit_caster_depth(p));
}
";

/// Returns the names of all files, relative to the workspace's folder, and their contents.
///
/// # Errors
/// If naga cannot translate a shader.
pub(crate) fn files() -> Result<Vec<(String, String)>> {
    let mut files = Vec::new();
    for language in Language::ALL {
        for (name, text) in [("lookup", look_up(language)), ("caster", caster(language)), ("demand", demand(language))]
        {
            let path = format!("{FOLDER}/shadowfit_{name}.{}", language.ending());
            let text = text.with_context(|| format!("cannot write {path}"))?;
            files.push((path, text));
        }
    }
    Ok(files)
}

/// Returns the filters that a language has. GLSL cannot load single texels through the sampler that compares.
fn filters(language: Language) -> impl Iterator<Item = &'static (&'static str, FilterKind, bool)> {
    FILTERS.iter().filter(move |(_, filter, _)| language != Language::Glsl || *filter != FilterKind::Pcss)
}

/// Returns the look-up with all its variants.
fn look_up(language: Language) -> Result<String> {
    let usual = ShadowMapDescriptor::default();
    let alternative = |condition: String, descriptor: ShadowMapDescriptor| {
        let wgsl = receiver_wgsl(&descriptor, &WgslOptions::group(0)) + LOOK_UP_ENTRY;
        Ok((condition, library(&wgsl, language)?))
    };
    let by_filter = filters(language).map(|&(name, filter, is_reversed)| {
        let depth = if is_reversed { DepthConvention::Reversed } else { DepthConvention::ZeroToOne };
        alternative(format!("SHADOWFIT_FILTER == {name}"), ShadowMapDescriptor { filter, depth, ..usual })
    });
    let by_maps =
        MAPS.map(|maps| alternative(format!("SHADOWFIT_MAPS <= {maps}"), ShadowMapDescriptor { maps, ..usual }));
    let by_view_depth = ShadowMapDescriptor { selection: MapSelection::ViewDepth { overlap: 0.0 }, ..usual };
    let by_selection = [
        alternative("SHADOWFIT_BY_VIEW_DEPTH".to_owned(), by_view_depth),
        alternative("!SHADOWFIT_BY_VIEW_DEPTH".to_owned(), usual),
    ];
    let axes = [
        Axis { alternatives: by_filter.collect::<Result<_>>()? },
        Axis { alternatives: by_maps.into_iter().collect::<Result<_>>()? },
        Axis { alternatives: by_selection.into_iter().collect::<Result<_>>()? },
    ];
    let items = &axes[2].alternatives[1].1;
    Ok([
        &text::look_up_head(language, items),
        &with_resources(&merge::merge(&axes)?, text::look_up_resources(language))?,
        text::END,
    ]
    .concat())
}

/// Returns the functions of the shadow pass.
fn caster(language: Language) -> Result<String> {
    let wgsl = caster_wgsl(&ShadowMapDescriptor::default(), &WgslOptions::group(0)) + CASTER_ENTRY;
    let items = library(&wgsl, language)?;
    let head = text::caster_head(language, &items);
    let body = merge::merge(&[Axis { alternatives: vec![(String::new(), items)] }])?;
    Ok([&head, &with_resources(&body, text::caster_resources(language))?, text::caster_extra(language), text::END]
        .concat())
}

/// Translates a library of functions.
fn library(wgsl: &str, language: Language) -> Result<Vec<Item>> {
    let mut items = translate::items(&translate::translate(wgsl, language)?)?;
    for item in &mut items {
        // The technique sets these two, so an engine may set them as well.
        if ["SHADOWFIT_REACH", "SHADOWFIT_BLEND"].contains(&item.name.as_str()) {
            let value = item.text.split(['=', ';']).nth(1).context("a constant without a value")?;
            item.text = format!("#ifndef {0}\n#define {0}{value}\n#endif\n", item.name);
        }
    }
    Ok(items)
}

/// Inserts the declarations of resources after the structs.
fn with_resources(text: &str, resources: &str) -> Result<String> {
    let block = ["shadowfit_Receiver {", "shadowfit_Caster {"].iter().find_map(|name| text.find(name));
    let begin = block.context("no constant block")?;
    let end = begin + text[begin..].find("};\n").context("a struct without an end")? + 3;
    Ok([&text[..end], resources, &text[end..]].concat())
}

/// Returns the compute shader that counts the visible demand. It is a whole shader with an entry point.
fn demand(language: Language) -> Result<String> {
    let mut wgsl = shadowfit_wgpu::demand::demand_wgsl(1);
    if language == Language::Glsl {
        // A sampler that does not compare reads a depth texture as a colour.
        let changes =
            [("texture_depth_2d", "texture_2d<f32>"), ("(demand.corner) + pixel, 0)", "(demand.corner) + pixel, 0).x")];
        for (old, new) in changes {
            ensure!(wgsl.matches(old).count() == 1, "the WGSL of the demand lacks {old:?}");
            wgsl = wgsl.replace(old, new);
        }
    }
    let mut translated = translate::translate(&wgsl, language)?;
    for (old, new) in text::demand_changes(language) {
        ensure!(translated.contains(old), "the demand shader lacks {old:?}");
        translated = translated.replace(old, new);
    }
    let lines = translated.lines().filter(|line| !line.starts_with(['#', '/']));
    let body: String = lines.map(|line| translate::tidy(line.trim_end()) + "\n").collect();
    Ok([&text::demand_head(language), body.trim_matches('\n'), "\n"].concat())
}
