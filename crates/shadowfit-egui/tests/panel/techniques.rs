//! Techniques by name, and a comparison of two.

use egui::Key;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use shadowfit::settings::FitKind;
use shadowfit::{PRESETS, Technique};
use shadowfit_egui::{Command, UserPreset};
use shadowfit_params::tool::Settings;

use crate::host::{Host, harness, press, type_into, wait_for_the_tooltip};
use crate::states::session;

fn open_menu(harness: &mut Harness<'_, Host>) {
    harness.get_by_role_and_label(Role::ComboBox, "Technique").click();
    harness.run();
}

fn choose(harness: &mut Harness<'_, Host>, name: &str, summary: &str) {
    open_menu(harness);
    let option = format!("{name}\n{summary}");
    harness.get_by_role_and_label(Role::Button, &option).scroll_to_me();
    harness.run();
    press(harness, &option);
}

/// Returns the text of the closed menu of techniques.
fn title(harness: &Harness<'_, Host>) -> String {
    harness.get_by_role_and_label(Role::ComboBox, "Technique").value().expect("it has a text")
}

#[test]
fn the_menu_of_techniques_sets_all_but_distance_and_resolution() {
    let mut settings = Settings::default();
    settings.technique.fit.max_distance = 60.0;
    settings.technique.fit.resolution = shadowfit::glam::UVec2::new(1024, 512);
    settings.technique.bias.slope = 3.0;
    settings.camera.speed = 7.0;
    let mut harness = harness(Host { settings, ..Host::default() });
    for preset in &PRESETS {
        choose(&mut harness, preset.name, preset.summary);
        let technique = preset.technique().with_max_distance(60.0).with_resolution(1024, 512);
        assert_eq!(harness.state().settings, settings.with_technique(technique), "{}", preset.name);
        assert_eq!(title(&harness), preset.name);
    }
}

#[test]
fn a_technique_in_the_menu_explains_when_to_take_it() {
    let mut harness = harness(Host::default());
    open_menu(&mut harness);
    let preset = PRESETS[5];
    harness.get_by_role_and_label(Role::Button, &format!("{}\n{}", preset.name, preset.summary)).hover();
    wait_for_the_tooltip(&mut harness);
    assert!(harness.query_by_label_contains(preset.advice).is_some());
}

#[test]
fn a_technique_that_was_changed_is_called_so() {
    let mut harness = harness(Host::default());
    assert_eq!(title(&harness), shadowfit::Preset::RECOMMENDED);
    harness.state_mut().settings.technique.fade = 0.1;
    harness.run();
    assert_eq!(title(&harness), format!("{}, changed", shadowfit::Preset::RECOMMENDED));

    let opened = Technique::default().with_fade(0.2);
    harness.state_mut().settings.technique = opened;
    harness.state_mut().panel.name_technique("street.toml", &opened);
    harness.run();
    assert_eq!(title(&harness), "street.toml");
    harness.state_mut().settings.technique.fade = 0.3;
    harness.run();
    assert_eq!(title(&harness), "street.toml, changed");
    choose(&mut harness, "street.toml", "as it was opened");
    assert_eq!(harness.state().settings.technique, opened);

    let preset = Technique::preset("stable-4").expect("a preset");
    harness.state_mut().settings.technique = preset.with_fade(0.3);
    harness.state_mut().panel.name_technique("stable-4", &preset);
    harness.run();
    assert_eq!(title(&harness), "stable-4, changed", "as it was opened by an argument, say");
    open_menu(&mut harness);
    assert_eq!(harness.query_all_by_label_contains("stable-4\n").count(), 1, "a preset is in the menu already");

    let settings = Settings::default().with_technique(Technique::default().with_fade(0.4));
    assert_eq!(title(&self::harness(Host { settings, ..Host::default() })), "custom, changed");
}

