//! The panel, driven through its accessibility tree as a person would drive it: no drawing, no GPU.
//! The harness itself fails on a widget without a name and on a glyph that egui's fonts lack.

use egui::accesskit::Role;
use egui::{Key, Rect, Vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::{Harness, Node};
use shadowfit::figures::Figures;
use shadowfit::params::{Group, Kind, PARAMETERS, Parameter, parameter};
use shadowfit::{Constraint, FitKind, Settings};
use shadowfit_egui::{Action, Artefact, KEYS, PANEL_WIDTH, Panel, PanelInput, SceneLine, apply_style, help_overlay};

/// Higher than all that the panel holds, so that nothing is scrolled out of view.
const HEIGHT: f32 = 2000.0;

#[derive(Default)]
struct Host {
    panel: Panel,
    settings: Settings,
    figures: Figures,
    notes: Vec<String>,
    message: Option<&'static str>,
    artefact: Option<Artefact>,
    fixed: bool,
    help: bool,
    actions: Vec<Action>,
    content_width: f32,
}

impl Host {
    fn show(&mut self, ui: &mut egui::Ui) {
        let input = PanelInput {
            settings: &mut self.settings,
            figures: &self.figures,
            scene: SceneLine { name: "Courtyard", triangles: 262_144, notes: &self.notes },
            artefact: self.artefact,
            artefact_fixed: self.fixed,
            message: self.message,
        };
        self.actions.extend(self.panel.show(ui, input).action);
        self.content_width = ui.min_rect().right();
        help_overlay(ui.ctx(), &mut self.help);
    }
}

fn harness(host: Host) -> Harness<'static, Host> {
    Harness::builder()
        .with_size(Vec2::new(PANEL_WIDTH, HEIGHT))
        .with_context_setup(apply_style)
        // Fast enough for double clicks, and steps enough for the groups to open.
        .with_step_dt(0.05)
        .with_max_steps(100)
        .build_ui_state(|ui, host: &mut Host| host.show(ui), host)
}

/// With every group open.
fn open_harness(host: Host) -> Harness<'static, Host> {
    let mut harness = harness(host);
    for group in Group::ALL {
        let first = group.parameters().next().expect("no group is empty");
        if harness.query_all_by_label(first.label).next().is_none() {
            harness.get_by_label(group.label()).click();
            harness.run();
        }
    }
    harness
}

/// The control of a parameter, which carries its label.
fn control<'a>(harness: &'a Harness<'_, Host>, parameter: &Parameter) -> Node<'a> {
    let role = match parameter.kind {
        Kind::Number(_) => Role::Slider,
        Kind::Choice(_) => Role::ComboBox,
        Kind::Toggle(_) => Role::CheckBox,
    };
    harness.get_by_role_and_label(role, parameter.label)
}

fn number_field<'a>(harness: &'a Harness<'_, Host>, id: &str) -> Node<'a> {
    harness.get_by_role_and_label(Role::SpinButton, parameter(id).expect(id).label)
}

fn type_into(harness: &mut Harness<'_, Host>, id: &str, text: &str) {
    number_field(harness, id).focus();
    harness.run();
    number_field(harness, id).type_text(text);
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
}

fn wait_for_the_tooltip(harness: &mut Harness<'_, Host>) {
    harness.run_steps(30);
}

#[test]
fn every_parameter_has_a_control_with_its_label() {
    let harness = open_harness(Host::default());
    for parameter in PARAMETERS {
        assert!(control(&harness, parameter).rect().is_positive(), "{}", parameter.id);
    }
}

