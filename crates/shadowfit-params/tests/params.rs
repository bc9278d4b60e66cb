//! The parameter table is complete and safe to drive from files and command lines.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;

use proptest::prelude::*;
use shadowfit::glam::{DVec3, UVec2, Vec3};
use shadowfit::settings::Shape;
use shadowfit::settings::{
    CasterPolicy, FilterKind, FitKind, FitSettings, MapFormat, RectangleKind, SoftRadius, SplitScheme, Stabilise,
};
use shadowfit::{Aabb, Boxes, DepthConvention, FitInput, Maps, PRESETS, PerspectiveCamera, Scratch, Technique};
use shadowfit_params::tool::Settings;
use shadowfit_params::{
    self as params, BoxSource, Group, Kind, Number, PARAMETERS, Parameter, Value, format_value, set_from_str,
    set_technique_from_str, technique_parameters,
};

fn written(settings: &Settings, parameter: &Parameter) -> String {
    format_value(settings, parameter)
}

fn row(id: &str) -> &'static Parameter {
    params::parameter(id).expect(id)
}

/// The default settings with values given as text.
fn with(values: &[(&str, &str)]) -> Settings {
    let mut settings = Settings::default();
    for (id, value) in values {
        set_from_str(&mut settings, id, value).expect("a value that the parameter takes");
    }
    settings
}

/// Settings that between them have every row.
fn starts() -> [Settings; 5] {
    [
        Settings::default(),
        with(&[("fit.kind", "focused"), ("splits.scheme", "practical")]),
        with(&[("fit.kind", "oriented"), ("splits.scheme", "manual"), ("splits.choice", "view_depth")]),
        with(&[("fit.kind", "sphere"), ("splits.count", "1"), ("stabilise.mode", "snap")]),
        with(&[("softness.measure", "metres"), ("view.inset_black", "0")]),
    ]
}

/// Settings in which the row exists.
fn settings_with(parameter: &Parameter) -> Settings {
    starts().into_iter().find(|start| parameter.is_present(start)).expect(parameter.id)
}

/// Gives the parameter a value that is not its present one, where the settings have the row.
fn change(settings: &mut Settings, parameter: &Parameter) {
    let before = parameter.get(settings);
    let values = match &parameter.kind {
        // Near where a panel begins: the middle of a range may be beyond all that matters.
        Kind::Number(Number { unset: Some(unset), step, max, .. }) => [unset.initial + step, *max].map(Value::Number),
        Kind::Number(Number { min, max, .. }) => [0.5 * (min + max), *max].map(Value::Number),
        Kind::Choice(_) => [0, 1].map(Value::Option),
        Kind::Toggle => [false, true].map(Value::Toggle),
    };
    for value in values {
        if parameter.get(settings) == before {
            parameter.set(settings, value);
        }
    }
}

/// Every field of the settings by its path, with what it holds: the lines of what the settings print as.
fn leaves(settings: &Settings) -> BTreeMap<String, String> {
    let mut leaves = BTreeMap::new();
    // The names and the counts of lines of what is open.
    let mut path: Vec<(String, usize)> = Vec::new();
    for line in format!("{settings:#?}").lines().skip(1).map(str::trim) {
        if line.ends_with(['}', ']', ')', ',']) && line.starts_with(['}', ']', ')']) {
            path.pop();
            continue;
        }
        let index = path.last_mut().map_or(0, |(_, count)| {
            *count += 1;
            *count
        });
        let (name, value) =
            line.split_once(": ").map_or((index.to_string(), line), |(name, value)| (name.to_owned(), value));
        if value.ends_with(['{', '[', '(']) {
            path.push((name, 0));
        } else {
            let names = path.iter().map(|(name, _)| name.as_str()).chain([name.as_str()]);
            leaves.insert(names.collect::<Vec<_>>().join("."), value.to_owned());
        }
    }
    leaves
}

#[test]
fn every_row_changes_the_settings_and_copies_its_value() {
    for parameter in PARAMETERS {
        let start = settings_with(parameter);
        let mut settings = start;
        change(&mut settings, parameter);
        assert_ne!(settings, start, "{}", parameter.id);
        assert!(!parameter.is_equal(&settings, &start), "{}", parameter.id);
        parameter.copy(&mut settings, &start);
        assert!(parameter.is_equal(&settings, &start), "{}", parameter.id);
    }
}

