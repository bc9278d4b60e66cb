//! Every command of the panel, and the parts that a host leaves out.

use egui::ThemePreference;
use egui::accesskit::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use shadowfit::Technique;
use shadowfit_egui::{Artefact, Changes, Command, Panel, Part, Toggle, Tune};

use crate::host::{Host, harness, harness_with, press, wait_for_the_tooltip};
use crate::states::{busy, changed, session, tune_done};

/// Returns the panel's commands since the last call.
fn asked(harness: &mut Harness<'_, Host>) -> Vec<Command> {
    std::mem::take(&mut harness.state_mut().commands)
}

#[test]
fn each_artefact_button_asks_to_show_its_artefact() {
    for artefact in Artefact::ALL {
        let mut harness = harness(Host::default());
        press(&mut harness, &format!("Show {}", artefact.label().to_lowercase()));
        assert_eq!(harness.state().commands, [Command::ShowArtefact(artefact)]);
    }
}

#[test]
fn the_card_narrates_and_explains_then_fixes_then_says_what_changed_and_shows_again() {
    for artefact in Artefact::ALL {
        let mut host = Host::default();
        (host.shown.artefact, host.shown.narration) = (Some(artefact), "Look at the wall.".into());
        host.shown.changes = changed();
        let mut harness = harness(host);
        harness.get_by_label("Look at the wall.");
        harness.get_by_label(artefact.explanation());
        assert!(harness.query_by_label_contains("0 → 1 texel").is_none());
        press(&mut harness, "Fix");
        assert_eq!(asked(&mut harness), [Command::FixArtefact]);

        harness.state_mut().shown.fixed = true;
        harness.run();
        harness.get_by_label(artefact.cure());
        harness.get_by_label_contains("0 → 1 texel");
        assert!(harness.query_by_label(artefact.explanation()).is_none());
        press(&mut harness, "Show again");
        assert_eq!(asked(&mut harness), [Command::ShowArtefact(artefact)]);
        press(&mut harness, "Close the artefact");
        assert_eq!(asked(&mut harness), [Command::CloseArtefact]);
    }
}

#[test]
fn the_buttons_at_the_top_ask_their_host() {
    let mut harness = harness(Host::default());
    press(&mut harness, "Screenshot");
    assert_eq!(asked(&mut harness), [Command::Screenshot(None)]);
    for (menu, label, command) in [
        ("Help", "Table of keys", Command::ToggleHelp),
        ("Help", "Check this GPU…", Command::CheckDevice),
        ("Reset", "Reset everything", Command::Reset),
        ("Reset", "Reset the camera", Command::ResetCamera),
        ("Copy", "Copy a link", Command::CopyLink),
        ("Copy", "Copy as Rust code", Command::CopyRust),
        ("Copy", "Copy the command line", Command::CopyCommandLine),
        ("Theme", "Dark", Command::SetTheme(ThemePreference::Dark)),
        ("Theme", "Light", Command::SetTheme(ThemePreference::Light)),
        ("Theme", "As the system", Command::SetTheme(ThemePreference::System)),
    ] {
        press(&mut harness, menu);
        press(&mut harness, label);
        assert_eq!(asked(&mut harness), [command]);
    }
}

#[test]
fn undo_and_redo_say_what_they_would_do_and_are_greyed_out_where_there_is_nothing() {
    let changes = Changes { undo: Some("Constant bias"), redo: None };
    let mut harness = harness(Host { changes, ..Host::default() });
    let is_disabled = |harness: &Harness<'_, Host>, name: &str| {
        harness.get_by_role_and_label(Role::Button, name).accesskit_node().is_disabled()
    };
    assert!(!is_disabled(&harness, "Undo") && is_disabled(&harness, "Redo"));
    harness.get_by_role_and_label(Role::Button, "Undo").hover();
    wait_for_the_tooltip(&mut harness);
    assert!(harness.query_by_label_contains("Undo: Constant bias (Ctrl+Z)").is_some());
    press(&mut harness, "Undo");
    assert_eq!(asked(&mut harness), [Command::Undo]);
    harness.state_mut().changes = Changes { undo: None, redo: Some("Filter") };
    harness.run();
    press(&mut harness, "Redo");
    assert_eq!(asked(&mut harness), [Command::Redo]);
}

#[test]
fn the_search_for_better_settings_is_begun_cancelled_applied_and_discarded() {
    let mut harness = harness(Host::default());
    let running = Tune::Running { tried: 12, at_most: 240, start_error: 2.0, best_error: 1.0, what: "PCF 5×5" };
    let failed = Tune::Failed("The picture has no pixel that faces the light.");
    let worse = Tune::Done { changes: &[], before: <_>::default(), after: <_>::default(), is_applied: false };
    for (tune, button, command) in [
        (Tune::Idle, "Auto-tune", Command::StartTune),
        (running, "Cancel", Command::CancelTune),
        (tune_done(false), "Apply", Command::ApplyTune),
        (tune_done(false), "Discard", Command::DiscardTune),
        (tune_done(true), "Tune again", Command::StartTune),
        (tune_done(true), "Close", Command::DiscardTune),
        (worse, "Tune again", Command::StartTune),
        (failed, "Try again", Command::StartTune),
    ] {
        harness.state_mut().tune = tune;
        harness.run();
        press(&mut harness, button);
        assert_eq!(asked(&mut harness), [command], "{button}");
    }
}

