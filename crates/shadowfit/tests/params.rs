//! The parameter table is complete and safe to drive from files and command lines.

use shadowfit::params::{self, Group, Kind, PARAMETERS, Parameter, format_value, set_from_str};
use shadowfit::{
    Aabb, BiasSettings, Boxes, CameraSettings, CasterPolicy, DepthConvention, FilterKind, FitInput, FitKind,
    FitSettings, LightSettings, MapFormat, PerspectiveCamera, RectangleKind, Settings, ViewSettings, Workspace,
    glam::{DVec3, UVec2, Vec3},
};

fn written(settings: &Settings, parameter: &Parameter) -> String {
    let mut text = String::new();
    format_value(settings, parameter, &mut text).expect("a string takes any text");
    text
}

/// Gives the parameter a value that is not its present one.
fn change(settings: &mut Settings, parameter: &Parameter) {
    match &parameter.kind {
        Kind::Number(number) => {
            let middle = 0.5 * (number.min + number.max);
            number.set(settings, if number.get(settings) == middle { number.max } else { middle });
        }
        Kind::Choice(choice) => choice.set(settings, (choice.get(settings) + 1) % choice.options.len()),
        Kind::Toggle(toggle) => toggle.set(settings, !toggle.get(settings)),
    }
}

fn number(id: &str) -> &'static params::Number {
    match &params::parameter(id).expect(id).kind {
        Kind::Number(number) => number,
        _ => panic!("{id} is no number"),
    }
}

#[test]
fn every_row_changes_the_settings() {
    for parameter in PARAMETERS {
        let mut settings = Settings::default();
        change(&mut settings, parameter);
        assert_ne!(settings, Settings::default(), "{}", parameter.id);
        assert!(!parameter.is_equal(&settings, &Settings::default()), "{}", parameter.id);
        parameter.copy(&mut settings, &Settings::default());
        assert!(parameter.is_equal(&settings, &Settings::default()), "{}", parameter.id);
    }
}

#[test]
fn every_field_is_reached_by_a_row() {
    let mut all = Settings::default();
    for parameter in PARAMETERS {
        change(&mut all, parameter);
    }
    // Without `..`, so that a new field does not compile until it is looked at here.
    let Settings { fit, bias, filter, format, light, camera, view } = all;
    let old = Settings::default();
    let FitSettings { kind, rectangle, max_distance, margin, border, casters, caster_extension, up, resolution, depth } =
        fit;
    assert!(kind != old.fit.kind && depth != old.fit.depth && resolution.x == resolution.y);
    assert!(resolution != old.fit.resolution && max_distance != old.fit.max_distance);
    assert!(margin != old.fit.margin && caster_extension != old.fit.caster_extension);
    assert!(rectangle != old.fit.rectangle && casters != old.fit.casters && border != old.fit.border.unwrap_or(3.0));
    assert_eq!(up, old.fit.up, "which way is up belongs to the world, and no person tunes it");
    let BiasSettings { constant, slope, normal_offset, receiver_plane } = bias;
    assert!(constant != old.bias.constant && slope != old.bias.slope && normal_offset != old.bias.normal_offset);
    assert!(receiver_plane != old.bias.receiver_plane);
    assert!(filter != old.filter && format != old.format);
    let LightSettings { azimuth, elevation, animate, animate_speed } = light;
    assert!(azimuth != old.light.azimuth && elevation != old.light.elevation);
    assert!(animate != old.light.animate && animate_speed != old.light.animate_speed);
    let CameraSettings { fov_y, near, far, speed } = camera;
    assert!(fov_y != old.camera.fov_y && near != old.camera.near);
    assert!(far != old.camera.far && speed != old.camera.speed);
    let ViewSettings { shadows, inset, outside, freeze_fit, play } = view;
    assert!(shadows != old.view.shadows && inset != old.view.inset && outside != old.view.outside);
    assert!(freeze_fit != old.view.freeze_fit && play != old.view.play);
}