#[test]
fn every_field_is_reached_by_a_row() {
    let mut unreached: BTreeSet<String> = starts().iter().flat_map(|start| leaves(start).into_keys()).collect();
    assert!(unreached.len() > 60 && unreached.contains("technique.fit.up.3"), "{unreached:#?}");
    for parameter in PARAMETERS {
        for start in starts() {
            let mut changed = start;
            change(&mut changed, parameter);
            let (before, after) = (leaves(&start), leaves(&changed));
            unreached.retain(|name| before.get(name) == after.get(name));
        }
    }
    assert!(unreached.is_empty(), "no row changes {unreached:?}");
}

#[test]
fn every_row_of_a_technique_shows_in_its_rust_code() {
    let code = |settings: &Settings| params::to_rust(&settings.technique);
    for parameter in technique_parameters() {
        let start = settings_with(parameter);
        let mut changed = start;
        change(&mut changed, parameter);
        assert_ne!(code(&changed), code(&start), "{}", parameter.id);
    }
}

#[test]
fn rows_of_a_technique_change_nothing_but_the_technique() {
    for parameter in technique_parameters() {
        let start = settings_with(parameter);
        let mut changed = start;
        change(&mut changed, parameter);
        let Settings { technique, .. } = changed;
        assert_eq!(changed, start.with_technique(technique), "{}", parameter.id);
        assert_ne!(technique, start.technique, "{}", parameter.id);
    }
    for parameter in PARAMETERS.iter().filter(|parameter| !parameter.group.is_technique()) {
        let mut changed = Settings::default();
        change(&mut changed, parameter);
        assert_eq!(changed.technique, Technique::default(), "{}", parameter.id);
    }
}

/// What makes maps slices of the view.
const SLICES: (&str, &str) = ("fit.kind", "focused");

/// Checks the options of a choice and what each of them sets.
fn check<T: PartialEq + Debug>(id: &str, get: fn(&Technique) -> T, expected: &[(&str, T)]) {
    let Kind::Choice(options) = &row(id).kind else { panic!("{id} is no choice") };
    let ids: Vec<&str> = options.iter().map(|option| option.id).collect();
    assert_eq!(ids, expected.iter().map(|(id, _)| *id).collect::<Vec<_>>(), "{id}");
    for (option, variant) in expected {
        let base = if row(id).is_present(&Settings::default()) { ("fit.kind", "windows") } else { SLICES };
        assert_eq!(get(&with(&[base, (id, option)]).technique), *variant, "{id}={option}");
    }
}

#[test]
fn option_names_select_their_variants() {
    let fits = [
        ("focused", Some(FitKind::Focused)),
        ("windows", None),
        ("oriented", Some(FitKind::Oriented)),
        ("sphere", Some(FitKind::Sphere)),
        ("frustum_aabb", Some(FitKind::FrustumAabb)),
        ("xna_sample", Some(FitKind::XnaSample)),
    ];
    check("fit.kind", |t| t.maps.shape().map(|shape| shape.kind), &fits);
    for (option, boxes) in [("clusters", BoxSource::Clusters), ("objects", BoxSource::Objects)] {
        assert_eq!(with(&[("input.boxes", option)]).inputs.boxes, boxes);
    }
    let rectangles = [
        ("minimum_area", RectangleKind::MinimumArea),
        ("minimum_square", RectangleKind::MinimumSquare),
        ("axis_aligned", RectangleKind::AxisAligned),
    ];
    check("fit.rectangle", |t| t.maps.as_slices().shape.rectangle, &rectangles);
    let casters = [
        ("list", CasterPolicy::PerObject),
        ("extend", CasterPolicy::Extend),
        ("scene_bounds", CasterPolicy::SceneBounds),
        ("depth_clamp", CasterPolicy::DepthClamp),
        ("none", CasterPolicy::None),
    ];
    check("fit.casters", |t| t.fit.casters, &casters);
    let splits = [
        ("from_histogram", SplitScheme::FromHistogram),
        ("from_boxes", SplitScheme::FromBoxes),
        ("practical", SplitScheme::Practical(0.5)),
        ("logarithmic", SplitScheme::Logarithmic),
        ("uniform", SplitScheme::Uniform),
        ("manual", SplitScheme::Manual([5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 320.0])),
    ];
    check("splits.scheme", |t| t.maps.as_slices().splits, &splits);
    let snap = Stabilise::Snap { max_waste: Stabilise::default().max_waste() };
    let modes = [("hysteresis", Stabilise::default()), ("snap", snap), ("off", Stabilise::Off)];
    check("stabilise.mode", |t| t.maps.as_slices().stabilise, &modes);
    let depths = [
        ("zero_to_one", DepthConvention::ZeroToOne),
        ("reversed", DepthConvention::Reversed),
        ("negative_one_to_one", DepthConvention::NegativeOneToOne),
    ];
    check("map.depth", |t| t.fit.depth, &depths);
}

