//! Draws samples: the frame that a sample's values ask for, by the samples' renderer.

use anyhow::Result;
use shadowfit::PerspectiveCamera;
use shadowfit_render::samples::{SampleFrame, SampleRenderer};
use shadowfit_render::{Gpu, Probe, ProbeTargets, RenderTarget};
use shadowfit_scene::Scene;

use super::{Sample, SampleDrawing, SampleValues};
use crate::PreparedScene;

/// Draws the samples of a GPU.
#[derive(Debug)]
pub struct SampleDrawer {
    renderer: SampleRenderer,
    targets: Option<ProbeTargets>,
}

/// What became of a frame that was asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SampleOutcome {
    /// It was drawn, and a person should know this.
    Drawn {
        /// What was drawn otherwise than asked for.
        message: Option<String>,
    },
    /// It is drawn as any scene, by a technique, and not here.
    ByTechnique,
}

impl SampleDrawer {
    /// A drawer of pictures of `samples` per pixel (1 or 4).
    pub fn new(gpu: &Gpu, samples: u32) -> Self {
        Self { renderer: SampleRenderer::new(gpu, samples), targets: None }
    }

    /// Draws a sample by its values.
    ///
    /// # Errors
    ///
    /// Where the camera cannot be fitted to, or the map cannot be made.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        (sample, values): (&Sample, &SampleValues),
        camera: &PerspectiveCamera,
        target: &RenderTarget,
    ) -> Result<SampleOutcome> {
        match sample.drawing(values, camera)? {
            SampleDrawing::Technique(_) => Ok(SampleOutcome::ByTechnique),
            SampleDrawing::Mapped(frame) => {
                let casts = casts(sample, scene.scene());
                let (mut frame, message) = possible(gpu, frame);
                frame.inset = inset(sample, values, target.size);
                let frame = SampleFrame { casts: casts.as_deref(), ..frame };
                self.renderer.draw(gpu, &mut scene.gpu_scene, &frame, target)?;
                Ok(SampleOutcome::Drawn { message })
            }
        }
    }

    /// What the shading of a mapped frame knows about each pixel.
    ///
    /// # Errors
    ///
    /// As for [`Self::draw`], and where the device cannot tell triangles apart or was lost.
    pub(super) fn probe(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        sample: &Sample,
        frame: &SampleFrame<'_>,
        size: [u32; 2],
    ) -> Result<Probe> {
        let kept = self.targets.take().filter(|targets| targets.size == size);
        let targets = kept.unwrap_or_else(|| ProbeTargets::new(&gpu.device, size));
        let casts = casts(sample, scene.scene());
        let frame = SampleFrame { casts: casts.as_deref(), ..possible(gpu, *frame).0 };
        let probe = self.renderer.probe(gpu, &mut scene.gpu_scene, &frame, &targets)?;
        self.targets = Some(targets);
        Ok(probe?)
    }

    /// The bytes of the map that was drawn last, rows from the top.
    ///
    /// # Errors
    ///
    /// If the device was lost.
    pub fn read_map(&self, gpu: &Gpu) -> Result<Option<Vec<u8>>> {
        Ok(self.renderer.read_map(gpu)?)
    }
}

/// A frame with a map format that the adapter can draw to, and what that changed.
fn possible<'a>(gpu: &Gpu, mut frame: SampleFrame<'a>) -> (SampleFrame<'a>, Option<String>) {
    let (format, message) = frame.map.format.or_fallback(|format| format.is_renderable(&gpu.adapter));
    frame.map.format = format;
    (frame, message)
}

/// Whether each node casts, where not all do.
fn casts(sample: &Sample, scene: &Scene) -> Option<Vec<bool>> {
    let subject = scene.subject.filter(|_| sample.only_subject_casts)?;
    Some((0..scene.nodes.len()).map(|node| scene.is_descendant(node, subject)).collect())
}

/// Where the map is shown in a picture of a size: as large a share of its height as in the source's window.
fn inset(sample: &Sample, values: &SampleValues, size: [u32; 2]) -> Option<[u32; 4]> {
    let inset = sample.inset.filter(|_| values.is_on("inset"))?;
    Some(inset.map(|side| (side * size[1]).div_ceil(sample.size[1])))
}