#[test]
fn options_reach_every_variant_and_resolution() {
    let reached = |id: &str, option: &str| {
        let mut settings = Settings::default();
        set_from_str(&mut settings, id, option).expect(option);
        settings
    };
    assert_eq!(reached("fit.kind", "xna_sample").fit.kind, FitKind::XnaSample);
    assert_eq!(reached("fit.kind", "frustum_aabb").fit.kind, FitKind::FrustumAabb);
    assert_eq!(reached("fit.kind", "oriented").fit.kind, FitKind::Oriented);
    assert_eq!(reached("fit.kind", "sphere").fit.kind, FitKind::Sphere);
    assert_eq!(reached("fit.kind", "focused").fit.kind, FitKind::Focused);
    assert_eq!(reached("fit.rectangle", "minimum_area").fit.rectangle, RectangleKind::MinimumArea);
    assert_eq!(reached("fit.rectangle", "minimum_square").fit.rectangle, RectangleKind::MinimumSquare);
    assert_eq!(reached("fit.rectangle", "axis_aligned").fit.rectangle, RectangleKind::AxisAligned);
    assert_eq!(reached("fit.casters", "none").fit.casters, CasterPolicy::None);
    assert_eq!(reached("fit.casters", "extend").fit.casters, CasterPolicy::Extend);
    assert_eq!(reached("fit.casters", "scene_bounds").fit.casters, CasterPolicy::SceneBounds);
    assert_eq!(reached("fit.casters", "list").fit.casters, CasterPolicy::List);
    assert_eq!(reached("fit.casters", "depth_clamp").fit.casters, CasterPolicy::DepthClamp);
    assert_eq!(reached("map.format", "r32float").format, MapFormat::R32Float);
    assert_eq!(reached("map.format", "depth32float").format, MapFormat::Depth32Float);
    assert_eq!(reached("map.filter", "point").filter, FilterKind::Point);
    assert_eq!(reached("map.filter", "hardware_2x2").filter, FilterKind::Hardware2x2);
    assert_eq!(reached("map.filter", "pcf_3x3").filter, FilterKind::Pcf3x3);
    assert_eq!(reached("map.filter", "pcf_5x5").filter, FilterKind::Pcf5x5);
    assert_eq!(reached("map.depth", "zero_to_one").fit.depth, DepthConvention::ZeroToOne);
    assert_eq!(reached("map.depth", "reversed").fit.depth, DepthConvention::Reversed);
    assert_eq!(reached("map.depth", "negative_one_to_one").fit.depth, DepthConvention::NegativeOneToOne);
    for side in [256, 512, 1024, 2048, 4096, 8192] {
        assert_eq!(reached("map.resolution", &side.to_string()).fit.resolution, UVec2::splat(side));
    }
}

#[test]
fn ids_are_unique_and_begin_with_their_group() {
    for (index, parameter) in PARAMETERS.iter().enumerate() {
        assert!(PARAMETERS[..index].iter().all(|other| other.id != parameter.id), "{}", parameter.id);
        assert_eq!(parameter.id.split_once('.').map(|(group, _)| group), Some(parameter.group.id()));
        assert!(core::ptr::eq(params::parameter(parameter.id).expect("found by its id"), parameter));
    }
    let listed: usize = Group::ALL.iter().map(|group| group.parameters().count()).sum();
    assert_eq!(listed, PARAMETERS.len());
}

#[test]
fn rows_speak_to_people() {
    for parameter in PARAMETERS {
        assert!(!parameter.label.is_empty() && parameter.help.ends_with('.'), "{}", parameter.id);
        assert!(!parameter.help.contains("  "), "{}: a line break left a gap", parameter.id);
        if let Kind::Choice(choice) = &parameter.kind {
            assert!(choice.options.len() > 1 && choice.options.iter().all(|option| option.help.ends_with('.')));
        }
    }
}

