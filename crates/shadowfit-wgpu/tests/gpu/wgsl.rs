//! WGSL of shadowfit-wgpu and of shadowfit-rays: every file is used and valid, and names and features stay
//! within the limits of engines that paste it. The other tests compare the results of the shaders.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use naga::ShaderStage;
use naga::valid::Capabilities;
use shadowfit::DepthConvention;
use shadowfit::settings::{Edges, FilterKind, MapFormat, MapSelection};
use shadowfit_rays::{RayWgslOptions, rays_wgsl, refit_wgsl};
use shadowfit_testing::package_folder;
use shadowfit_testing::pairs::{all_pairs, full_product};
use shadowfit_testing::wgsl::{Shader, assert_every_file_is_used};
use shadowfit_wgpu::demand::demand_wgsl;
use shadowfit_wgpu::exact_edges::{NormalEncoding, edges_wgsl, exact_factor_wgsl};
use shadowfit_wgpu::{
    CullingRegion, MAX_MAPS, ShadowMapDescriptor, WgslOptions, caster_wgsl, culling_wgsl, receiver_wgsl, stored_wgsl,
};

use super::layout::MAX_UNKNOWN;

/// Values of all options that change the WGSL. Samples per pixel and normals change only the edge passes.
const DEPTHS: [DepthConvention; 2] = [DepthConvention::ZeroToOne, DepthConvention::Reversed];
const SELECTIONS: [MapSelection; 2] = [MapSelection::Coverage { blend: 8.0 }, MapSelection::ViewDepth { overlap: 0.0 }];
const CROSS_FADES: [bool; 2] = [false, true];
const SAMPLES: [u32; 2] = [1, 4];
const NORMALS: [Option<NormalEncoding>; 3] = [None, Some(NormalEncoding::Signed), Some(NormalEncoding::Unsigned)];

/// Number of values of each option, in the order that [`Kind::new`] reads.
const COUNTS: [usize; 7] = [MapFormat::ALL.len(), FilterKind::ALL.len(), 2, 2, 2, SAMPLES.len(), NORMALS.len()];

/// Maps, and a view whose edges are traced with them.
#[derive(Clone, Copy, Debug)]
struct Kind {
    map: ShadowMapDescriptor,
    samples: u32,
    normals: Option<NormalEncoding>,
}

impl Kind {
    /// Takes one value per option, by its number.
    fn new(values: &[usize]) -> Self {
        let [format, filter, depth, selection, cross_fades, samples, normals] = values else {
            panic!("one value per option: {values:?}")
        };
        let map = ShadowMapDescriptor {
            format: MapFormat::ALL[*format],
            filter: FilterKind::ALL[*filter],
            depth: DEPTHS[*depth],
            selection: SELECTIONS[*selection],
            cross_fades: CROSS_FADES[*cross_fades],
            ..ShadowMapDescriptor::default()
        };
        Self { map, samples: SAMPLES[*samples], normals: NORMALS[*normals] }
    }

    fn name(&self) -> String {
        let Self { map, samples, normals } = self;
        let sets = if map.cross_fades { "two sets" } else { "one set" };
        let (format, filter, depth, selection) = (map.format, map.filter, map.depth, map.selection);
        format!("{format:?} {filter:?} {depth:?} {selection:?} {sets}, {samples} samples, normals {normals:?}")
    }

    /// Returns whether PCSS reads depths as numbers, which WebGL2 cannot.
    fn loads_depths(&self) -> bool {
        self.map.format.is_depth() && self.map.filter == FilterKind::Pcss
    }
}

/// Kinds that contain every pair of values of two options.
static KINDS: LazyLock<Vec<Kind>> = LazyLock::new(|| all_pairs(&COUNTS).iter().map(|row| Kind::new(row)).collect());

/// Look-ups of [`KINDS`].
static RECEIVERS: LazyLock<Vec<Shader>> = LazyLock::new(|| {
    let receiver = |kind: &Kind| receiver_wgsl(&kind.map, &WgslOptions::group(1));
    KINDS.iter().map(|kind| Shader::new(kind.name(), receiver(kind))).collect()
});

