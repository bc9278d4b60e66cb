//! The WGSL of the compute passes: valid with what every WebGPU device has, and laid out as the Rust that fills it.

use core::mem::offset_of;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Module, TypeInner};
use shadowfit_truth::gpu::{BeforeUniform, JudgeUniform, MAX_MAPS, MapUniform, TallyRecord, shader};

fn modules() -> [(&'static str, String); 4] {
    [("truth", shader::truth()), ("rows", shader::rows()), ("classes", shader::classes()), ("tally", shader::tally())]
}

fn parse(name: &str, source: &str) -> Module {
    naga::front::wgsl::parse_str(source).unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)))
}

#[test]
fn every_pass_is_valid_without_any_capability() {
    for (name, source) in modules() {
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
        validator.validate(&parse(name, &source)).unwrap_or_else(|error| panic!("{name}: {error:?}"));
    }
}

#[test]
fn every_wgsl_file_is_part_of_a_pass() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/gpu/shaders");
    let files: Vec<_> =
        std::fs::read_dir(folder).expect("the folder").map(|file| file.expect("a file").path()).collect();
    assert!(files.len() >= 4, "{files:?}");
    for file in files {
        let text = std::fs::read_to_string(&file).expect("the file's text");
        assert!(modules().iter().any(|(_, source)| source.contains(&text)), "{} is not used", file.display());
    }
}

/// Compares a Rust struct with naga's reflection: size, names and offsets of all fields.
macro_rules! assert_layout {
    ($module:expr, $wgsl:literal = $rust:ident { $($field:ident),+ $(,)? }) => {{
        // A pattern without `..` has to name every field.
        let _ = |value: $rust| { let $rust { $($field: _),+ } = value; };
        let fields = [$((stringify!($field).to_owned(), offset_of!($rust, $field) as u32)),+];
        let found = $module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some($wgsl));
        let Some((_, naga::Type { inner: TypeInner::Struct { members, span }, .. })) = found else {
            panic!("no struct {}", $wgsl)
        };
        let members: Vec<_> = members.iter().map(|m| (m.name.clone().unwrap_or_default(), m.offset)).collect();
        assert_eq!((members.as_slice(), *span as usize), (fields.as_slice(), size_of::<$rust>()), "{}", $wgsl);
    }};
}

#[test]
fn every_record_has_the_size_and_offsets_of_its_wgsl_struct() {
    let module = parse("classes", &shader::classes());
    assert_layout!(
        module,
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
    assert_layout!(
        module,
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
            tan_half_fov,
            size,
            map_count,
            depth_clamp,
            triangles,
            by_coverage,
            reach,
            blend,
            padding_0,
            padding_1,
            maps,
            before
        }
    );
    assert_layout!(
        module,
        "Before" = BeforeUniform { forward, eye_depth, map_count, by_coverage, padding_0, padding_1, maps }
    );
}

#[test]
fn the_tally_has_the_size_and_offsets_of_its_wgsl_struct() {
    let module = parse("tally", &shader::tally());
    assert_layout!(
        module,
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
            bins
        }
    );
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
