//! A host of the panel, with functions that find and move its widgets.

use egui::accesskit::Role;
use egui::epaint::{ClippedShape, Shape};
use egui::{Key, Rect, Theme, ThemePreference, Vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::{Harness, HarnessBuilder, Node};
use shadowfit::Technique;
use shadowfit_egui::{
    Artefact, Card, Changes, Command, Compare, PANEL_WIDTH, Panel, PanelInput, SceneLine, ShownArtefact, Tune,
    UserPreset, apply_theme, help_overlay,
};
use shadowfit_params::figures::Figures;
use shadowfit_params::tool::Settings;
use shadowfit_params::{Kind, Number, Parameter, Value, parameter};

/// Higher than the whole panel, so that nothing is scrolled out of view.
pub(crate) const HEIGHT: f32 = 4600.0;

/// The parameter that has buttons, one for each map.
pub(crate) const INSET_MAP: &str = "view.inset_map";

/// A shown artefact, as a host stores it.
#[derive(Clone, Default)]
pub(crate) struct Shown {
    pub(crate) artefact: Option<Artefact>,
    pub(crate) fixed: bool,
    pub(crate) narration: String,
    pub(crate) changes: Vec<String>,
}

#[derive(Default)]
pub(crate) struct Host {
    pub(crate) panel: Panel,
    pub(crate) settings: Settings,
    pub(crate) figures: Figures,
    pub(crate) notes: Vec<String>,
    pub(crate) message: Option<&'static str>,
    pub(crate) shown: Shown,
    /// Technique B and whether it is edited, if two are compared.
    pub(crate) compare: Option<(Technique, bool)>,
    pub(crate) tune: Tune<'static>,
    pub(crate) card: Option<Card<'static>>,
    pub(crate) changes: Changes<'static>,
    pub(crate) presets: Vec<UserPreset>,
    pub(crate) help: bool,
    pub(crate) commands: Vec<Command>,
    /// Width of the panel, if not the default.
    pub(crate) width: Option<f32>,
    /// Area of the panel, margins included.
    pub(crate) panel_rect: Option<Rect>,
    /// Right end of the panel's contents.
    pub(crate) content_right: f32,
}

impl Host {
    pub(crate) fn show(&mut self, ui: &mut egui::Ui) {
        // The harness adds a margin around its interface. A window has none.
        let window = ui.ctx().content_rect();
        let ui = &mut ui.new_child(egui::UiBuilder::new().max_rect(window));
        ui.set_clip_rect(window);
        let response = egui::Panel::right("tuning")
            .exact_size(self.width.unwrap_or(PANEL_WIDTH))
            .resizable(false)
            .show(ui, |ui| {
                let mut input = PanelInput::new(
                    &mut self.settings,
                    &self.figures,
                    SceneLine { name: "Courtyard", triangles: 262_144, notes: &self.notes },
                );
                input.artefact = self.shown.artefact.map(|artefact| ShownArtefact {
                    artefact,
                    fixed: self.shown.fixed,
                    narration: &self.shown.narration,
                    changes: &self.shown.changes,
                });
                input.compare = self.compare.as_mut().map(|(other, edits_other)| Compare { other, edits_other });
                input.tune = self.tune;
                input.card = self.card;
                input.changes = self.changes;
                input.presets = &self.presets;
                input.message = self.message;
                self.commands.extend(self.panel.show(ui, input).command);
                self.content_right = ui.min_rect().right();
            });
        self.panel_rect = Some(response.response.rect);
        help_overlay(ui.ctx(), &mut self.help);
    }
}

/// Makes a harness of this size and scale with the theme of the panel.
pub(crate) fn builder<State>(size: Vec2, theme: Theme, scale: f32) -> HarnessBuilder<State> {
    HarnessBuilder::default()
        .with_size(size)
        .with_theme(theme)
        .with_pixels_per_point(scale)
        .with_context_setup(move |ctx| apply_theme(ctx, ThemePreference::from(theme)))
        // Short enough for double clicks, with enough steps for the sections to open.
        .with_step_dt(0.05)
        .with_max_steps(100)
}

pub(crate) fn harness_of(host: Host, theme: Theme, scale: f32, height: f32) -> Harness<'static, Host> {
    builder(Vec2::new(PANEL_WIDTH, height), theme, scale).build_ui_state(|ui, host: &mut Host| host.show(ui), host)
}

pub(crate) fn harness(host: Host) -> Harness<'static, Host> {
    harness_of(host, Theme::Dark, 1.0, HEIGHT)
}

/// Opens every section.
pub(crate) fn open_sections(harness: &mut Harness<'_, Host>) {
    for _ in 0..harness.query_all_by_role(Role::DisclosureTriangle).count() {
        let is_closed = |node: &Node<'_>| !node.accesskit_node().data().is_expanded().unwrap_or(true);
        let Some(closed) = harness.query_all_by_role(Role::DisclosureTriangle).find(is_closed) else { break };
        closed.click();
        harness.run();
    }
}