#[test]
fn names_of_formats_and_filters_select_them() {
    let formats = [
        ("depth32float", MapFormat::Depth32Float),
        ("depth16_unorm", MapFormat::Depth16Unorm),
        ("r32float", MapFormat::R32Float),
        ("r16_float", MapFormat::R16Float),
        ("rgba8_packed", MapFormat::Rgba8Packed),
        ("r8_grey", MapFormat::R8Grey),
    ];
    check("map.format", |t| t.format, &formats);
    let filters = [
        ("point", FilterKind::Point),
        ("hardware_2x2", FilterKind::Hardware2x2),
        ("pcf_3x3", FilterKind::Pcf3x3),
        ("pcf_5x5", FilterKind::Pcf5x5),
        ("pcf_7x7", FilterKind::Pcf7x7),
        ("vogel_8", FilterKind::Vogel8),
        ("vogel_16", FilterKind::Vogel16),
        ("vogel_32", FilterKind::Vogel32),
        ("pcss", FilterKind::Pcss),
    ];
    check("map.filter", |t| t.filter, &filters);
    let measured = |t: &Technique| matches!(t.softness.radius, SoftRadius::Metres(_));
    check("softness.measure", measured, &[("sun_angle", false), ("metres", true)]);
}

#[test]
fn a_width_is_also_the_height_until_one_is_set() {
    let resolution = |values: &[(&str, &str)]| with(values).technique.fit.resolution;
    assert_eq!(resolution(&[("map.resolution", "512")]), UVec2::splat(512));
    assert_eq!(resolution(&[("map.resolution", "512"), ("map.height", "256")]), UVec2::new(512, 256));
    assert_eq!(resolution(&[("map.height", "256"), ("map.resolution", "512")]), UVec2::new(512, 256));
    assert_eq!(resolution(&[("map.height", "256"), ("map.height", "square")]), UVec2::splat(2048));
}

#[test]
fn ids_are_unique_and_begin_with_their_group() {
    for (index, parameter) in PARAMETERS.iter().enumerate() {
        assert!(PARAMETERS[..index].iter().all(|other| other.id != parameter.id), "{}", parameter.id);
        assert_eq!(parameter.id.split_once('.').map(|(group, _)| group), Some(parameter.group.id()));
        assert!(core::ptr::eq(row(parameter.id), parameter));
    }
    let listed: usize = Group::ALL.iter().map(|group| group.parameters().count()).sum();
    assert_eq!(listed, PARAMETERS.len());
}

#[test]
fn rows_speak_to_people() {
    for parameter in PARAMETERS {
        assert!(!parameter.label.is_empty() && parameter.help.ends_with('.'), "{}", parameter.id);
        assert!(!parameter.help.contains("  "), "{}: a line break left a gap", parameter.id);
        let same_label = parameter.group.parameters().filter(|other| other.label == parameter.label).count();
        assert_eq!(same_label, 1, "{}: two rows of a group have this label", parameter.id);
        let options: Vec<_> = match &parameter.kind {
            Kind::Choice(options) => options.to_vec(),
            Kind::Number(number) => number.unset.into_iter().map(|unset| unset.option).collect(),
            Kind::Toggle => continue,
        };
        assert!(options.iter().all(|option| option.help.ends_with('.') && !option.help.contains("  ")));
    }
}

#[test]
fn defaults_and_steps_lie_within_the_ranges() {
    for parameter in PARAMETERS {
        let settings = settings_with(parameter);
        let Kind::Number(Number { min, max, step, unset, .. }) = &parameter.kind else { continue };
        let (min, max, step) = (*min, *max, *step);
        let initial = unset.map(|unset| unset.initial);
        let values: Vec<f64> = initial.into_iter().chain(parameter.number(&settings)).collect();
        assert!(values.iter().all(|value| (min..=max).contains(value)), "{} is {values:?}", parameter.id);
        assert!(step > 0.0 && step < max - min, "{}", parameter.id);
    }
}

