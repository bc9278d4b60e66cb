//! Rust structs against naga's reflection of the WGSL that reads them: size, and every field's offset by its name.

use core::mem::offset_of;

use naga::{Binding, Module, StructMember, TypeInner};
use shadowfit::settings::Edges;
use shadowfit_classics::mapped::SampleUniform;
use shadowfit_classics::occlusion::OcclusionUniform;
use shadowfit_classics::sky_box::SkyBoxUniform;
use shadowfit_classics::{mapped, occlusion, sky_box};
use shadowfit_render::{
    BlockUniform, FrameUniform, InsetVertex, InstanceData, JudgedUniform, LineVertex, MarksUniform, MaterialUniform,
    Overlay, QuadVertex, shaders,
};
use shadowfit_wgpu::demand::{DemandUniform, demand_wgsl};
use shadowfit_wgpu::resolve::{ResolveUniform, UnknownUniform, resolve_wgsl};
use shadowfit_wgpu::{
    CasterUniform, CullingPiece, FadingUniform, MAX_MAPS, MapUniform, ReceiverUniform, ShadowMapDescriptor,
    WgslOptions, culling_wgsl,
};

use super::parse;

/// Boxes around unknown casters that a picture may have.
pub(super) const MAX_UNKNOWN: usize =
    (size_of::<ResolveUniform>() - offset_of!(ResolveUniform, unknown)) / size_of::<UnknownUniform>();

/// A Rust struct: its name in WGSL, its size, and its fields' names and offsets, in bytes.
struct Layout {
    wgsl: &'static str,
    size: usize,
    fields: Vec<(&'static str, usize)>,
}

/// The layout of a struct. A field that is missing in the list is an error of the compiler's.
macro_rules! layout {
    ($wgsl:literal = $rust:ident { $($field:ident),+ $(,)? }) => {{
        // A pattern without `..` has to name every field.
        let _ = |value: $rust| { let $rust { $($field: _),+ } = value; };
        Layout { wgsl: $wgsl, size: size_of::<$rust>(), fields: vec![$((stringify!($field), offset_of!($rust, $field))),+] }
    }};
}

/// Members and size of a struct of a module.
fn reflected<'a>(module: &'a Module, name: &str) -> (&'a [StructMember], u32) {
    let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name));
    let Some((_, ty)) = found else { panic!("no type `{name}`") };
    let TypeInner::Struct { members, span } = &ty.inner else { panic!("`{name}` is no struct") };
    (members, *span)
}

fn size_of_member(module: &Module, member: &StructMember) -> usize {
    module.types[member.ty].inner.size(module.to_ctx()) as usize
}

/// Compares a struct with the reflection of a module that reads it. Padding at the end of the Rust struct may be what WGSL
/// leaves free there without a name.
fn assert_same(module: &Module, layout: &Layout) {
    let Layout { wgsl, size, fields } = layout;
    let (members, span) = reflected(module, wgsl);
    assert_eq!(*size, span as usize, "size of {wgsl}");
    let reflected: Vec<(&str, usize)> =
        members.iter().map(|member| (member.name.as_deref().unwrap_or(""), member.offset as usize)).collect();
    let (named, unnamed) = fields.split_at(reflected.len().min(fields.len()));
    assert_eq!(named, reflected, "fields of {wgsl}");
    assert!(unnamed.iter().all(|(name, _)| name.starts_with("padding")), "{wgsl} lacks {unnamed:?}");
}

#[test]
fn every_uniform_has_the_size_and_offsets_of_its_wgsl_struct() {
    let map = ShadowMapDescriptor::default();
    let caster = parse("caster", &shaders::caster(&ShadowMapDescriptor::default()));
    let scene = parse("scene", &shaders::scene(&map));
    let material = layout!(
        "Material" = MaterialUniform {
            base_color,
            base_uv,
            normal_uv,
            emissive,
            alpha_cutoff,
            metallic,
            roughness,
            normal_scale,
            blended,
        }
    );
    let frame = layout!(
        "Frame" = FrameUniform {
            clip_from_world,
            ray_right,
            ray_up,
            ray_forward,
            to_light,
            shadows,
            sun,
            haze_per_metre,
            zenith,
            horizon,
            ground,
            viewport,
            padding,
            map_tints,
        }
    );
    assert_same(
        &caster,
        &layout!(
            "shadowfit_Caster" = CasterUniform { clip_from_world, clamps_in_fragment, padding_0, padding_1, padding_2 }
        ),
    );
    assert_same(&caster, &material);
    assert_same(&scene, &material);
    assert_same(&scene, &frame);
}