/// Makes a harness with every section open.
pub(crate) fn open_harness(host: Host) -> Harness<'static, Host> {
    let mut harness = harness(host);
    open_sections(&mut harness);
    harness
}

/// Makes a harness with one section open.
pub(crate) fn harness_with(host: Host, section: &str) -> Harness<'static, Host> {
    let mut harness = harness(host);
    harness.get_by_role_and_label(Role::DisclosureTriangle, section).click();
    harness.run();
    harness
}

/// Returns the control of a parameter, which carries its label; for the map of the inset its first button.
pub(crate) fn query_control<'a>(harness: &'a Harness<'_, Host>, parameter: &Parameter) -> Option<Node<'a>> {
    let (role, label) = match &parameter.kind {
        Kind::Number(_) if parameter.id == INSET_MAP => (Role::RadioButton, inset_button(1)),
        Kind::Number(Number { unset: Some(unset), .. })
            if parameter.get(&harness.state().settings) == Some(Value::Unset) =>
        {
            (Role::CheckBox, format!("{}: {}", parameter.label, unset.option.label))
        }
        Kind::Number(_) => (Role::Slider, parameter.label.to_owned()),
        Kind::Choice(_) => (Role::ComboBox, parameter.label.to_owned()),
        Kind::Toggle => (Role::CheckBox, parameter.label.to_owned()),
    };
    find(harness, role, &label)
}

/// Returns the only widget with a role and name, if there is one.
pub(crate) fn find<'a>(harness: &'a Harness<'_, Host>, role: Role, label: &str) -> Option<Node<'a>> {
    let mut found =
        harness.query_all_by_role(role).filter(|node| node.accesskit_node().label().as_deref() == Some(label));
    let first = found.next();
    assert!(found.next().is_none(), "there are several of {label}");
    first
}

pub(crate) fn control<'a>(harness: &'a Harness<'_, Host>, parameter: &Parameter) -> Node<'a> {
    query_control(harness, parameter).unwrap_or_else(|| panic!("{} has no control", parameter.id))
}

pub(crate) fn inset_button(map: usize) -> String {
    format!("Show map {map} in the inset")
}

/// Returns least and greatest value of a number, optional or not, and its value.
pub(crate) fn number(parameter: &Parameter, settings: &Settings) -> Option<(f64, f64, f64)> {
    let Kind::Number(Number { min, max, .. }) = parameter.kind else { return None };
    parameter.number(settings).map(|value| (min, max, value))
}

/// Returns the check box of an optional number.
pub(crate) fn unset_box<'a>(harness: &'a Harness<'_, Host>, parameter: &Parameter) -> Node<'a> {
    let Kind::Number(Number { unset: Some(unset), .. }) = parameter.kind else { panic!("{}", parameter.id) };
    find(harness, Role::CheckBox, &format!("{}: {}", parameter.label, unset.option.label)).expect(parameter.id)
}

pub(crate) fn number_field<'a>(harness: &'a Harness<'_, Host>, id: &str) -> Node<'a> {
    harness.get_by_role_and_label(Role::SpinButton, parameter(id).expect(id).label)
}

pub(crate) fn type_into(harness: &mut Harness<'_, Host>, id: &str, text: &str) {
    number_field(harness, id).focus();
    harness.run();
    number_field(harness, id).type_text(text);
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
}

/// Clicks a button by its name.
pub(crate) fn press(harness: &mut Harness<'_, Host>, name: &str) {
    harness.get_by_role_and_label(Role::Button, name).click();
    harness.run();
}

pub(crate) fn wait_for_the_tooltip<State>(harness: &mut Harness<'_, State>) {
    harness.run_steps(30);
}

/// Returns every drawn text with its place.
pub(crate) fn texts<State>(harness: &Harness<'_, State>) -> Vec<(Rect, String)> {
    let mut texts = Vec::new();
    for ClippedShape { shape, .. } in &harness.output().shapes {
        visit_texts(shape, &mut |rect, text, _| texts.push((rect, text.to_owned())));
    }
    texts
}

/// Visits the texts of a shape: place, text, and whether it was shortened.
pub(crate) fn visit_texts(shape: &Shape, found: &mut impl FnMut(Rect, &str, bool)) {
    match shape {
        Shape::Vec(shapes) => shapes.iter().for_each(|shape| visit_texts(shape, found)),
        Shape::Text(text) if !text.galley.text().is_empty() => {
            found(text.visual_bounding_rect(), text.galley.text(), text.galley.elided);
        }
        _ => {}
    }
}
