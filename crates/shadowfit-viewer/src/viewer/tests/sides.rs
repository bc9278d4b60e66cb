//! Two techniques: changes apply to the one that the panel edits.

use super::*;

/// Returns a viewer that compares two techniques. The panel edits B.
fn on_b() -> Viewer {
    let mut viewer = ready(&["--technique", "xna-1"], None);
    run(&mut viewer, Command::Compare(Toggle::On));
    viewer.interface.edits_other = true;
    viewer
}

#[test]
fn gpu_lines_and_files_change_the_technique_that_the_panel_edits() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("street.toml");
    let dropped = Technique::preset("calm-4").expect("a preset").with_resolution(256, 256);
    let dropped = shadowfit_study::NamedTechnique::from(dropped);
    std::fs::write(&path, dropped.to_toml().expect("text")).expect("written");
    let mut viewer = on_b();
    let a = viewer.stage.settings.technique;
    run(&mut viewer, Command::Set("bias.slope".to_owned(), "2.5".to_owned()));
    assert_eq!(viewer.stage.other_technique().map(|other| other.bias.slope), Some(2.5));
    run(&mut viewer, Command::Technique("calm-4".to_owned()));
    let expected = Technique::preset("calm-4").expect("a preset").with_lengths_of(&a);
    assert_eq!(viewer.stage.other_technique(), Some(expected));
    run(&mut viewer, Command::OpenFile(path));
    assert_eq!(viewer.stage.other_technique(), Some(dropped.technique));
    assert_eq!(viewer.stage.settings.technique, a);
    run(&mut viewer, Command::Set("view.mode".to_owned(), "maps".to_owned()));
    assert_eq!(viewer.stage.settings.view.mode, ViewMode::Maps);
}

#[test]
fn gpu_what_was_found_for_b_goes_to_b_wherever_it_is() {
    let mut viewer = on_b();
    run(&mut viewer, Command::Technique("xna-1".to_owned()));
    run(&mut viewer, Command::StartTune);
    let tried = |viewer: &Viewer| matches!(viewer.tuning.shown(), Tune::Running { tried, .. } if tried >= 3);
    until(&mut viewer, "three techniques", tried);
    run(&mut viewer, Command::CancelTune);
    until(&mut viewer, "the end", |viewer| !viewer.tuning.is_running());
    viewer.interface.edits_other = false;
    let techniques = |viewer: &Viewer| [Some(viewer.stage.settings.technique), viewer.stage.other_technique()];
    let [a, b] = techniques(&viewer);
    run(&mut viewer, Command::SwapSides);
    assert_eq!(techniques(&viewer), [b, a]);
    run(&mut viewer, Command::SwapSides);
    run(&mut viewer, Command::ApplyTune);
    assert_eq!(viewer.stage.settings.technique, a.expect("A"));
    assert_ne!(viewer.stage.other_technique(), b);
    run(&mut viewer, Command::Compare(Toggle::Off));
    run(&mut viewer, Command::ApplyTune);
    assert_eq!(viewer.stage.settings.technique, a.expect("A"), "B is not shown any more");
}