#[test]
fn what_overlays_marks_and_blocks_of_texels_read_lies_as_in_wgsl() {
    let map = ShadowMapDescriptor::default();
    let judged =
        layout!("Judged" = JudgedUniform { clip_from_world, world_from_ndc, size, scale, near, far, viewport });
    assert_same(&parse("truth", &shaders::overlay(&map, Overlay::Truth)), &judged);
    assert_same(&parse("error", &shaders::overlay(&map, Overlay::Error)), &judged);
    let rows = parse("mark rows", &shaders::mark_rows(1));
    assert_same(&rows, &judged);
    let marks = layout!("Marks" = MarksUniform { strength, outline, classes, padding });
    assert_same(&rows, &marks);
    assert_same(&parse("marks", &shaders::marks()), &marks);
    let block = layout!("Block" = BlockUniform { first, last, map, padding_0, padding_1, padding_2 });
    assert_same(&parse("block", &shaders::block(&map, wgpu::Backend::Vulkan)), &block);
}

#[test]
fn what_the_look_up_reads_has_the_size_and_offsets_of_its_wgsl_structs() {
    let scene = parse("scene", &shaders::scene(&ShadowMapDescriptor::default()));
    assert_same(
        &scene,
        &layout!(
            "shadowfit_Map" = MapUniform {
                uv_from_world,
                depth_per_texel_u,
                constant_depth,
                depth_per_texel_v,
                slope_depth,
                size,
                normal_offset,
                receiver_plane,
                far,
                blend_near,
                layer,
                padding_0,
                wrap,
                disc,
                penumbra,
                padding_1,
                padding_2,
            }
        ),
    );
    assert_same(
        &scene,
        &layout!(
            "shadowfit_Receiver" = ReceiverUniform {
                to_light,
                map_count,
                view,
                fade_near,
                fade_width,
                least_disc,
                greatest_disc,
                frame_shift,
                is_off,
                padding_0,
                padding_1,
                maps,
            }
        ),
    );
}

#[test]
fn what_a_look_up_into_two_sets_of_maps_reads_lies_as_in_wgsl() {
    let scene = parse("scene", &shaders::scene(&ShadowMapDescriptor { cross_fades: true, ..Default::default() }));
    let fading = layout!("shadowfit_Fading" = FadingUniform { now, before, share, first_layer, padding_0, padding_1 });
    assert_same(&scene, &fading);
    // The sets themselves are what the only one is elsewhere.
    assert_eq!(reflected(&scene, "shadowfit_Receiver").1 as usize, size_of::<ReceiverUniform>());
    assert_eq!(reflected(&scene, "shadowfit_Map").1 as usize, size_of::<MapUniform>());
}

#[test]
fn the_pieces_that_casters_are_culled_by_lie_as_in_wgsl() {
    let culling = parse("culling", &culling_wgsl(&WgslOptions::group(0)));
    assert_same(
        &culling,
        &layout!(
            "shadowfit_CullingPiece" = CullingPiece {
                planes,
                viewport,
                scissor,
                map,
                fixed,
                moving,
                fixed_planes,
                moving_planes,
                padding_0,
                padding_1,
                padding_2,
            }
        ),
    );
    let (_, global) = culling.global_variables.iter().next().expect("the pieces");
    let TypeInner::Array { stride, .. } = culling.types[global.ty].inner else { panic!("pieces are an array") };
    assert_eq!(stride as usize, size_of::<CullingPiece>());
}

#[test]
fn the_uniform_of_the_demand_pass_lies_as_in_wgsl() {
    let demand = layout!(
        "Demand" = DemandUniform {
            world_from_pixel,
            view,
            direction,
            far_depth,
            x,
            cell,
            y,
            shape,
            corner,
            size,
            step,
            pixels,
            exponent,
            near,
            far,
            bins_per_octave,
            pixel_width,
        }
    );
    assert_same(&parse("demand", &demand_wgsl(1)), &demand);
}

