//! Device faults: a device that is lost, or has no memory left.

use std::fmt::Write as _;

use anyhow::{Context, Result, bail};
use glam::UVec2;
use shadowfit_render::{DeviceFault, Gpu};
use shadowfit_wgpu::RESOLUTIONS;
use web_time::Instant;

use super::Viewer;
use crate::background::loading::Loading;
use crate::platform::output;
use crate::scene_source::SceneSource;

/// Least life of a replaced device, in seconds. If it is lost sooner, further devices would be lost, too.
const CALM: f32 = 60.0;

/// Time when the device was last replaced.
#[derive(Debug, Default)]
pub(crate) struct Renewals(Option<Instant>);

impl Renewals {
    /// Records that a device was lost.
    ///
    /// # Errors
    ///
    /// If the previous device was lost only shortly before.
    pub(crate) fn next(&mut self, why: &str) -> Result<()> {
        let last = self.0.replace(Instant::now());
        if let Some(since) = last.map(|last| last.elapsed().as_secs_f32()).filter(|since| *since < CALM) {
            bail!(
                "the graphics device was lost again, {since:.1} s after it was replaced ({why}). The settings are \
                 saved: start the viewer again, or with `--software`, which needs no graphics card"
            );
        }
        output::tell(format_args!("the graphics device was lost ({why}); opening a new one"));
        Ok(())
    }
}

impl Viewer {
    /// Continues with another device after the first one was lost, and shows a message. Scene, settings and
    /// camera stay, except for maps that caused the device to run out of memory.
    ///
    /// # Errors
    ///
    /// If the new device cannot draw the same as the first one.
    pub(crate) fn move_to(&mut self, gpu: Gpu, format: wgpu::TextureFormat, why: &str) -> Result<()> {
        self.stage.move_to(gpu).context("the graphics device was lost, and a new one cannot replace it")?;
        self.restore_lost();
        self.interface.move_to(&self.stage, format);
        for saving in std::mem::take(&mut self.saving) {
            self.line.clone_from(&saving.destination.line);
            self.tell(Err(anyhow::anyhow!(
                "{} was not saved: the graphics device was lost",
                saving.destination.path.display()
            )));
        }
        self.line = None;
        if let Some(Loading { source, line, .. }) = self.loading.take() {
            self.loading = Some(Loading::start(source, line, self.stage.gpu(), self.stage.material_layout()));
        }
        let mut text = "The graphics device was lost and replaced: scene, settings and camera are unchanged".to_owned();
        if why.to_ascii_lowercase().contains("memory") {
            let resolution = &mut self.stage.settings.technique.fit.resolution;
            *resolution = (*resolution / 2).max(UVec2::splat(*RESOLUTIONS.start()));
            let [width, height] = resolution.to_array();
            let _ = write!(
                text,
                ", except for the maps, which now have {width} × {height} texels: the old device had \
                   no memory left"
            );
        }
        self.say(text);
        Ok(())
    }

    /// Restores state that an interrupted frame had taken out: the second technique, or the sample.
    fn restore_lost(&mut self) {
        let Some(state) = self.last_state.take().filter(|_| self.has_scene) else { return };
        if let (SceneSource::Sample { sample, variant }, None) = (&self.source, self.stage.sample()) {
            let camera = self.stage.camera;
            self.stage.set_sample(sample, *variant);
            self.restore_state(state);
            self.stage.camera = camera;
        } else if self.stage.other_technique().is_none() {
            self.stage.compare_with(state.other);
        }
    }

    /// Reports device faults that were not reported elsewhere, each one once.
    pub(crate) fn tell_faults(&mut self) {
        for fault in self.stage.gpu().take_faults() {
            if !self.told_faults.insert(fault.to_string()) {
                continue;
            }
            output::tell(format_args!("error: {fault}"));
            match fault {
                DeviceFault::OutOfMemory(_) => {
                    self.say("The GPU has no memory left: choose smaller or fewer maps, or a smaller window or scene");
                }
                DeviceFault::Refused(_) => {
                    self.player.failed = true;
                    self.say(format!("{fault}. This is a bug of the viewer"));
                }
            }
        }
    }
}
