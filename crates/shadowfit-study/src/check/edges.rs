//! Compares exact edges on the device with shadow rays on the CPU.

use anyhow::{Context, Result};
use shadowfit::settings::Edges;
use shadowfit_truth::{Class, Judged, PixelTruth};
use shadowfit_wgpu::exact_edges::EdgeOutcome;

use super::bench::{Bench, SIZE, small};
use super::numbers::steps_in_a_pixel;
use super::outcome::Outcome;
use crate::{NamedTechnique, SharedTruth, View};

pub(super) const NAME: &str = "Exact edges";
pub(super) const ABOUT: &str = "Compares a picture whose shadow edges the device traces with shadow rays that the CPU \
                                traces for the same pixels.";
pub(super) const TOLERANCE: &str = "1/256 of a pixel: rasterisers snap corners of triangles to such steps, so a pixel \
                                    may differ where a shadow's edge passes its centre that closely.";

/// Preset with traced edges.
const PRESET: &str = "exact-4";

/// Steps per pixel to which the device must round the corners of triangles. The pass assumes that a stored
/// depth lies that close to its triangle.
const NEEDED: u32 = 256;

/// Steps per pixel by which rays are moved to look for an edge: the vertex snap, rounded up to an odd number,
/// so that a step lies at the pixel's centre.
const STEPS: u32 = 257;

/// Runs the check.
pub(super) async fn run(bench: &mut Bench<'_>) -> Result<Outcome> {
    run_with(bench, SharedTruth::default()).await
}

/// Runs the check with a truth that may already be traced.
async fn run_with(bench: &mut Bench<'_>, mut truth: SharedTruth) -> Result<Outcome> {
    let steps = steps_in_a_pixel(bench.gpu).await?;
    if steps < NEEDED {
        return Ok(Outcome::Unavailable(format!(
            "the device rounds corners of triangles to 1/{steps} of a pixel. Exact edges need 1/{NEEDED}: about one \
             pixel in a thousand is wrong on this device"
        )));
    }
    let named = NamedTechnique::preset(PRESET).context("the preset whose edges are traced")?;
    // Like the judge, traces one ray through the pixel's centre.
    let technique = small(&named.technique).with_edges(Edges::Traced { samples: 1 });
    let view = Bench::view(0);
    let maps = bench.fit(&technique, named.inputs, &view)?;
    if let Err(error) = bench.scene.make_gpu_rays(bench.gpu) {
        return Ok(Outcome::Unavailable(error.to_string()));
    }
    let mut evaluator = bench.evaluator(&technique)?;
    bench.pause().await?;
    let judged = evaluator.judge_async(bench.gpu, &mut bench.scene, &view, &maps, &mut truth).await?;
    if let EdgeOutcome::Filtered(reason) = evaluator.renderer.edge_result() {
        return Ok(Outcome::Unavailable(reason.to_string()));
    }
    bench.pause().await?;
    Ok(outcome(bench, &view, &judged))
}

fn outcome(bench: &Bench<'_>, view: &View, judged: &Judged) -> Outcome {
    let is_wrong = |pixel: &usize| !matches!(judged.classes[*pixel], Class::Right | Class::NotJudged);
    let wrong: Vec<usize> = (0..judged.classes.len()).filter(is_wrong).collect();
    let far = wrong.iter().filter(|pixel| !is_at_edge(bench, view, **pixel)).count();
    let facing = judged.tally.all.facing;
    let traced = judged.tally.traced;
    Outcome::of(
        facing > 0 && far == 0,
        format!(
            "{} of {facing} pixels differ, {far} of them farther than 1/256 of a pixel from an edge; {traced} pixels \
             took rays",
            wrong.len(),
        ),
    )
}

/// Returns whether rays one step beside a pixel's centre disagree about its light, or show no judged surface.
fn is_at_edge(bench: &Bench<'_>, view: &View, pixel: usize) -> bool {
    let (judging, rays) = (bench.judging(), bench.scene.rays());
    let fine = crate::Judging { size: SIZE.map(|side| side * STEPS), ..judging };
    let (camera, settings) = (fine.pixel_camera(rays.origin, view), fine.truth_settings(view));
    let truth = PixelTruth { tracer: &rays.tracer, camera: &camera, settings: &settings };
    let (width, steps) = (SIZE[0] as usize, STEPS as usize);
    let [x, y] = [pixel % width, pixel / width].map(|place| place * steps + steps / 2);
    let verdict = |x: usize, y: usize| truth.point(y * width * steps + x).and_then(|point| point.verdict());
    let centre = verdict(x, y);
    (0..9).any(|place| verdict(x + place % 3 - 1, y + place / 3 - 1) != centre)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use shadowfit::Technique;

    use super::*;

    #[test]
    fn gpu_corners_are_rounded_to_the_steps_that_drivers_name() {
        let gpu = shadowfit_testing::renderer_gpu();
        let steps = pollster::block_on(steps_in_a_pixel(&gpu)).expect("it draws");
        // Mesa's software driver snaps edges to steps, and interpolates between them as exactly as it can.
        let named = (1.0 / shadowfit_testing::subpixel_step(&gpu.adapter.get_info())) as u32;
        assert!([named, 1024].contains(&steps), "{steps} steps, not {named}");
    }

    #[test]
    fn gpu_traced_edges_agree_with_the_cpu_and_not_with_a_scene_that_has_moved() {
        let (gpu, is_cancelled) = (shadowfit_testing::renderer_gpu(), AtomicBool::new(false));
        let mut bench = Bench::new(&gpu, &is_cancelled).expect("a scene");
        shadowfit_testing::require_fine_steps(&gpu.adapter.get_info());
        let found = pollster::block_on(run(&mut bench)).expect("it runs");
        assert!(matches!(found, Outcome::Passed(_)), "{found:?}");
        // The truth of another light.
        let view = Bench::view(0);
        let mut truth = SharedTruth::default();
        let other = View { direction: (view.direction + glam::Vec3::X * 0.02).normalize(), ..view };
        let mut evaluator = bench.evaluator(&Technique::default()).expect("a renderer");
        evaluator.judge(&gpu, &mut bench.scene, &other, &[], &mut truth).expect("judged");
        let found = pollster::block_on(run_with(&mut bench, truth)).expect("it runs");
        assert!(matches!(found, Outcome::Failed(_)), "a light that is a degree off: {found:?}");
    }
}
