//! Draws samples: what a sample's values ask for, by the renderer that can do it.

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
    /// Whether pictures wait for what rays have to find, instead of showing what there is.
    pub waits: bool,
    samples: u32,
    renderer: SampleRenderer,
    targets: Option<ProbeTargets>,
    /// Made for the first picture that needs it.
    sky: Option<SkyBox>,
    occlusion: Option<OcclusionPasses>,
    traced: Traced,
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
    /// Where the camera cannot be fitted to, the map cannot be made, or the adapter cannot draw to a format.
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

    /// The sky with its sun where the frame's light is, where it is wanted.
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

    /// Draws a scene with ambient occlusion; what is traced is that of screen space until it is there.
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
        is_missing.then(|| "Rays are being traced; until then this is screen space".to_owned())
    }

    /// The occlusion that a frame finds in screen space for a picture of a size, rows from the top, 0 where there is sky.
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

    /// What the shading of a mapped frame knows about each pixel.
    ///
    /// # Errors
    ///
    /// As for [`Self::draw`], and where the device was lost.
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

    /// The bytes of the map that was drawn last, rows from the top.
    ///
    /// # Errors
    ///
    /// If the device was lost.
    pub fn read_map(&self, gpu: &Gpu) -> Result<Option<Vec<u8>>> {
        Ok(self.renderer.read_map(gpu)?)
    }
}

/// Refuses an adapter that cannot draw to what ambient occlusion is found from.
fn check_formats(gpu: &Gpu) -> Result<()> {
    match missing_format(&gpu.adapter) {
        Some(format) => bail!("this graphics adapter cannot draw to {format:?}, which ambient occlusion needs"),
        None => Ok(()),
    }
}

/// A frame with a map format that the adapter can draw to, and what that changed.
fn possible(gpu: &Gpu, mut frame: SampleFrame) -> (SampleFrame, Option<String>) {
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
