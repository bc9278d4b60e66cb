//! The times when pictures are judged, and the picture of the figures: by the GPU in each frame, and by
//! threads at intervals.

use shadowfit::Technique;
use shadowfit::settings::Edges;
use shadowfit_params::tool::ViewMode;
use shadowfit_render::{FlyInput, RenderTarget, UpdateKind, UpdatedRect};
use shadowfit_scene::builtin::default_scene;
use shadowfit_testing::renderer_gpu;

use shadowfit_study::{Judging, SharedTruth, View};

use super::live::JudgedBy;
use super::*;

const SIZE: [u32; 2] = [160, 90];

/// Returns a stage with the default scene, judged by the GPU in each frame or by threads.
fn stage(on_gpu: bool) -> (Stage, RenderTarget) {
    let mut stage = Stage::new(renderer_gpu(), default_scene(), 1).expect("the default scene");
    stage.prepared_scene().rays();
    stage.read_depths();
    stage.settings.technique = stage.settings.technique.with_resolution(256, 256);
    stage.settings.view.play = false;
    stage.side.live.by = if on_gpu { JudgedBy::Gpu } else { JudgedBy::Threads };
    let target = stage.target(SIZE);
    (stage, target)
}

/// Advances the stage's clock while nothing moves.
fn wait(stage: &mut Stage, seconds: f32) {
    stage.update(&FlyInput::default(), seconds);
}

fn draw(stage: &mut Stage, target: &RenderTarget) {
    stage.draw(target);
    assert_eq!(stage.problem(), None);
}

