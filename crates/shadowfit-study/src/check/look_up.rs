//! Compares the look-up's WGSL on the device with the same look-up on the CPU, from maps that the device
//! drew.

use anyhow::Result;
use shadowfit::FittedMap;
use shadowfit::settings::{BiasSettings, FilterKind};
use shadowfit_wgpu::ShadowMapDescriptor;

use super::bench::{Bench, technique};
use super::numbers::{Point, factors, texels};
use super::outcome::Outcome;
use super::twin::Twin;
use crate::View;

pub(super) const NAME: &str = "Look-up";
pub(super) const ABOUT: &str = "Compares shadow factors that the device looks up in its maps with eight filters with \
                                factors that the CPU computes from the same texels.";
pub(super) const TOLERANCE: &str = "2/256: samplers place a look-up between texels in steps of 1/256 along both axes. \
                                    Comparisons closer than the rounding of f32 may go either way.";

/// Biases of all kinds, in texels, with different values.
const BIAS: BiasSettings =
    BiasSettings { constant: 0.5, slope: 0.75, normal_offset: 1.0, receiver_plane: 1.25, depth_steps: 1.0 };

/// Returns all filters whose look-up positions do not depend on the map's content.
fn filters() -> impl Iterator<Item = FilterKind> {
    FilterKind::ALL.into_iter().filter(|filter| *filter != FilterKind::Pcss)
}

/// Compared factors, and their distance from the allowed ranges.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Compared {
    pub(super) factors: usize,
    /// Factors between 0 and 1.
    partly: usize,
    /// Factors beyond the tolerance.
    pub(super) wrong: usize,
    /// Greatest distance of a factor from its range.
    pub(super) worst: f64,
}

impl Compared {
    pub(super) fn add(&mut self, twin: &Twin<'_>, points: &[Point], factors: &[f32]) {
        for (point, factor) in points.iter().zip(factors) {
            let Some(range) = twin.factor(point) else { continue };
            let factor = f64::from(*factor);
            let beyond = (range.start - factor).max(factor - range.end).max(0.0);
            // NaN lies outside of every range.
            let beyond = if factor.is_nan() { 1.0 } else { beyond };
            self.factors += 1;
            self.partly += usize::from(factor > 0.0 && factor < 1.0);
            self.wrong += usize::from(beyond > twin.weight_error());
            self.worst = self.worst.max(beyond);
        }
    }
}

/// Runs the check.
pub(super) async fn run(bench: &mut Bench<'_>) -> Result<Outcome> {
    run_with(bench, filters(), |map| map).await
}

/// Runs the check for some filters, with other maps on the CPU.
async fn run_with(
    bench: &mut Bench<'_>,
    filters: impl Iterator<Item = FilterKind>,
    on_cpu: impl Fn(FittedMap) -> FittedMap,
) -> Result<Outcome> {
    let view = Bench::view(0);
    let points = bench.points(&view);
    let mut compared = Compared::default();
    for filter in filters {
        bench.pause().await?;
        compare(bench, &view, &points, filter, &on_cpu, &mut compared).await?;
    }
    let Compared { factors, partly, wrong, worst } = compared;
    let is_within = wrong == 0 && partly * 100 > factors;
    Ok(Outcome::of(
        is_within,
        format!("{wrong} of {factors} factors differ; {partly} factors lie at edges; greatest difference {worst:.4}"),
    ))
}

async fn compare(
    bench: &mut Bench<'_>,
    view: &View,
    points: &[Point],
    filter: FilterKind,
    on_cpu: &impl Fn(FittedMap) -> FittedMap,
    compared: &mut Compared,
) -> Result<()> {
    // The automatic bias sets only two kinds of bias.
    let has_all = filter == FilterKind::Hardware2x2;
    let technique = if has_all { technique().with_look_up(filter, BIAS) } else { technique().with_filter(filter) };
    let mut renderer = bench.renderer(&ShadowMapDescriptor::from(&technique))?;
    let maps = bench.fit(&technique, Default::default(), view)?;
    bench.draw_maps(&mut renderer, view, &maps)?;
    let texels = texels(bench.gpu, renderer.shadow_map()).await?;
    let factors = factors(bench.gpu, renderer.shadow_map(), points).await?;
    let maps: Vec<FittedMap> = maps.iter().map(|map| on_cpu(map.relative_to(view.camera.eye))).collect();
    let twin = Twin { descriptor: renderer.shadow_map().descriptor(), maps: &maps, texels: &texels, precision: 0.0 };
    compared.add(&twin, points, &factors);
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use glam::{Mat4, Vec3};

    use super::*;

    fn checked(filters: impl Iterator<Item = FilterKind>, on_cpu: impl Fn(FittedMap) -> FittedMap) -> Outcome {
        let (gpu, is_cancelled) = (shadowfit_testing::renderer_gpu(), AtomicBool::new(false));
        let mut bench = Bench::new(&gpu, &is_cancelled).expect("a scene");
        pollster::block_on(run_with(&mut bench, filters, on_cpu)).expect("it runs")
    }

    // Eight filters with their shaders: 10 s on the software adapter.
    #[test]
    fn gpu_factors_agree_with_the_cpu() {
        let found = checked(filters(), |map| map);
        assert!(matches!(found, Outcome::Passed(_)), "{found:?}");
    }

    // One filter with its shaders, five times: 5 s on the software adapter.
    #[test]
    fn gpu_factors_disagree_with_another_bias_or_place() {
        let fails = |what: &str, change: &dyn Fn(&mut FittedMap)| {
            let found = checked([FilterKind::Hardware2x2].into_iter(), |mut map| {
                change(&mut map);
                map
            });
            assert!(matches!(found, Outcome::Failed(_)), "{what}: {found:?}");
        };
        fails("the constant bias", &|map| map.bias.constant_depth *= 0.5);
        fails("the slope's bias", &|map| map.bias.slope_depth *= 0.5);
        fails("the normal offset", &|map| map.bias.normal_offset *= 0.5);
        fails("the receiver plane's bias", &|map| map.bias.receiver_plane *= 0.5);
        fails("half a texel to the right", &|map| {
            let half = Vec3::new(0.5 / map.projection.resolution.x as f32, 0.0, 0.0);
            map.projection.uv_from_world = Mat4::from_translation(half) * map.projection.uv_from_world;
        });
    }
}
