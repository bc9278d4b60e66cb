//! Techniques side by side in one scene, frame by frame.

use anyhow::{Context, Result, ensure};
use shadowfit::FittedMap;
use shadowfit_render::{Gpu, Renderer};
use shadowfit_scene::Scene;
use shadowfit_truth::{Judged, PictureTally};
use shadowfit_wgpu::ShadowMapDescriptor;

use crate::{Evaluator, Judging, NamedTechnique, PreparedScene, SharedTruth, View};

/// Samples per pixel of pictures that are compared.
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
    /// How pictures of the techniques that are added from now on are judged.
    pub judging: Judging,
    gpu: Gpu,
    scene: PreparedScene,
    entries: Vec<Entry>,
}

/// The maps and the picture of a technique for a frame.
#[derive(Debug)]
pub struct Outcome {
    /// Its maps.
    pub maps: Vec<FittedMap>,
    /// Its picture, judged.
    pub judged: Judged,
}

impl Comparison {
    /// A comparison without techniques.
    ///
    /// # Errors
    ///
    /// When the scene has nothing to draw.
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
    /// When its shadow map cannot be made on this GPU.
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

    /// The scene.
    pub fn scene(&self) -> &PreparedScene {
        &self.scene
    }

    /// The GPU that draws.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The techniques, in the order in which they were added.
    pub fn techniques(&self) -> impl Iterator<Item = &NamedTechnique> {
        self.entries.iter().map(|entry| &entry.named)
    }

    /// Poses the scene at a time of an animation, in seconds.
    pub fn set_time(&mut self, animation: usize, seconds: f32) {
        self.scene.set_time(&self.gpu, animation, seconds);
    }

    /// Fits, draws and judges a frame with every technique, in the order in which they were added. The truth is traced
    /// unless that of the same frame is there already.
    ///
    /// # Errors
    ///
    /// When the camera makes no sense or the device was lost.
    pub fn frame(&mut self, view: &View, truth: &mut SharedTruth) -> Result<Vec<Outcome>> {
        pollster::block_on(self.frame_async(view, truth))
    }

    /// The same, and lets a browser do other things while the GPU draws.
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

    /// A technique's evaluator and the scene, to judge frames live.
    pub fn evaluator(&mut self, technique: usize) -> (&Gpu, &mut Evaluator, &mut PreparedScene) {
        (&self.gpu, &mut self.entries[technique].evaluator, &mut self.scene)
    }

    /// The shaded picture of a frame by a technique, with maps that [`Self::frame`] gave: sRGB pixels, four bytes each,
    /// rows from the top; and the picture judged again.
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

/// Refuses sums without judged pixels: all shares of wrong pixels would be 0.
///
/// # Errors
///
/// When there is no frame, or no pixel of the frames faces the light.
pub fn ensure_judged(tally: &PictureTally) -> Result<()> {
    ensure!(tally.frames > 0, "nothing was judged: there is no frame");
    ensure!(
        tally.all.facing > 0,
        "nothing was judged: in none of the {} frames a pixel faces the light; choose another path or light",
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
