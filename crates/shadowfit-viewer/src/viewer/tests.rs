//! The viewer frame by frame, on the tests' adapter and without a window: saved state and what overrides it,
//! undo, comparison, artefacts and tuning through commands.

use std::path::Path;
use std::time::{Duration, Instant};

use clap::Parser;
use egui::{Pos2, RawInput, Rect, vec2};
use shadowfit::Maps;
use shadowfit::Technique;
use shadowfit_egui::{Artefact, Command, Toggle, Tune};
use shadowfit_params::tool::ViewMode;
use shadowfit_render::{FlyInput, Gpu};
use shadowfit_testing::{adapter_name, renderer_gpu};

use super::{Start, Viewer};
use crate::arguments::Arguments;
use crate::keep::saved::{Saved, Theme};
use crate::keep::store::Store;
use crate::platform::StateFile;
use crate::scene_source::SceneSource;
use crate::stage::Stage;

mod bars;
mod devices;
mod links;
mod narrow;
mod samples;
mod scenes;
mod scripts;
mod sides;
mod starts;
mod touch;

const SIZE: [u32; 2] = [640, 360];
/// Width and height of the maps.
const MAP_TEXELS: u32 = 256;
const FRAME: f32 = 1.0 / 30.0;

fn viewer(arguments: &[&str], store: Option<&Path>) -> Viewer {
    viewer_on(renderer_gpu(), arguments, store)
}

fn viewer_on(gpu: Gpu, arguments: &[&str], store: Option<&Path>) -> Viewer {
    // Judging takes the software driver longer than drawing. Tests of judging turn it on.
    let resolution = format!("map.resolution={MAP_TEXELS}");
    let all = ["viewer", "--adapter", adapter_name(), "--no-play", "--set", &resolution, "--set", "view.judge=off"];
    let arguments = Arguments::parse_from(all.iter().chain(arguments));
    let start = Start::new(&arguments).expect("arguments that make sense");
    let mut stage = Stage::empty(gpu, 1).expect("a stage");
    stage.read_depths();
    let store = store.map(|path| Store::new(StateFile::at(path.to_owned())));
    let viewer = Viewer::new(stage, wgpu::TextureFormat::Rgba8Unorm, start, store);
    // With a quarter of a pixel per point, the software driver draws a sixteenth of the pixels.
    viewer.interface.context.set_pixels_per_point(0.25);
    viewer
}

fn frame(viewer: &mut Viewer) {
    frame_with(viewer, Vec::new());
}

/// Advances the viewer's clock by some seconds, in a few long frames.
fn pass(viewer: &mut Viewer, seconds: f32) {
    const FRAMES: u8 = 6;
    (0..FRAMES).for_each(|_| frame_of(viewer, Vec::new(), seconds / f32::from(FRAMES)));
}

fn frame_with(viewer: &mut Viewer, events: Vec<egui::Event>) {
    frame_of(viewer, events, FRAME);
}

fn frame_of(viewer: &mut Viewer, events: Vec<egui::Event>, seconds: f32) {
    let screen_rect = Some(Rect::from_min_size(Pos2::ZERO, vec2(SIZE[0] as f32, SIZE[1] as f32)));
    let input = RawInput { screen_rect, time: Some(viewer.clock), events, ..Default::default() };
    let _ = viewer.frame(input, seconds);
}

/// Draws a frame while waiting for a thread, and then sleeps, since drawing takes CPU time from the thread.
fn wait(viewer: &mut Viewer) {
    let start = Instant::now();
    frame(viewer);
    std::thread::sleep((3 * start.elapsed()).max(Duration::from_millis(40)));
}

/// Draws frames until running work has ended, even with an error.
fn settle(viewer: &mut Viewer, is_over: impl Fn(&Viewer) -> bool) {
    for _ in 0..6000 {
        wait(viewer);
        if is_over(viewer) {
            return;
        }
    }
    panic!("it goes on and on");
}

