//! The card of a scene.

use egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use shadowfit_egui::{Card, CardChoice, CardControl, CardFigure, CardRow, Command};

use crate::host::{Host, find, harness, press, query_control};
use crate::states;

const VARIANTS: [CardChoice<'static>; 2] = [
    CardChoice { label: "Self-shadow acne", text: "Without a bias the character shadows itself in stripes." },
    CardChoice { label: "Cure: a larger map", text: "Four times the texels halve the staircase." },
];

const ROWS: [CardRow<'static>; 3] = [
    CardRow {
        label: "Map format",
        help: "What the map stores.",
        control: CardControl::Choice(&[("r32f", "32-bit float"), ("grey8", "8-bit, plain")]),
        value: 0.0,
    },
    CardRow {
        label: "Bias",
        help: "In units of the stored depth.",
        control: CardControl::Number { min: 0.0, max: 0.01, unit: "" },
        value: 0.001,
    },
    CardRow { label: "Map in a corner", help: "Shows it.", control: CardControl::Toggle, value: 1.0 },
];

fn card(is_technique: bool, shown: Option<usize>) -> Card<'static> {
    Card {
        title: "XNA Shadow Mapping",
        text: "A sun's shadow map from first principles.",
        flaw: "The box moves with the camera.",
        is_technique,
        first: "As its source",
        variants: &VARIANTS,
        shown,
        rows: &ROWS,
        measure: Some("Judges this view against rays."),
        figures: &[],
    }
}

/// Returns a host with a card in a real session.
pub(crate) fn session() -> Host {
    let figures = [("Wrong pixels, as its source", "0.32%"), ("Wrong pixels, modern maps", "0.03%")];
    let figures = figures.map(|(name, value)| CardFigure { name: name.to_owned(), value: value.to_owned() });
    // A test's host lives as long as the test.
    let figures: &'static [CardFigure] = Box::leak(Box::new(figures));
    Host { card: Some(Card { figures, ..card(false, Some(0)) }), ..states::session() }
}

#[test]
fn a_scene_with_a_card_shows_its_own_options_and_none_of_a_technique() {
    let shows_techniques = |host: Host| {
        let harness = harness(host);
        let kind = shadowfit_params::parameter("fit.kind").expect("a parameter");
        query_control(&harness, kind).is_some() || harness.query_by_label("Show acne").is_some()
    };
    assert!(shows_techniques(Host::default()));
    assert!(!shows_techniques(session()));
    assert!(shows_techniques(Host { card: Some(card(true, None)), ..Host::default() }), "modern maps have all of it");
    let harness = harness(session());
    assert!(find(&harness, Role::ComboBox, "Map format").is_some());
    assert!(find(&harness, Role::Slider, "Bias").is_some());
    assert!(find(&harness, Role::CheckBox, "Map in a corner").is_some());
    assert!(harness.query_by_label(VARIANTS[0].text).is_some(), "what is to be seen");
    assert!(harness.query_by_label("0.03%").is_some());
}

#[test]
fn options_variants_and_measuring_are_asked_for() {
    let mut harness = harness(session());
    find(&harness, Role::CheckBox, "Map in a corner").expect("a check box").click();
    harness.run();
    assert_eq!(harness.state().commands, [Command::SetSampleOption { index: 2, value: 0.0 }]);
    find(&harness, Role::ComboBox, "Map format").expect("a list").click();
    harness.run();
    harness.get_by_label("8-bit, plain").click();
    harness.run();
    assert_eq!(harness.state().commands.last(), Some(&Command::SetSampleOption { index: 0, value: 1.0 }));
    find(&harness, Role::ComboBox, "Variant").expect("a list").click();
    harness.run();
    harness.get_by_label(VARIANTS[1].label).click();
    harness.run();
    assert_eq!(harness.state().commands.last(), Some(&Command::ShowSampleVariant(Some(1))));
    press(&mut harness, "Measure");
    assert_eq!(harness.state().commands.last(), Some(&Command::MeasureSample));
}