#[test]
fn values_survive_text_to_the_bit() {
    for parameter in PARAMETERS {
        for share in [0.0, 0.001, 1.0 / 3.0, 0.5, 0.77, 1.0] {
            let mut settings = settings_with(parameter);
            match &parameter.kind {
                Kind::Number(number) => {
                    parameter.set(&mut settings, Value::Number(number.min + share * (number.max - number.min)));
                }
                Kind::Choice(_) | Kind::Toggle => change(&mut settings, parameter),
            }
            survives_text(&settings, parameter);
            if let Kind::Number(Number { unset: Some(_), .. }) = &parameter.kind {
                survives_text(&settings_with(parameter), parameter);
            }
        }
    }
}

/// Checks that a row's value is read back as it was written.
fn survives_text(settings: &Settings, parameter: &Parameter) {
    let text = written(settings, parameter);
    let mut restored = *settings;
    change(&mut restored, parameter);
    set_from_str(&mut restored, parameter.id, &text).expect("what was written is read");
    assert!(parameter.is_equal(&restored, settings), "{} = {text}", parameter.id);
}

#[test]
fn all_defaults_survive_text_in_any_order() {
    let defaults = Settings::default();
    for start in starts() {
        let mut forward = start;
        for parameter in PARAMETERS {
            change(&mut forward, parameter);
        }
        let mut backward = forward;
        let there = || PARAMETERS.iter().filter(|parameter| parameter.is_present(&defaults));
        for parameter in there() {
            set_from_str(&mut forward, parameter.id, &written(&defaults, parameter)).expect(parameter.id);
        }
        let set = |settings: &mut Settings, parameter: &'static Parameter| {
            set_from_str(settings, parameter.id, &written(&defaults, parameter)).map_err(|error| error.to_string())
        };
        // A row that only another one brings about waits for it.
        let waiting: Vec<_> = there().rev().filter(|parameter| set(&mut backward, parameter).is_err()).collect();
        for parameter in waiting {
            set(&mut backward, parameter).expect(parameter.id);
        }
        assert_eq!((forward, backward), (defaults, defaults));
    }
}

/// The technique that its rows, written in the order of the table, make of the default one.
fn restored(technique: &Technique) -> Technique {
    let settings = Settings::default().with_technique(*technique);
    let mut restored = Technique::default();
    for parameter in technique_parameters().filter(|parameter| parameter.is_present(&settings)) {
        set_technique_from_str(&mut restored, parameter.id, &written(&settings, parameter)).expect(parameter.id);
    }
    restored
}

/// A technique whose rows have values by these numbers, 0..=1, one for each row.
fn technique_by(shares: &[f64]) -> Technique {
    let mut settings = Settings::default();
    for (parameter, share) in technique_parameters().zip(shares) {
        let value = match &parameter.kind {
            Kind::Number(Number { unset: Some(_), .. }) if *share < 0.3 => Value::Unset,
            // Many of the values that matter are small.
            Kind::Number(Number { min, max, .. }) => Value::Number(min + share.powi(4) * (max - min)),
            Kind::Choice(options) => Value::Option(((share * options.len() as f64) as usize).min(options.len() - 1)),
            Kind::Toggle => Value::Toggle(*share < 0.5),
        };
        parameter.set(&mut settings, value);
    }
    settings.technique
}

proptest! {
    /// What saved files rely on.
    #[test]
    fn rows_written_in_order_restore_any_technique(
        shares in prop::collection::vec(0.0..=1.0_f64, technique_parameters().count())
    ) {
        let technique = technique_by(&shares);
        prop_assert_eq!(restored(&technique), technique);
    }
}

#[test]
fn rows_written_in_order_restore_every_preset() {
    for preset in &PRESETS {
        assert_eq!(restored(&preset.technique()), preset.technique(), "{}", preset.name);
    }
}

#[test]
fn numbers_are_written_short() {
    let mut settings = with(&[SLICES, ("splits.scheme", "practical")]);
    settings.light.elevation = 30_f32.to_radians();
    settings.light.azimuth = core::f32::consts::TAU;
    for (id, text) in [
        ("light.elevation", "30"),
        ("light.azimuth", "360"),
        ("camera.fov_y", "45"),
        ("camera.near", "0.1"),
        ("fit.max_distance", "far_plane"),
        ("fit.border", "auto"),
        ("fit.max_texel_ratio", "none"),
        ("fit.up_y", "1"),
        ("splits.count", "4"),
        ("splits.lambda", "0.5"),
        ("splits.manual_1", ""),
        ("stabilise.waste", "1.8"),
        ("map.resolution", "2048"),
        ("map.height", "square"),
        ("view.inset", "one"),
        ("view.play", "true"),
        ("view.mode", "final"),
        ("light.hour", "by_angles"),
    ] {
        assert_eq!(written(&settings, row(id)), text, "{id}");
    }
}