/// Every module that the crate creates on a device, and the pieces for engines.
static MODULES: LazyLock<Vec<Shader>> = LazyLock::new(|| {
    let [_, count, select, ..] = edges_wgsl(&ShadowMapDescriptor::default(), 1, None);
    let mut all = vec![
        Shader::new("culling piece", culling_wgsl(&WgslOptions::group(0))),
        Shader::new("need, compute", demand_wgsl(1)),
        Shader::new("need of four samples, compute", demand_wgsl(4)),
        Shader::new("refit, compute", refit_wgsl()),
        Shader::new("rays piece", rays_wgsl(&RayWgslOptions::group(0))),
        Shader::new("edges count, compute", count),
        Shader::new("edges select, compute", select),
    ];
    for format in MapFormat::ALL {
        let map = ShadowMapDescriptor { format, ..Default::default() };
        all.push(Shader::new(format!("caster piece, {format:?}"), caster_wgsl(&map, &WgslOptions::group(0))));
    }
    for depth in DEPTHS {
        let far = if depth == DepthConvention::Reversed { "0.0" } else { "1.0" };
        let clear = include_str!("../../src/maps/clear.wgsl").replace("FAR", far);
        let caster = caster_wgsl(&ShadowMapDescriptor { depth, ..Default::default() }, &WgslOptions::group(1));
        let mend = [&caster, &clear, include_str!("../../src/maps/mend.wgsl")].concat();
        let named = [(format!("clear, {depth:?}"), clear), (format!("mend, {depth:?}"), mend)];
        all.extend(named.map(|(name, text)| Shader::new(name, text)));
    }
    for (number, kind) in (0..).zip(KINDS.iter()) {
        all.extend(edge_modules(number, kind));
        all.extend(receiver_pieces(kind));
    }
    all
});

/// Returns the modules of the edge passes, with another first binding for every kind.
fn edge_modules(number: u32, kind: &Kind) -> Vec<Shader> {
    let map = ShadowMapDescriptor { first_binding: number % 3, ..kind.map };
    let [classify, _, _, surfaces, trace, blocks, levels] = edges_wgsl(&map, kind.samples, kind.normals);
    let mut passes = vec![("classify", classify), ("trace", trace)];
    // These do not depend on the filter.
    if map.filter == FilterKind::default() {
        passes.extend([("surfaces", surfaces), ("blocks", blocks), ("levels", levels)]);
    }
    passes
        .into_iter()
        .map(|(pass, text)| Shader::new(format!("edges {pass}, {}, compute", kind.name()), text))
        .collect()
}

/// Returns the look-up with the functions that an engine may add to it.
fn receiver_pieces(kind: &Kind) -> Vec<Shader> {
    let options = WgslOptions::group(1);
    let receiver = receiver_wgsl(&kind.map, &options);
    let piece = |what: &str, text: &str| {
        Shader::new(format!("receiver piece with {what}, {}", kind.name()), receiver.clone() + text)
    };
    let mut pieces: Vec<Shader> = [wgpu::Backend::Vulkan, wgpu::Backend::Gl]
        .map(|backend| piece(&format!("{backend:?} views"), &stored_wgsl(&kind.map, &options, backend)))
        .into();
    // The function that reads exact factors does not depend on the filter.
    if kind.map.filter == FilterKind::default() {
        pieces.push(piece("exact factors", &exact_factor_wgsl(&WgslOptions::group(2), 0)));
    }
    pieces.push(piece("nothing else", ""));
    pieces
}