/// Draws frames until a condition holds.
fn until(viewer: &mut Viewer, what: &str, is_so: impl Fn(&Viewer) -> bool) {
    for _ in 0..6000 {
        wait(viewer);
        assert!(viewer.failure.is_none(), "{:?}", viewer.failure);
        if is_so(viewer) {
            return;
        }
    }
    panic!("{what} never happens");
}

fn ready(arguments: &[&str], store: Option<&Path>) -> Viewer {
    loaded(viewer(arguments, store))
}

fn loaded(mut viewer: Viewer) -> Viewer {
    until(&mut viewer, "the scene", Viewer::is_ready);
    viewer
}

fn run(viewer: &mut Viewer, command: Command) {
    viewer.ask(command);
    frame(viewer);
}

#[test]
fn gpu_what_is_saved_comes_back_and_yields_to_the_technique_and_that_to_set() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("viewer.toml");
    let mut first = ready(&["plain"], Some(&path));
    run(&mut first, Command::Technique("calm-4".to_owned()));
    run(&mut first, Command::Set("bias.constant".to_owned(), "0.75".to_owned()));
    run(&mut first, Command::SetTheme(egui::ThemePreference::Light));
    run(&mut first, Command::SetBookmark(4));
    run(&mut first, Command::SavePreset("mine".to_owned()));
    let (technique, camera) = (first.stage.settings.technique, first.stage.camera);
    first.save();
    drop(first);

    let mut second = ready(&[], Some(&path));
    assert_eq!(second.source, SceneSource::from_text("plain"), "the scene of the last time");
    let technique = technique.with_resolution(MAP_TEXELS, MAP_TEXELS);
    assert_eq!(second.stage.settings.technique, technique, "but for what the arguments set");
    assert!((second.stage.camera.position - camera.position).length() < 1e-9);
    assert_eq!((second.saved.theme, second.presets.len()), (Theme::Light, 1));
    run(&mut second, Command::Reset);
    let maps = second.stage.settings.technique.maps;
    assert_eq!(maps, Maps::default(), "a reset goes to the start, not to the file");
    drop(second);

    let third = ready(&["--technique", "stable-4", "--set", "bias.constant=0.25"], Some(&path));
    let mut expected = Technique::preset("stable-4").expect("a preset").with_resolution(MAP_TEXELS, MAP_TEXELS);
    expected.bias.constant = 0.25;
    let fit = third.stage.settings.technique.fit;
    (expected.fit.max_distance, expected.fit.caster_extension) = (fit.max_distance, fit.caster_extension);
    assert_eq!(third.stage.settings.technique, expected);
    assert_eq!(third.source, SceneSource::from_text("plain"));
    drop(third);

    let (kept, _) = Store::new(StateFile::at(path)).load();
    assert_eq!(kept.map(|kept: Saved| kept.bookmarks.len()), Some(1));
}