#[test]
fn numbers_clamp_and_ignore_what_is_not_finite() {
    for parameter in PARAMETERS {
        let start = settings_with(parameter);
        let Kind::Number(Number { min, max, .. }) = parameter.kind else { continue };
        let set = |value: f64| {
            let mut settings = start;
            parameter.set(&mut settings, Value::Number(value));
            settings
        };
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(set(value), start, "{} took {value}", parameter.id);
        }
        for (value, bound) in [(-1e30, min), (1e30, max)] {
            let read = parameter.number(&set(value)).expect("a number");
            // f32 and the radians round the bound.
            assert!((read - bound).abs() <= 1e-6 * bound.abs(), "{} = {read}", parameter.id);
        }
    }
}

#[test]
fn a_row_that_does_not_exist_is_written_as_nothing_and_ignores_what_it_is_given() {
    for parameter in PARAMETERS {
        for start in starts().into_iter().filter(|start| !parameter.is_present(start)) {
            let mut settings = start;
            change(&mut settings, parameter);
            parameter.copy(&mut settings, &settings_with(parameter));
            assert_eq!((settings, written(&start, parameter)), (start, String::new()), "{}", parameter.id);
            assert!((parameter.inert)(&start).is_some(), "{} says why", parameter.id);
        }
    }
}

#[test]
fn broken_settings_are_still_written_and_read() {
    for mut settings in starts() {
        settings.camera.near = f32::NAN;
        settings.camera.far = f32::INFINITY;
        settings.light.azimuth = f32::NEG_INFINITY;
        settings.light.elevation = f32::MAX;
        let technique = &mut settings.technique;
        technique.maps = technique.maps.with_count(u32::MAX);
        technique.fit.resolution = UVec2::new(0, 3);
        technique.fit.max_distance = -0.0;
        technique.fit.border = Some(f32::NAN);
        technique.fit.up = Vec3::INFINITY;
        if let Maps::Slices(slices) = &mut technique.maps {
            match &mut slices.splits {
                SplitScheme::Practical(lambda) => *lambda = f32::NAN,
                SplitScheme::Manual(ends) => ends[0] = f32::INFINITY,
                _ => {}
            }
        }
        for parameter in PARAMETERS {
            let is_written = !written(&settings, parameter).is_empty();
            assert_eq!(is_written, parameter.is_present(&settings), "{}", parameter.id);
            change(&mut settings, parameter);
        }
        for parameter in PARAMETERS {
            parameter.copy(&mut settings, &Settings::default());
        }
        assert_eq!(settings, Settings::default());
    }
}

#[test]
fn near_far_and_shadow_distance_move_each_other() {
    let mut settings = with(&[("fit.max_distance", "40"), ("camera.far", "20")]);
    let distances =
        |settings: &Settings| (settings.camera.near, settings.camera.far, settings.technique.fit.max_distance);
    row("camera.near").set(&mut settings, Value::Number(50.0));
    assert_eq!(distances(&settings), (50.0, 100.0, 100.0));
    row("camera.far").set(&mut settings, Value::Number(60.0));
    assert_eq!(distances(&settings), (30.0, 60.0, 100.0));
    set_from_str(&mut settings, "fit.max_distance", "10").expect("a distance");
    assert_eq!(distances(&settings), (5.0, 60.0, 10.0));
    set_from_str(&mut settings, "fit.max_distance", "far_plane").expect("no distance");
    assert_eq!(distances(&settings), (5.0, 60.0, f32::MAX));
}

#[test]
fn the_least_and_the_greatest_radius_move_each_other() {
    let mut settings = with(&[("softness.floor", "20")]);
    let radii = |settings: &Settings| (settings.technique.softness.floor, settings.technique.softness.ceiling);
    assert_eq!(radii(&settings), (20.0, 20.0));
    row("softness.ceiling").set(&mut settings, Value::Number(3.0));
    assert_eq!(radii(&settings), (3.0, 3.0));
    row("softness.ceiling").set(&mut settings, Value::Number(8.0));
    assert_eq!(radii(&settings), (3.0, 8.0));
}