#[test]
fn defaults_and_steps_lie_within_the_ranges() {
    let settings = Settings::default();
    for parameter in PARAMETERS {
        if let Kind::Number(number) = &parameter.kind {
            let value = number.get(&settings);
            assert!(number.min <= value && value <= number.max, "{} = {value}", parameter.id);
            assert!(number.step > 0.0 && number.step < number.max - number.min, "{}", parameter.id);
        }
    }
}

#[test]
fn values_survive_text_to_the_bit() {
    for parameter in PARAMETERS {
        for share in [0.0, 0.001, 1.0 / 3.0, 0.5, 0.77, 1.0] {
            let mut settings = Settings::default();
            match &parameter.kind {
                Kind::Number(number) => number.set(&mut settings, number.min + share * (number.max - number.min)),
                _ => change(&mut settings, parameter),
            }
            let text = written(&settings, parameter);
            let mut restored = settings;
            change(&mut restored, parameter);
            set_from_str(&mut restored, parameter.id, &text).expect("what was written is read");
            assert!(parameter.is_equal(&restored, &settings), "{} = {text}", parameter.id);
        }
    }
}

#[test]
fn all_defaults_survive_text_in_any_order() {
    let defaults = Settings::default();
    let mut forward = Settings::default();
    for parameter in PARAMETERS {
        change(&mut forward, parameter);
    }
    let mut backward = forward;
    for parameter in PARAMETERS {
        set_from_str(&mut forward, parameter.id, &written(&defaults, parameter)).expect(parameter.id);
    }
    for parameter in PARAMETERS.iter().rev() {
        set_from_str(&mut backward, parameter.id, &written(&defaults, parameter)).expect(parameter.id);
    }
    assert_eq!((forward, backward), (defaults, defaults));
}

#[test]
fn numbers_are_written_short() {
    let mut settings = Settings::default();
    settings.light.elevation = 30_f32.to_radians();
    settings.light.azimuth = core::f32::consts::TAU;
    for (id, text) in [
        ("light.elevation", "30"),
        ("light.azimuth", "360"),
        ("camera.fov_y", "45"),
        ("camera.near", "0.1"),
        ("fit.max_distance", "40"),
        ("map.resolution", "2048"),
        ("view.inset", "true"),
    ] {
        assert_eq!(written(&settings, params::parameter(id).expect(id)), text);
    }
}

#[test]
fn numbers_clamp_and_ignore_what_is_not_finite() {
    for parameter in PARAMETERS {
        let Kind::Number(number) = &parameter.kind else { continue };
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut settings = Settings::default();
            number.set(&mut settings, value);
            assert_eq!(settings, Settings::default(), "{} took {value}", parameter.id);
        }
        for (value, bound) in [(-1e30, number.min), (1e30, number.max)] {
            let mut settings = Settings::default();
            number.set(&mut settings, value);
            // f32 and the radians round the bound.
            assert!((number.get(&settings) - bound).abs() <= 1e-6 * bound.abs(), "{}", parameter.id);
        }
    }
}

#[test]
fn broken_settings_are_still_written_and_read() {
    let mut settings = Settings::default();
    settings.camera.near = f32::NAN;
    settings.camera.far = f32::INFINITY;
    settings.light.azimuth = f32::NEG_INFINITY;
    settings.light.elevation = f32::MAX;
    settings.fit.resolution = UVec2::new(0, 3);
    settings.fit.max_distance = -0.0;
    for parameter in PARAMETERS {
        assert!(!written(&settings, parameter).is_empty(), "{}", parameter.id);
        change(&mut settings, parameter);
    }
    for parameter in PARAMETERS {
        parameter.copy(&mut settings, &Settings::default());
    }
    assert_eq!(settings, Settings::default());
}

