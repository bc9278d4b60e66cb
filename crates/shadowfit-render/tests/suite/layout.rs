//! The renderer's Rust structs, compared with naga's reflection of the WGSL that reads them.

use core::mem::offset_of;

use naga::Binding;
use shadowfit_render::{
    BlockUniform, FrameUniform, InsetVertex, InstanceData, JudgedUniform, LineVertex, MarksUniform, MaterialUniform,
    Overlay, QuadVertex, shaders,
};
use shadowfit_testing::layout;
use shadowfit_testing::layout::{assert_same, at_locations, packed, reflected};
use shadowfit_testing::wgsl::{Shader, parse};
use shadowfit_wgpu::ShadowMapDescriptor;

/// Uniforms whose layouts the tests below compare.
const COMPARED: [&str; 5] = ["Frame", "Material", "Judged", "Marks", "Block"];

/// Asserts that a test compares the layout of every uniform of a module, here or in shadowfit-wgpu, whose
/// names have a prefix.
pub(crate) fn assert_uniforms_are_compared(shader: &Shader) {
    for uniform in shader.uniform_structs() {
        let is_compared = COMPARED.contains(&uniform.as_str()) || uniform.starts_with("shadowfit_");
        assert!(is_compared, "{} reads the uniform {uniform}, which no test compares", shader.name);
    }
}

fn scene() -> naga::Module {
    parse("scene", &shaders::scene(&ShadowMapDescriptor::default()))
}

fn caster() -> naga::Module {
    parse("caster", &shaders::caster(&ShadowMapDescriptor::default()))
}

#[test]
fn uniforms_of_frames_and_materials_have_the_size_and_offsets_of_their_wgsl_structs() {
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
            near,
            parallel,
            map_tints,
        }
    );
    let scene = scene();
    assert_same(&caster(), &material);
    assert_same(&scene, &material);
    assert_same(&scene, &frame);
}

#[test]
fn uniforms_of_overlays_marks_and_blocks_of_texels_have_the_size_and_offsets_of_their_wgsl_structs() {
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
fn vertex_shaders_read_instances_where_the_buffer_has_them() {
    let scene = scene();
    let rows = offset_of!(InstanceData, rows);
    let ends =
        [rows, rows + 16, rows + 32, offset_of!(InstanceData, first_triangle), offset_of!(InstanceData, first_map)];
    assert_eq!(packed(&scene, &at_locations(&scene, "SceneIn", &[5, 6, 7, 8])), ends);
    let caster = caster();
    assert_eq!(packed(&caster, &at_locations(&caster, "CasterIn", &[5, 6, 7])), ends[..4]);
    assert_eq!(size_of::<InstanceData>() % 16, 0);
}

#[test]
fn casters_read_each_location_with_the_type_that_the_scene_reads_there() {
    let (scene, caster) = (scene(), caster());
    for member in reflected(&caster, "CasterIn").0 {
        let Some(Binding::Location { location, .. }) = member.binding else { continue };
        let other = at_locations(&scene, "SceneIn", &[location])[0];
        assert_eq!(member.name, other.name, "location {location}");
        assert_eq!(caster.types[member.ty].inner, scene.types[other.ty].inner, "location {location}");
    }
}

#[test]
fn the_vertex_shader_of_lines_reads_both_ends_where_the_buffer_has_them() {
    let module = parse("lines", &shaders::lines());
    let (position, color, size) =
        (offset_of!(LineVertex, position), offset_of!(LineVertex, color), size_of::<LineVertex>());
    let ends = [position, color, size, size + color, 2 * size];
    assert_eq!(packed(&module, &at_locations(&module, "LineIn", &[0, 1, 2, 3])), ends);
}

#[test]
fn vertex_shaders_read_insets_and_quadrilaterals_where_the_buffers_have_them() {
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