#[test]
fn softness_keeps_its_width_when_it_is_measured_otherwise() {
    let mut settings = with(&[("softness.angle", "2")]);
    let width = |settings: &Settings| settings.technique.softness.metres(FilterKind::Vogel8);
    let before = width(&settings);
    for measure in ["metres", "sun_angle", "metres"] {
        set_from_str(&mut settings, "softness.measure", measure).expect("a measure");
        assert!((width(&settings) / before - 1.0).abs() < 1e-6, "{measure}");
    }
    assert!((written(&settings, row("softness.metres")).parse::<f32>().expect("a number") - before).abs() < 1e-6);
}

#[test]
fn another_filter_by_its_row_leaves_the_bias_as_it_is() {
    let before = Settings::default();
    for filter in ["point", "pcf_7x7", "vogel_16", "pcss"] {
        assert_eq!(with(&[("map.filter", filter)]).technique.bias, before.technique.bias, "{filter}");
    }
}

#[test]
fn an_azimuth_that_kept_counting_reads_as_a_compass_angle() {
    let mut settings = Settings::default();
    for (degrees, shown) in [(-90.0, 270.0), (370.0, 10.0), (3690.0, 90.0), (359.0, 359.0), (0.0, 0.0)] {
        settings.light.azimuth = f32::to_radians(degrees);
        let read = row("light.azimuth").number(&settings).expect("an angle");
        assert!((read - shown).abs() < 1e-3, "{degrees} reads {read}");
    }
}

/// Checks that a parameter of slices has an effect with some values, and says with a word why it has none once another one
/// is set.
fn loses_its_effect(id: &str, base: &[(&str, &str)], (other, option): (&str, &str), word: &str) {
    let mut settings = with(&[&[SLICES], base].concat());
    assert_eq!((row(id).inert)(&settings), None, "{id}");
    set_from_str(&mut settings, other, option).expect("an option");
    let reason = (row(id).inert)(&settings);
    assert!(reason.is_some_and(|reason| reason.contains(word)), "{id} with {other}={option}: {reason:?}");
}

#[test]
fn what_only_some_filters_and_formats_use_says_where_it_has_no_effect() {
    for (id, base, set, word) in [
        ("softness.measure", &[("map.filter", "pcss")][..], ("map.filter", "pcf_7x7"), "Filter"),
        ("softness.angle", &[("map.filter", "vogel_8")], ("map.filter", "point"), "Filter"),
        ("softness.angle", &[("map.filter", "vogel_8")], ("softness.measure", "metres"), "Angle of the sun"),
        (
            "softness.metres",
            &[("map.filter", "vogel_16"), ("softness.measure", "metres")],
            ("softness.measure", "sun_angle"),
            "Metres",
        ),
        ("softness.floor", &[("map.filter", "vogel_32")], ("map.filter", "hardware_2x2"), "Filter"),
        ("softness.ceiling", &[("map.filter", "pcss")], ("map.filter", "pcf_3x3"), "Filter"),
        ("map.fade", &[("fit.max_distance", "50")], ("fit.max_distance", "far_plane"), "Shadow distance"),
        ("bias.depth_steps", &[("map.format", "depth16_unorm")], ("map.format", "depth32float"), "Format"),
        ("bias.depth_steps", &[("map.format", "r16_float")], ("map.format", "r32float"), "Format"),
        ("bias.depth_steps", &[("map.format", "r8_grey")], ("map.format", "rgba8_packed"), "Format"),
    ] {
        loses_its_effect(id, base, set, word);
    }
}