#[test]
fn the_uniforms_of_the_resolve_passes_lie_as_in_wgsl() {
    let resolve = layout!(
        "Resolve" = ResolveUniform {
            world_from_pixel,
            eye,
            far_depth,
            forward,
            ray_offset,
            corner,
            size,
            depth_rounding,
            point_reach,
            unsure_maps,
            sun_tangent,
            padding_0,
            padding_1,
            padding_2,
            points,
            unknown,
        }
    );
    let unknown = layout!("Unknown" = UnknownUniform { least, maps, most, is_filtered });
    let [classify, _, select, trace, blocks, _] =
        resolve_wgsl(&ShadowMapDescriptor::default(), 4, None).map(|source| parse("resolve", &source));
    for module in [classify, trace] {
        assert_same(&module, &resolve);
        assert_same(&module, &unknown);
        let (members, _) = reflected(&module, "Resolve");
        let [.., points, unknown] = members else { panic!("two arrays at the end") };
        let counts = [points, unknown].map(|member| match module.types[member.ty].inner {
            TypeInner::Array { size: naga::ArraySize::Constant(count), .. } => count.get() as usize,
            _ => panic!("an array of a fixed number"),
        });
        assert_eq!(counts, [Edges::MAX_SAMPLES as usize, MAX_UNKNOWN]);
    }
    // These are written as four numbers: how many pixels, and the frame; and a layer.
    for (module, name, fields) in
        [(&select, "Budget", &[("pixels", 0), ("frame", 4)][..]), (&blocks, "Layer", &[("layer", 0)])]
    {
        let (members, span) = reflected(module, name);
        let named: Vec<_> =
            members.iter().map(|member| (member.name.as_deref().unwrap_or(""), member.offset)).collect();
        assert_eq!((&named[..fields.len()], span), (fields, 16), "{name}");
    }
}

#[test]
fn the_maps_of_the_receiver_uniform_are_as_many_and_as_far_apart_in_both_languages() {
    let module = parse("scene", &shaders::scene(&ShadowMapDescriptor::default()));
    let (members, _) = reflected(&module, "shadowfit_Receiver");
    let maps = members.last().expect("the maps");
    let TypeInner::Array { size, stride, .. } = module.types[maps.ty].inner else { panic!("maps are an array") };
    let naga::ArraySize::Constant(count) = size else { panic!("maps are a fixed number") };
    assert_eq!((count.get() as usize, stride as usize), (MAX_MAPS, size_of::<MapUniform>()));
}

#[test]
fn every_uniform_of_every_module_is_one_whose_layout_is_compared() {
    let compared = [
        "shadowfit_Caster",
        "shadowfit_Receiver",
        "shadowfit_Fading",
        "Frame",
        "Material",
        "Judged",
        "Marks",
        "Block",
        "Demand",
        "Resolve",
        "Budget",
        "Layer",
        "shadowfit_rays_Refit",
        "Occlusion",
        "Sample",
        "SkyBox",
    ];
    for (name, source) in super::modules() {
        let module = parse(&name, &source);
        let uniforms = module.global_variables.iter().filter(|(_, global)| global.space == naga::AddressSpace::Uniform);
        for (_, global) in uniforms {
            let ty = module.types[global.ty].name.as_deref().unwrap_or("a type without a name");
            assert!(compared.contains(&ty), "{name} reads the uniform {ty}, which no test compares");
        }
    }
}

/// The members of a vertex shader's input that come from vertex buffers at the given locations, in that order.
fn at_locations<'a>(module: &'a Module, input: &str, locations: &[u32]) -> Vec<&'a StructMember> {
    let (members, _) = reflected(module, input);
    let at = |wanted: u32| {
        let is_it = |member: &&StructMember| matches!(member.binding, Some(Binding::Location { location, .. }) if location == wanted);
        members.iter().find(is_it).unwrap_or_else(|| panic!("{input} has no location {wanted}"))
    };
    locations.iter().map(|location| at(*location)).collect()
}

/// Offsets of packed attributes, and where the last one ends.
fn packed(module: &Module, members: &[&StructMember]) -> Vec<usize> {
    let mut offsets = vec![0];
    for member in members {
        offsets.push(offsets[offsets.len() - 1] + size_of_member(module, member));
    }
    offsets
}

