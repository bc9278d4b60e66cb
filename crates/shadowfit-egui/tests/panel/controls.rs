//! The panel, driven through its accessibility tree as a person would drive it: no drawing, no GPU.
//! The harness itself fails on a widget without a name and on a glyph that egui's fonts lack.

use egui::accesskit::Role;
use egui::{Key, Rect, Vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::{Harness, Node};
use shadowfit::figures::{Figures, MapFigures};
use shadowfit::light_fit::Constraint;
use shadowfit::params::{Group, Kind, PARAMETERS, Parameter, parameter};
use shadowfit::settings::{
    CasterPolicy, FilterKind, FitKind, MAX_MAPS, MapChoice, MapFormat, MapOverride, SoftRadius, SplitScheme,
};
use shadowfit::tool::{InsetMaps, Settings};
use shadowfit::{PRESETS, Technique, glam::UVec2};
use shadowfit_egui::{Action, Artefact, KEYS, PANEL_WIDTH, Panel, PanelInput, SceneLine, apply_style, help_overlay};

/// Higher than all that the panel holds, so that nothing is scrolled out of view.
const HEIGHT: f32 = 3400.0;

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

/// Settings of slices under which every row of the table is shown and has an effect, but the one of the other
/// choice of splits, λ or the manual ones, of the other choice of maps, blend or overlap, and of the other measure of
/// softness.
fn everything(splits: SplitScheme) -> Settings {
    let mut settings = Settings::default();
    let technique = &mut settings.technique;
    (technique.count, technique.splits) = (MAX_MAPS as u32, splits);
    technique.overrides = [MapOverride { resolution: Some(UVec2::new(1024, 512)), ..MapOverride::default() }; MAX_MAPS];
    (technique.fit.kind, technique.fit.resolution) = (FitKind::Focused, UVec2::new(2048, 1024));
    (technique.fit.max_distance, technique.fit.border) = (100.0, Some(3.0));
    technique.fit.casters = CasterPolicy::Extend;
    // Their softness and the steps of their depths count.
    (technique.filter, technique.format) = (FilterKind::Vogel16, MapFormat::Depth16Unorm);
    settings.light.animate = true;
    settings
}

/// Three of them that show all rows together, each of them active in one at least.
fn all_rows() -> [Settings; 3] {
    let manual = SplitScheme::Manual([5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 320.0]);
    let mut settings = [SplitScheme::Practical(0.5), manual, SplitScheme::FromHistogram].map(everything);
    settings[1].technique.choice = MapChoice::ViewDepth;
    settings[2].technique.fit.kind = FitKind::Windows;
    settings[2].technique.softness.radius = SoftRadius::Metres(0.05);
    settings
}

/// The control of a parameter, which carries its label; for the map of the inset its first button.
fn query_control<'a>(harness: &'a Harness<'_, Host>, parameter: &Parameter) -> Option<Node<'a>> {
    let (role, label) = match &parameter.kind {
        Kind::Number(_) if parameter.id == INSET_MAP => (Role::RadioButton, inset_button(1)),
        Kind::Number(_) => (Role::Slider, parameter.label.to_owned()),
        Kind::Optional(optional) => match optional.unset {
            Some(unset) if optional.get(&harness.state().settings).is_none() => {
                (Role::CheckBox, format!("{}: {}", parameter.label, unset.label))
            }
            _ => (Role::Slider, parameter.label.to_owned()),
        },
        Kind::Choice(_) => (Role::ComboBox, parameter.label.to_owned()),
        Kind::Toggle(_) => (Role::CheckBox, parameter.label.to_owned()),
    };
    find(harness, role, &label)
}

/// The only widget of a role and name, if there is one.
fn find<'a>(harness: &'a Harness<'_, Host>, role: Role, label: &str) -> Option<Node<'a>> {
    let mut found =
        harness.query_all_by_role(role).filter(|node| node.accesskit_node().label().as_deref() == Some(label));
    let first = found.next();
    assert!(found.next().is_none(), "there are several of {label}");
    first
}

fn control<'a>(harness: &'a Harness<'_, Host>, parameter: &Parameter) -> Node<'a> {
    query_control(harness, parameter).unwrap_or_else(|| panic!("{} has no control", parameter.id))
}

const INSET_MAP: &str = "view.inset_map";

fn inset_button(map: usize) -> String {
    format!("Show map {map} in the inset")
}

/// Least and greatest value of a number, whether it has to be there or not, and its value.
fn number(parameter: &Parameter, settings: &Settings) -> Option<(f64, f64, f64)> {
    match &parameter.kind {
        Kind::Number(number) => Some((number.min, number.max, number.get(settings))),
        Kind::Optional(optional) => optional.get(settings).map(|value| (optional.min, optional.max, value)),
        Kind::Choice(_) | Kind::Toggle(_) => None,
    }
}

/// The check box of a number that need not be there.
fn unset_box<'a>(harness: &'a Harness<'_, Host>, parameter: &Parameter) -> Node<'a> {
    let Kind::Optional(optional) = &parameter.kind else { panic!("{} is always there", parameter.id) };
    let unset = optional.unset.expect("it has a name for no number");
    find(harness, Role::CheckBox, &format!("{}: {}", parameter.label, unset.label)).expect(parameter.id)
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
    let mut seen = std::collections::BTreeSet::new();
    for settings in all_rows() {
        let harness = open_harness(Host { settings, ..Host::default() });
        for parameter in PARAMETERS {
            let goes = parameter.group == Group::Override && (parameter.inert)(&settings).is_some();
            if parameter.is_present(&settings) && !goes {
                assert!(control(&harness, parameter).rect().is_positive(), "{}", parameter.id);
                seen.insert(parameter.id);
            } else {
                assert!(query_control(&harness, parameter).is_none(), "{}", parameter.id);
            }
        }
    }
    assert_eq!(seen.len(), PARAMETERS.len());
}

/// A map with the widest figures of a real scene.
fn wide_map() -> MapFigures {
    MapFigures {
        view_depths: Some([888.8, 8888.8]),
        set_by: [Constraint::CasterExtension; 6],
        is_empty: false,
        extent: [888.8, 888.8],
        texel_size: [0.8888, 0.8888],
        depth_range: 888.8,
        depth_step: 0.000_088_8,
        casters: Some(8888),
        draws: Some(8888),
        triangles: Some(8_888_888),
    }
}

fn widest_host() -> Host {
    let mut host = Host { artefact: Some(Artefact::ClippingHole), ..Host::default() };
    host.notes = vec!["The texture 'bark.ktx2' has a compression that is not supported; it is drawn grey.".into()];
    host.message = Some("Saved the picture as shadowfit-2026-07-02-12-30-00.png in the current folder.");
    host.figures = Figures {
        maps: [Some(wide_map()); MAX_MAPS],
        map_ahead: Some(7),
        pixels_per_texel: Some(12.34),
        frame_ms: Some(16.7),
        shadow_pass_ms: Some(0.4),
        scene_pass_ms: Some(1.25),
        shadow_draws: Some(123),
        shadow_triangles: Some(1_234_567),
    };
    host
}

#[test]
fn everything_fits_the_panel_width() {
    for settings in all_rows() {
        let mut host = Host { settings, ..widest_host() };
        // The widest values, all changed so that the reset buttons show.
        for parameter in PARAMETERS {
            match &parameter.kind {
                Kind::Number(number) => number.set(&mut host.settings, number.max),
                Kind::Optional(optional) if optional.unset.is_none() => {
                    optional.set(&mut host.settings, Some(optional.max));
                }
                // Not its greatest, which the width has, and which is as wide.
                Kind::Optional(optional) => optional.set(&mut host.settings, Some(0.999 * optional.max)),
                Kind::Choice(choice) if parameter.id != "splits.scheme" => {
                    choice.set(&mut host.settings, usize::from(choice.get(&Settings::default()) == 0));
                }
                Kind::Choice(_) => {}
                Kind::Toggle(toggle) => toggle.set(&mut host.settings, !toggle.get(&Settings::default())),
            }
        }
        assert_fits(&open_harness(host));
    }
}

fn assert_fits(harness: &Harness<'_, Host>) {
    let width = harness.state().content_width;
    assert!(width <= PANEL_WIDTH, "the content is {width} points wide");
    for parameter in PARAMETERS {
        let reset = format!("Reset {}", parameter.label);
        let list = format!("{}: powers of two", parameter.label);
        let labels = harness.query_all_by_role(Role::Label).filter(|n| n.value().as_deref() == Some(parameter.label));
        let widgets: Vec<Rect> = labels
            .chain(query_control(harness, parameter))
            .chain(find(harness, Role::SpinButton, parameter.label))
            .chain(find(harness, Role::ComboBox, &list))
            .chain(find(harness, Role::Button, &reset))
            .map(|node| node.rect())
            .collect();
        for (index, rect) in widgets.iter().enumerate() {
            assert!(rect.right() <= PANEL_WIDTH, "{}", parameter.id);
            for other in &widgets[..index] {
                let overlap = rect.intersect(*other);
                assert!(!overlap.is_positive(), "{}: {overlap:?}", parameter.id);
            }
        }
    }
}

#[test]
fn showing_the_panel_changes_no_setting() {
    let mut settings = Settings::default();
    settings.technique.bias.normal_offset = 1.234_567;
    settings.technique.fit.resolution = UVec2::new(641, 481);
    settings.technique.fit.border = Some(1.234_567);
    settings.technique.splits = SplitScheme::Practical(0.123_456_7);
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
    assert_eq!(harness.state().settings.technique.bias.normal_offset, 1.5);
    type_into(&mut harness, "bias.normal_offset", "99");
    assert_eq!(harness.state().settings.technique.bias.normal_offset, 16.0);
    type_into(&mut harness, "light.elevation", "30");
    assert_eq!(harness.state().settings.light.elevation, 30_f32.to_radians());
    type_into(&mut harness, "camera.near", "-1");
    assert_eq!(harness.state().settings.camera.near, 0.01);
    type_into(&mut harness, "camera.near", "nonsense");
    assert_eq!(harness.state().settings.camera.near, 0.01);
}

#[test]
fn dragged_sliders_set_and_clamp_every_number() {
    let mut dragged = std::collections::BTreeSet::new();
    for settings in all_rows() {
        for parameter in PARAMETERS.iter().filter(|parameter| parameter.id != INSET_MAP) {
            let Some((_, max, _)) = number(parameter, &settings) else { continue };
            if (parameter.inert)(&settings).is_some() {
                continue;
            }
            let mut harness = open_harness(Host { settings, ..Host::default() });
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
    let Kind::Number(number) = &frames.kind else { panic!("a number") };
    for step in 1..20 {
        let rect = control(&harness, frames).rect();
        let place = rect.left_center() + Vec2::new(rect.width() * step as f32 / 20.0, 0.0);
        harness.drag_at(place);
        harness.run();
        harness.drop_at(place);
        harness.run();
        let value = number.get(&harness.state().settings);
        assert_eq!(value, value.round());
    }
    type_into(&mut harness, "map.resolution", "1536");
    assert_eq!(harness.state().settings.technique.fit.resolution.x, 1536);
}

#[test]
fn check_boxes_and_lists_set_their_parameters() {
    // The focused fit, with which every list of its group but that of windows has an effect.
    let focused = everything(SplitScheme::Uniform);
    let mut windows = focused;
    windows.technique.fit.kind = FitKind::Windows;
    let mut harness = open_harness(Host::default());
    for parameter in PARAMETERS {
        let settings = if parameter.id == "fit.need" { windows } else { focused };
        harness.state_mut().settings = settings;
        harness.run();
        match &parameter.kind {
            Kind::Number(_) | Kind::Optional(_) => continue,
            Kind::Toggle(_) => control(&harness, parameter).click(),
            Kind::Choice(choice) => {
                let next = choice.options[(choice.get(&settings) + 1) % choice.options.len()].label;
                control(&harness, parameter).click();
                harness.run();
                let option = harness.get_all_by_label_contains(next).next_back().expect("the popup is last");
                option.click();
            }
        }
        harness.run();
        assert!(!parameter.is_equal(&harness.state().settings, &settings), "{}", parameter.id);
    }
}

#[test]
fn numbers_that_need_not_be_there_turn_on_and_off() {
    let mut settings = Settings::default();
    // The resolution of map 1 makes room for its height.
    settings.technique.overrides[0].resolution = Some(UVec2::splat(256));
    let mut harness = open_harness(Host { settings, ..Host::default() });
    for id in ["fit.max_distance", "fit.border", "map.height", "override.map_1_height", "override.map_4_resolution"] {
        let parameter = parameter(id).expect(id);
        let Kind::Optional(optional) = parameter.kind else { panic!("{id} is always there") };
        assert!(harness.query_by_role_and_label(Role::Slider, parameter.label).is_none(), "{id}");
        unset_box(&harness, parameter).click();
        harness.run();
        assert_eq!(optional.get(&harness.state().settings), Some(optional.initial), "{id}");
        assert!(control(&harness, parameter).rect().is_positive(), "{id}");
        unset_box(&harness, parameter).click();
        harness.run();
        assert_eq!(harness.state().settings, settings, "{id}");
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
    harness.state_mut().settings.technique.fit.kind = FitKind::Focused;
    for (splits, lambda, manual) in [
        (SplitScheme::FromHistogram, false, false),
        (SplitScheme::Practical(0.7), true, false),
        (SplitScheme::Manual([1.0; MAX_MAPS - 1]), false, true),
    ] {
        harness.state_mut().settings.technique.splits = splits;
        harness.run();
        assert_eq!(shown(&harness, "splits.lambda"), lambda);
        // Four maps have three splits between them.
        assert_eq!(shown(&harness, "splits.manual_3"), manual);
        assert!(!shown(&harness, "splits.manual_4"));
    }
    type_into(&mut harness, "splits.manual_2", "12.5");
    let SplitScheme::Manual(splits) = harness.state().settings.technique.splits else { panic!("they stay manual") };
    assert_eq!(splits[..3], [1.0, 12.5, 1.0]);
}

#[test]
fn single_maps_have_rows_while_they_exist_and_are_folded_away_at_first() {
    let first = parameter("override.map_1_kind").expect("a row");
    let mut harness = harness(Host::default());
    assert!(query_control(&harness, first).is_none());
    harness.get_by_label("Single maps").click();
    harness.run();
    for count in [1, 3, 8] {
        harness.state_mut().settings.technique.count = count;
        harness.run();
        for map in 1..=MAX_MAPS {
            let id = format!("override.map_{map}_resolution");
            let parameter = parameter(&id).expect("a row");
            assert_eq!(query_control(&harness, parameter).is_some(), map <= count as usize, "{id} of {count}");
        }
    }
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
    harness.state_mut().settings.technique.fit.kind = FitKind::XnaSample;
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
fn the_menu_of_techniques_sets_all_but_distance_and_resolution() {
    let mut settings = Settings::default();
    settings.technique.fit.max_distance = 60.0;
    settings.technique.fit.resolution = UVec2::new(1024, 512);
    settings.technique.bias.slope = 3.0;
    settings.camera.speed = 7.0;
    let mut harness = harness(Host { settings, ..Host::default() });
    for preset in &PRESETS {
        harness.get_by_role_and_label(Role::ComboBox, "Technique").click();
        harness.run();
        let option = format!("{}\n{}", preset.name, preset.summary);
        harness.get_by_role_and_label(Role::Button, &option).scroll_to_me();
        harness.run();
        harness.get_by_role_and_label(Role::Button, &option).click();
        harness.run();
        let technique = preset.technique().with_max_distance(60.0).with_resolution(1024, 512);
        assert_eq!(harness.state().settings, settings.with_technique(technique), "{}", preset.name);
        assert_eq!(technique_title(&harness), preset.name);
    }
}

#[test]
fn a_technique_in_the_menu_explains_when_to_take_it() {
    let mut harness = harness(Host::default());
    harness.get_by_role_and_label(Role::ComboBox, "Technique").click();
    harness.run();
    let preset = PRESETS[5];
    harness.get_by_role_and_label(Role::Button, &format!("{}\n{}", preset.name, preset.summary)).hover();
    wait_for_the_tooltip(&mut harness);
    assert!(harness.query_by_label_contains(preset.advice).is_some());
}

#[test]
fn a_technique_that_was_changed_is_called_so() {
    let mut harness = harness(Host::default());
    assert_eq!(technique_title(&harness), shadowfit::presets::RECOMMENDED);
    let technique = &mut harness.state_mut().settings.technique;
    technique.overlap = 0.1;
    harness.run();
    assert_eq!(technique_title(&harness), format!("{}, changed", shadowfit::presets::RECOMMENDED));

    let opened = Technique::default().with_overlap(0.2);
    harness.state_mut().settings.technique = opened;
    harness.state_mut().panel.name_technique("street.toml", &opened);
    harness.run();
    assert_eq!(technique_title(&harness), "street.toml");
    harness.state_mut().settings.technique.overlap = 0.3;
    harness.run();
    assert_eq!(technique_title(&harness), "street.toml, changed");
    harness.get_by_role_and_label(Role::ComboBox, "Technique").click();
    harness.run();
    harness.get_by_role_and_label(Role::Button, "street.toml\nas it was opened").click();
    harness.run();
    assert_eq!(harness.state().settings.technique, opened);

    let settings = Settings::default().with_technique(Technique::default().with_overlap(0.4));
    let harness = self::harness(Host { settings, ..Host::default() });
    assert_eq!(technique_title(&harness), "custom, changed");
}

/// What the closed menu of techniques says.
fn technique_title(harness: &Harness<'_, Host>) -> String {
    harness.get_by_role_and_label(Role::ComboBox, "Technique").value().expect("it has a text")
}

#[test]
fn figures_that_were_not_measured_are_dashes() {
    let mut harness = harness(Host::default());
    assert_eq!(harness.query_all_by_label("—").count(), 6);
    assert!(harness.query_by_label("Map 1").is_none());
    harness.state_mut().figures.shadow_triangles = Some(1_234_567);
    harness.state_mut().figures.frame_ms = Some(5.0);
    harness.state_mut().figures.maps[0] = Some(MapFigures::default());
    harness.run();
    // Distances and draws of the map are not known.
    assert_eq!(harness.query_all_by_label("—").count(), 6);
    harness.get_by_label("1\u{a0}234\u{a0}567");
    harness.get_by_label("5.00 ms, 200 Hz");
}

#[test]
fn each_map_has_a_line_of_figures_that_tells_more_when_hovered() {
    let mut harness = harness(Host::default());
    for count in [1, 4, MAX_MAPS] {
        for (map, figures) in harness.state_mut().figures.maps.iter_mut().enumerate() {
            *figures = (map < count).then(|| MapFigures { draws: Some(700 + map as u32), ..wide_map() });
        }
        harness.run();
        for map in 1..=MAX_MAPS {
            assert_eq!(harness.query_by_label(&format!("Map {map}")).is_some(), map <= count, "{map} of {count}");
            assert_eq!(harness.query_by_label(&(699 + map).to_string()).is_some(), map <= count, "{map} of {count}");
        }
    }
    harness.state_mut().figures.maps[1] = Some(MapFigures { is_empty: true, ..wide_map() });
    (harness.state_mut().figures.pixels_per_texel, harness.state_mut().figures.map_ahead) = (Some(1.5), Some(2));
    harness.run();
    harness.get_by_label("1.50 on map 3");
    harness.get_by_label("empty").hover();
    wait_for_the_tooltip(&mut harness);
    let details = harness.get_by_label_contains("Map 2: no receiver is in view");
    let text = details.accesskit_node().label().or(details.value()).expect("a text");
    assert!(text.contains("left caster extension") && text.contains("Triangles: 8\u{a0}888\u{a0}888"), "{text}");
}

#[test]
fn the_inset_shows_any_map_that_there_is() {
    let mut harness = harness(Host::default());
    let is_there = |harness: &Harness<'_, Host>, map| {
        harness.query_by_role_and_label(Role::RadioButton, &inset_button(map)).is_some()
    };
    assert!(is_there(&harness, 4) && !is_there(&harness, 5));
    harness.get_by_label(&inset_button(3)).click();
    harness.run();
    assert_eq!(harness.state().settings.view.inset_map, 3);

    harness.state_mut().settings.technique.count = 2;
    harness.run();
    assert!(is_there(&harness, 2) && !is_there(&harness, 3));
    assert_eq!(harness.state().settings.view.inset_map, 3, "it comes back with the maps");
    let toggled = harness.get_by_label(&inset_button(2)).accesskit_node().toggled();
    assert_eq!(toggled, Some(egui::accesskit::Toggled::True), "fewer maps show the last one");

    harness.state_mut().settings.view.inset = InsetMaps::Off;
    harness.run();
    assert!(harness.get_by_label(&inset_button(1)).accesskit_node().is_disabled());
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
