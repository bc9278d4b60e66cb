//! The WGSL of the workspace: every file is used and valid, names and features stay within what engines can paste, and
//! the uniforms lie in memory as the shaders read them. What the shaders compute is compared in [`parity_gpu`],
//! [`culling_gpu`] and [`demand_gpu`].

mod acne_gpu;
mod cached_maps_gpu;
mod clamp_gpu;
mod culling_gpu;
mod demand_gpu;
mod demand_picture;
mod demand_reference;
mod door_gpu;
mod exact_counts_gpu;
mod fade_gpu;
mod formats_gpu;
mod frames_gpu;
mod gpu_casters_gpu;
mod harness;
mod heat_map_gpu;
mod judged_gpu;
mod kept_scene_gpu;
mod layout;
mod parity_gpu;
mod penumbra_gpu;
mod pictures;
mod pixel_gpu;
mod prefixes;
mod read_back;
mod refusals_gpu;
mod resolve_gpu;
mod several_maps_gpu;
mod sweep_gpu;
mod tents_gpu;
mod tint_gpu;
mod webgl2;
mod wrap_gpu;

use std::collections::BTreeSet;
use std::path::PathBuf;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Module, ShaderStage};
use shadowfit::DepthConvention;
use shadowfit::settings::{Edges, FilterKind, MapFormat, MapSelection};
use shadowfit_classics::mapped::SampleFrame;
use shadowfit_classics::{SAMPLES, SampleDrawing, SampleValues, mapped, occlusion, sky_box};
use shadowfit_rays::{RayWgslOptions, rays_wgsl, refit_wgsl};
use shadowfit_render::passes::Numbering;
use shadowfit_render::{Overlay, shaders};
use shadowfit_wgpu::demand::demand_wgsl;
use shadowfit_wgpu::resolve::{NormalEncoding, resolve_wgsl, resolved_wgsl};
use shadowfit_wgpu::{
    CullingPiece, MAX_MAPS, ShadowMapDescriptor, WgslOptions, caster_wgsl, culling_wgsl, layers_wgsl, receiver_wgsl,
    stored_wgsl,
};

use crate::support::workspace;

/// Every shadow map that the look-up's WGSL differs for.
fn descriptors() -> Vec<ShadowMapDescriptor> {
    let mut all = Vec::new();
    for format in MapFormat::ALL {
        for filter in FilterKind::ALL {
            for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed] {
                for choice in [MapSelection::default(), MapSelection::ViewDepth { overlap: 0.0 }] {
                    all.push(ShadowMapDescriptor { format, filter, depth, selection: choice, ..Default::default() });
                }
            }
            all.push(ShadowMapDescriptor { format, filter, cross_fades: true, ..Default::default() });
        }
    }
    all
}

/// Every kind of picture that the resolve passes' WGSL differs for: samples per pixel, and normals.
fn resolved_pictures() -> [(u32, Option<NormalEncoding>); 6] {
    let normals = [None, Some(NormalEncoding::Signed), Some(NormalEncoding::Unsigned)];
    core::array::from_fn(|index| ([1, 4][index / 3], normals[index % 3]))
}

/// The modules of the resolve passes: each map with one kind of picture, in turn, and each format with all of them.
fn resolve_modules() -> Vec<(String, String)> {
    let pictures = resolved_pictures();
    let in_turn = descriptors().into_iter().zip(pictures.into_iter().cycle());
    let formats = MapFormat::ALL.into_iter().map(|format| ShadowMapDescriptor { format, ..Default::default() });
    let all = formats.flat_map(|map| pictures.map(|picture| (map, picture)));
    let [_, count, select, ..] = resolve_wgsl(&ShadowMapDescriptor::default(), 1, None);
    let mut modules =
        vec![("resolve count, compute".to_owned(), count), ("resolve select, compute".to_owned(), select)];
    for (number, (map, (samples, normals))) in in_turn.chain(all).enumerate() {
        let map = ShadowMapDescriptor { first_binding: number as u32 % 3, ..map };
        let kind = format!("{map:?}, {samples} samples, normals {normals:?}, compute");
        let [classify, _, _, trace, blocks, levels] = resolve_wgsl(&map, samples, normals);
        modules.push((format!("resolve classify, {kind}"), classify));
        modules.push((format!("resolve trace, {kind}"), trace));
        if map.filter == FilterKind::default() {
            modules.push((format!("resolve blocks, {kind}"), blocks));
            modules.push((format!("resolve levels, {kind}"), levels));
        }
    }
    modules
}

