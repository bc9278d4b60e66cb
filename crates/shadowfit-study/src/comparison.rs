//! Side-by-side comparison of techniques in one scene, frame by frame.

use anyhow::{Context, Result, ensure};
use shadowfit::FittedMap;
use shadowfit_render::{Gpu, Renderer};
use shadowfit_scene::Scene;
use shadowfit_truth::{Judged, PictureTally};
use shadowfit_wgpu::ShadowMapDescriptor;

use crate::{Evaluator, Judging, NamedTechnique, PreparedScene, SharedTruth, View};

/// Samples per pixel of the compared pictures.
const SAMPLES: u32 = 1;

/// One technique in a comparison.
#[derive(Debug)]
struct Entry {
    named: NamedTechnique,
    evaluator: Evaluator,
}

/// Techniques that are compared in a scene.
#[derive(Debug)]
pub struct Comparison {
    /// Settings for judging the pictures of techniques that are added from now on.
    pub judging: Judging,
    gpu: Gpu,
    scene: PreparedScene,
    entries: Vec<Entry>,
}

/// The maps and the picture of a technique for a frame.
#[derive(Debug)]
pub struct Outcome {
    /// Maps of the technique.
    pub maps: Vec<FittedMap>,
    /// The judged picture.
    pub judged: Judged,
}

impl Comparison {
    /// Creates a comparison without techniques.
    ///
    /// # Errors
    ///
    /// If the scene has nothing to draw.
    pub fn new(gpu: Gpu, scene: Scene, judging: Judging) -> Result<Self> {
        // Renderers of all shadow maps share one layout.
        let renderer = Renderer::new(&gpu, &ShadowMapDescriptor::default(), SAMPLES)?;
        let scene = PreparedScene::new(&gpu, renderer.material_layout(), scene)?;
        Ok(Self { gpu, scene, judging, entries: Vec::new() })
    }

    /// Adds a technique.
    ///
    /// # Errors
    ///
    /// If its shadow map cannot be created on this GPU.
    pub fn add(&mut self, technique: impl Into<NamedTechnique>) -> Result<()> {
        let named = technique.into();
        let renderer = Renderer::new(&self.gpu, &ShadowMapDescriptor::from(&named.technique), SAMPLES)
            .with_context(|| format!("technique {}", named.name))?;
        let mut evaluator = Evaluator::new(renderer, self.judging);
        evaluator.renderer.sun_mut().fitter_mut().set_technique(&named.technique);
        self.entries.push(Entry { named, evaluator });
        Ok(())
    }

    /// Removes all techniques.
    pub fn clear(&mut self) {
        self.entries.clear();
    }

    /// Returns the scene.
    pub fn scene(&self) -> &PreparedScene {
        &self.scene
    }

    /// Returns the GPU that draws.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Returns the techniques, in the order in which they were added.
    pub fn techniques(&self) -> impl Iterator<Item = &NamedTechnique> {
        self.entries.iter().map(|entry| &entry.named)
    }

    /// Poses the scene at a time of an animation, in seconds.
    pub fn set_time(&mut self, animation: usize, seconds: f32) {
        self.scene.set_time(&self.gpu, animation, seconds);
    }

    /// Fits, draws and judges a frame with every technique, in the order in which they were added. The truth
    /// is traced unless `truth` already has it for this frame.
    ///
    /// # Errors
    ///
    /// If the camera is invalid or the device was lost.
    pub fn frame(&mut self, view: &View, truth: &mut SharedTruth) -> Result<Vec<Outcome>> {
        pollster::block_on(self.frame_async(view, truth))
    }

    /// Runs like [`Self::frame`]. A browser can do other work while the GPU draws.
    ///
    /// # Errors
    ///
    /// As for [`Self::frame`].
    pub async fn frame_async(&mut self, view: &View, truth: &mut SharedTruth) -> Result<Vec<Outcome>> {
        let mut outcomes = Vec::with_capacity(self.entries.len());
        for Entry { named, evaluator } in &mut self.entries {
            let maps = self.scene.fit_next(evaluator.renderer.sun_mut().fitter_mut(), named.inputs, view);
            let maps = maps.with_context(|| format!("technique {}", named.name))?.to_vec();
            let judged = evaluator.judge_async(&self.gpu, &mut self.scene, view, &maps, truth).await?;
            outcomes.push(Outcome { maps, judged });
        }
        Ok(outcomes)
    }

    /// Returns a technique's evaluator and the scene, to judge frames live.
    pub fn evaluator(&mut self, technique: usize) -> (&Gpu, &mut Evaluator, &mut PreparedScene) {
        (&self.gpu, &mut self.entries[technique].evaluator, &mut self.scene)
    }

    /// Draws the shaded picture of a frame with a technique and with maps from [`Self::frame`]. Returns sRGB
    /// pixels, four bytes each, rows from the top, and the picture judged again.
    ///
    /// # Errors
    ///
    /// As for [`Self::frame`].
    pub fn picture(
        &mut self,
        technique: usize,
        view: &View,
        maps: &[FittedMap],
        truth: &mut SharedTruth,
    ) -> Result<(Vec<u8>, Judged)> {
        let evaluator = &mut self.entries[technique].evaluator;
        let alone = View { is_first: true, ..*view };
        let judged = evaluator.judge(&self.gpu, &mut self.scene, &alone, maps, truth)?;
        Ok((evaluator.picture(&self.gpu, &mut self.scene, view, maps)?, judged))
    }
}

/// Returns an error for sums without judged pixels, because all shares of wrong pixels would be 0.
///
/// # Errors
///
/// If there is no frame, or no pixel of the frames faces the light.
pub fn ensure_judged(tally: &PictureTally) -> Result<()> {
    ensure!(tally.frames > 0, "nothing was judged: there are no frames");
    ensure!(
        tally.all.facing > 0,
        "nothing was judged: no pixel faces the light in any of the {} frames; choose another path or light",
        tally.frames
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use shadowfit_truth::ClassTally;

    #[test]
    fn sums_without_a_frame_or_a_facing_pixel_are_refused() {
        let none = PictureTally::default();
        assert!(ensure_judged(&none).is_err_and(|error| error.to_string().contains("no frame")));
        let dark = PictureTally { frames: 3, ..none };
        assert!(ensure_judged(&dark).is_err_and(|error| error.to_string().contains("3 frames")));
        let lit = PictureTally { all: ClassTally { facing: 1, ..ClassTally::default() }, ..dark };
        assert!(ensure_judged(&lit).is_ok());
    }
}
