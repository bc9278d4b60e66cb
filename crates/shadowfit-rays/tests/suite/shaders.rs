//! The WGSL: valid with what every WebGPU device has, and laid out as the Rust that fills it.

use core::mem::offset_of;

use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Module, TypeInner};
use shadowfit_rays::records::{CutOutRecord, InstanceRecord, NodeRecord, RefitUniform, TriangleRecord};
use shadowfit_rays::{RayError, RayWgslOptions, rays_wgsl, refit_wgsl};

fn parse(name: &str, source: &str) -> Module {
    naga::front::wgsl::parse_str(source).unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(source)))
}

fn validate(name: &str, source: &str) -> Module {
    let module = parse(name, source);
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    validator.validate(&module).unwrap_or_else(|error| panic!("{name}: {error:?}"));
    module
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
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/src/shaders");
    let files: Vec<_> =
        std::fs::read_dir(folder).expect("the folder").map(|file| file.expect("a file").path()).collect();
    assert_eq!(files.len(), 4, "{files:?}");
    let all = rays_wgsl(&RayWgslOptions::group(0)) + &refit_wgsl();
    for file in files {
        let text = std::fs::read_to_string(&file).expect("the file's text");
        let text = text.replace("GROUP", "0").replace("MAX_DEPTH", &shadowfit_rays::MAX_DEPTH.to_string());
        assert!(all.contains(&text), "{} is not used", file.display());
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
    let module = parse("rays", &rays_wgsl(&RayWgslOptions::group(0)));
    assert_layout!(module, "shadowfit_rays_Node" = NodeRecord { least, count, most, first });
    assert_layout!(module, "shadowfit_rays_Triangle" = TriangleRecord { a, cut_out, b, index, c, padding });
    assert_layout!(
        module,
        "shadowfit_rays_Instance" = InstanceRecord { row_x, row_y, row_z, root, sides, custom, padding }
    );
    assert_layout!(
        module,
        "shadowfit_rays_CutOut" =
            CutOutRecord { uv_a, uv_b, uv_c, base_alpha, cutoff, alphas, image, wrap, nearest, padding }
    );
    let module = parse("refit", &refit_wgsl());
    assert_layout!(module, "shadowfit_rays_Refit" = RefitUniform { first, count, offset, stride });
}
