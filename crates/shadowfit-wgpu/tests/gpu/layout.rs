//! Layout of Rust structs equals naga's reflection of the WGSL that reads them: size, and each field's offset
//! by name.

use core::mem::offset_of;

use naga::{Module, TypeInner};
use shadowfit::settings::Edges;
use shadowfit_testing::layout;
use shadowfit_testing::layout::{assert_same, reflected};
use shadowfit_testing::wgsl::parse;
use shadowfit_wgpu::demand::{DemandUniform, demand_wgsl};
use shadowfit_wgpu::exact_edges::{EdgeUniform, UnknownUniform, edges_wgsl};
use shadowfit_wgpu::uniforms::{CasterUniform, FadingUniform, MapUniform, ReceiverUniform};
use shadowfit_wgpu::{
    CullingRegion, MAX_MAPS, ShadowMapDescriptor, WgslOptions, caster_wgsl, culling_wgsl, receiver_wgsl,
};

/// Maximum number of boxes around unknown casters in a frame.
pub(super) const MAX_UNKNOWN: usize =
    (size_of::<EdgeUniform>() - offset_of!(EdgeUniform, unknown)) / size_of::<UnknownUniform>();

/// Parses the look-up of a map.
fn receiver(map: &ShadowMapDescriptor) -> Module {
    parse("receiver", &receiver_wgsl(map, &WgslOptions::group(0)))
}

#[test]
fn the_uniform_of_casters_has_the_size_and_offsets_of_its_wgsl_struct() {
    let caster = caster_wgsl(&ShadowMapDescriptor::default(), &WgslOptions::group(0));
    assert_same(
        &parse("caster", &caster),
        &layout!(
            "shadowfit_Caster" = CasterUniform { clip_from_world, clamps_in_fragment, padding_0, padding_1, padding_2 }
        ),
    );
}

#[test]
fn what_the_look_up_reads_has_the_size_and_offsets_of_its_wgsl_structs() {
    let module = receiver(&ShadowMapDescriptor::default());
    assert_same(
        &module,
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
                texel_offset,
                disc,
                penumbra,
                padding_1,
                padding_2,
            }
        ),
    );
    assert_same(
        &module,
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
    let module = receiver(&ShadowMapDescriptor { cross_fades: true, ..Default::default() });
    let fading = layout!("shadowfit_Fading" = FadingUniform { now, before, share, first_layer, padding_0, padding_1 });
    assert_same(&module, &fading);
    // Both sets have the same layout as the only set without cross-fades.
    assert_eq!(reflected(&module, "shadowfit_Receiver").1 as usize, size_of::<ReceiverUniform>());
    assert_eq!(reflected(&module, "shadowfit_Map").1 as usize, size_of::<MapUniform>());
}

#[test]
fn the_pieces_that_casters_are_culled_by_lie_as_in_wgsl() {
    let culling = parse("culling", &culling_wgsl(&WgslOptions::group(0)));
    assert_same(
        &culling,
        &layout!(
            "shadowfit_CullingRegion" = CullingRegion {
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
    let (_, global) = culling.global_variables.iter().next().expect("the regions");
    let TypeInner::Array { stride, .. } = culling.types[global.ty].inner else { panic!("regions are an array") };
    assert_eq!(stride as usize, size_of::<CullingRegion>());
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
fn the_uniforms_of_the_edge_passes_lie_as_in_wgsl() {
    let edges = layout!(
        "Edges" = EdgeUniform {
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
            vertex_rounding,
            padding_1,
            padding_2,
            points,
            unknown,
        }
    );
    let unknown = layout!("Unknown" = UnknownUniform { least, maps, most, is_filtered });
    let [classify, _, select, surfaces, trace, blocks, _] =
        edges_wgsl(&ShadowMapDescriptor::default(), 4, None).map(|source| parse("edges", &source));
    for module in [classify, surfaces, trace] {
        assert_same(&module, &edges);
        assert_same(&module, &unknown);
        let (members, _) = reflected(&module, "Edges");
        let [.., points, unknown] = members else { panic!("two arrays at the end") };
        let counts = [points, unknown].map(|member| match module.types[member.ty].inner {
            TypeInner::Array { size: naga::ArraySize::Constant(count), .. } => count.get() as usize,
            _ => panic!("an array of a fixed number"),
        });
        assert_eq!(counts, [Edges::MAX_SAMPLES as usize, MAX_UNKNOWN]);
    }
    // Rust code writes these as four numbers: the budget in pixels and the frame, and a layer.
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
    let module = receiver(&ShadowMapDescriptor::default());
    let (members, _) = reflected(&module, "shadowfit_Receiver");
    let maps = members.last().expect("the maps");
    let TypeInner::Array { size, stride, .. } = module.types[maps.ty].inner else { panic!("maps are an array") };
    let naga::ArraySize::Constant(count) = size else { panic!("maps are a fixed number") };
    assert_eq!((count.get() as usize, stride as usize), (MAX_MAPS, size_of::<MapUniform>()));
}