#[test]
fn the_card_of_the_search_tells_how_far_it_is_and_what_it_found() {
    let mut harness = harness(Host::default());
    harness.state_mut().tune =
        Tune::Running { tried: 12, at_most: 240, start_error: 2.0, best_error: 1.0, what: "PCF 5×5" };
    harness.run();
    harness.get_by_label("2.00\u{a0}% → 1.00\u{a0}%");
    harness.get_by_label("12 of at most 240 tried; now PCF 5×5");
    harness.get_by_role_and_label(Role::ProgressIndicator, "Progress of the search");
    harness.state_mut().tune = tune_done(false);
    harness.run();
    harness.get_by_label("Wrong pixels 2.13\u{a0}% → 0.74\u{a0}%");
    harness.get_by_label_contains("Receiver plane: 0 → 2.5 texels");
}

#[test]
fn two_techniques_are_compared_swapped_copied_and_left() {
    let mut harness = harness(Host::default());
    press(&mut harness, "Compare A | B");
    assert_eq!(asked(&mut harness), [Command::Compare(Toggle::On)]);
    harness.state_mut().compare = Some((Technique::default(), false));
    harness.run();
    assert!(harness.query_by_role_and_label(Role::Button, "Compare A | B").is_none());
    for (button, command) in [
        ("Swap A and B", Command::SwapSides),
        ("Copy A to B", Command::CopyToOther),
        ("Stop comparing", Command::Compare(Toggle::Off)),
    ] {
        press(&mut harness, button);
        assert_eq!(asked(&mut harness), [command]);
    }
    press(&mut harness, "Technique B");
    press(&mut harness, "Copy B to A");
    assert_eq!(asked(&mut harness), [Command::CopyToOther]);
}

#[test]
fn the_plots_are_paused_cleared_and_saved() {
    let mut harness = harness_with(session(), "Plots");
    press(&mut harness, "Save CSV");
    assert_eq!(asked(&mut harness), [Command::SaveFigures(None)]);
    let csv = harness.state().panel.figures_csv();
    assert!(csv.starts_with("time (s),wrong (%)") && csv.lines().count() > 2, "{csv}");
    press(&mut harness, "Pause");
    press(&mut harness, "Clear");
    harness.run_steps(5);
    let save = |harness: &Harness<'_, Host>| {
        harness.get_by_role_and_label(Role::Button, "Save CSV").accesskit_node().is_disabled()
    };
    assert!(save(&harness), "nothing comes in while it is paused");
    press(&mut harness, "Resume");
    harness.run_steps(5);
    assert!(!save(&harness));
}

#[test]
fn every_plot_can_be_chosen() {
    let mut harness = harness_with(session(), "Plots");
    for name in [
        "Wrong pixels, A | B",
        "Light error",
        "FLIP",
        "Crawl",
        "Pixels per texel",
        "Time of passes",
        "Texels drawn",
        "Wrong pixels",
    ] {
        harness.get_by_role_and_label(Role::ComboBox, "Plot").click();
        harness.run();
        harness.get_by_role_and_label(Role::Button, name).click();
        harness.run();
        assert_eq!(harness.get_by_role_and_label(Role::ComboBox, "Plot").value().as_deref(), Some(name));
    }
}

#[test]
fn a_host_leaves_out_what_it_does_not_use() {
    use Part::{Artefacts, Compare, Copy, Plots, Quality, Screenshot, Theme, Tune, Undo, UserPresets};
    let parts = [
        (Artefacts, Role::Button, "Show acne"),
        (Quality, Role::Label, "Quality"),
        (Tune, Role::Button, "Auto-tune"),
        (Compare, Role::Button, "Compare A | B"),
        (UserPresets, Role::Button, "Save the technique"),
        (Undo, Role::Button, "Undo"),
        (Copy, Role::Button, "Copy"),
        (Screenshot, Role::Button, "Screenshot"),
        (Theme, Role::Button, "Theme"),
        (Plots, Role::DisclosureTriangle, "Plots"),
    ];
    let is_there = |harness: &Harness<'_, Host>, role: Role, name: &str| match role {
        Role::Label => harness.query_by_label(name).is_some(),
        _ => harness.query_by_role_and_label(role, name).is_some(),
    };
    let whole = harness(Host::default());
    let panel = Panel::new().without(parts.map(|(part, _, _)| part));
    let less = harness(Host { panel, ..Host::default() });
    for (_, role, name) in parts {
        assert!(is_there(&whole, role, name) && !is_there(&less, role, name), "{name}");
    }
    assert!(is_there(&less, Role::ComboBox, "Technique"));
}

#[test]
fn both_themes_show_the_same_controls() {
    let names = |theme| {
        let harness = crate::host::harness_of(busy(), theme, 1.0, crate::host::HEIGHT);
        let names = harness.root().children_recursive().filter_map(|node| node.accesskit_node().label());
        names.collect::<Vec<_>>()
    };
    let dark = names(egui::Theme::Dark);
    assert!(dark.len() > 30);
    assert_eq!(dark, names(egui::Theme::Light));
}
