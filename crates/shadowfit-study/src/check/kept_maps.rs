//! Compares maps that are kept from frame to frame with newly drawn maps, over a short walk.

use anyhow::{Context, Result};
use shadowfit::ShadowFitter;
use shadowfit_wgpu::ShadowMapDescriptor;

use super::bench::{Bench, small};
use super::numbers::texels;
use super::outcome::Outcome;
use super::texels::{Difference, Texels};
use crate::NamedTechnique;

pub(super) const NAME: &str = "Kept maps";
pub(super) const ABOUT: &str = "Compares maps that are kept along a walk, and redrawn only where something changes, \
                                with maps that are redrawn in each frame, texel by texel. A figure moves.";
pub(super) const TOLERANCE: &str = "1/256 of a texel: rasterisers snap corners of triangles to such steps. A depth may \
                                    differ by the slope over that distance, and 2/256 of the texels at edges may \
                                    hold the neighbouring surface.";

/// Preset of the kept maps: windows that are placed by boxes, so that they do not depend on the previous
/// frame.
const PRESET: &str = "windows-boxes-4";

/// Width and height of the maps, in texels: small, because there are hundreds of maps.
const TEXELS: u32 = 256;

/// Frames of the walk.
const FRAMES: u32 = 12;

/// Time between frames, in seconds.
const FRAME: f32 = 0.1;

/// Animation in which the figure walks.
const WALK: usize = 0;

/// Runs the check.
pub(super) async fn run(bench: &mut Bench<'_>) -> Result<Outcome> {
    let mut difference = Difference::default();
    let reused = walk(bench, |_, kept, anew| difference.add_all(kept, anew)).await?;
    Ok(outcome(&difference, reused))
}

/// Calls `compare` with the number of each frame, the texels of its kept maps, and the texels of newly drawn
/// maps. Returns the number of kept maps.
async fn walk(bench: &mut Bench<'_>, mut compare: impl FnMut(u32, &[Texels], &[Texels])) -> Result<usize> {
    let named = NamedTechnique::preset(PRESET).context("the preset whose maps are kept")?;
    let technique = small(&named.technique).with_resolution(TEXELS, TEXELS);
    let descriptor = ShadowMapDescriptor::from(&technique);
    let mut fitter = ShadowFitter::new(&technique);
    let mut kept = bench.renderer(&descriptor)?;
    kept.sun_mut().set_caching(true);
    let mut anew = bench.renderer(&descriptor)?;
    let mut reused = 0;
    for frame in 0..FRAMES {
        bench.pause().await?;
        bench.scene.set_time(bench.gpu, WALK, frame as f32 * FRAME);
        let view = Bench::view(frame);
        let maps = bench.scene.fit_next(&mut fitter, named.inputs, &view)?.to_vec();
        bench.draw_maps(&mut kept, &view, &maps)?;
        bench.draw_maps(&mut anew, &view, &maps)?;
        let found = texels(bench.gpu, kept.shadow_map()).await?;
        let expected = texels(bench.gpu, anew.shadow_map()).await?;
        compare(frame, &found, &expected);
        reused += (0..maps.len()).filter(|map| kept.sun().is_cached(*map)).count();
    }
    bench.scene.set_time(bench.gpu, WALK, 0.0);
    Ok(reused)
}

fn outcome(difference: &Difference, reused: usize) -> Outcome {
    let Difference { texels, at_edges, moved, wrong } = difference;
    Outcome::of(
        difference.is_explained() && reused > 0,
        format!(
            "of {:.1} million texels in {FRAMES} frames, {wrong} hold a wrong depth, and of {:.1} million at edges, \
             {moved} hold the neighbouring surface; {reused} maps were kept",
            *texels as f64 / 1e6,
            *at_edges as f64 / 1e6,
        ),
    )
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::AtomicBool;

    use super::*;

    // A walk of 12 frames with two sets of maps: 5 s on the software adapter.
    #[test]
    fn gpu_kept_maps_hold_what_maps_drawn_anew_hold_and_stale_or_shifted_ones_do_not() {
        let (gpu, is_cancelled) = (shadowfit_testing::renderer_gpu(), AtomicBool::new(false));
        let mut bench = Bench::new(&gpu, &is_cancelled).expect("a scene");
        let [mut right, mut stale, mut shifted] = [Difference::default(); 3];
        let mut before: Option<Vec<Texels>> = None;
        let reused = pollster::block_on(walk(&mut bench, |frame, kept, anew| {
            right.add_all(kept, anew);
            let mut moved = kept.to_vec();
            if frame == 7 {
                moved[1].depths.rotate_right(1);
            }
            shifted.add_all(&moved, anew);
            // In the eighth frame, uses the maps of the previous frame.
            let stays = before.replace(kept.to_vec()).filter(|_| frame == 7);
            stale.add_all(&stays.unwrap_or_else(|| kept.to_vec()), anew);
        }));
        let reused = reused.expect("it runs");
        let outcomes = [&right, &stale, &shifted].map(|difference| outcome(difference, reused));
        assert!(matches!(outcomes[0], Outcome::Passed(_)), "{outcomes:?}");
        assert!(outcomes[1..].iter().all(|outcome| matches!(outcome, Outcome::Failed(_))), "{outcomes:?}");
    }
}
