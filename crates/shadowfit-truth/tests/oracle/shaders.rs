//! The WGSL of the compute passes: valid on every WebGPU device, and laid out like the Rust types that fill
//! it.

use naga::TypeInner;
use naga::valid::Capabilities;
use shadowfit_testing::layout;
use shadowfit_testing::layout::assert_same;
use shadowfit_testing::package_folder;
use shadowfit_testing::wgsl::{assert_every_file_is_used, assert_valid, parse};
use shadowfit_truth::gpu::{BeforeUniform, JudgeUniform, MAX_MAPS, MapUniform, TallyRecord, shader};

#[test]
fn every_pass_is_valid_without_any_capability() {
    assert_valid("truth", &shader::truth(), Capabilities::empty());
    assert_valid("rows", &shader::rows(), Capabilities::empty());
    assert_valid("classes", &shader::classes(), Capabilities::empty());
    assert_valid("tally", &shader::tally(), Capabilities::empty());
}

#[test]
fn every_wgsl_file_is_part_of_a_pass() {
    let folder = package_folder(env!("CARGO_MANIFEST_DIR")).join("src/gpu/shaders");
    let texts = [shader::truth(), shader::rows(), shader::classes(), shader::tally()];
    assert_every_file_is_used(&folder, &texts.each_ref().map(String::as_str), |file| vec![file.to_owned()]);
}

#[test]
fn every_record_has_the_size_and_offsets_of_its_wgsl_struct() {
    let map = layout!(
        "Map" = MapUniform {
            row_x,
            row_y,
            row_z,
            row_w,
            size,
            split_far,
            is_reversed,
            blend_near,
            index,
            edge_width,
            padding
        }
    );
    let judge = layout!(
        "Judge" = JudgeUniform {
            eye,
            near,
            right,
            far,
            up,
            ray_offset,
            forward,
            max_distance,
            to_light,
            edge_width,
            half_size,
            size,
            map_count,
            depth_clamp,
            triangles,
            by_coverage,
            reach,
            blend,
            is_orthographic,
            padding,
            maps,
            before
        }
    );
    let before =
        layout!("Before" = BeforeUniform { forward, eye_depth, map_count, by_coverage, padding_0, padding_1, maps });
    let module = parse("classes", &shader::classes());
    for layout in [map, judge, before] {
        assert_same(&module, &layout);
    }
}

#[test]
fn the_tally_has_the_size_and_offsets_of_its_wgsl_struct() {
    let tally = layout!(
        "Tally" = TallyRecord {
            all,
            grazing,
            lit,
            edge_zone,
            uncovered,
            undersampled,
            crawl_compared,
            crawl_different,
            error_low,
            error_high,
            light_low,
            light_high,
            light_error_low,
            light_error_high,
            bins
        }
    );
    assert_same(&parse("tally", &shader::tally()), &tally);
}

#[test]
fn the_maps_are_as_many_and_as_far_apart_in_both_languages() {
    let module = parse("truth", &shader::truth());
    let arrays: Vec<_> = module
        .types
        .iter()
        .filter_map(|(_, ty)| match ty.inner {
            TypeInner::Array { base, size: naga::ArraySize::Constant(count), stride }
                if module.types[base].name.as_deref() == Some("Map") =>
            {
                Some((count.get() as usize, stride as usize))
            }
            _ => None,
        })
        .collect();
    assert_eq!(arrays, [(MAX_MAPS, size_of::<MapUniform>())]);
}
