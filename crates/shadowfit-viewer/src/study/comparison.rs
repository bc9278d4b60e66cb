//! Techniques side by side in one scene, frame by frame.

use anyhow::{Context, Result};
use shadowfit_render::Gpu;
use shadowfit_scene::Scene;
use shadowfit_truth::Judged;
use shadowfit_wgpu::MapFit;

use crate::study::{Contender, Fitter, Judging, SharedTruth, Shot, Subject, Technique};

/// One technique in a comparison.
#[derive(Debug)]
struct Entry {
    technique: Technique,
    fitter: Fitter,
    contender: Contender,
}

/// Techniques that are compared in a scene.
#[derive(Debug)]
pub struct Comparison {
    gpu: Gpu,
    subject: Subject,
    judging: Judging,
    entries: Vec<Entry>,
}

/// What a technique made of a frame.
#[derive(Debug)]
pub struct Outcome {
    /// Its maps.
    pub maps: Vec<MapFit>,
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
        // A renderer of any technique has the layout that all share.
        let technique = Technique::default();
        let layout = Contender::new(&gpu, &technique.descriptor(), Judging { size: [1; 2], ..judging })?;
        let subject = Subject::new(&gpu, layout.material_layout(), scene)?;
        Ok(Self { gpu, subject, judging, entries: Vec::new() })
    }

    /// Adds a technique.
    ///
    /// # Errors
    ///
    /// When its shadow map cannot be made on this GPU.
    pub fn add(&mut self, technique: Technique) -> Result<()> {
        let contender = Contender::new(&self.gpu, &technique.descriptor(), self.judging)
            .with_context(|| format!("technique {}", technique.name))?;
        self.entries.push(Entry { fitter: Fitter::new(&technique), contender, technique });
        Ok(())
    }

    /// Takes all techniques out.
    pub fn clear(&mut self) {
        self.entries.clear();
    }

    /// The scene.
    pub fn subject(&self) -> &Subject {
        &self.subject
    }

    /// The GPU that draws.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The techniques, in the order in which they were added.
    pub fn techniques(&self) -> impl Iterator<Item = &Technique> {
        self.entries.iter().map(|entry| &entry.technique)
    }

    /// Poses the scene at a time of an animation, in seconds.
    pub fn set_time(&mut self, animation: usize, seconds: f32) {
        self.subject.set_time(&self.gpu, animation, seconds);
    }

    /// Fits, draws and judges a frame with every technique, in the order in which they were added. The truth is traced
    /// unless it is there already, of the same frame.
    ///
    /// # Errors
    ///
    /// When the camera makes no sense or the device cannot tell triangles apart.
    pub fn frame(&mut self, shot: &Shot, truth: &mut SharedTruth) -> Result<Vec<Outcome>> {
        let mut outcomes = Vec::with_capacity(self.entries.len());
        for entry in &mut self.entries {
            let maps = entry.fitter.fit(&self.subject, shot)?;
            let judged = entry.contender.judge(&self.gpu, &mut self.subject, shot, &maps, truth)?;
            outcomes.push(Outcome { maps, judged });
        }
        Ok(outcomes)
    }

    /// A technique's contender and the scene, to judge frames live.
    pub fn contender(&mut self, technique: usize) -> (&Gpu, &mut Contender, &mut Subject) {
        (&self.gpu, &mut self.entries[technique].contender, &mut self.subject)
    }

    /// The shaded picture of a frame by a technique, with maps that [`Self::frame`] gave: sRGB pixels, four bytes
    /// each, rows from the top; and the same judged anew.
    ///
    /// # Errors
    ///
    /// As for [`Self::frame`].
    pub fn picture(
        &mut self,
        technique: usize,
        shot: &Shot,
        maps: &[MapFit],
        truth: &mut SharedTruth,
    ) -> Result<(Vec<u8>, Judged)> {
        let contender = &mut self.entries[technique].contender;
        let alone = Shot { is_first: true, ..*shot };
        let judged = contender.judge(&self.gpu, &mut self.subject, &alone, maps, truth)?;
        Ok((contender.picture(&self.gpu, &mut self.subject, shot, maps)?, judged))
    }
}
