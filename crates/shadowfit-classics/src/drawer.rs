//! Draws samples with the renderer that a sample's values require.

use anyhow::{Result, bail};
use shadowfit::PerspectiveCamera;
use shadowfit_render::{Gpu, Probe, ProbeTargets, RenderTarget};
use shadowfit_scene::Scene;
use shadowfit_study::PreparedScene;

use crate::mapped::{FrameExtras, LightPlace, SampleFrame, SampleRenderer};
use crate::occlusion::{OcclusionFrame, OcclusionPasses, Traced, missing_format};
use crate::options::SampleValues;
use crate::sample::{Sample, SampleDrawing};
use crate::sky_box::SkyBox;

/// Draws the samples of a GPU.
#[derive(Debug)]
pub struct SampleDrawer {
    /// If true, pictures wait for traced rays. If false, they show an approximation until the rays are
    /// traced.
    pub waits: bool,
    samples: u32,
    renderer: SampleRenderer,
    targets: Option<ProbeTargets>,
    /// Created for the first picture that needs it.
    sky: Option<SkyBox>,
    occlusion: Option<OcclusionPasses>,
    traced: Traced,
}

/// Result of drawing a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SampleOutcome {
    /// The frame was drawn.
    Drawn {
        /// A deviation from the request that the user should know, if any.
        message: Option<String>,
    },
    /// The frame was not drawn. The caller must draw it with a technique, like any scene.
    ByTechnique,
}

impl SampleDrawer {
    /// Creates a drawer of pictures with `samples` samples per pixel (1 or 4).
    pub fn new(gpu: &Gpu, samples: u32) -> Self {
        Self {
            waits: true,
            samples,
            renderer: SampleRenderer::new(gpu, samples),
            targets: None,
            sky: None,
            occlusion: None,
            traced: Traced::default(),
        }
    }

    /// Draws a sample by its values.
    ///
    /// # Errors
    ///
    /// If the camera cannot be fitted, the map cannot be created, or the adapter cannot draw to a format.
    pub fn draw(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        sample: &Sample,
        values: &SampleValues,
        camera: &PerspectiveCamera,
        target: &RenderTarget,
    ) -> Result<SampleOutcome> {
        let message = match sample.drawing(values, camera)? {
            SampleDrawing::Technique { .. } => return Ok(SampleOutcome::ByTechnique),
            SampleDrawing::Mapped(frame) => {
                let casts = casts(sample, scene.scene());
                let (frame, message) = possible(gpu, frame);
                let sky = self.sky(gpu, &frame, values.is_on("sky"));
                let behind = |pass: &mut wgpu::RenderPass<'_>| sky.iter().for_each(|sky| sky.draw(pass));
                let inset = inset(sample, values, target.size);
                let extras = FrameExtras { behind: Some(&behind), casts: casts.as_deref(), inset };
                let drawn = self.renderer.draw(gpu, &mut scene.gpu_scene, &frame, extras, target);
                self.sky = sky.or(self.sky.take());
                drawn?;
                message
            }
            SampleDrawing::Occlusion { frame, is_traced } => {
                check_formats(gpu)?;
                self.draw_occlusion(gpu, scene, &frame, is_traced, camera, target)
            }
        };
        Ok(SampleOutcome::Drawn { message })
    }

    /// Returns the sky, with its sun in the direction of the frame's light, if it is wanted.
    fn sky(&mut self, gpu: &Gpu, frame: &SampleFrame, is_wanted: bool) -> Option<SkyBox> {
        let LightPlace::Toward(to_light) = frame.light.place else { return None };
        if !is_wanted {
            return None;
        }
        let mut sky = self.sky.take().unwrap_or_else(|| SkyBox::new(gpu, to_light, self.samples));
        sky.set_light(gpu, to_light);
        sky.prepare(gpu, &frame.camera);
        Some(sky)
    }