/// Returns the texts that a file may become when its placeholders are filled in.
fn filled(text: &str) -> Vec<String> {
    let mut all = BTreeSet::new();
    for group in ["0", "1", "2", "3"] {
        for closer in ["<=", ">="] {
            for (count, depth) in [("u32", "0"), ("atomic<u32>", "at")] {
                all.insert(
                    text.replace("group(GROUP)", &format!("group({group})"))
                        .replace("MAX_MAPS", &MAX_MAPS.to_string())
                        .replace("MAX_REGION_PLANES", &CullingRegion::MAX_PLANES.to_string())
                        .replace("NODES_ON_STACK", &shadowfit_rays::STACK.to_string())
                        .replace("MAX_POINTS", &Edges::MAX_SAMPLES.to_string())
                        .replace("MAX_UNKNOWN", &MAX_UNKNOWN.to_string())
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
    all.into_iter().collect()
}

#[test]
fn every_pair_of_options_occurs_in_a_kind() {
    let rows = all_pairs(&COUNTS);
    for (second, first) in (0..COUNTS.len()).flat_map(|second| (0..second).map(move |first| (second, first))) {
        let pairs: BTreeSet<_> = rows.iter().map(|row| [row[first], row[second]]).collect();
        assert_eq!(pairs.len(), COUNTS[first] * COUNTS[second], "options {first} and {second}");
    }
    let maps: BTreeSet<String> = KINDS.iter().map(Kind::name).collect();
    assert!(maps.len() >= MapFormat::ALL.len() * FilterKind::ALL.len(), "{} kinds", maps.len());
}

#[test]
fn every_wgsl_file_stands_whole_in_some_module() {
    let package = package_folder(env!("CARGO_MANIFEST_DIR"));
    let crates = package.parent().expect("the crates' folder");
    let texts: Vec<&str> = MODULES.iter().map(|shader| shader.source.as_str()).collect();
    for folder in ["wgpu/src", "rays/src"] {
        assert_every_file_is_used(&crates.join(format!("shadowfit-{folder}")), &texts, filled);
    }
}

#[test]
fn every_module_is_valid_without_an_optional_capability() {
    for shader in MODULES.iter() {
        shader.assert_valid(Capabilities::empty());
    }
}

#[test]
fn every_uniform_of_every_module_is_one_whose_layout_is_compared() {
    let compared = [
        "shadowfit_Caster",
        "shadowfit_Receiver",
        "shadowfit_Fading",
        "Demand",
        "Edges",
        "Budget",
        "Layer",
        // `layout.rs` compares the uniforms of this crate, and shadowfit-rays compares this one.
        "shadowfit_rays_Refit",
    ];
    for shader in MODULES.iter() {
        for name in shader.uniform_structs() {
            assert!(
                compared.contains(&name.as_str()),
                "{} reads the uniform {name}, which no test compares",
                shader.name
            );
        }
    }
}

#[test]
fn every_module_has_the_entry_points_of_its_passes() {
    for shader in MODULES.iter().filter(|shader| !shader.name.contains("piece")) {
        let stages: &[ShaderStage] = match shader.name.as_str() {
            name if name.contains("compute") => &[ShaderStage::Compute],
            // Depth only, from vertices.
            name if name.contains("clear") => &[ShaderStage::Vertex],
            _ => &[ShaderStage::Vertex, ShaderStage::Fragment],
        };
        shader.assert_has_stages(stages);
    }
}

#[test]
fn the_pieces_for_engines_name_nothing_without_their_prefix() {
    for Shader { name, module, .. } in MODULES.iter().filter(|shader| shader.name.contains("piece")) {
        let types = module.types.iter().filter_map(|(_, ty)| ty.name.clone());
        let globals = module.global_variables.iter().filter_map(|(_, global)| global.name.clone());
        let functions = module.functions.iter().filter_map(|(_, function)| function.name.clone());
        let constants = module.constants.iter().filter_map(|(_, constant)| constant.name.clone());
        let names: Vec<String> = types.chain(globals).chain(functions).chain(constants).collect();
        assert!(names.len() >= 3, "{name}: {names:?}");
        for global in names {
            let prefixed = global.starts_with("shadowfit_") || global.starts_with("SHADOWFIT_");
            assert!(prefixed, "{name}: `{global}` may conflict with a name of the engine");
        }
        assert!(module.entry_points.is_empty() && module.overrides.is_empty(), "{name}");
    }
}

#[test]
fn the_look_up_needs_uniforms_and_sampled_textures_only_and_no_derivatives() {
    for Shader { name, module, .. } in RECEIVERS.iter() {
        for (_, global) in module.global_variables.iter() {
            let allowed = matches!(global.space, naga::AddressSpace::Uniform | naga::AddressSpace::Handle);
            assert!(allowed, "{name}: {:?} is in {:?}", global.name, global.space);
            let inner = &module.types[global.ty].inner;
            let storage = matches!(inner, naga::TypeInner::Image { class: naga::ImageClass::Storage { .. }, .. });
            assert!(!storage, "{name}: {:?} is a storage texture", global.name);
        }
        for (_, function) in module.functions.iter() {
            for (_, expression) in function.expressions.iter() {
                // Sampling without an explicit level takes derivatives, too.
                let derives = match expression {
                    naga::Expression::Derivative { .. } => true,
                    naga::Expression::ImageSample { level, .. } => {
                        !matches!(level, naga::SampleLevel::Zero | naga::SampleLevel::Exact(_))
                    }
                    _ => false,
                };
                assert!(!derives, "{name}: {:?} takes derivatives", function.name);
            }
        }
    }
}

/// A fragment shader that makes the look-up a complete module; wgpu translates all functions.
const SHADED: &str = "
@fragment fn fs(@builtin(position) at: vec4<f32>, @location(0) position: vec3<f32>) -> @location(0) vec4<f32> {
    let factor = shadowfit_factor_at(position, vec3<f32>(0.0, 1.0, 0.0), at.xy);
    return vec4<f32>(factor, f32(shadowfit_map_index(position)), 0.0, 1.0);
}
";

/// Asserts that the look-up of a kind can be translated for WebGL2, except where PCSS loads depths.
fn assert_translates(kind: &Kind) {
    let shader = Shader::new(kind.name(), receiver_wgsl(&kind.map, &WgslOptions::group(0)) + SHADED);
    if kind.loads_depths() {
        let info = shader.assert_valid(Capabilities::empty());
        assert!(shader.translate_to_webgl2(&info).is_err(), "{}", shader.name);
    } else {
        shader.assert_translates_to_webgl2();
    }
}

#[test]
fn the_look_up_can_be_translated_for_webgl2_but_where_pcss_reads_depth_as_numbers() {
    KINDS.iter().for_each(assert_translates);
}

#[test]
fn the_passes_over_layers_can_be_translated_for_webgl2() {
    let is_drawn = |shader: &&Shader| ["clear", "mend"].iter().any(|pass| shader.name.starts_with(pass));
    let drawn: Vec<_> = MODULES.iter().filter(is_drawn).collect();
    assert_eq!(drawn.len(), 4);
    drawn.into_iter().for_each(Shader::assert_translates_to_webgl2);
}

#[test]
fn the_look_up_reads_the_bind_group_that_it_is_told_to() {
    for kind in KINDS.iter() {
        // The names of the look-up's bindings do not depend on the group.
        for group in if kind.map.filter == FilterKind::default() { &[0, 1, 3][..] } else { &[3] } {
            let shader = Shader::new(kind.name(), receiver_wgsl(&kind.map, &WgslOptions::group(*group)));
            let mut bindings: Vec<u32> = Vec::new();
            for (_, global) in shader.module.global_variables.iter() {
                let binding = global.binding.as_ref().expect("every global is bound");
                assert_eq!(binding.group, *group);
                bindings.push(binding.binding);
            }
            bindings.sort_unstable();
            let expected: &[u32] = if kind.map.format.is_depth() { &[0, 1, 2] } else { &[0, 1] };
            assert_eq!(bindings, expected, "{}", shader.name);
        }
    }
}

#[test]
#[ignore = "the full product of descriptors: cargo xtask test --all"]
fn every_product_of_options_is_valid_and_can_be_translated_for_webgl2() {
    for (number, kind) in (0..).zip(full_product(&COUNTS).iter().map(|row| Kind::new(row))) {
        for shader in edge_modules(number, &kind) {
            shader.assert_valid(Capabilities::empty());
        }
        // Samples and normals are options of the edge passes only.
        if kind.samples == 1 && kind.normals.is_none() {
            for shader in receiver_pieces(&kind) {
                shader.assert_valid(Capabilities::empty());
            }
            assert_translates(&kind);
        }
    }
}