#[test]
fn parameters_say_where_they_have_no_effect() {
    // Parameter, settings of slices with which it has an effect, one that takes it away, and a word of the reason.
    for (id, base, (other, option), word) in [
        ("fit.rectangle", &[][..], ("fit.kind", "xna_sample"), "focused"),
        ("fit.rectangle", &[], ("fit.kind", "frustum_aabb"), "focused"),
        ("fit.rectangle", &[], ("fit.kind", "sphere"), "focused"),
        ("fit.rectangle", &[], ("fit.kind", "windows"), "focused"),
        ("input.seen", &[], ("splits.scheme", "from_boxes"), "Splits"),
        ("input.seen", &[], ("splits.count", "1"), "Splits"),
        ("fit.casters", &[], ("fit.kind", "xna_sample"), "XNA"),
        ("fit.max_texel_ratio", &[], ("fit.kind", "windows"), "windows"),
        ("fit.max_texel_ratio", &[], ("fit.kind", "xna_sample"), "XNA"),
        ("fit.max_texel_ratio", &[], ("fit.kind", "sphere"), "sphere"),
        ("fit.max_texel_ratio", &[("map.height", "512")], ("fit.kind", "xna_sample"), "XNA"),
        ("fit.border", &[], ("fit.kind", "xna_sample"), "XNA"),
        ("fit.least_texel", &[], ("fit.kind", "xna_sample"), "XNA"),
        ("fit.caster_extension", &[("fit.casters", "extend")], ("fit.kind", "xna_sample"), "XNA"),
        ("fit.caster_extension", &[("fit.casters", "extend")], ("fit.casters", "none"), "By extension"),
        ("fit.caster_extension", &[("fit.casters", "extend")], ("fit.casters", "scene_bounds"), "By extension"),
        ("fit.caster_extension", &[("fit.casters", "extend")], ("fit.casters", "list"), "By extension"),
        ("fit.caster_extension", &[("fit.casters", "extend")], ("fit.casters", "depth_clamp"), "By extension"),
        ("splits.scheme", &[], ("splits.count", "1"), "number of maps"),
        ("splits.scheme", &[], ("fit.kind", "windows"), "Windows"),
        ("splits.choice", &[], ("splits.count", "1"), "number of maps"),
        ("splits.choice", &[], ("fit.kind", "windows"), "coverage"),
        ("splits.blend", &[("splits.choice", "view_depth"), ("fit.kind", "windows")], ("splits.count", "1"), "maps"),
        ("splits.blend", &[], ("splits.count", "1"), "number of maps"),
        ("splits.blend", &[], ("splits.choice", "view_depth"), "By coverage"),
        ("splits.overlap", &[("splits.choice", "view_depth")], ("splits.count", "1"), "number of maps"),
        ("splits.overlap", &[("splits.choice", "view_depth")], ("splits.choice", "coverage"), "By view depth"),
        ("splits.overlap", &[("splits.choice", "view_depth")], ("fit.kind", "windows"), "Windows"),
        ("splits.lambda", &[("splits.scheme", "practical")], ("splits.count", "1"), "number of maps"),
        ("splits.lambda", &[("splits.scheme", "practical")], ("fit.kind", "windows"), "Windows"),
        ("splits.lambda", &[("splits.scheme", "practical")], ("splits.scheme", "uniform"), "Practical"),
        ("splits.manual_3", &[("splits.scheme", "manual")], ("splits.count", "3"), "number of maps"),
        ("splits.manual_3", &[("splits.scheme", "manual")], ("splits.scheme", "from_boxes"), "Manual"),
        ("splits.manual_3", &[("splits.scheme", "manual")], ("fit.kind", "windows"), "Windows"),
        ("stabilise.mode", &[], ("fit.kind", "windows"), "Windows"),
        ("stabilise.margin", &[], ("stabilise.mode", "snap"), "Stabilise"),
        ("stabilise.margin", &[], ("fit.kind", "windows"), "Windows"),
        ("stabilise.growth", &[], ("stabilise.mode", "off"), "Stabilise"),
        ("stabilise.horizon", &[], ("stabilise.mode", "snap"), "Stabilise"),
        ("stabilise.waste", &[], ("stabilise.mode", "off"), "Stabilise"),
    ] {
        loses_its_effect(id, base, (other, option), word);
    }
}

#[test]
fn a_parameter_that_says_it_has_no_effect_has_none_and_the_others_have_one() {
    let view = PerspectiveCamera {
        eye: DVec3::ZERO,
        forward: Vec3::new(0.3, -0.2, -0.9),
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: 1.6,
        near: 0.1,
        far: 150.0,
    };
    let views = [view.frustum().expect("a frustum")];
    let objects = [
        Aabb::new(Vec3::new(-60.0, -3.0, -120.0), Vec3::new(15.0, -2.0, 5.0)),
        Aabb::new(Vec3::new(-9.0, 12.0, -25.0), Vec3::new(9.0, 14.0, -8.0)),
        Aabb::new(Vec3::new(30.0, 30.0, 30.0), Vec3::new(31.0, 31.0, 31.0)),
    ];
    let boxes = Boxes { origin: DVec3::ZERO, boxes: &objects };
    let input =
        FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, Vec3::new(0.4, -0.7, 0.3)) };
    let map = |settings: &Settings| {
        let mut storage = [Default::default(); Scratch::required(3, 1)];
        // What all windows together hold.
        let whole = Shape::default().with_rectangle(RectangleKind::AxisAligned);
        let shape = settings.technique.maps.shape().unwrap_or(whole);
        let settings = FitSettings { shape, map: settings.technique.fit };
        shadowfit::fit_scene(&input, &settings, &mut Scratch::new(&mut storage)).expect("a fit")
    };
    let Kind::Choice(kinds) = row("fit.kind").kind else { panic!("fits are options") };
    // y alone is up already, at any length.
    let others = ["fit.kind", "fit.up_y"];
    for kind in kinds {
        for parameter in Group::Fit.parameters().filter(|parameter| !others.contains(&parameter.id)) {
            let mut settings = with(&[("fit.kind", kind.id)]);
            let before = map(&settings);
            let reason = (parameter.inert)(&settings);
            // A limit that this view is sure to exceed.
            if parameter.id == "fit.max_texel_ratio" {
                parameter.set(&mut settings, Value::Number(1.0));
            } else {
                change(&mut settings, parameter);
            }
            assert_eq!(map(&settings) == before, reason.is_some(), "{} with {}: {reason:?}", parameter.id, kind.id);
        }
    }
}

