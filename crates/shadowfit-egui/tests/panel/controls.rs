//! The controls of the parameters.

use std::collections::BTreeSet;

use egui::Vec2;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::{Harness, Node};
use shadowfit::glam::UVec2;
use shadowfit::settings::{
    CasterPolicy, Edges, FilterKind, FitKind, MAX_MAPS, MapFormat, MapSelection, SoftRadius, SplitScheme,
};
use shadowfit::{Cascades, Maps, Technique};
use shadowfit_egui::Panel;
use shadowfit_params::tool::{InsetMaps, Settings};
use shadowfit_params::{Kind, Number, PARAMETERS, Value, parameter};

use crate::host::{
    Host, INSET_MAP, control, harness, harness_with, inset_button, number, open_harness, query_control, texts,
    type_into, unset_box, wait_for_the_tooltip,
};

/// Returns settings of cascades with which every row is shown and active, except the rows of other choices: λ
/// or the manual splits, blend or overlap, and the other measure of softness.
pub(crate) fn everything(splits: SplitScheme) -> Settings {
    let mut settings = Settings::default();
    let technique = &mut settings.technique;
    technique.maps = Cascades { count: MAX_MAPS as u32, splits, ..Cascades::default() }.into();
    technique.fit.resolution = UVec2::new(2048, 1024);
    (technique.fit.max_distance, technique.fit.border) = (100.0, Some(3.0));
    technique.fit.casters = CasterPolicy::Extend;
    technique.edges = Edges::Traced { samples: 4 };
    // So that softness and depth steps have an effect.
    (technique.filter, technique.format) = (FilterKind::Vogel16, MapFormat::Depth16Unorm);
    settings.light.animate = true;
    settings.view.inset_depths = Some([0.1, 0.9]);
    settings
}

/// Returns three settings that together show all rows, each row active in at least one.
pub(crate) fn all_rows() -> [Settings; 3] {
    let manual = SplitScheme::Manual([5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 320.0]);
    let mut settings = [SplitScheme::Practical(0.5), manual, SplitScheme::FromHistogram].map(everything);
    let by_view_depth = Cascades { selection: MapSelection::ViewDepth { overlap: 0.1 }, ..cascades(&settings[1]) };
    settings[1].technique.maps = by_view_depth.into();
    settings[2].technique.maps = settings[2].technique.maps.as_windows().into();
    settings[2].technique.softness.radius = SoftRadius::Metres(0.05);
    settings[2].light.hour = Some(10.0);
    settings
}

/// Returns the cascades of settings.
fn cascades(settings: &Settings) -> Cascades {
    let Maps::Cascades(cascades) = settings.technique.maps else { panic!("they have cascades") };
    cascades
}

#[test]
fn every_parameter_has_a_control_with_its_label() {
    let mut seen = BTreeSet::new();
    for settings in all_rows() {
        let harness = open_harness(Host { settings, ..Host::default() });
        for parameter in PARAMETERS {
            if parameter.is_present(&settings) {
                assert!(control(&harness, parameter).rect().is_positive(), "{}", parameter.id);
                seen.insert(parameter.id);
            } else {
                assert!(query_control(&harness, parameter).is_none(), "{}", parameter.id);
            }
        }
    }
    assert_eq!(seen.len(), PARAMETERS.len());
}

#[test]
fn showing_the_panel_changes_no_setting() {
    let mut settings = Settings::default();
    settings.technique.bias.normal_offset = 1.234_567;
    settings.technique.fit.resolution = UVec2::new(641, 481);
    settings.technique.fit.border = Some(1.234_567);
    settings.technique.maps = Cascades::default().with_splits(SplitScheme::Practical(0.123_456_7)).into();
    settings.camera.speed = 1e9;
    settings.view.inset_map = 7;
    let mut harness = open_harness(Host { settings, ..Host::default() });
    harness.run();
    assert_eq!(harness.state().settings, settings);
}

#[test]
fn a_setting_that_is_nan_goes_back_to_its_default() {
    let mut settings = Settings::default();
    settings.light.elevation = f32::NAN;
    settings.technique.fit.border = Some(f32::NAN);
    let harness = open_harness(Host { settings, ..Host::default() });
    assert_eq!(harness.state().settings, Settings::default());
}