#[test]
fn gpu_a_first_scene_that_cannot_be_loaded_ends_the_viewer_and_a_later_one_is_told() {
    let mut broken = viewer(&["no/such/scene.glb"], None);
    for _ in 0..2000 {
        frame(&mut broken);
        if broken.window_requests.quit {
            break;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let error = format!("{:#}", broken.failure.take().expect("it ends with an error"));
    assert!(error.contains("no/such/scene.glb"), "{error}");

    let mut viewer = ready(&[], None);
    run(&mut viewer, Command::OpenFile("no/such/scene.glb".into()));
    until(&mut viewer, "a message", |viewer| viewer.message.is_some());
    assert!(!viewer.window_requests.quit && viewer.source == SceneSource::default());
}

#[test]
fn gpu_changes_are_taken_back_one_by_one() {
    let mut viewer = ready(&[], None);
    let pause = |viewer: &mut Viewer| pass(viewer, 2.0);
    pause(&mut viewer);
    let before = viewer.stage.settings;
    for (id, value) in [("map.filter", "point"), ("splits.count", "2")] {
        run(&mut viewer, Command::Set(id.to_owned(), value.to_owned()));
        pause(&mut viewer);
    }
    run(&mut viewer, Command::Undo);
    assert_eq!(viewer.stage.settings.technique.maps.count(), 4);
    assert_ne!(viewer.stage.settings, before);
    run(&mut viewer, Command::Undo);
    assert_eq!(viewer.stage.settings, before);
    run(&mut viewer, Command::Redo);
    run(&mut viewer, Command::Redo);
    assert_eq!(viewer.stage.settings.technique.maps.count(), 2);
}

#[test]
fn gpu_two_techniques_are_drawn_judged_and_swapped() {
    let mut viewer = ready(&["--technique", "xna-1", "--set", "view.judge=on"], None);
    run(&mut viewer, Command::Compare(Toggle::On));
    run(&mut viewer, Command::View(ViewMode::Error));
    until(&mut viewer, "both are judged", |viewer| viewer.stage.is_judged());
    let wrong = |viewer: &mut Viewer| {
        let figures = viewer.stage.figures(SIZE, None);
        [figures.judged, figures.judged_other].map(|judged| judged.expect("it was judged").wrong)
    };
    let [a, b] = wrong(&mut viewer);
    assert!(a > 2.0 * b, "one map of the sample is wrong in {a} %, four maps in {b} %");
    let [technique, other] = [Some(viewer.stage.settings.technique), viewer.stage.other_technique()];
    run(&mut viewer, Command::SwapSides);
    assert_eq!([Some(viewer.stage.settings.technique), viewer.stage.other_technique()], [other, technique]);
    run(&mut viewer, Command::Compare(Toggle::Off));
    assert!(!viewer.stage.is_comparing());
}

#[test]
fn gpu_an_artefact_is_found_on_a_thread_shown_told_and_fixed() {
    let mut viewer = ready(&[], None);
    run(&mut viewer, Command::ShowArtefact(Artefact::Acne));
    until(&mut viewer, "acne", |viewer| viewer.stage.shown().is_some());
    assert!(viewer.stage.narration().contains("texel"), "{}", viewer.stage.narration());
    run(&mut viewer, Command::FixArtefact);
    assert_eq!(viewer.stage.shown().map(|shown| shown.fixed), Some(true));
    assert!(viewer.stage.cure_changes().iter().any(|line| line.contains('→')), "{:?}", viewer.stage.cure_changes());
}

#[test]
fn gpu_the_card_of_an_artefact_comes_back_as_it_was_and_marks_outlast_it() {
    let mut viewer = ready(&[], None);
    let pause = |viewer: &mut Viewer| pass(viewer, 2.0);
    pause(&mut viewer);
    run(&mut viewer, Command::ShowArtefact(Artefact::Acne));
    until(&mut viewer, "acne", |viewer| viewer.stage.shown().is_some());
    run(&mut viewer, Command::NextMarks);
    pause(&mut viewer);
    let card = viewer.stage.artefact_show().clone();
    run(&mut viewer, Command::CloseArtefact);
    assert_ne!(viewer.stage.settings.view.marks, shadowfit_params::tool::ErrorMarks::Off);
    pause(&mut viewer);
    run(&mut viewer, Command::Undo);
    assert_eq!(*viewer.stage.artefact_show(), card);
    assert!(viewer.stage.narration().contains("texel") && viewer.stage.notice().is_none());
}

#[test]
fn gpu_a_search_for_a_technique_can_be_stopped_and_taken_over() {
    let mut viewer = ready(&["--technique", "xna-1"], None);
    run(&mut viewer, Command::StartTune);
    let tried = |viewer: &Viewer| matches!(viewer.tuning.shown(), Tune::Running { tried, .. } if tried >= 3);
    until(&mut viewer, "three techniques", tried);
    run(&mut viewer, Command::CancelTune);
    until(&mut viewer, "the end", |viewer| !viewer.tuning.is_running());
    let Tune::Done { before, after, .. } = viewer.tuning.shown() else { panic!("{:?}", viewer.tuning.shown()) };
    assert!(after.wrong <= before.wrong, "{} % after {} %", after.wrong, before.wrong);
    let technique = viewer.stage.settings.technique;
    run(&mut viewer, Command::ApplyTune);
    assert_ne!(viewer.stage.settings.technique, technique);
}

#[test]
fn gpu_a_picture_brings_its_settings_back_when_it_is_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("picture.png");
    let mut viewer = ready(&[], None);
    run(&mut viewer, Command::Set("bias.slope".to_owned(), "1.25".to_owned()));
    let settings = viewer.stage.settings;
    run(&mut viewer, Command::Screenshot(Some(path.clone())));
    run(&mut viewer, Command::Reset);
    assert_ne!(viewer.stage.settings, settings);
    run(&mut viewer, Command::OpenFile(path));
    assert_eq!(viewer.stage.settings, settings);
}

#[test]
fn gpu_the_pixel_under_a_resting_pointer_is_explained() {
    let mut viewer = ready(&[], None);
    until(&mut viewer, "rays", |viewer| viewer.stage.prepared_scene().ready_rays().is_some());
    let (size, at) = (viewer.interface.pictures.size(), Some([0.5, 0.9]));
    for _ in 0..6000 {
        viewer.stage.ask_why(at, size);
        viewer.stage.update(&FlyInput::default(), FRAME);
        if viewer.stage.why().is_some_and(|card| card.stored_depth.is_some()) {
            break;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let card = viewer.stage.why().expect("the ground is there");
    assert!(card.map.is_some() && card.reason.len() > 10 && card.map_reason.contains("map"), "{card:?}");
    viewer.stage.settings.technique.bias.constant += 1.0;
    viewer.stage.ask_why(at, size);
    assert_eq!(viewer.stage.why(), None, "another technique");
}

#[test]
fn gpu_a_double_click_keeps_the_roll_and_moves_an_orthographic_picture_across() {
    let mut viewer = ready(&[], None);
    until(&mut viewer, "rays", |viewer| viewer.stage.prepared_scene().ready_rays().is_some());
    viewer.stage.camera.roll = 0.3;
    run(&mut viewer, Command::Set("camera.height".to_owned(), "4".to_owned()));
    let before = viewer.stage.camera;
    run(&mut viewer, Command::Focus([0.6, 0.55]));
    let after = viewer.stage.camera;
    let way = after.position - before.position;
    assert!(way.length() > 0.1 && way.dot(before.forward().as_dvec3()).abs() < 1e-4, "{way}");
    assert_eq!((after.yaw, after.pitch, after.roll), (before.yaw, before.pitch, 0.3));
    let height = viewer.stage.settings.camera.height.expect("it stays orthographic");
    assert!((height - 1.6).abs() < 1e-5, "{height}");
    run(&mut viewer, Command::Set("camera.height".to_owned(), "perspective".to_owned()));
    run(&mut viewer, Command::Focus([0.6, 0.55]));
    assert_ne!(viewer.stage.camera.position, after.position);
    assert_eq!(viewer.stage.camera.roll, 0.3);
}

#[test]
fn gpu_a_click_flies_nowhere_where_the_picture_is_not_the_cameras() {
    let mut viewer = ready(&[], None);
    until(&mut viewer, "rays", |viewer| viewer.stage.prepared_scene().ready_rays().is_some());
    let camera = viewer.stage.camera;
    run(&mut viewer, Command::View(ViewMode::Outside));
    run(&mut viewer, Command::Focus([0.5, 0.9]));
    assert_eq!(viewer.stage.camera, camera);
    run(&mut viewer, Command::View(ViewMode::Error));
    run(&mut viewer, Command::Focus([0.5, 0.9]));
    assert_ne!(viewer.stage.camera, camera);
}