#[test]
fn everything_fits_the_panel_width() {
    let mut host = Host { artefact: Some(Artefact::ClippingHole), ..Host::default() };
    host.notes = vec!["The texture 'bark.ktx2' has a compression that is not supported; it is drawn grey.".into()];
    host.message = Some("Saved the picture as shadowfit-2026-07-02-12-30-00.png in the current folder.");
    host.figures = Figures {
        set_by: Some([Constraint::CasterExtension; 6]),
        is_empty: Some(true),
        texel_size: Some([0.029, 0.031]),
        depth_range: Some(110.0),
        depth_step: Some(0.000_013),
        pixels_per_texel: Some(12.34),
        frame_ms: Some(16.7),
        shadow_pass_ms: Some(0.4),
        scene_pass_ms: Some(1.25),
        shadow_draws: Some(123),
        shadow_triangles: Some(1_234_567),
    };
    // The widest values, all changed so that the reset buttons show.
    for parameter in PARAMETERS {
        match &parameter.kind {
            Kind::Number(number) => number.set(&mut host.settings, number.max),
            Kind::Choice(choice) => choice.set(&mut host.settings, usize::from(choice.get(&Settings::default()) == 0)),
            Kind::Toggle(toggle) => toggle.set(&mut host.settings, !toggle.get(&Settings::default())),
        }
    }
    let harness = open_harness(host);
    let width = harness.state().content_width;
    assert!(width <= PANEL_WIDTH, "the content is {width} points wide");
    for parameter in PARAMETERS {
        let row = control(&harness, parameter).rect();
        for other in harness.get_all_by_label(&format!("Reset {}", parameter.label)) {
            let overlap = other.rect().intersect(row);
            assert!(!overlap.is_positive(), "{}: {overlap:?}", parameter.id);
            assert!(other.rect().right() <= PANEL_WIDTH, "{}", parameter.id);
        }
        let labels = harness.query_all_by_role(Role::Label).filter(|n| n.value().as_deref() == Some(parameter.label));
        for label in labels {
            let overlap: Rect = label.rect().intersect(row);
            assert!(!overlap.is_positive(), "{}: {overlap:?}", parameter.id);
        }
    }
}

#[test]
fn showing_the_panel_changes_no_setting() {
    let mut settings = Settings::default();
    settings.bias.normal_offset = 1.234_567;
    settings.camera.speed = 1e9;
    settings.fit.resolution = shadowfit::glam::UVec2::new(640, 480);
    let mut harness = open_harness(Host { settings, ..Host::default() });
    harness.run();
    assert_eq!(harness.state().settings, settings);
}

#[test]
fn a_setting_that_is_nan_goes_back_to_its_default() {
    let mut settings = Settings::default();
    settings.light.elevation = f32::NAN;
    let harness = open_harness(Host { settings, ..Host::default() });
    assert_eq!(harness.state().settings, Settings::default());
}

#[test]
fn each_artefact_button_asks_to_show_its_artefact() {
    for artefact in Artefact::ALL {
        let mut harness = harness(Host::default());
        let label = format!("Show {}", artefact.label().to_lowercase());
        harness.get_by_role_and_label(Role::Button, &label).click();
        harness.run();
        assert_eq!(harness.state().actions, [Action::ShowArtefact(artefact)]);
    }
}

#[test]
fn the_card_explains_then_fixes_then_shows_again() {
    for artefact in Artefact::ALL {
        let mut harness = harness(Host { artefact: Some(artefact), ..Host::default() });
        harness.get_by_label(artefact.explanation());
        harness.get_by_role_and_label(Role::Button, "Fix (F)").click();
        harness.run();
        assert_eq!(harness.state().actions, [Action::FixArtefact(artefact)]);

        harness.state_mut().fixed = true;
        harness.run();
        harness.get_by_label(artefact.cure());
        assert!(harness.query_by_label(artefact.explanation()).is_none());
        harness.get_by_role_and_label(Role::Button, "Show again").click();
        harness.run();
        assert_eq!(harness.state().actions[1..], [Action::ShowArtefact(artefact)]);
    }
}

#[test]
fn the_buttons_of_the_header_ask_their_host() {
    for (label, action) in [
        ("Reset", Action::Reset),
        ("Reset camera", Action::ResetCamera),
        ("Screenshot", Action::Screenshot),
        ("Help", Action::OpenHelp),
    ] {
        let mut harness = harness(Host::default());
        harness.get_by_role_and_label(Role::Button, label).click();
        harness.run();
        assert_eq!(harness.state().actions, [action]);
    }
}

#[test]
fn typed_numbers_are_set_in_the_shown_unit_and_clamped() {
    let mut harness = open_harness(Host::default());
    type_into(&mut harness, "bias.normal_offset", "1.5");
    assert_eq!(harness.state().settings.bias.normal_offset, 1.5);
    type_into(&mut harness, "bias.normal_offset", "99");
    assert_eq!(harness.state().settings.bias.normal_offset, 16.0);
    type_into(&mut harness, "light.elevation", "30");
    assert_eq!(harness.state().settings.light.elevation, 30_f32.to_radians());
    type_into(&mut harness, "camera.near", "-1");
    assert_eq!(harness.state().settings.camera.near, 0.01);
    type_into(&mut harness, "camera.near", "nonsense");
    assert_eq!(harness.state().settings.camera.near, 0.01);
}