#[test]
fn a_technique_is_saved_under_a_name_that_a_person_types() {
    let mut harness = harness(Host::default());
    press(&mut harness, "Save the technique");
    let field = |harness: &mut Harness<'_, Host>, text: &str| {
        harness.get_by_role_and_label(Role::TextInput, "Name of the technique").focus();
        harness.run();
        harness.get_by_role_and_label(Role::TextInput, "Name of the technique").type_text(text);
        harness.run();
    };
    press(&mut harness, "Save");
    assert_eq!(harness.state().commands, [], "a name is needed");
    field(&mut harness, " evening street ");
    press(&mut harness, "Save");
    assert_eq!(harness.state().commands, [Command::SavePreset("evening street".into())]);
    assert!(harness.query_by_role_and_label(Role::TextInput, "Name of the technique").is_none());

    press(&mut harness, "Save the technique");
    field(&mut harness, "noon");
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(harness.state().commands[1..], [Command::SavePreset("noon".into())]);
    press(&mut harness, "Save the technique");
    press(&mut harness, "Cancel");
    assert!(harness.query_by_role_and_label(Role::TextInput, "Name of the technique").is_none());
}

#[test]
fn saved_techniques_are_in_the_menu_and_can_be_deleted() {
    let mut harness = harness(session());
    let saved = harness.state().presets[0].technique;
    choose(&mut harness, "evening street", "saved by you");
    assert_eq!(harness.state().settings.technique, saved);
    assert_eq!(title(&harness), "evening street");
    open_menu(&mut harness);
    press(&mut harness, "Delete evening street");
    assert_eq!(harness.state().commands, [Command::DeletePreset("evening street".into())]);
}

#[test]
fn the_controls_edit_the_side_that_is_chosen() {
    let a = Technique::default();
    let b = Technique::preset("calm-4").expect("a preset");
    let mut harness = harness(Host { compare: Some((b, false)), ..Host::default() });
    assert_eq!(title(&harness), shadowfit::Preset::RECOMMENDED);
    press(&mut harness, "Technique B");
    assert_eq!(harness.state().compare, Some((b, true)));
    assert_eq!(title(&harness), "calm-4");
    type_into(&mut harness, "splits.count", "3");
    assert_eq!(harness.state().settings.technique, a);
    assert_eq!(harness.state().compare, Some((b.with_count(3), true)));
    assert_eq!(title(&harness), "calm-4, changed");
    press(&mut harness, "Technique A");
    type_into(&mut harness, "splits.count", "2");
    assert_eq!(harness.state().settings.technique.maps.count(), 2);
    assert_eq!(harness.state().compare, Some((b.with_count(3), false)));
}

#[test]
fn the_menu_sets_the_side_that_is_chosen() {
    let other = Technique::default().with_maps(shadowfit::Maps::default().with_kind(FitKind::Sphere));
    let mut harness = harness(Host { compare: Some((other, true)), ..Host::default() });
    choose(&mut harness, PRESETS[3].name, PRESETS[3].summary);
    assert_eq!(harness.state().settings, Settings::default());
    let expected = PRESETS[3].technique().with_resolution(other.fit.resolution.x, other.fit.resolution.y);
    assert_eq!(harness.state().compare.map(|(technique, _)| technique.maps), Some(expected.maps));
}

#[test]
fn the_near_plane_keeps_the_shadow_distance_of_both_techniques_beyond_it() {
    let short = Technique::default().with_max_distance(30.0);
    let settings = Settings::default().with_technique(short);
    let mut harness =
        crate::host::harness_with(Host { settings, compare: Some((short, false)), ..Host::default() }, "Camera");
    type_into(&mut harness, "camera.near", "20");
    assert_eq!(harness.state().settings.technique.fit.max_distance, 40.0);
    assert_eq!(harness.state().compare.map(|(other, _)| other.fit.max_distance), Some(40.0));
}

#[test]
fn names_go_with_the_techniques_when_they_are_swapped() {
    let mut host = Host { compare: Some((Technique::preset("calm-4").expect("a preset"), false)), ..Host::default() };
    host.presets = vec![UserPreset { name: "mine".into(), technique: Technique::default().with_fade(0.3) }];
    let mut harness = harness(host);
    // Both are shown once, so that both have names, and A is changed.
    press(&mut harness, "Technique B");
    press(&mut harness, "Technique A");
    harness.state_mut().settings.technique.fade = 0.1;
    harness.run();
    press(&mut harness, "Swap A and B");
    let state = harness.state_mut();
    let (other, _) = state.compare.as_mut().expect("two");
    std::mem::swap(other, &mut state.settings.technique);
    harness.run();
    assert_eq!(title(&harness), "calm-4");
    press(&mut harness, "Technique B");
    assert_eq!(title(&harness), format!("{}, changed", shadowfit::Preset::RECOMMENDED));
}