#[test]
fn typed_numbers_are_set_in_the_shown_unit_and_clamped() {
    let mut harness = open_harness(Host::default());
    type_into(&mut harness, "bias.normal_offset", "1.5");
    assert_eq!(harness.state().settings.technique.bias.normal_offset, 1.5);
    type_into(&mut harness, "bias.normal_offset", "99");
    assert_eq!(harness.state().settings.technique.bias.normal_offset, 16.0);
    type_into(&mut harness, "light.elevation", "30");
    assert_eq!(harness.state().settings.light.elevation, 30_f32.to_radians());
    type_into(&mut harness, "camera.near", "-1");
    assert_eq!(harness.state().settings.camera.near, 1e-6);
    type_into(&mut harness, "camera.near", "nonsense");
    assert_eq!(harness.state().settings.camera.near, 1e-6);
}

#[test]
fn dragged_sliders_set_and_clamp_every_number() {
    let mut dragged = BTreeSet::new();
    for settings in all_rows() {
        let mut harness = open_harness(Host { settings, ..Host::default() });
        for parameter in PARAMETERS.iter().filter(|parameter| parameter.id != INSET_MAP) {
            let Some((_, max, _)) = number(parameter, &settings) else { continue };
            if (parameter.inert)(&settings).is_some() {
                continue;
            }
            harness.state_mut().settings = settings;
            harness.run();
            let rect = control(&harness, parameter).rect();
            harness.drag_at(rect.center());
            harness.run();
            harness.hover_at(rect.right_center() + Vec2::new(200.0, 0.0));
            harness.run();
            harness.drop_at(rect.right_center() + Vec2::new(200.0, 0.0));
            harness.run();
            let (_, _, value) = number(parameter, &harness.state().settings).expect("it is still there");
            assert!((value - max).abs() <= 1e-6 * max, "{} = {value}", parameter.id);
            dragged.insert(parameter.id);
        }
    }
    let numbers = |settings| PARAMETERS.iter().filter(move |parameter| number(parameter, &settings).is_some());
    for parameter in all_rows().into_iter().flat_map(numbers).filter(|parameter| parameter.id != INSET_MAP) {
        assert!(dragged.contains(parameter.id), "{} has no effect anywhere", parameter.id);
    }
}

#[test]
fn whole_numbers_are_dragged_and_typed_in_whole_steps() {
    let mut harness = open_harness(Host { settings: everything(SplitScheme::Uniform), ..Host::default() });
    let frames = parameter("stabilise.horizon").expect("a row");
    for step in 1..20 {
        let rect = control(&harness, frames).rect();
        let place = rect.left_center() + Vec2::new(rect.width() * step as f32 / 20.0, 0.0);
        harness.drag_at(place);
        harness.run();
        harness.drop_at(place);
        harness.run();
        let value = frames.number(&harness.state().settings).expect("a number");
        assert_eq!(value, value.round());
    }
    type_into(&mut harness, "map.resolution", "1536");
    assert_eq!(harness.state().settings.technique.fit.resolution.x, 1536);
}

#[test]
fn check_boxes_and_lists_set_their_parameters() {
    // The focused fit, with which every list has an effect.
    let focused = everything(SplitScheme::FromHistogram);
    let mut harness = open_harness(Host::default());
    for parameter in PARAMETERS {
        harness.state_mut().settings = focused;
        harness.run();
        match &parameter.kind {
            Kind::Number(_) => continue,
            Kind::Toggle => control(&harness, parameter).click(),
            Kind::Choice(options) => {
                let Some(Value::Option(index)) = parameter.get(&focused) else { panic!("{}", parameter.id) };
                let next = options[(index + 1) % options.len()].label;
                control(&harness, parameter).click();
                harness.run();
                let is_option =
                    |node: &Node<'_>| node.accesskit_node().label().is_some_and(|label| label.contains(next));
                let option = harness.query_all_by_role(Role::Button).rfind(is_option).expect("an option");
                option.click();
            }
        }
        harness.run();
        assert!(!parameter.is_equal(&harness.state().settings, &focused), "{}", parameter.id);
    }
}

#[test]
fn numbers_that_need_not_be_there_turn_on_and_off() {
    let settings = Settings::default();
    let mut harness = open_harness(Host { settings, ..Host::default() });
    for id in ["fit.max_distance", "fit.border", "map.height", "light.hour"] {
        let parameter = parameter(id).expect(id);
        let Kind::Number(Number { unset: Some(unset), .. }) = parameter.kind else { panic!("{id} is always there") };
        assert!(harness.query_by_role_and_label(Role::Slider, parameter.label).is_none(), "{id}");
        unset_box(&harness, parameter).click();
        harness.run();
        assert_eq!(parameter.number(&harness.state().settings), Some(unset.initial), "{id}");
        assert!(control(&harness, parameter).rect().is_positive(), "{id}");
        unset_box(&harness, parameter).click();
        harness.run();
        assert_eq!(harness.state().settings, Settings::default(), "{id}");
    }
}

