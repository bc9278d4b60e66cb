//! The dialog of the device check.

use egui::accesskit::Role;
use egui::{Theme, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use shadowfit_egui::{Command, device_check_overlay};
use shadowfit_params::device_check::{CheckReport, CheckRow, CheckState};

use crate::host::builder;
use crate::layout::assert_no_text_is_clipped;

/// A report, and the commands of its dialog.
type Dialog = (CheckReport, Vec<Command>);

fn report(states: [CheckState; 3]) -> CheckReport {
    let names = ["Look-up", "Kept maps", "Exact edges"];
    let row = |(state, name): (CheckState, &'static str)| CheckRow {
        name,
        about: "What the device computes, with what the CPU computes from the same texels, as words that wrap.",
        seconds: if matches!(state, CheckState::Waiting | CheckState::Running) { 0.0 } else { 12.3 },
        state,
        found: "7 of 115200 factors differ; greatest difference 0.0012".to_owned(),
        tolerance: "2/256: samplers place a look-up between texels in steps of 1/256 along both axes.",
    };
    let facts = vec![("adapter", "A device of some name".to_owned()), ("backend", "Vulkan".to_owned())];
    CheckReport { facts, rows: states.into_iter().zip(names).map(row).collect() }
}

fn dialog(size: [f32; 2], states: [CheckState; 3]) -> Harness<'static, Dialog> {
    let show = |ui: &mut egui::Ui, (report, asked): &mut Dialog| asked.extend(device_check_overlay(ui.ctx(), report));
    let mut harness = builder(Vec2::from(size), Theme::Dark, 1.0).build_ui_state(show, (report(states), Vec::new()));
    harness.run();
    harness
}

/// Presses a button, and returns the commands of the dialog.
fn pressed(harness: &mut Harness<'static, Dialog>, label: &str) -> Vec<Command> {
    harness.get_by_role_and_label(Role::Button, label).click();
    harness.run();
    std::mem::take(&mut harness.state_mut().1)
}

#[test]
fn while_a_check_runs_it_can_be_cancelled_and_closed_and_not_be_copied() {
    let mut harness = dialog([1280.0, 720.0], [CheckState::Passed, CheckState::Running, CheckState::Waiting]);
    harness.get_by_label("Checking: 1 of 3 checks have ended.");
    harness.get_by_label("Progress of the check");
    assert_eq!(pressed(&mut harness, "Copy report"), []);
    assert_eq!(pressed(&mut harness, "Cancel"), [Command::CancelCheck]);
    assert_eq!(pressed(&mut harness, "Close"), [Command::CloseCheck]);
    assert_eq!(pressed(&mut harness, "Close window"), [Command::CloseCheck]);
}

#[test]
fn a_check_that_has_ended_shows_results_and_reasons_and_can_be_copied_and_run_again() {
    let reason = "this graphics device has no compute shaders";
    let missing = CheckState::Unavailable(reason.to_owned());
    let mut harness = dialog([1280.0, 720.0], [CheckState::Passed, CheckState::Failed, missing]);
    harness.get_by_label_contains("Do not trust shadows on this device: kept maps failed");
    for label in ["passed", "FAILED", "not available", reason] {
        harness.get_by_label(label);
    }
    assert_eq!(harness.get_all_by_label("12.3 s").count(), 3);
    assert_eq!(pressed(&mut harness, "Copy report"), [Command::CopyCheck]);
    harness.get_by_label("Copied");
    assert_eq!(pressed(&mut harness, "Check again"), [Command::CheckDevice]);
}

#[test]
fn the_dialog_fits_a_window_and_a_phone() {
    for size in [[1280.0, 720.0], [390.0, 760.0]] {
        let harness = dialog(size, [CheckState::Passed, CheckState::Passed, CheckState::Passed]);
        assert_no_text_is_clipped(&harness, "the check of the device");
        for label in ["Copy report", "Check again", "Close", "Close window"] {
            let rect = harness.get_by_role_and_label(Role::Button, label).rect();
            let is_inside =
                rect.left() >= 0.0 && rect.top() >= 0.0 && rect.right() <= size[0] && rect.bottom() <= size[1];
            assert!(is_inside, "{label} in {size:?}: {rect:?}");
        }
    }
}
