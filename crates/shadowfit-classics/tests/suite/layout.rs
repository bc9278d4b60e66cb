//! The samples' Rust structs against naga's reflection of the WGSL that reads them.

use naga::Binding;
use shadowfit_classics::mapped::{SampleUniform, shaders};
use shadowfit_classics::occlusion::OcclusionUniform;
use shadowfit_classics::sky_box::SkyBoxUniform;
use shadowfit_classics::{occlusion, sky_box};
use shadowfit_testing::layout;
use shadowfit_testing::layout::{assert_same, at_locations, reflected};
use shadowfit_testing::wgsl::{Shader, parse};
use shadowfit_wgpu::ShadowMapDescriptor;

/// Uniforms whose layouts the tests below compare, and uniforms of shadowfit-render, whose own tests compare
/// them.
const COMPARED: [&str; 5] = ["Occlusion", "Sample", "SkyBox", "Frame", "Material"];

/// Asserts that the layout of every uniform of a module is compared.
pub(crate) fn assert_uniforms_are_compared(shader: &Shader) {
    for uniform in shader.uniform_structs() {
        let is_compared = COMPARED.contains(&uniform.as_str());
        assert!(is_compared, "{} reads the uniform {uniform}, which no test compares", shader.name);
    }
}

#[test]
fn every_uniform_has_the_size_and_offsets_of_its_wgsl_struct() {
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
    assert_same(&parse("occlusion shade", &occlusion::shaders::shade()), &gathered);
    assert_same(&parse("occlusion gather", &occlusion::shaders::gather()), &gathered);
    let sample = layout!(
        "Sample" =
            SampleUniform { clip_from_world, light_from_world, light, test, further, shading, map_size, padding }
    );
    assert_same(&parse("caster", &shaders::caster()), &sample);
    let frame = super::wgsl::frames().pop().expect("a frame");
    assert_same(&parse("sample", &shaders::shaded(&frame)), &sample);
    assert_same(&parse("sky box", sky_box::WGSL), &layout!("SkyBox" = SkyBoxUniform { clip_from_world }));
}

#[test]
fn occlusion_reads_each_location_with_the_type_that_the_renderers_scene_reads_there() {
    let scene = parse("scene", &shadowfit_render::shaders::scene(&ShadowMapDescriptor::default()));
    for source in [occlusion::shaders::surface(), occlusion::shaders::shade()] {
        let module = parse("occlusion", &source);
        for member in reflected(&module, "PartIn").0 {
            let Some(Binding::Location { location, .. }) = member.binding else { continue };
            let other = at_locations(&scene, "SceneIn", &[location])[0];
            assert_eq!(member.name, other.name, "location {location}");
            assert_eq!(module.types[member.ty].inner, scene.types[other.ty].inner, "location {location}");
        }
    }
}
