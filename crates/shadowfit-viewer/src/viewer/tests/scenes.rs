//! State that belongs to a scene and ends with it.

use super::*;

#[test]
fn gpu_nothing_can_be_taken_back_that_was_done_before_the_scene_was_there() {
    let mut viewer = ready(&["--technique", "xna-1"], None);
    let pause = |viewer: &mut Viewer| pass(viewer, 2.0);
    pause(&mut viewer);
    assert_eq!(viewer.history.undo_name(), None);
    run(&mut viewer, Command::Set("bias.slope".to_owned(), "2".to_owned()));
    pause(&mut viewer);
    assert!(viewer.history.undo_name().is_some());
    run(&mut viewer, Command::Open("plain".to_owned()));
    until(&mut viewer, "the plain", |viewer| viewer.loading.is_none());
    pause(&mut viewer);
    assert_eq!(viewer.history.undo_name(), None, "the settings of before are of another scene");
}

#[test]
fn gpu_the_start_of_rays_belongs_to_its_scene() {
    let mut viewer = ready(&[], None);
    run(&mut viewer, Command::Set("view.ray_offset".to_owned(), "0.5".to_owned()));
    run(&mut viewer, Command::Set("view.shadows".to_owned(), "off".to_owned()));
    run(&mut viewer, Command::Open("plain".to_owned()));
    until(&mut viewer, "the plain", |viewer| viewer.loading.is_none());
    let view = viewer.stage.settings.view;
    assert_eq!((view.ray_offset, view.shadows), (None, false));
}

#[test]
fn gpu_a_search_for_a_technique_ends_with_its_scene() {
    let mut viewer = ready(&["--technique", "xna-1"], None);
    run(&mut viewer, Command::StartTune);
    assert!(viewer.tuning.is_running());
    run(&mut viewer, Command::Open("plain".to_owned()));
    until(&mut viewer, "the end of the search", |viewer| viewer.loading.is_none() && !viewer.tuning.is_running());
    assert_eq!(viewer.tuning.shown(), Tune::Idle, "nothing is offered that was found for another scene");
}

#[test]
fn gpu_a_reset_goes_back_to_one_technique_that_the_panel_edits_and_to_no_search() {
    let mut viewer = ready(&[], None);
    run(&mut viewer, Command::Compare(Toggle::On));
    viewer.interface.edits_other = true;
    run(&mut viewer, Command::ShowArtefact(Artefact::Acne));
    run(&mut viewer, Command::Reset);
    assert!(viewer.searching.is_none() && !viewer.interface.edits_other && !viewer.stage.is_comparing());
}
