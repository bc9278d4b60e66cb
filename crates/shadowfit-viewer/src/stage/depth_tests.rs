//! Visible demand for windows: rays and depth buffers agree.

use shadowfit::Windows;
use shadowfit::demand::{DemandGrid, LEVELS};
use shadowfit_render::Gpu;
use shadowfit_render::RenderTarget;
use shadowfit_scene::builtin::default_scene;
use shadowfit_testing::renderer_gpu;

use super::*;

/// Returns the shares of the points in each octave of texels.
fn shares(grid: &DemandGrid<'_>) -> Vec<f64> {
    let total: u32 = grid.counts.iter().sum();
    let levels = grid.counts.chunks(grid.counts.len() / LEVELS);
    levels.map(|level| f64::from(level.iter().sum::<u32>()) / f64::from(total)).collect()
}

/// Returns the fitter's visible demand: whether it comes from a picture, and the shares.
fn told(stage: &Stage) -> (bool, Vec<f64>) {
    let seen = stage.side.sun().fitter().visible_demand().expect("windows are told");
    // There are far fewer rays than points of a picture.
    (seen.demand().counts.iter().sum::<u32>() > 2500, shares(&seen.demand()))
}

fn draw(stage: &mut Stage, target: &RenderTarget) {
    stage.draw(target);
    assert_eq!(stage.problem(), None);
    stage.gpu().device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
}

/// Returns a stage with the default scene and windows that get the demand of their last picture.
fn told_by_pictures(gpu: &Gpu, samples: u32) -> Stage {
    let mut stage = Stage::new(gpu.clone(), default_scene(), samples).expect("the default scene");
    stage.prepared_scene().rays();
    stage.read_depths();
    stage.settings.technique.maps = Windows::default().into();
    stage
}

#[test]
fn of_two_techniques_both_are_told_of_the_whole_picture() {
    let gpu = renderer_gpu();
    for samples in [1, 4] {
        let mut stage = told_by_pictures(&gpu, samples);
        let target = stage.target([320, 180]);
        draw(&mut stage, &target);
        draw(&mut stage, &target);
        let (is_picture, alone) = told(&stage);
        assert!(is_picture);
        stage.compare_with(Some(stage.settings.technique.with_count(3)));
        stage.set_split(0.2);
        for _ in 0..3 {
            draw(&mut stage, &target);
        }
        for swaps in 0..2 {
            assert_eq!(told(&stage), (true, alone.clone()), "{samples} samples, swapped {swaps} times");
            stage.swap_sides();
        }
    }
}

#[test]
fn a_view_that_follows_no_other_is_seen_by_rays_and_the_next_ones_by_pictures_which_agree() {
    let gpu = renderer_gpu();
    for samples in [1, 4] {
        let mut stage = told_by_pictures(&gpu, samples);
        let target = stage.target([640, 360]);
        draw(&mut stage, &target);
        let (is_picture, by_rays) = told(&stage);
        assert!(!is_picture);
        draw(&mut stage, &target);
        let (is_picture, by_picture) = told(&stage);
        assert!(is_picture);
        for (level, (a, b)) in by_rays.iter().zip(&by_picture).enumerate() {
            assert!((a - b).abs() < 0.03, "octave {level}: {a} of the rays, {b} of the pixels");
        }
        stage.settings.technique.filter = shadowfit::settings::FilterKind::Point;
        draw(&mut stage, &target);
        assert!(!told(&stage).0, "another technique begins anew, whatever is on its way");
    }
}

#[test]
fn the_switch_for_blended_surfaces_changes_what_casts_in_the_very_next_picture() {
    let mut scene = default_scene();
    for material in &mut scene.materials {
        material.alpha = shadowfit_scene::AlphaMode::Blend;
    }
    let mut stage = Stage::new(renderer_gpu(), scene, 1).expect("a scene");
    let target = stage.target([64, 36]);
    for blended_cast in [true, false, true] {
        stage.settings.view.blended_cast = blended_cast;
        draw(&mut stage, &target);
        let prepared = stage.prepared_scene();
        assert_eq!(prepared.casting_triangles() > 0, blended_cast);
        assert_eq!(!prepared.gpu_scene.casters().moves.is_empty(), blended_cast);
    }
}
