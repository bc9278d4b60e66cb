//! The Rust code of a technique compiles and makes the same technique.
//!
//! The samples under `rust_code/` hold the current code. This command writes them again:
//!
//! ```sh
//! SHADOWFIT_UPDATE_GOLDENS=1 cargo test -p shadowfit-params --test rust_code
//! ```

use std::path::Path;

use shadowfit::glam::{UVec2, Vec3};
use shadowfit::settings::*;
use shadowfit::*;
use shadowfit_params::to_rust;

/// A technique with a name, the technique that the code of its sample makes, and that code.
type Sample = (&'static str, Technique, Technique, &'static str);

/// Makes a sample from the name of its file.
macro_rules! sample {
    ($name:literal, $technique:expr) => {
        (
            $name,
            $technique,
            include!(concat!("rust_code/", $name, ".rs")),
            include_str!(concat!("rust_code/", $name, ".rs")),
        )
    };
}

#[expect(clippy::let_and_return, reason = "a sample makes a technique, and then gives it back")]
#[expect(clippy::unreadable_literal, reason = "numbers are written as Rust prints them")]
fn samples() -> [Sample; 7] {
    [
        sample!("default", Technique::default()),
        sample!("stable_4", Technique::preset("stable-4").expect("a preset")),
        sample!("xna_1", Technique::preset("xna-1").expect("a preset")),
        sample!("all_fields", all_fields()),
        sample!("some_fields", some_fields()),
        sample!("not_finite", not_finite()),
        sample!("three_windows", Technique::default().with_count(3)),
    ]
}

/// Returns a technique without default values.
fn all_fields() -> Technique {
    Technique {
        maps: Maps::Cascades(Cascades {
            count: 3,
            shape: Shape { kind: FitKind::Oriented, rectangle: RectangleKind::MinimumSquare, max_texel_ratio: 3.0 },
            splits: SplitScheme::Manual([1.0, 2.5, 0.1, 1e-7, 3e9, 16_777_216.0, f32::MAX]),
            selection: MapSelection::ViewDepth { overlap: 0.1 },
            stabilise: Stabilise::Snap { max_oversize: 3.0 },
        }),
        fit: MapSettings {
            max_distance: 80.25,
            margin: 0.25,
            border: Some(4.0),
            casters: CasterPolicy::DepthClamp,
            caster_extension: 7.0,
            up: Vec3::new(0.0, -0.0, 1.0),
            least_texel: 0.001,
            resolution: UVec2::new(1024, 512),
            depth: DepthConvention::Reversed,
        },
        filter: FilterKind::Vogel8,
        softness: Softness { radius: SoftRadius::Metres(0.1), floor: 0.5, ceiling: 8.0 },
        fade: 0.2,
        bias: BiasSettings {
            constant: 1.0 / 3.0,
            slope: 0.2,
            normal_offset: 1e-9,
            receiver_plane: 1.5,
            depth_steps: 0.5,
        },
        format: MapFormat::R32Float,
        edges: Edges::Traced { samples: 9 },
    }
}

/// Returns a technique with single fields changed in each of the nested structs.
fn some_fields() -> Technique {
    let hold = Hysteresis::default().with_look_ahead(60);
    let cascades =
        Cascades::default().with_splits(SplitScheme::Practical(0.7)).with_stabilise(Stabilise::Hysteresis(hold));
    let mut technique = Technique::default().with_maps(cascades).with_max_distance(f32::MIN);
    technique.bias.slope = 1.0;
    technique.softness.radius = SoftRadius::SunAngle(0.01);
    technique
}

fn not_finite() -> Technique {
    let selection = MapSelection::ViewDepth { overlap: f32::INFINITY };
    let cascades = Cascades::default().with_splits(SplitScheme::Practical(f32::NAN)).with_selection(selection);
    let mut technique = Technique::default().with_maps(cascades);
    technique.fit.up = Vec3::new(f32::NEG_INFINITY, f32::NAN, f32::MAX);
    technique.fit.border = Some(-f32::NAN);
    technique
}

#[test]
fn the_code_of_a_technique_compiles_and_makes_that_technique() {
    if std::env::var_os("SHADOWFIT_UPDATE_GOLDENS").is_some_and(|value| value != "0") {
        return write_anew();
    }
    for (name, technique, made, sample) in samples() {
        assert_eq!(code_of(&technique), sample, "{name}: the head of this file says how to write it anew");
        // As text, since NaN is not equal to itself.
        assert_eq!(format!("{made:?}"), format!("{technique:?}"), "{name}");
    }
}

#[test]
fn the_code_begins_with_the_nearest_preset_and_says_what_differs() {
    let technique = Technique::preset("stable-4").expect("a preset").with_fade(0.25);
    let code = to_rust(&technique);
    assert_eq!(code.lines().count(), 2, "{code}");
    assert!(code.contains("\"stable-4\"") && code.ends_with("technique.fade = 0.25;\n"), "{code}");
}

fn write_anew() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/rust_code");
    for (name, technique, ..) in samples() {
        std::fs::write(folder.join(name).with_extension("rs"), code_of(&technique)).expect("a sample is written");
    }
}

/// Returns a sample: a block with the generated statement, and the technique as its value.
fn code_of(technique: &Technique) -> String {
    let code = to_rust(technique);
    format!("{{\n{code}technique\n}}\n")
}