#[test]
fn instances_in_the_buffer_are_what_the_vertex_shaders_read() {
    let scene = parse("scene", &shaders::scene(&ShadowMapDescriptor::default()));
    let rows = offset_of!(InstanceData, rows);
    let ends = [rows, rows + 16, rows + 32, offset_of!(InstanceData, first_triangle), offset_of!(InstanceData, holder)];
    assert_eq!(packed(&scene, &at_locations(&scene, "SceneIn", &[5, 6, 7, 8])), ends);
    let caster = parse("caster", &shaders::caster(&ShadowMapDescriptor::default()));
    assert_eq!(packed(&caster, &at_locations(&caster, "CasterIn", &[5, 6, 7])), ends[..4]);
    assert_eq!(size_of::<InstanceData>() % 16, 0);
}

#[test]
fn casters_and_samples_read_each_location_with_the_type_that_the_scene_reads_there() {
    let scene = parse("scene", &shaders::scene(&ShadowMapDescriptor::default()));
    let caster = parse("caster", &shaders::caster(&ShadowMapDescriptor::default()));
    let [surface, shade] =
        [occlusion::shaders::surface(), occlusion::shaders::shade()].map(|text| parse("sample", &text));
    for (module, input) in [(caster, "CasterIn"), (surface, "PartIn"), (shade, "PartIn")] {
        for member in reflected(&module, input).0 {
            let Some(Binding::Location { location, .. }) = member.binding else { continue };
            let other = at_locations(&scene, "SceneIn", &[location])[0];
            assert_eq!(member.name, other.name, "location {location}");
            assert_eq!(module.types[member.ty].inner, scene.types[other.ty].inner, "location {location}");
        }
    }
}

#[test]
fn the_two_ends_of_a_line_are_what_the_vertex_shader_reads() {
    let module = parse("lines", &shaders::lines());
    let (position, color, size) =
        (offset_of!(LineVertex, position), offset_of!(LineVertex, color), size_of::<LineVertex>());
    let ends = [position, color, size, size + color, 2 * size];
    assert_eq!(packed(&module, &at_locations(&module, "LineIn", &[0, 1, 2, 3])), ends);
}

#[test]
fn insets_and_quadrilaterals_in_the_buffers_are_what_the_vertex_shaders_read() {
    let inset = parse("inset", &shaders::inset(&ShadowMapDescriptor::default(), wgpu::Backend::Vulkan));
    let rectangle = offset_of!(InsetVertex, rectangle);
    let [depth_range, map] = [offset_of!(InsetVertex, depth_range), offset_of!(InsetVertex, map)];
    let ends = [rectangle, depth_range, map, offset_of!(InsetVertex, border), size_of::<InsetVertex>()];
    assert_eq!(packed(&inset, &at_locations(&inset, "InsetIn", &[0, 1, 2, 3])), ends);
    let quads = parse("quads", &shaders::quads());
    let [first, second] = [offset_of!(QuadVertex, first), offset_of!(QuadVertex, second)];
    let ends = [first, second, offset_of!(QuadVertex, color), size_of::<QuadVertex>()];
    assert_eq!(packed(&quads, &at_locations(&quads, "QuadIn", &[0, 1, 2])), ends);
}

#[test]
fn what_the_samples_read_lies_as_in_wgsl() {
    let gathered = layout!(
        "Occlusion" = OcclusionUniform {
            view_from_world,
            uv_from_view,
            height,
            far,
            radius,
            scale,
            bias,
            intensity,
            detail,
            padding_0,
            padding_1,
            padding_2,
            ambient,
            diffuse,
        }
    );
    let shade = parse("occlusion shade", &occlusion::shaders::shade());
    assert_same(&shade, &gathered);
    assert_same(&parse("occlusion gather", &occlusion::shaders::gather()), &gathered);
    let sample = layout!(
        "Sample" =
            SampleUniform { clip_from_world, light_from_world, light, test, further, shading, map_size, padding }
    );
    for frame in super::sample_frames() {
        assert_same(&parse("sample", &mapped::shaders::shaded(&frame)), &sample);
    }
    assert_same(&parse("samples' casters", &mapped::shaders::caster()), &sample);
    assert_same(&parse("sky box", sky_box::WGSL), &layout!("SkyBox" = SkyBoxUniform { clip_from_world }));
}
