//! Compares the compute pass that counts a depth buffer's visible points with the same counts on the CPU.

use anyhow::{Result, ensure};
use shadowfit::{DepthConvention, VisibleDemand};
use shadowfit_render::{Frame, ProbeTargets};
use shadowfit_wgpu::ShadowMapDescriptor;
use shadowfit_wgpu::demand::{DemandPass, DemandPassError, DemandView, count_on_cpu};

use super::bench::{Bench, SIZE, technique};
use super::numbers::depths;
use super::outcome::Outcome;
use crate::View;

pub(super) const NAME: &str = "Visible points";
pub(super) const ABOUT: &str = "Compares the counts of visible points, which place the maps, from the device's pass \
                                over a depth buffer with the CPU's counts from the same depths.";
pub(super) const TOLERANCE: &str = "1 point in 1000 in a neighbouring cell: the device computes in f32, whose rounding \
                                    matters to points at the border of a cell.";

/// Greatest share of the points that rounding moves into a neighbouring cell or bin. Neighbouring depths are
/// subtracted, so a point's coordinates and slope have an error of about 2⁻¹⁴ of a cell or bin, on either
/// side along each of four axes.
const ROUNDING: f64 = 0.001;

/// Runs the check.
pub(super) async fn run(bench: &mut Bench<'_>) -> Result<Outcome> {
    run_with(bench, |view| view).await
}

/// Runs the check with another view for the CPU.
async fn run_with(bench: &mut Bench<'_>, on_cpu: impl Fn(DemandView) -> DemandView) -> Result<Outcome> {
    let gpu = bench.gpu;
    let mut pass = match DemandPass::new(&gpu.device, &gpu.queue, 1) {
        Ok(pass) => pass,
        Err(error @ DemandPassError::Unsupported(_)) => return Ok(Outcome::Unavailable(error.to_string())),
        Err(error) => return Err(error.into()),
    };
    let view = Bench::view(0);
    let targets = ProbeTargets::new(&gpu.device, SIZE);
    let mut renderer = bench.renderer(&ShadowMapDescriptor::from(&technique()))?;
    let atmosphere = view.atmosphere();
    let frame = Frame::new(view.camera, view.direction, &[], &atmosphere);
    renderer.draw_probe(gpu, &mut bench.scene.gpu_scene, &frame, &targets)?;
    let seen_view = demand_view(&view)?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    ensure!(pass.record(&mut encoder, targets.depth_view(), &seen_view, None)?, "the pass recorded nothing");
    gpu.submit([encoder.finish()]);
    let found = arrived(bench, &mut pass).await?;
    let expected = count_on_cpu(&on_cpu(seen_view), &depths(gpu, targets.depth_view()).await?)?;
    Ok(outcome(&found, &expected))
}

fn demand_view(view: &View) -> Result<DemandView> {
    let (depth, settings) = (DepthConvention::Reversed, technique().fit);
    Ok(DemandView {
        frustum: view.camera.frustum()?,
        clip_from_world: view.camera.clip_from_world(depth),
        depth,
        direction: view.direction,
        up: settings.up,
        max_distance: settings.max_distance,
        rectangle: [0, 0, SIZE[0], SIZE[1]],
    })
}

/// Waits for the counts. A browser does other work meanwhile.
async fn arrived(bench: &Bench<'_>, pass: &mut DemandPass) -> Result<VisibleDemand> {
    loop {
        bench.pause().await?;
        let counts = if cfg!(target_family = "wasm") { pass.take()? } else { pass.wait()? };
        if let Some(seen) = counts {
            return Ok(seen);
        }
    }
}

fn outcome(found: &VisibleDemand, expected: &VisibleDemand) -> Outcome {
    let points: u32 = expected.demand().counts.iter().sum();
    let differ = |found: &[u32], expected: &[u32]| {
        // A point in a wrong cell is missing in one cell and surplus in another.
        found.iter().zip(expected).map(|(a, b)| a.abs_diff(*b)).sum::<u32>().div_ceil(2)
    };
    let cells = differ(found.demand().counts, expected.demand().counts);
    let bins = differ(found.histogram().bins, expected.histogram().bins);
    let most = ROUNDING * f64::from(points);
    Outcome::of(
        points > 0 && f64::from(cells.max(bins)) <= most,
        format!(
            "of {points} points, {cells} are in another cell of the grid, and {bins} in another bin of the histogram"
        ),
    )
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use glam::Vec3;

    use super::*;

    fn checked(on_cpu: impl Fn(DemandView) -> DemandView) -> Outcome {
        let (gpu, is_cancelled) = (shadowfit_testing::renderer_gpu(), AtomicBool::new(false));
        let mut bench = Bench::new(&gpu, &is_cancelled).expect("a scene");
        pollster::block_on(run_with(&mut bench, on_cpu)).expect("it runs")
    }

    #[test]
    fn gpu_counts_agree_with_the_cpu_and_not_with_another_light() {
        let found = checked(|view| view);
        assert!(matches!(found, Outcome::Passed(_)), "{found:?}");
        let turned = |view: DemandView| view.direction + Vec3::new(0.02, 0.0, 0.0);
        let found = checked(|view| DemandView { direction: turned(view), ..view });
        assert!(matches!(found, Outcome::Failed(_)), "a light that is a degree off: {found:?}");
    }
}
