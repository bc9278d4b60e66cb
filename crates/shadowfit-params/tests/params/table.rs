//! The rows: their ids and texts, the field of each, and the rows that change one another.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;

use shadowfit::glam::UVec2;
use shadowfit::settings::{
    CasterPolicy, Edges, FilterKind, FitKind, MapFormat, RectangleKind, SoftRadius, SplitScheme, Stabilise,
};
use shadowfit::{DepthConvention, Technique};
use shadowfit_params::tool::Settings;
use shadowfit_params::{
    self as params, BoxSource, Group, Kind, Number, PARAMETERS, Value, set_from_str, set_technique_from_str,
    technique_parameters,
};

use crate::{SLICES, change, row, settings_with, starts, with, written};

/// Returns every field of the settings by its path, with its value, parsed from the lines of the debug
/// output.
fn leaves(settings: &Settings) -> BTreeMap<String, String> {
    let mut leaves = BTreeMap::new();
    // The names of the open structs and lists, with the number of their lines.
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

/// Checks the options of a choice and the value that each of them sets.
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
    check("fit.rectangle", |t| t.maps.as_cascades().shape.rectangle, &rectangles);
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
    check("splits.scheme", |t| t.maps.as_cascades().splits, &splits);
    let snap = Stabilise::Snap { max_oversize: Stabilise::default().max_oversize() };
    let modes = [("hysteresis", Stabilise::default()), ("snap", snap), ("off", Stabilise::Off)];
    check("stabilise.mode", |t| t.maps.as_cascades().stabilise, &modes);
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
        ("depth24_unorm", MapFormat::Depth24Unorm),
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
    check("map.edges", |t| t.edges.samples(), &[("filtered", 0), ("traced", Edges::USUAL_SAMPLES)]);
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
fn any_camera_and_sun_of_a_file_can_be_chosen() {
    let settings = with(&[("camera.file", "65"), ("light.file", "1000")]);
    assert_eq!((settings.camera.file, settings.light.file), (Some(65), Some(1000)));
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
    // The widest edges in metres exceed the table's largest sun. The value that is set can be read back.
    let widest = with(&[("softness.measure", "metres"), ("softness.metres", "10"), ("softness.measure", "sun_angle")]);
    assert_eq!(widest, with(&[("softness.angle", &written(&widest, row("softness.angle")))]));
}

#[test]
fn the_number_of_rays_is_there_while_edges_are_traced_and_stays_when_they_are_traced_again() {
    let rays = row("map.edge_samples");
    assert!(!rays.is_present(&Settings::default()) && rays.is_of_choice());
    let mut settings = with(&[("map.edges", "traced"), ("map.edge_samples", "16"), ("map.edges", "traced")]);
    assert_eq!(settings.technique.edges, Edges::Traced { samples: 16 });
    assert!(set_from_str(&mut settings, "map.edge_samples", "65").is_err());
    let preset = Technique::preset("exact-4").expect("a preset");
    assert_eq!(preset, with(&[("map.edges", "traced")]).technique);
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

#[test]
fn a_technique_takes_its_own_rows_and_says_which_these_are() {
    let mut technique = Technique::default();
    set_technique_from_str(&mut technique, "map.filter", "point").expect("a filter");
    assert_eq!(technique, Technique { filter: FilterKind::Point, ..Technique::default() });
    let message = set_technique_from_str(&mut technique, "light.elevation", "30").expect_err("the sun").to_string();
    assert!(message.contains("light.elevation") && message.contains("map.filter"), "{message}");
    assert!(!message.contains("light.azimuth"), "{message}");
}