#[test]
fn dragged_sliders_set_and_clamp_every_number() {
    for parameter in PARAMETERS {
        let Kind::Number(number) = &parameter.kind else { continue };
        let mut harness = open_harness(Host::default());
        harness.state_mut().settings.light.animate = true;
        harness.run();
        let rect = control(&harness, parameter).rect();
        harness.drag_at(rect.center());
        harness.run();
        harness.hover_at(rect.right_center() + Vec2::new(200.0, 0.0));
        harness.run();
        harness.drop_at(rect.right_center() + Vec2::new(200.0, 0.0));
        harness.run();
        let value = number.get(&harness.state().settings);
        assert!((value - number.max).abs() <= 1e-6 * number.max, "{} = {value}", parameter.id);
    }
}

#[test]
fn check_boxes_and_lists_set_their_parameters() {
    let mut harness = open_harness(Host::default());
    for parameter in PARAMETERS {
        // The focused fit, with which every list of its group has an effect.
        harness.state_mut().settings = Settings::default();
        harness.state_mut().settings.fit.kind = FitKind::Focused;
        harness.run();
        let before = harness.state().settings;
        match &parameter.kind {
            Kind::Number(_) => continue,
            Kind::Toggle(_) => control(&harness, parameter).click(),
            Kind::Choice(choice) => {
                let next = choice.options[(choice.get(&before) + 1) % choice.options.len()].label;
                control(&harness, parameter).click();
                harness.run();
                let option = harness.get_all_by_label_contains(next).next_back().expect("the popup is last");
                option.click();
            }
        }
        harness.run();
        assert!(!parameter.is_equal(&harness.state().settings, &before), "{}", parameter.id);
    }
}

#[test]
fn a_changed_value_is_reset_by_its_button_or_a_double_click_on_its_label() {
    let mut harness = open_harness(Host::default());
    let name = "Reset Slope-scaled";
    assert!(harness.query_by_label(name).is_none());
    harness.state_mut().settings.bias.slope = 3.0;
    harness.run();
    harness.get_by_label(name).click();
    harness.run();
    assert_eq!(harness.state().settings, Settings::default());

    harness.state_mut().settings.bias.slope = 3.0;
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
    let extension = parameter("fit.caster_extension").expect("a row");
    assert!(!control(&harness, extension).accesskit_node().is_disabled());
    harness.state_mut().settings.fit.kind = FitKind::XnaSample;
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
fn figures_that_were_not_measured_are_dashes() {
    let mut harness = harness(Host::default());
    assert_eq!(harness.query_all_by_label("—").count(), 11);
    harness.state_mut().figures.shadow_triangles = Some(1_234_567);
    harness.state_mut().figures.frame_ms = Some(5.0);
    harness.run();
    assert_eq!(harness.query_all_by_label("—").count(), 9);
    harness.get_by_label("1\u{a0}234\u{a0}567");
    harness.get_by_label("5.00 ms, 200 Hz");
}

#[test]
fn the_header_names_scene_notes_and_message() {
    let notes = vec!["One texture is missing.".to_owned()];
    let harness = harness(Host { notes, message: Some("Saved."), ..Host::default() });
    harness.get_by_label("Courtyard, 262\u{a0}144 triangles");
    harness.get_by_label("One texture is missing.");
    harness.get_by_label("Saved.");
}

#[test]
fn the_help_lists_every_key_and_closes() {
    let mut harness = Harness::builder()
        .with_size(Vec2::new(600.0, 700.0))
        .build_ui_state(|ui, open: &mut bool| help_overlay(ui.ctx(), open), true);
    for line in KEYS {
        harness.get_all_by_label(line.keys).next().expect(line.keys);
        harness.get_all_by_label(line.does).next().expect(line.does);
    }
    harness.get_by_role_and_label(Role::Button, "Close window").click();
    harness.run();
    assert!(!*harness.state());
    assert!(harness.query_by_label(KEYS[0].keys).is_none());
}

#[test]
fn the_help_fits_a_low_screen_and_scrolls() {
    let harness = Harness::builder()
        .with_size(Vec2::new(400.0, 300.0))
        .build_ui_state(|ui, open: &mut bool| help_overlay(ui.ctx(), open), true);
    let title = harness.get_by_role_and_label(Role::Button, "Close window").rect();
    assert!(title.top() >= 0.0, "the title bar is cut off: {title:?}");
    let last = harness.get_by_label(KEYS[KEYS.len() - 1].does).rect();
    assert!(last.top() > 300.0, "the last line should wait to be scrolled to: {last:?}");
}

#[test]
fn the_artefact_keys_are_in_the_table() {
    for artefact in Artefact::ALL {
        let line = KEYS.iter().find(|line| line.keys == artefact.key()).expect("each artefact has a key");
        assert!(line.does.contains(&artefact.label().to_lowercase()), "{}", line.does);
    }
}
