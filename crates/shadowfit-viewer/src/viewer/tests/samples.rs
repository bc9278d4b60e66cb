//! Classic samples in the viewer: their controls, options and variants, their saved state, and commands that
//! do not apply.

use egui::Key;
use glam::{DVec3, Vec3};
use shadowfit_classics::SampleValues;

use super::*;

const XNA: &str = "xna-shadow-mapping";

fn values(viewer: &Viewer) -> &SampleValues {
    &viewer.stage.sample().expect("a sample").values
}

/// Draws a frame with a press or release of a key.
fn key(viewer: &mut Viewer, key: Key, pressed: bool) {
    let modifiers = egui::Modifiers::NONE;
    let event = egui::Event::Key { key, physical_key: None, pressed, repeat: false, modifiers };
    frame_with(viewer, vec![event]);
}

/// Holds a key for some frames.
fn hold(viewer: &mut Viewer, held: Key, frames: usize) {
    key(viewer, held, true);
    for _ in 1..frames {
        frame(viewer);
    }
    key(viewer, held, false);
}

#[test]
fn gpu_the_xna_sample_has_the_controls_of_its_source() {
    let mut viewer = ready(&["--sample", XNA], None);
    let start = viewer.stage.camera;
    assert!((start.position - DVec3::new(0.0, 70.0, 100.0)).length() < 1e-9);
    assert!(start.forward().abs_diff_eq(Vec3::new(0.0, -0.447_213_6, -0.894_427_2), 1e-6));
    // A second is thirty frames: 100 units along the view.
    hold(&mut viewer, Key::W, 30);
    let flown = (viewer.stage.camera.position - start.position).length();
    assert!((flown - 100.0).abs() < 0.5, "{flown}");
    // Half a second turns by half a radian.
    hold(&mut viewer, Key::ArrowLeft, 15);
    let turned = viewer.stage.camera.yaw - start.yaw;
    assert!((turned - 0.5).abs() < 0.01, "{turned}");
    // Q and E turn the model by 200 degrees a second, a whole turn in 1.8 s, and do not move the camera.
    let (place, seconds) = (viewer.stage.camera, viewer.stage.seconds());
    hold(&mut viewer, Key::E, 15);
    assert_eq!(viewer.stage.camera, place);
    assert!((viewer.stage.seconds() - seconds - 0.5).abs() < 0.01, "{}", viewer.stage.seconds());
    hold(&mut viewer, Key::Q, 15);
    assert!((viewer.stage.seconds() - seconds).abs() < 0.01 || (viewer.stage.seconds() - 1.8).abs() < 0.01);
    // R has the source's action.
    key(&mut viewer, Key::R, true);
    let camera = viewer.stage.camera;
    assert_eq!(camera.position, DVec3::new(0.0, 50.0, 50.0));
    assert!(camera.forward().abs_diff_eq(Vec3::NEG_Z, 1e-6));
    assert!(!viewer.window_requests.quit);
    key(&mut viewer, Key::Escape, true);
    assert!(viewer.window_requests.quit);
}

#[test]
fn gpu_a_sample_with_its_options_and_camera_comes_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("viewer.toml");
    let mut first = ready(&["--sample", "xna-shadow-mapping/hole"], Some(&path));
    run(&mut first, Command::Set("sample.bias".to_owned(), "0.004".to_owned()));
    run(&mut first, Command::Set("sample.format".to_owned(), "r16f".to_owned()));
    hold(&mut first, Key::W, 5);
    let camera = first.stage.camera;
    first.save();
    drop(first);
    let second = ready(&[], Some(&path));
    assert_eq!(second.source, SceneSource::from_text("xna-shadow-mapping/hole"));
    assert_eq!((values(&second).get("bias"), values(&second).choice("format")), (0.004, "r16f"));
    assert!((second.stage.camera.position - camera.position).length() < 1e-6);
    drop(second);
    // Arguments override saved state, and other scenes ignore it.
    let third = ready(&["--sample", XNA, "--set", "sample.bias=0"], Some(&path));
    assert_eq!((values(&third).get("bias"), values(&third).choice("format")), (0.0, "r32f"));
    drop(third);
    assert!(ready(&["plain"], Some(&path)).stage.sample().is_none());
}