    /// Draws a scene with ambient occlusion. Uses screen-space occlusion until traced occlusion is available.
    fn draw_occlusion(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        frame: &OcclusionFrame,
        is_traced: bool,
        camera: &PerspectiveCamera,
        target: &RenderTarget,
    ) -> Option<String> {
        let passes = self.occlusion.get_or_insert_with(|| OcclusionPasses::new(gpu, self.samples));
        let given = if is_traced { self.traced.occlusion(scene, camera, target.size, self.waits) } else { None };
        passes.draw(gpu, &mut scene.gpu_scene, frame, camera, given, target);
        let is_missing = is_traced && given.is_none();
        is_missing.then(|| "Rays are being traced. Until then the picture shows screen-space occlusion".to_owned())
    }

    /// Returns the screen-space occlusion of a frame for a picture of a size, rows from the top, 0 in the
    /// sky.
    pub(crate) async fn occlusion(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        frame: &OcclusionFrame,
        camera: &PerspectiveCamera,
        size: [u32; 2],
    ) -> Result<Vec<f32>> {
        check_formats(gpu)?;
        let target = RenderTarget::new(&gpu.device, size, self.samples);
        let passes = self.occlusion.get_or_insert_with(|| OcclusionPasses::new(gpu, self.samples));
        passes.draw(gpu, &mut scene.gpu_scene, frame, camera, None, &target);
        Ok(passes.read_occlusion(gpu).await?)
    }

    /// Returns the shading's data for each pixel of a mapped frame.
    ///
    /// # Errors
    ///
    /// As [`Self::draw`]. Also fails if the device was lost.
    pub(crate) async fn probe(
        &mut self,
        gpu: &Gpu,
        scene: &mut PreparedScene,
        sample: &Sample,
        frame: &SampleFrame,
        size: [u32; 2],
    ) -> Result<Probe> {
        let kept = self.targets.take().filter(|targets| targets.size == size);
        let targets = kept.unwrap_or_else(|| ProbeTargets::new(&gpu.device, size));
        let casts = casts(sample, scene.scene());
        let extras = FrameExtras { casts: casts.as_deref(), ..FrameExtras::default() };
        let frame = possible(gpu, *frame).0;
        let probe = self.renderer.probe(gpu, &mut scene.gpu_scene, &frame, extras, &targets).await?;
        self.targets = Some(targets);
        Ok(probe?)
    }

    /// Returns the bytes of the map that was drawn last, rows from the top.
    ///
    /// # Errors
    ///
    /// If the device was lost.
    pub fn read_map(&self, gpu: &Gpu) -> Result<Option<Vec<u8>>> {
        Ok(self.renderer.read_map(gpu)?)
    }
}

/// Fails if the adapter cannot draw to the formats that ambient occlusion needs.
fn check_formats(gpu: &Gpu) -> Result<()> {
    match missing_format(&gpu.adapter) {
        Some(format) => bail!("this graphics adapter cannot draw to {format:?}, which ambient occlusion needs"),
        None => Ok(()),
    }
}

/// Returns the frame with a map format that the adapter can draw to, and a message if the format changed.
fn possible(gpu: &Gpu, mut frame: SampleFrame) -> (SampleFrame, Option<String>) {
    let (format, message) = frame.map.format.or_fallback(|format| format.is_renderable(&gpu.adapter));
    frame.map.format = format;
    (frame, message)
}

/// Returns whether each node casts, or `None` if all do.
fn casts(sample: &Sample, scene: &Scene) -> Option<Vec<bool>> {
    let subject = scene.subject.filter(|_| sample.only_subject_casts)?;
    Some((0..scene.nodes.len()).map(|node| scene.is_descendant(node, subject)).collect())
}

/// Returns the rectangle of the map's inset in a picture of a size. It takes the same share of the height as
/// in the source's window.
fn inset(sample: &Sample, values: &SampleValues, size: [u32; 2]) -> Option<[u32; 4]> {
    let inset = sample.inset.filter(|_| values.is_on("inset"))?;
    Some(inset.map(|side| (side * size[1]).div_ceil(sample.size[1])))
}