/// Every module that is handed to a device, and the pieces for engines, with names.
fn modules() -> Vec<(String, String)> {
    let mut all = vec![
        ("sky".to_owned(), shaders::sky()),
        ("lines".to_owned(), shaders::lines()),
        ("clear".to_owned(), shaders::clear()),
        ("encode".to_owned(), shaders::encode()),
        ("mip".to_owned(), shaders::mip()),
        ("quads".to_owned(), shaders::quads()),
        ("mark rows".to_owned(), shaders::mark_rows(1)),
        ("mark rows of four samples".to_owned(), shaders::mark_rows(4)),
        ("marks".to_owned(), shaders::marks()),
        ("occlusion surface".to_owned(), occlusion::shaders::surface()),
        ("occlusion shade".to_owned(), occlusion::shaders::shade()),
        ("occlusion gather".to_owned(), occlusion::shaders::gather()),
        ("occlusion blur".to_owned(), occlusion::shaders::blur()),
        ("occlusion view".to_owned(), occlusion::shaders::view()),
        ("sky box".to_owned(), sky_box::WGSL.to_owned()),
        ("culling piece".to_owned(), culling_wgsl(&WgslOptions::group(0))),
        ("need, compute".to_owned(), demand_wgsl(1)),
        ("need of four samples, compute".to_owned(), demand_wgsl(4)),
        ("refit, compute".to_owned(), refit_wgsl()),
        ("rays piece".to_owned(), rays_wgsl(&RayWgslOptions::group(0))),
    ];
    for format in MapFormat::ALL {
        let map = ShadowMapDescriptor { format, ..Default::default() };
        all.push((format!("caster, {format:?}"), shaders::caster(&map)));
        all.push((format!("caster piece, {format:?}"), caster_wgsl(&map, &WgslOptions::group(0))));
    }
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed] {
        let [clear, mend] = layers_wgsl(&ShadowMapDescriptor { depth, ..Default::default() });
        all.extend([(format!("clear, {depth:?}"), clear), (format!("mend, {depth:?}"), mend)]);
    }
    all.extend(sample_modules());
    all.extend(resolve_modules());
    for map in descriptors() {
        let sets = if map.cross_fades { "two sets" } else { "one set" };
        let kind = format!("{:?} {:?} {:?} {:?} {sets}", map.format, map.filter, map.depth, map.selection);
        all.push((format!("scene, {kind}"), shaders::scene(&map)));
        all.push((format!("probe, {kind}"), shaders::probe(&map, Numbering::Primitives)));
        all.push((format!("unrolled probe, {kind}"), shaders::probe(&map, Numbering::Vertices)));
        for backend in [wgpu::Backend::Vulkan, wgpu::Backend::Gl] {
            all.push((format!("{backend:?} inset, {kind}"), shaders::inset(&map, backend)));
            all.push((format!("{backend:?} block, {kind}"), shaders::block(&map, backend)));
        }
        for overlay in Overlay::ALL {
            all.push((format!("overlay {overlay:?}, {kind}"), shaders::overlay(&map, overlay)));
        }
        let receiver = receiver_wgsl(&map, &WgslOptions::group(1));
        for backend in [wgpu::Backend::Vulkan, wgpu::Backend::Gl] {
            let stored = stored_wgsl(&map, &WgslOptions::group(1), backend);
            all.push((format!("receiver piece with {backend:?} views, {kind}"), receiver.clone() + &stored));
        }
        if map.filter == FilterKind::default() {
            let resolved = resolved_wgsl(&WgslOptions::group(2), 0);
            all.push((format!("receiver piece with what was resolved, {kind}"), receiver.clone() + &resolved));
            all.push((format!("surfaces, {kind}"), shaders::surfaces(&map)));
        }
        all.push((format!("receiver piece, {kind}"), receiver));
    }
    all
}

/// Every module of mapped frames that the classic samples' options ask for.
fn sample_modules() -> Vec<(String, String)> {
    let mut all = std::collections::BTreeMap::from([("samples' casters".to_owned(), mapped::shaders::caster())]);
    for frame in sample_frames() {
        let (format, test, shading) = (frame.map.format, frame.test.name, frame.shading.name);
        all.insert(format!("samples' inset, {format:?}"), mapped::shaders::inset(format));
        let probe = |numbering| mapped::shaders::probe(&frame, numbering);
        all.insert(format!("probe of samples, {format:?} {test}"), probe(Numbering::Primitives));
        all.insert(format!("unrolled probe of samples, {format:?} {test}"), probe(Numbering::Vertices));
        all.insert(format!("sample, {format:?} {test} {shading}"), mapped::shaders::shaded(&frame));
    }
    all.into_iter().collect()
}