#[test]
fn a_height_turns_on_beside_a_width_that_it_would_begin_with() {
    let mut settings = Settings::default();
    settings.technique.fit.resolution = UVec2::splat(1024);
    let mut harness = open_harness(Host { settings, ..Host::default() });
    let height = parameter("map.height").expect("a row");
    unset_box(&harness, height).click();
    harness.run();
    assert_eq!(harness.state().settings.technique.fit.resolution, UVec2::new(1024, 512));
    type_into(&mut harness, "map.height", "1024");
    assert_eq!(harness.state().settings.technique.fit.resolution, UVec2::splat(1024));
    assert!(harness.query_by_role_and_label(Role::Slider, height.label).is_none());
}

#[test]
fn a_height_that_is_dragged_to_the_width_keeps_its_slider() {
    let mut settings = Settings::default();
    settings.technique.fit.resolution = UVec2::new(256, 1024);
    let mut harness = open_harness(Host { settings, ..Host::default() });
    let slider = control(&harness, parameter("map.height").expect("a row")).rect();
    harness.drag_at(slider.center());
    harness.run();
    harness.hover_at(slider.left_center() - Vec2::new(200.0, 0.0));
    harness.run();
    assert!(control(&harness, parameter("map.height").expect("a row")).rect().is_positive());
    assert_ne!(harness.state().settings.technique.fit.resolution.y, 256);
}

#[test]
fn resolutions_have_a_list_of_powers_of_two() {
    let mut harness = open_harness(Host::default());
    harness.get_by_role_and_label(Role::ComboBox, "Resolution: powers of two").click();
    harness.run();
    for side in ["256", "512", "1024", "2048", "4096", "8192"] {
        harness.get_by_role_and_label(Role::Button, side);
    }
    assert!(harness.query_by_role_and_label(Role::Button, "128").is_none());
    harness.get_by_role_and_label(Role::Button, "4096").click();
    harness.run();
    assert_eq!(harness.state().settings.technique.fit.resolution, UVec2::splat(4096));
}

#[test]
fn lambda_is_shown_with_practical_splits_alone_and_splits_with_manual_ones() {
    let shown = |harness: &Harness<'_, Host>, id: &str| query_control(harness, parameter(id).expect(id)).is_some();
    let mut harness = open_harness(Host::default());
    for (splits, lambda, manual) in [
        (SplitScheme::FromHistogram, false, false),
        (SplitScheme::Practical(0.7), true, false),
        (SplitScheme::Manual([1.0; MAX_MAPS - 1]), false, true),
    ] {
        harness.state_mut().settings.technique.maps = Cascades::default().with_splits(splits).into();
        harness.run();
        assert_eq!(shown(&harness, "splits.lambda"), lambda);
        // Four maps have three splits between them.
        assert_eq!(shown(&harness, "splits.manual_3"), manual);
        assert!(!shown(&harness, "splits.manual_4"));
    }
    type_into(&mut harness, "splits.manual_2", "12.5");
    let SplitScheme::Manual(splits) = cascades(&harness.state().settings).splits else { panic!("they stay manual") };
    assert_eq!(splits[..3], [1.0, 12.5, 1.0]);
}

#[test]
fn a_changed_value_is_reset_by_its_button_or_a_double_click_on_its_label() {
    let mut harness = open_harness(Host::default());
    let name = "Reset Slope-scaled";
    assert!(harness.query_by_label(name).is_none());
    harness.state_mut().settings.technique.bias.slope = 3.0;
    harness.run();
    harness.get_by_label(name).click();
    harness.run();
    assert_eq!(harness.state().settings, Settings::default());

    harness.state_mut().settings.technique.bias.slope = 3.0;
    harness.run();
    let label = harness.query_all_by_role(Role::Label).find(|node| node.value().as_deref() == Some("Slope-scaled"));
    let label = label.expect("the row has a label");
    label.click();
    label.click();
    harness.run();
    assert_eq!(harness.state().settings, Settings::default());
}

#[test]
fn a_host_has_defaults_and_hidden_rows_of_its_own() {
    let mut host = Host { panel: Panel::new().with_hidden(["map.depth"]), ..Host::default() };
    host.panel.defaults.camera.speed = 100.0;
    host.settings.camera.speed = 7.0;
    let mut harness = open_harness(host);
    assert!(harness.query_by_role_and_label(Role::ComboBox, "Depth convention").is_none());
    harness.get_by_label("Reset Flying speed").click();
    harness.run();
    assert_eq!(harness.state().settings.camera.speed, 100.0);
}

