//! Tests of the WGSL: it is valid on every WebGPU device, and its structs have the layout of the Rust
//! records.

use naga::valid::Capabilities;
use shadowfit_rays::records::{CutOutRecord, InstanceRecord, NodeRecord, RefitUniform, TriangleRecord};
use shadowfit_rays::{RayError, RayWgslOptions, rays_wgsl, refit_wgsl};
use shadowfit_testing::layout;
use shadowfit_testing::layout::assert_same;
use shadowfit_testing::package_folder;
use shadowfit_testing::wgsl::{assert_every_file_is_used, assert_valid, parse};

fn validate(name: &str, source: &str) {
    assert_valid(name, source, Capabilities::empty());
}

#[test]
fn every_text_is_valid_without_any_capability() {
    validate("rays", &rays_wgsl(&RayWgslOptions::group(0)));
    validate("refit", &refit_wgsl());
    let fragment = "@fragment fn main(@location(0) at: vec3<f32>) -> @location(0) vec4<f32> {
        return vec4<f32>(f32(shadowfit_rays_blocked(at, vec3<f32>(0.0, 1.0, 0.0))));
    }";
    validate("fragment", &(rays_wgsl(&RayWgslOptions::group(2)) + fragment));
}

#[test]
fn texts_of_two_prefixes_stand_in_one_shader_and_bad_prefixes_are_refused() {
    let options = RayWgslOptions::group(1).with_prefix("moon").expect("a word");
    let counts = "fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool { return hit.custom != 3u; }";
    let moon = rays_wgsl(&options.with_counts(counts));
    assert!(!moon.contains("shadowfit_") && !moon.contains("SHADOWFIT_"));
    validate("two", &(rays_wgsl(&RayWgslOptions::group(0)) + &moon));
    for prefix in ["", "1a", "a-b", "ä", "_a"] {
        assert_eq!(RayWgslOptions::group(0).with_prefix(prefix), Err(RayError::Prefix(prefix.to_owned())));
    }
}

#[test]
fn every_wgsl_file_is_part_of_a_text() {
    let folder = package_folder(env!("CARGO_MANIFEST_DIR")).join("src/shaders");
    let texts = [rays_wgsl(&RayWgslOptions::group(0)), refit_wgsl()];
    assert_every_file_is_used(&folder, &texts.each_ref().map(String::as_str), |file| {
        vec![file.replace("GROUP", "0").replace("NODES_ON_STACK", &shadowfit_rays::STACK.to_string())]
    });
}

#[test]
fn every_record_has_the_size_and_offsets_of_its_wgsl_struct() {
    let module = parse("rays", &rays_wgsl(&RayWgslOptions::group(0)));
    for layout in [
        layout!("shadowfit_rays_Node" = NodeRecord { least, count, most, first }),
        layout!("shadowfit_rays_Triangle" = TriangleRecord { a, cut_out, b, index, c, padding }),
        layout!("shadowfit_rays_Instance" = InstanceRecord { row_x, row_y, row_z, root, sides, custom, padding }),
        layout!(
            "shadowfit_rays_CutOut" =
                CutOutRecord { uv_a, uv_b, uv_c, base_alpha, cutoff, alphas, image, wrap, nearest, padding }
        ),
    ] {
        assert_same(&module, &layout);
    }
    let refit = layout!("shadowfit_rays_Refit" = RefitUniform { first, count, offset, stride });
    assert_same(&parse("refit", &refit_wgsl()), &refit);
}