#[test]
fn errors_name_the_id_the_value_and_what_is_allowed() {
    for (id, value, words) in [
        ("bias.nrmal", "1", &["bias.nrmal", "bias.normal_offset", "view.play"][..]),
        ("bias.slope", "steep", &["bias.slope", "steep", "0 to 16 texels"]),
        ("bias.slope", "17", &["bias.slope", "17", "0 to 16 texels"]),
        ("bias.slope", "NaN", &["bias.slope", "NaN", "0 to 16 texels"]),
        ("bias.slope", "inf", &["bias.slope", "inf", "0 to 16 texels"]),
        ("bias.slope", "", &["bias.slope", "\"\"", "0 to 16 texels"]),
        ("map.resolution", "20", &["map.resolution", "20", "256 to 8192 texels"]),
        ("map.resolution", "2000.5", &["map.resolution", "2000.5", "a whole number", "256 to 8192 texels"]),
        ("splits.count", "9", &["splits.count", "9", "a whole number from 1 to 8"]),
        ("fit.border", "wide", &["fit.border", "wide", "0 to 32 texels, or auto"]),
        ("fit.max_distance", "0", &["fit.max_distance", "0", "1 to 100000 m, or far_plane"]),
        ("fit.casters", "some", &["fit.casters", "some", "list, extend, scene_bounds, depth_clamp, none"]),
        ("splits.lambda", "2", &["splits.lambda", "2", "0 to 1"]),
        ("view.play", "maybe", &["view.play", "maybe", "true or false"]),
    ] {
        let mut settings = Settings::default();
        let message = set_from_str(&mut settings, id, value).expect_err(value).to_string();
        for word in words {
            assert!(message.contains(word), "{message:?} lacks {word:?}");
        }
        assert_eq!(settings, Settings::default());
    }
}

#[test]
fn setting_a_row_that_does_not_exist_is_an_error_that_names_what_to_set_first() {
    for (id, value, first, option) in [
        ("splits.lambda", "0.3", "splits.scheme", "practical"),
        ("softness.metres", "0.3", "softness.measure", "metres"),
        ("view.inset_white", "0.5", "view.inset_black", "0.25"),
        ("splits.manual_1", "3", "splits.scheme", "manual"),
        ("splits.manual_7", "300", "splits.scheme", "manual"),
    ] {
        let slices = with(&[SLICES]);
        let mut settings = slices;
        let error = set_from_str(&mut settings, id, value).expect_err(id);
        assert!(matches!(error, params::ParameterError::NotPresent { .. }), "{error:?}");
        assert!(error.to_string().contains(id) && error.to_string().contains(first), "{error}");
        assert_eq!(settings, slices);
        set_from_str(&mut settings, first, option).expect(first);
        set_from_str(&mut settings, id, value).expect(id);
        assert_eq!(written(&settings, row(id)), value, "{id}");
    }
}

#[test]
fn a_technique_takes_its_own_rows_and_says_which_these_are() {
    let mut technique = Technique::default();
    set_technique_from_str(&mut technique, "map.filter", "point").expect("a filter");
    assert_eq!(technique, Technique { filter: FilterKind::Point, ..Technique::default() });
    let message = set_technique_from_str(&mut technique, "light.elevation", "30").expect_err("the sun").to_string();
    assert!(message.contains("light.elevation") && message.contains("map.filter"), "{message}");
    assert!(!message.contains("light.azimuth"), "{message}");
}

#[test]
fn values_may_be_surrounded_by_spaces() {
    let settings = with(&[("view.play", " off "), ("camera.speed", "\t12.5\n"), ("fit.border", " auto")]);
    assert!(!settings.view.play && settings.camera.speed == 12.5);
}