/// Draws the same frame until it is judged.
fn judge(stage: &mut Stage, target: &RenderTarget) {
    for _ in 0..6000 {
        draw(stage, target);
        if stage.is_judged() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("it is never judged");
}

/// Changes the view: moves the camera to the side.
fn step(stage: &mut Stage) {
    stage.camera.position.x += 0.01;
}

#[test]
fn gpu_figures_of_an_older_picture_are_not_those_of_the_view() {
    let (mut stage, target) = stage(true);
    judge(&mut stage, &target);
    let wrong = |stage: &Stage| stage.judged_figures().expect("it was judged").wrong;
    let fine = wrong(&stage);
    stage.settings.technique = stage.settings.technique.with_count(1);
    draw(&mut stage, &target);
    let judging = stage.side.live.gpu_ms();
    assert!(judging.is_some_and(|ms| ms > 0.0), "its passes are timed");
    assert!(!stage.is_judged(), "its sums are on their way");
    assert_eq!(wrong(&stage), fine, "those of the picture before");
    judge(&mut stage, &target);
    assert!(wrong(&stage) > fine * 1.5, "{} %, then {fine} %", wrong(&stage));
}

#[test]
fn gpu_a_picture_that_is_waited_for_has_its_figures_at_once() {
    for on_gpu in [true, false] {
        let (mut stage, target) = stage(on_gpu);
        stage.wait_for_rays();
        for _ in 0..2 {
            draw(&mut stage, &target);
            assert!(stage.is_judged() && stage.judged_figures().is_some(), "on the GPU: {on_gpu}");
            step(&mut stage);
        }
    }
}

#[test]
fn gpu_a_picture_whose_verdicts_nothing_shows_is_judged_once_they_are_shown() {
    for on_gpu in [true, false] {
        let (mut stage, target) = stage(on_gpu);
        stage.wait_for_rays();
        for is_unseen in [true, false] {
            stage.set_unseen(is_unseen);
            draw(&mut stage, &target);
            assert_eq!(stage.is_judged(), !is_unseen, "on the GPU: {on_gpu}");
        }
    }
}

#[test]
fn gpu_a_view_that_stands_still_is_judged_again_when_its_maps_change() {
    let (mut stage, target) = stage(false);
    // Focused maps follow the visible demand, while windows keep their place.
    stage.settings.technique = Technique::preset("focused-4").expect("a preset").with_resolution(256, 256);
    stage.side.live.waits = true;
    draw(&mut stage, &target);
    let maps = |stage: &Stage| stage.side.evaluator.drawn_fits().to_vec();
    let figures = |stage: &Stage| stage.judged_figures().expect("it was judged");
    // The visible demand of the first frame places the maps of a later one.
    let (first, before) = (maps(&stage), figures(&stage));
    let has_changed = (0..1000).any(|_| {
        std::thread::sleep(std::time::Duration::from_millis(5));
        draw(&mut stage, &target);
        maps(&stage) != first
    });
    assert!(has_changed, "what was seen never arrives");
    let shown = figures(&stage);
    assert_ne!(shown, before);
    stage.side.live.forget();
    draw(&mut stage, &target);
    assert_eq!(shown, figures(&stage), "those of the maps that are shown");
}

#[test]
fn gpu_the_age_of_figures_is_told_by_the_clock_of_the_stage() {
    let (mut stage, target) = stage(false);
    stage.wait_for_rays();
    draw(&mut stage, &target);
    std::thread::sleep(std::time::Duration::from_millis(20));
    let age = |stage: &Stage| stage.judged_figures().expect("it was judged").age;
    assert_eq!(age(&stage), 0.0);
    wait(&mut stage, 1.5);
    assert_eq!(age(&stage), 1.5);
}

#[test]
fn gpu_threads_judge_a_moving_view_every_two_seconds_and_one_after_the_other_where_errors_are_shown() {
    let (mut stage, target) = stage(false);
    judge(&mut stage, &target);
    // Whether a step of this many seconds starts judging the next picture.
    let is_begun = |stage: &mut Stage, seconds: f32| {
        wait(stage, seconds);
        step(stage);
        draw(stage, &target);
        !stage.side.live.is_idle()
    };
    for _ in 0..9 {
        assert!(!is_begun(&mut stage, 0.2));
    }
    assert!(is_begun(&mut stage, 0.3), "two seconds after the last one");
    judge_what_is_begun(&mut stage, &target);
    assert!(!is_begun(&mut stage, 0.2));
    wait(&mut stage, 0.4);
    draw(&mut stage, &target);
    assert!(!stage.side.live.is_idle(), "the view stood still");
    judge_what_is_begun(&mut stage, &target);
    stage.settings.view.mode = ViewMode::Error;
    assert!(is_begun(&mut stage, 0.01));
    let picture = stage.side.live.picture().expect("one was judged");
    assert!(picture.depth.is_some(), "it tells which surfaces it shows");
}

/// Draws the same frame until the threads are idle.
fn judge_what_is_begun(stage: &mut Stage, target: &RenderTarget) {
    while !stage.side.live.is_idle() {
        std::thread::sleep(std::time::Duration::from_millis(5));
        draw(stage, target);
    }
}

#[test]
fn gpu_maps_that_are_drawn_for_the_judge_are_not_shown_as_kept() {
    let (mut stage, target) = stage(true);
    stage.settings.view.mode = ViewMode::Updates;
    draw(&mut stage, &target);
    let drawn = stage.side.evaluator.renderer.sun().updates();
    let maps = stage.settings.technique.maps.count() as usize;
    // Once each: moving casters are drawn with it.
    let is_whole = |update: &&UpdatedRect| matches!(update.content, UpdateKind::All | UpdateKind::Static);
    assert_eq!(drawn.iter().filter(is_whole).count(), maps, "{drawn:?}");
    assert_eq!(drawn.len(), maps, "{drawn:?}");
}

/// Returns the ꟻLIP error of the stage's view as reports measure it.
fn flip_as_in_reports(stage: &mut Stage) -> f32 {
    let (maps, view) = (stage.maps(SIZE), View { is_first: true, ..stage.view(SIZE) });
    let evaluator = &mut stage.side.evaluator;
    evaluator.judging = Judging { size: SIZE, crawl: false, flip: true, ..evaluator.judging };
    let judged = evaluator.judge(&stage.gpu, &mut stage.scene, &view, &maps, &mut SharedTruth::default());
    judged.expect("it can be judged").tally.figures().and_then(|figures| figures.flip).expect("measured") as f32
}

#[test]
fn gpu_a_view_that_rests_is_compared_with_true_shadows_as_in_reports() {
    for on_gpu in [true, false] {
        let (mut stage, target) = stage(on_gpu);
        stage.settings.technique = stage.settings.technique.with_count(1);
        let flip = |stage: &Stage| stage.judged_figures().expect("it was judged").flip;
        judge(&mut stage, &target);
        draw(&mut stage, &target);
        assert_eq!(flip(&stage), None, "it has just come to rest");
        wait(&mut stage, 0.4);
        draw(&mut stage, &target);
        let measured = (0..2000).find_map(|_| {
            std::thread::sleep(std::time::Duration::from_millis(5));
            flip(&stage)
        });
        let (measured, wanted) = (measured.expect("it is measured"), flip_as_in_reports(&mut stage));
        assert!(wanted > 0.01, "the shadows are coarse: {wanted}");
        assert!((measured - wanted).abs() < 0.01 * wanted, "{measured}, in reports {wanted}, on the GPU: {on_gpu}");
        wait(&mut stage, 2.5);
        step(&mut stage);
        judge(&mut stage, &target);
        assert_eq!(flip(&stage), None, "another picture");
    }
}

#[test]
fn gpu_a_picture_that_was_compared_is_drawn_with_all_its_maps_and_its_traced_edges() {
    for on_gpu in [true, false] {
        let mut stage = Stage::new(renderer_gpu(), default_scene(), 4).expect("the default scene");
        let traced = Technique { edges: Edges::Traced { samples: 1 }, ..Technique::default() };
        stage.settings.technique = traced.with_resolution(256, 256);
        stage.side.live.by = if on_gpu { JudgedBy::Gpu } else { JudgedBy::Threads };
        stage.wait_for_rays();
        let target = stage.target(SIZE);
        let mut pictures = Vec::new();
        for _ in 0..3 {
            // This also asserts that no line says that edges are filtered.
            draw(&mut stage, &target);
            assert!(stage.side.statistics.shadow_draws > 0, "on the GPU: {on_gpu}");
            pictures.push(target.read(&stage.gpu).expect("pixels"));
        }
        let flip = stage.judged_figures().and_then(|judged| judged.flip).expect("it was compared");
        assert!(flip < 0.003, "edges are exact: {flip}");
        assert!(pictures[0] == pictures[1] && pictures[1] == pictures[2], "on the GPU: {on_gpu}");
    }
}