#[test]
fn a_setting_without_effect_is_greyed_out_and_says_why() {
    let mut harness = open_harness(Host::default());
    harness.state_mut().settings.technique.fit.casters = CasterPolicy::Extend;
    harness.run();
    let extension = parameter("fit.caster_extension").expect("a row");
    assert!(!control(&harness, extension).accesskit_node().is_disabled());
    let technique = &mut harness.state_mut().settings.technique;
    technique.maps = technique.maps.with_kind(FitKind::XnaSample);
    harness.run();
    assert!(control(&harness, extension).accesskit_node().is_disabled());
    control(&harness, extension).hover();
    wait_for_the_tooltip(&mut harness);
    let reason = (extension.inert)(&harness.state().settings).expect("the XNA fit has none");
    assert!(harness.query_by_label_contains(reason).is_some());
}

#[test]
fn hovering_a_control_shows_help_range_and_default() {
    let mut harness = open_harness(Host::default());
    control(&harness, parameter("bias.slope").expect("a row")).hover();
    wait_for_the_tooltip(&mut harness);
    let help = harness.get_by_label_contains("peter-panning");
    let text = help.accesskit_node().label().or(help.value()).expect("a text");
    assert!(text.contains("0 to 16 texels, default 0.00 texels."), "{text}");
}

#[test]
fn the_inset_shows_any_map_that_there_is() {
    let mut harness = harness_with(Host::default(), "View");
    let is_there = |harness: &Harness<'_, Host>, map| {
        harness.query_by_role_and_label(Role::RadioButton, &inset_button(map)).is_some()
    };
    assert!(is_there(&harness, 4) && !is_there(&harness, 5));
    harness.get_by_label(&inset_button(3)).click();
    harness.run();
    assert_eq!(harness.state().settings.view.inset_map, 3);

    harness.state_mut().settings.technique = Technique::default().with_count(2);
    harness.run();
    assert!(is_there(&harness, 2) && !is_there(&harness, 3));
    assert_eq!(harness.state().settings.view.inset_map, 3, "it comes back with the maps");
    let toggled = harness.get_by_label(&inset_button(2)).accesskit_node().toggled();
    assert_eq!(toggled, Some(egui::accesskit::Toggled::True), "fewer maps show the last one");

    harness.state_mut().settings.view.inset = InsetMaps::Off;
    harness.run();
    assert!(harness.get_by_label(&inset_button(1)).accesskit_node().is_disabled());
}

/// Types into the field of the search.
fn search(harness: &mut Harness<'_, Host>, text: &str) {
    harness.get_by_role_and_label(Role::TextInput, "Search all settings").focus();
    harness.run();
    harness.get_by_role_and_label(Role::TextInput, "Search all settings").type_text(text);
    harness.run();
}

#[test]
fn a_search_shows_the_rows_that_it_finds_under_their_groups_and_nothing_else() {
    let mut harness = harness(Host::default());
    let is_shown = |harness: &Harness<'_, Host>, id: &str| query_control(harness, parameter(id).expect(id)).is_some();
    search(&mut harness, "slope");
    assert!(is_shown(&harness, "bias.slope") && !is_shown(&harness, "fit.kind"));
    harness.get_by_label("Bias");
    type_into(&mut harness, "bias.slope", "2");
    assert_eq!(harness.state().settings.technique.bias.slope, 2.0);
    harness.get_by_role_and_label(Role::Button, "Clear the search").click();
    harness.run();
    assert!(is_shown(&harness, "fit.kind") && !is_shown(&harness, "bias.slope"));
    // The search also finds settings of the tools.
    search(&mut harness, "sun light.an");
    assert!(is_shown(&harness, "light.animate") && !is_shown(&harness, "light.elevation"));
    harness.get_by_role_and_label(Role::Button, "Clear the search").click();
    harness.run();
    search(&mut harness, "nonsense");
    harness.get_by_label("No active setting has these words in its name or help.");
}

#[test]
fn a_folded_group_says_how_many_of_its_rows_were_changed() {
    let mut settings = Settings::default();
    (settings.technique.bias.slope, settings.technique.bias.normal_offset) = (1.0, 1.0);
    let harness = harness(Host { settings, ..Host::default() });
    let bias = harness.get_by_role_and_label(Role::DisclosureTriangle, "Bias").rect();
    let drawn = texts(&harness).into_iter().find(|(_, text)| text == "2 changed");
    assert!(drawn.is_some_and(|(rect, _)| bias.contains_rect(rect)));
}