#[test]
fn near_far_and_shadow_distance_move_each_other() {
    let mut settings = Settings::default();
    settings.camera.far = 20.0;
    number("camera.near").set(&mut settings, 50.0);
    assert_eq!((settings.camera.near, settings.camera.far, settings.fit.max_distance), (50.0, 100.0, 100.0));
    number("camera.far").set(&mut settings, 60.0);
    assert_eq!((settings.camera.near, settings.camera.far, settings.fit.max_distance), (30.0, 60.0, 100.0));
    number("fit.max_distance").set(&mut settings, 10.0);
    assert_eq!((settings.camera.near, settings.camera.far, settings.fit.max_distance), (5.0, 60.0, 10.0));
}

#[test]
fn an_azimuth_that_kept_counting_reads_as_a_compass_angle() {
    let mut settings = Settings::default();
    for (degrees, shown) in [(-90.0, 270.0), (370.0, 10.0), (3690.0, 90.0), (359.0, 359.0), (0.0, 0.0)] {
        settings.light.azimuth = f32::to_radians(degrees);
        let read = number("light.azimuth").get(&settings);
        assert!((read - shown).abs() < 1e-3, "{degrees} reads {read}");
    }
}

#[test]
fn knobs_of_the_fit_say_where_they_have_no_effect() {
    // Knob, a setting that leaves it without effect, and a word of the reason.
    for (id, other, option, word) in [
        ("fit.rectangle", "fit.kind", "xna_sample", "focused"),
        ("fit.rectangle", "fit.kind", "frustum_aabb", "focused"),
        ("fit.rectangle", "fit.kind", "sphere", "focused"),
        ("fit.casters", "fit.kind", "xna_sample", "XNA"),
        ("fit.border", "fit.kind", "xna_sample", "XNA"),
        ("fit.caster_extension", "fit.kind", "xna_sample", "XNA"),
        ("fit.caster_extension", "fit.casters", "none", "By extension"),
        ("fit.caster_extension", "fit.casters", "scene_bounds", "By extension"),
        ("fit.caster_extension", "fit.casters", "list", "By extension"),
        ("fit.caster_extension", "fit.casters", "depth_clamp", "By extension"),
    ] {
        let mut settings = Settings::default();
        set_from_str(&mut settings, "fit.kind", "focused").expect("a fit");
        let inert = |settings: &Settings| (params::parameter(id).expect("a row").inert)(settings);
        assert_eq!(inert(&settings), None, "{id}");
        set_from_str(&mut settings, other, option).expect("an option");
        assert!(inert(&settings).is_some_and(|reason| reason.contains(word)), "{id} with {other}={option}");
    }
}

#[test]
fn a_knob_that_says_it_has_no_effect_has_none_and_the_others_have_one() {
    let view = PerspectiveCamera {
        eye: DVec3::ZERO,
        forward: Vec3::new(0.3, -0.2, -0.9),
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: 1.6,
        near: 0.1,
        far: 100.0,
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
        let mut storage = [Default::default(); Workspace::required(3, 1)];
        shadowfit::fit_scene(&input, &settings.fit, &mut Workspace::new(&mut storage)).expect("a fit")
    };
    let Kind::Choice(kinds) = &params::parameter("fit.kind").expect("a row").kind else { panic!("fits are options") };
    for kind in kinds.options {
        for parameter in Group::Fit.parameters().filter(|parameter| parameter.id != "fit.kind") {
            let mut settings = Settings::default();
            set_from_str(&mut settings, "fit.kind", kind.id).expect("an option");
            let before = map(&settings);
            let reason = (parameter.inert)(&settings);
            change(&mut settings, parameter);
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
        ("map.resolution", "2000", &["map.resolution", "2000", "256, 512, 1024, 2048, 4096, 8192"]),
        ("view.inset", "maybe", &["view.inset", "maybe", "true or false"]),
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
fn values_may_be_surrounded_by_spaces() {
    let mut settings = Settings::default();
    set_from_str(&mut settings, "view.inset", " off ").expect("off is a value");
    set_from_str(&mut settings, "camera.speed", "\t12.5\n").expect("12.5 is a value");
    assert!(!settings.view.inset && settings.camera.speed == 12.5);
}