/// Frames of every sample with one map, for all of its shadows, lightings and formats.
fn sample_frames() -> Vec<SampleFrame> {
    let mut frames = Vec::new();
    for sample in &SAMPLES {
        for (shadows, lighting) in
            ["source", "off", "ours"].into_iter().flat_map(|shadows| ["source", "modern"].map(|light| (shadows, light)))
        {
            for format in ["r32f", "rgba8", "grey8", "r16f"] {
                let mut values = SampleValues::new(sample);
                for (id, text) in [("shadows", shadows), ("lighting", lighting), ("format", format)] {
                    // What a sample cannot be stays as its source has it.
                    let _ = values.set_from_str(id, text);
                }
                if let Ok(SampleDrawing::Mapped(frame)) = sample.drawing(&values, &sample.lens(1.0)) {
                    frames.push(frame);
                }
            }
        }
    }
    frames
}

/// Every WGSL file of the crates' folders of shaders, and of the classic samples, whose shaders lie beside their Rust; with
/// its text.
fn files() -> Vec<(PathBuf, String)> {
    let crates = std::fs::read_dir(workspace().join("crates")).expect("the crates' folder");
    let mut folders: Vec<PathBuf> =
        crates.map(|entry| entry.expect("a crate's folder").path().join("src/shaders")).collect();
    folders.push(workspace().join("crates/shadowfit-classics/src"));
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

fn parse(name: &str, source: &str) -> Module {
    naga::front::wgsl::parse_str(source).unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)))
}

/// A file's text with its placeholders filled in, in every way that a module may.
fn filled(text: &str) -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    for group in ["0", "1", "2", "3"] {
        for closer in ["<=", ">="] {
            for (count, depth) in [("u32", "0"), ("atomic<u32>", "at")] {
                all.insert(
                    text.replace("MATERIAL_GROUP", group)
                        .replace("group(GROUP)", &format!("group({group})"))
                        .replace("MAX_MAPS", &MAX_MAPS.to_string())
                        .replace("MAX_PIECE_PLANES", &CullingPiece::MAX_PLANES.to_string())
                        .replace("MAX_DEPTH", &shadowfit_rays::MAX_DEPTH.to_string())
                        .replace("MAX_POINTS", &Edges::MAX_SAMPLES.to_string())
                        .replace("MAX_UNKNOWN", &layout::MAX_UNKNOWN.to_string())
                        .replace("COMPARE", closer)
                        .replace("IS_REVERSED", if closer == ">=" { "true" } else { "false" })
                        .replace("LIST_COUNT", count)
                        .replace("DEPTH_INDEX", depth)
                        .replace(" FAR,", if closer == ">=" { " 0.0," } else { " 1.0," })
                        .replace("BINDING_", ""),
                );
            }
        }
    }
    all
}

#[test]
fn every_wgsl_file_stands_whole_in_some_module() {
    let files = files();
    assert!(!files.is_empty(), "no WGSL file was found: the folder that this test walks has moved");
    let modules = modules();
    for (path, text) in files {
        let used = filled(&text).iter().any(|text| modules.iter().any(|(_, module)| module.contains(text.as_str())));
        assert!(used, "{} is part of no module that this test knows", path.display());
    }
}

#[test]
fn every_module_is_valid_and_probes_alone_need_an_optional_capability() {
    for (name, source) in modules() {
        let module = parse(&name, &source);
        let needed = if name.starts_with("probe") { Capabilities::PRIMITIVE_INDEX } else { Capabilities::empty() };
        let mut validator = Validator::new(ValidationFlags::all(), needed);
        if let Err(error) = validator.validate(&module) {
            panic!("{name}: {}", error.emit_to_string(&source));
        }
    }
}

#[test]
fn every_module_has_the_entry_points_of_its_passes() {
    for (name, source) in modules().iter().filter(|(name, _)| !name.contains("piece")) {
        let module = parse(name, source);
        let draws: &[ShaderStage] = &[ShaderStage::Vertex, ShaderStage::Fragment];
        let stages = match name.as_str() {
            name if name.contains("compute") => &[ShaderStage::Compute],
            // Depth alone, from vertices.
            name if name.contains("clear") => &[ShaderStage::Vertex],
            _ => draws,
        };
        for &stage in stages {
            assert!(module.entry_points.iter().any(|entry| entry.stage == stage), "{name} has no {stage:?} stage");
        }
    }
}

