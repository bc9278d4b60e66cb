//! Rows whose settings have no effect, and the reasons that they give.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::{FitSettings, RectangleKind, Shape};
use shadowfit::{Aabb, Boxes, FitInput, PerspectiveCamera, Scratch};
use shadowfit_params::tool::Settings;
use shadowfit_params::{Group, Kind, Value, set_from_str};

use crate::{SLICES, change, row, with};

/// Checks that a parameter of cascades has an effect with some values, and gives a reason with this word once
/// another parameter is set.
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
        ("map.edge_samples", &[("map.edges", "traced")], ("map.edges", "filtered"), "Edges"),
        ("map.fade", &[("fit.max_distance", "50")], ("fit.max_distance", "far_plane"), "Shadow distance"),
    ] {
        loses_its_effect(id, base, set, word);
    }
}

#[test]
fn parameters_say_where_they_have_no_effect() {
    // Parameter, cascade settings with which it has an effect, a setting that removes the effect, and a word
    // of the reason.
    for (id, base, (other, option), word) in [
        ("fit.rectangle", &[][..], ("fit.kind", "xna_sample"), "focused"),
        ("fit.rectangle", &[], ("fit.kind", "frustum_aabb"), "focused"),
        ("fit.rectangle", &[], ("fit.kind", "sphere"), "focused"),
        ("fit.rectangle", &[], ("fit.kind", "windows"), "focused"),
        ("input.visible_demand", &[], ("splits.scheme", "from_boxes"), "Splits"),
        ("input.visible_demand", &[], ("splits.count", "1"), "Splits"),
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
        ("splits.selection", &[], ("splits.count", "1"), "number of maps"),
        ("splits.selection", &[], ("fit.kind", "windows"), "coverage"),
        ("splits.blend", &[("splits.selection", "view_depth"), ("fit.kind", "windows")], ("splits.count", "1"), "maps"),
        ("splits.blend", &[], ("splits.count", "1"), "number of maps"),
        ("splits.blend", &[], ("splits.selection", "view_depth"), "By coverage"),
        ("splits.overlap", &[("splits.selection", "view_depth")], ("splits.count", "1"), "number of maps"),
        ("splits.overlap", &[("splits.selection", "view_depth")], ("splits.selection", "coverage"), "By view depth"),
        ("splits.overlap", &[("splits.selection", "view_depth")], ("fit.kind", "windows"), "Windows"),
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
        ("stabilise.max_oversize", &[], ("stabilise.mode", "off"), "Stabilise"),
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
    let boxes = Boxes::world(&objects);
    let input =
        FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, Vec3::new(0.4, -0.7, 0.3)) };
    let map = |settings: &Settings| {
        let mut storage = [Default::default(); Scratch::required(3, 1)];
        // The area that all windows together cover.
        let whole = Shape::default().with_rectangle(RectangleKind::AxisAligned);
        let shape = settings.technique.maps.shape().unwrap_or(whole);
        let settings = FitSettings { shape, map: settings.technique.fit };
        shadowfit::fit_scene(&input, &settings, &mut Scratch::new(&mut storage)).expect("a fit")
    };
    let Kind::Choice(kinds) = row("fit.kind").kind else { panic!("fits are options") };
    // y is the up direction already, at any length.
    let others = ["fit.kind", "fit.up_y"];
    for kind in kinds {
        for parameter in Group::Fit.parameters().filter(|parameter| !others.contains(&parameter.id)) {
            let mut settings = with(&[("fit.kind", kind.id)]);
            let before = map(&settings);
            let reason = (parameter.inert)(&settings);
            // A limit that this view certainly exceeds.
            if parameter.id == "fit.max_texel_ratio" {
                parameter.set(&mut settings, Value::Number(1.0));
            } else {
                change(&mut settings, parameter);
            }
            assert_eq!(map(&settings) == before, reason.is_some(), "{} with {}: {reason:?}", parameter.id, kind.id);
        }
    }
}
