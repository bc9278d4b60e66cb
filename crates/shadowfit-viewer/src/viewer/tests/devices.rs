//! Lost devices: in each view, with a second technique, while a scene is loading, in a sample, and
//! repeatedly.

use shadowfit_testing::open_renderer_gpu;

use super::*;
use crate::viewer::Renewals;

fn ready(arguments: &[&str]) -> Viewer {
    loaded(viewer_on(open_renderer_gpu(), arguments, None))
}

/// Loses the device, draws a frame with the lost one, and continues with another one.
fn lose(viewer: &mut Viewer) {
    let gpu = viewer.stage.gpu().clone();
    gpu.keep_faults();
    gpu.device.destroy();
    frame(viewer);
    settle(viewer, |_| gpu.lost().is_some());
    assert_eq!(gpu.take_faults(), [], "a lost device is no other fault");
    let why = gpu.lost().unwrap_or_default();
    viewer.move_to(open_renderer_gpu(), wgpu::TextureFormat::Rgba8Unorm, &why).expect("another device");
}

fn picture(viewer: &mut Viewer) -> Vec<u8> {
    for _ in 0..4 {
        frame(viewer);
    }
    viewer.interface.pictures.read_back(&viewer.stage).wait(viewer.stage.gpu()).expect("a device that works")
}

#[test]
fn gpu_a_lost_device_takes_nothing_along_in_any_view() {
    let mut viewer = ready(&["--technique", "stable-4", "--set", "view.judge=off"]);
    run(&mut viewer, Command::Set("bias.constant".to_owned(), "0.25".to_owned()));
    viewer.stage.camera.position.y += 3.0;
    let (settings, camera) = (viewer.stage.settings, viewer.stage.camera);
    let before = picture(&mut viewer);
    lose(&mut viewer);
    assert!(viewer.message.as_ref().is_some_and(|message| message.text.contains("replaced")));
    assert_eq!((viewer.stage.settings, viewer.stage.camera), (settings, camera));
    assert!(picture(&mut viewer) == before, "the picture is another one");
    for mode in ViewMode::ALL {
        viewer.stage.settings.view.mode = mode;
        frame(&mut viewer);
        lose(&mut viewer);
        frame(&mut viewer);
        assert!(viewer.is_ready() && viewer.failure.is_none(), "{mode:?}");
    }
}

// Opens a device with a scene, and waits for a look-up with its shaders: 3 s on the software adapter.
#[test]
fn gpu_the_check_of_the_device_is_shown_cancelled_copied_and_closed_beside_frames() {
    let mut viewer = ready(&[]);
    let link = viewer.link().to_fragment();
    run(&mut viewer, Command::CheckDevice);
    let has_facts = |viewer: &Viewer| viewer.device_check.report().is_some_and(|report| !report.facts.is_empty());
    until(&mut viewer, "the device of the check", has_facts);
    assert!(viewer.device_check.is_running() && viewer.is_waiting());
    run(&mut viewer, Command::CancelCheck);
    until(&mut viewer, "the end of the check", |viewer| !viewer.device_check.is_running());
    let report = viewer.device_check.report().expect("the dialog stays open").clone();
    assert!(report.has_ended() && !report.has_passed(), "{}", report.text());
    viewer.ask(Command::CopyCheck);
    let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, vec2(640.0, 360.0)));
    let copied =
        [(); 3].map(|()| viewer.frame(RawInput { screen_rect, ..Default::default() }, FRAME).1.commands).concat();
    assert_eq!(copied, [egui::OutputCommand::CopyText(report.text())]);
    run(&mut viewer, Command::Escape);
    assert!(viewer.device_check.report().is_none() && !viewer.window_requests.quit);
    assert_eq!(viewer.link().to_fragment(), link, "the check changes nothing that a link keeps");
    assert_eq!(viewer.history.undo_name(), None, "nor anything to undo");
    // A check that is closed while it runs leaves nothing behind.
    run(&mut viewer, Command::CheckDevice);
    run(&mut viewer, Command::CloseCheck);
    frame(&mut viewer);
    assert!(!viewer.device_check.is_running() && viewer.device_check.report().is_none());
}

#[test]
fn gpu_two_techniques_a_frozen_fit_and_a_sample_outlive_their_device() {
    let mut viewer = ready(&[]);
    run(&mut viewer, Command::Compare(Toggle::On));
    run(&mut viewer, Command::ToggleFreeze);
    frame(&mut viewer);
    let (other, maps) = (viewer.stage.other_technique(), viewer.stage.maps(SIZE));
    viewer.stage.camera.yaw += 0.5;
    lose(&mut viewer);
    frame(&mut viewer);
    assert!(other.is_some() && viewer.stage.other_technique() == other);
    assert_eq!(viewer.stage.maps(SIZE), maps, "the frozen fit is of the view before");

    let mut sample = ready(&["--sample", "xna-shadow-mapping"]);
    let before = picture(&mut sample);
    lose(&mut sample);
    assert!(picture(&mut sample) == before, "the sample is another picture");
}

#[test]
fn gpu_what_was_under_way_on_a_lost_device_is_begun_again_or_told() {
    let mut viewer = ready(&[]);
    viewer.ask(Command::Open("plain".to_owned()));
    frame(&mut viewer);
    lose(&mut viewer);
    until(&mut viewer, "the scene that was asked for", |viewer| viewer.source == SceneSource::from_text("plain"));
    run(&mut viewer, Command::StartTune);
    lose(&mut viewer);
    run(&mut viewer, Command::CancelTune);
    run(&mut viewer, Command::ShowArtefact(Artefact::Acne));
    lose(&mut viewer);
    settle(&mut viewer, |viewer| viewer.searching.is_none());
    assert!(viewer.failure.is_none(), "{:?}", viewer.failure);
}

#[test]
fn gpu_a_device_that_was_lost_for_want_of_memory_comes_back_with_smaller_maps() {
    let mut viewer = ready(&["--technique", "stable-4", "--set", "map.resolution=512"]);
    let resolution = viewer.stage.settings.technique.fit.resolution;
    viewer.move_to(open_renderer_gpu(), wgpu::TextureFormat::Rgba8Unorm, "Out of memory").expect("another device");
    assert_eq!(viewer.stage.settings.technique.fit.resolution, resolution / 2);
    assert!(viewer.message.as_ref().is_some_and(|message| message.text.contains("256 × 256")));
}

#[test]
fn a_device_that_is_lost_again_at_once_ends_the_viewer_with_what_to_do() {
    let mut renewals = Renewals::default();
    renewals.next("the driver was reset").expect("the first time");
    let error = renewals.next("removed").expect_err("at once").to_string();
    assert!(error.contains("removed") && error.contains("--software"), "{error}");
}