#[test]
fn the_pieces_for_engines_name_nothing_without_their_prefix() {
    for (name, source) in modules().iter().filter(|(name, _)| name.contains("piece")) {
        let module = parse(name, source);
        let types = module.types.iter().filter_map(|(_, ty)| ty.name.clone());
        let globals = module.global_variables.iter().filter_map(|(_, global)| global.name.clone());
        let functions = module.functions.iter().filter_map(|(_, function)| function.name.clone());
        let constants = module.constants.iter().filter_map(|(_, constant)| constant.name.clone());
        let names: Vec<String> = types.chain(globals).chain(functions).chain(constants).collect();
        assert!(names.len() >= 3, "{name}: {names:?}");
        for global in names {
            let prefixed = global.starts_with("shadowfit_") || global.starts_with("SHADOWFIT_");
            assert!(prefixed, "{name}: `{global}` may meet a name of the engine's");
        }
        assert!(module.entry_points.is_empty() && module.overrides.is_empty(), "{name}");
    }
}

#[test]
fn the_look_up_needs_uniforms_and_sampled_textures_only_and_no_derivatives() {
    for map in descriptors() {
        let source = receiver_wgsl(&map, &WgslOptions::group(1));
        let module = parse("receiver", &source);
        for (_, global) in module.global_variables.iter() {
            let allowed = matches!(global.space, naga::AddressSpace::Uniform | naga::AddressSpace::Handle);
            assert!(allowed, "{map:?}: {:?} is in {:?}", global.name, global.space);
            let inner = &module.types[global.ty].inner;
            let storage = matches!(inner, naga::TypeInner::Image { class: naga::ImageClass::Storage { .. }, .. });
            assert!(!storage, "{map:?}: {:?} is a storage texture", global.name);
        }
        for (_, function) in module.functions.iter() {
            for (_, expression) in function.expressions.iter() {
                // Sampling without an explicit level takes derivatives too.
                let derives = match expression {
                    naga::Expression::Derivative { .. } => true,
                    naga::Expression::ImageSample { level, .. } => {
                        !matches!(level, naga::SampleLevel::Zero | naga::SampleLevel::Exact(_))
                    }
                    _ => false,
                };
                assert!(!derives, "{map:?}: {:?} takes derivatives", function.name);
            }
        }
    }
}

/// A fragment shader alone in its module, of which wgpu translates all functions.
const SHADED: &str = "
@fragment fn fs(@builtin(position) at: vec4<f32>, @location(0) position: vec3<f32>) -> @location(0) vec4<f32> {
    let factor = shadowfit_factor_at(position, vec3<f32>(0.0, 1.0, 0.0), at.xy);
    return vec4<f32>(factor, f32(shadowfit_map_index(position)), 0.0, 1.0);
}
";

#[test]
fn the_look_up_can_be_translated_for_webgl2_but_where_pcss_reads_depth_as_numbers() {
    use naga::back::glsl;
    for map in descriptors() {
        let source = receiver_wgsl(&map, &WgslOptions::group(0)) + SHADED;
        let module = parse("receiver", &source);
        let info =
            Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).expect("it is valid");
        let options = glsl::Options { version: glsl::Version::new_gles(300), ..Default::default() };
        let pipeline = glsl::PipelineOptions {
            shader_stage: ShaderStage::Fragment,
            entry_point: "fs".to_owned(),
            multiview: None,
        };
        let mut text = String::new();
        let policies = naga::proc::BoundsCheckPolicies::default();
        let translated = glsl::Writer::new(&mut text, &module, &info, &options, &pipeline, policies)
            .and_then(|mut writer| writer.write());
        let reads_depth = map.format.is_depth() && map.filter == FilterKind::Pcss;
        assert_eq!(translated.is_ok(), !reads_depth, "{map:?}: {:?}", translated.err());
    }
}

#[test]
fn the_look_up_reads_the_bind_group_that_it_is_told_to() {
    for map in descriptors() {
        for group in [0, 1, 3] {
            let module = parse("receiver", &receiver_wgsl(&map, &WgslOptions::group(group)));
            let mut bindings: Vec<u32> = Vec::new();
            for (_, global) in module.global_variables.iter() {
                let binding = global.binding.as_ref().expect("every global is bound");
                assert_eq!(binding.group, group);
                bindings.push(binding.binding);
            }
            bindings.sort_unstable();
            let expected: &[u32] = if map.format.is_depth() { &[0, 1, 2] } else { &[0, 1] };
            assert_eq!(bindings, expected, "{map:?}");
        }
    }
}
