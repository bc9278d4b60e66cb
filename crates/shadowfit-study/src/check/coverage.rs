//! Proves that maps have no holes, and judges pictures by rays: every visible point lies inside of its maps,
//! and no caster is missing.

use anyhow::{Context, Result};
use shadowfit::proof::CoverageProof;
use shadowfit::{Boxes, FitInput, FittedMaps};
use shadowfit_wgpu::SunFrame;

use super::bench::{Bench, technique};
use super::outcome::Outcome;
use crate::{Evaluator, SharedTruth, View};

pub(super) const NAME: &str = "Coverage";
pub(super) const ABOUT: &str = "The proof that maps hold every visible point and every caster, and the device's pictures of \
                                the same maps, judged by rays on the CPU.";
pub(super) const TOLERANCE: &str = "None: each map is proven, no visible point lies outside of the maps, and no shadow is \
                                    missing because a map lacks its caster.";

/// Steps of the walk that are checked.
const STEPS: [u32; 3] = [0, 6, 12];

/// Runs the check.
pub(super) async fn run(bench: &mut Bench<'_>) -> Result<Outcome> {
    run_with(bench, |view| view).await
}

/// Runs the check with maps that are fitted to other views.
async fn run_with(bench: &mut Bench<'_>, fitted_to: impl Fn(View) -> View) -> Result<Outcome> {
    let mut evaluator = bench.evaluator(&technique())?;
    evaluator.renderer.sun_mut().fitter_mut().set_technique(&technique());
    let [mut judged, mut uncovered, mut holes] = [0; 3];
    let mut unproven = Vec::new();
    for step in STEPS {
        bench.pause().await?;
        let view = Bench::view(step);
        let fitter = evaluator.renderer.sun_mut().fitter_mut();
        let maps: FittedMaps = bench.scene.fit_next(fitter, Default::default(), &fitted_to(view))?;
        let picture =
            evaluator.judge_async(bench.gpu, &mut bench.scene, &view, &maps, &mut SharedTruth::default()).await?;
        judged += picture.tally.all.facing;
        uncovered += picture.tally.uncovered;
        holes += picture.tally.all.hole;
        let proof = prove(bench, &evaluator, &view)?;
        unproven.extend((!proof.is_proven()).then(|| format!("; step {step} of the walk: {}", reason(&proof))));
    }
    Ok(Outcome::of(
        judged > 0 && uncovered == 0 && holes == 0 && unproven.is_empty(),
        format!(
            "{} of {} views are proven; of {judged} visible points {uncovered} lie outside of the maps, and {holes} miss \
             their caster{}",
            STEPS.len() - unproven.len(),
            STEPS.len(),
            unproven.concat(),
        ),
    ))
}

/// Proves the maps of the view that was drawn last.
fn prove(bench: &Bench<'_>, evaluator: &Evaluator, view: &View) -> Result<CoverageProof> {
    let views = [view.camera.frustum()?];
    let input: FitInput<'_> = bench.scene.input(Default::default(), &views, view.direction);
    let none = Boxes::world(&[]);
    let casters = bench.scene.gpu_scene.casters();
    let frame = SunFrame::new(&views, view.direction, input.receivers.unwrap_or(none), casters);
    let frame = SunFrame { receiver_cones: input.receiver_cones, ..frame };
    evaluator.renderer.sun().prove(&frame).context("the proof")
}

fn reason(proof: &CoverageProof) -> String {
    match proof {
        CoverageProof::Proven(_) => "proven".to_owned(),
        CoverageProof::Uncovered { plane, by, .. } => format!("a receiver lies {by} beyond the map's side {plane:?}"),
        CoverageProof::MarkedEmpty { .. } => "a map that has receivers is marked empty".to_owned(),
        CoverageProof::CasterLost { by, .. } => format!("a caster lies {by} m before the near plane"),
        CoverageProof::DepthTooCoarse(_) => "depths are rounded by more than the bias".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use glam::{Quat, Vec3};
    use shadowfit::Camera;

    use super::*;

    fn checked(fitted_to: impl Fn(View) -> View) -> Outcome {
        let (gpu, is_cancelled) = (shadowfit_testing::renderer_gpu(), AtomicBool::new(false));
        let mut bench = Bench::new(&gpu, &is_cancelled).expect("a scene");
        pollster::block_on(run_with(&mut bench, fitted_to)).expect("it runs")
    }

    #[test]
    fn gpu_maps_of_the_walk_are_proven_and_maps_of_other_views_are_not() {
        let found = checked(|view| view);
        assert!(matches!(found, Outcome::Passed(_)), "{found:?}");
        let turned = |forward: Vec3| Quat::from_rotation_y(0.8) * forward;
        let found = checked(|view| View {
            camera: Camera { forward: turned(view.camera.forward), far: 6.0, ..view.camera },
            ..view
        });
        let Outcome::Failed(found) = found else { panic!("{found:?}") };
        assert!(found.contains("0 of 3 views are proven") && found.contains("beyond the map's side"), "{found}");
        assert!(!found.contains(" 0 lie outside"), "{found}");
    }
}