#[test]
fn gpu_options_variants_and_reset_do_what_the_card_says() {
    let mut viewer = ready(&["--sample", XNA], None);
    run(&mut viewer, Command::ShowSampleVariant(Some(0)));
    assert_eq!((viewer.source.text().as_str(), values(&viewer).get("bias")), ("xna-shadow-mapping/acne", 0.0));
    let line = viewer.command_line();
    assert!(line.starts_with("viewer --sample xna-shadow-mapping/acne --no-state"), "{line}");
    assert!(!line.contains("sample.bias"), "the variant's name says it: {line}");
    run(&mut viewer, Command::SetSampleOption { index: 2, value: 1.0 });
    assert_eq!(values(&viewer).choice("format"), "r16f");
    assert!(viewer.command_line().contains("--set sample.format=r16f"));
    run(&mut viewer, Command::Reset);
    assert_eq!((values(&viewer).choice("format"), values(&viewer).get("bias")), ("r32f", 0.0));
    run(&mut viewer, Command::ShowSampleVariant(None));
    assert_eq!((viewer.source.text().as_str(), values(&viewer).changes().count()), (XNA, 0));
}

#[test]
fn gpu_a_change_of_an_option_is_undone_by_name() {
    let mut viewer = ready(&["--sample", XNA], None);
    let rest = |viewer: &mut Viewer| pass(viewer, 3.0);
    rest(&mut viewer);
    run(&mut viewer, Command::Set("sample.bias".to_owned(), "0.005".to_owned()));
    rest(&mut viewer);
    assert_eq!(viewer.history.undo_name(), Some("Bias"));
    run(&mut viewer, Command::Undo);
    assert_eq!(values(&viewer).get("bias"), 0.001);
    run(&mut viewer, Command::Redo);
    assert_eq!(values(&viewer).get("bias"), 0.005);
}

#[test]
fn gpu_what_is_for_techniques_waits_for_modern_maps() {
    let mut viewer = ready(&["--sample", XNA], None);
    assert!(viewer.stage.draws_sample());
    run(&mut viewer, Command::ShowArtefact(Artefact::Acne));
    run(&mut viewer, Command::Compare(Toggle::On));
    run(&mut viewer, Command::StartTune);
    assert!(viewer.searching.is_none() && !viewer.stage.is_comparing() && !viewer.tuning.is_running());
    assert!(viewer.message.as_ref().is_some_and(|message| message.text.contains("modern maps")));
    run(&mut viewer, Command::Set("sample.shadows".to_owned(), "ours".to_owned()));
    assert!(!viewer.stage.draws_sample());
    run(&mut viewer, Command::Compare(Toggle::On));
    assert!(viewer.stage.is_comparing());
}

#[test]
fn gpu_a_sample_is_measured_in_the_background() {
    let mut viewer = ready(&["--sample", XNA], None);
    run(&mut viewer, Command::MeasureSample);
    until(&mut viewer, "the figures", |viewer| !viewer.measuring.is_running());
    let lines = viewer.measuring.lines();
    assert!(lines.iter().any(|line| line.name.contains("modern maps") && line.value.ends_with('%')), "{lines:?}");
}

#[test]
fn gpu_samples_that_do_not_exist_are_refused_by_name() {
    let arguments = Arguments::parse_from(["viewer", "--sample", "no-such"]);
    let error = Start::new(&arguments).expect_err("no such sample").to_string();
    assert!(error.contains("no-such") && error.contains("--sample list"), "{error}");
    let mut viewer = viewer(&["--sample", XNA, "--set", "sample.bias=9"], None);
    settle(&mut viewer, |viewer| viewer.failure.is_some());
    let error = format!("{:#}", viewer.failure.take().expect("a failure"));
    assert!(error.contains("sample.bias=9") && error.contains("0..0.01"), "{error}");
}
