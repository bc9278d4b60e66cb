//! What the last pictures showed, read from their depth buffers as an engine does it.

use shadowfit::DepthConvention;
use shadowfit_render::RenderTarget;
use shadowfit_study::{Seen, View};
use shadowfit_wgpu::need::{NeedPass, NeedView};

use super::Stage;

impl Stage {
    /// From now on, what the last picture showed comes from its depth buffer, of `samples` per pixel, and not from
    /// rays: for pictures that follow each other in a window. It comes a frame or two late, whenever the GPU is done
    /// with it, so that pictures need not be the same each time. Rays go on where the GPU cannot do it, and find what a
    /// view shows that follows no other. What stands still is kept in the shadow maps, too.
    pub fn read_depths(&mut self, samples: u32) {
        self.evaluator.renderer.set_keeps(true);
        self.need_pass = NeedPass::new(&self.gpu.device, &self.gpu.queue, samples).ok();
        self.fitter.is_told = self.need_pass.is_some();
    }

    /// Tells the fitter what has come back.
    pub(super) fn take_last_picture(&mut self) {
        let Some(pass) = &mut self.need_pass else { return };
        match pass.take() {
            Ok(Some(seen)) if Seen::is_used_by(self.fitter.technique()) => self.fitter.tell(seen),
            Ok(_) => {}
            // The device is lost, which is said where pictures are read or presented.
            Err(_) => (self.need_pass, self.fitter.is_told) = (None, false),
        }
    }

    /// Reads the picture of a view that has just been drawn, if the technique is told of it.
    pub(super) fn record_picture(&mut self, view: &View, target: &RenderTarget) {
        let technique = self.fitter.technique();
        let Some(pass) = self.need_pass.as_mut().filter(|_| Seen::is_used_by(technique)) else { return };
        // A camera without a frustum has no maps either, which is said there.
        let depth = DepthConvention::Reversed;
        let Ok(picture) = NeedView::from_camera(&view.camera, depth, view.direction, &technique.fit, target.size)
        else {
            return;
        };
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        if pass.record(&mut encoder, target.depth_view(), &picture, None) == Ok(true) {
            self.gpu.queue.submit([encoder.finish()]);
        }
    }

    /// Forgets the pictures on their way: the next view follows none of them.
    pub(super) fn forget_pictures(&mut self) {
        if let Some(pass) = &mut self.need_pass {
            pass.reset();
        }
    }
}

#[cfg(test)]
mod gpu_tests {
    use shadowfit::Technique;
    use shadowfit::need::{LEVELS, NeedGrid};
    use shadowfit::settings::{FitKind, NeedSource};
    use shadowfit_render::{AdapterChoice, Gpu};
    use shadowfit_scene::builtin::default_scene;

    use super::*;

    /// Shares of the points in each octave of texels.
    fn shares(grid: &NeedGrid<'_>) -> Vec<f64> {
        let total: u32 = grid.counts.iter().sum();
        let levels = grid.counts.chunks(grid.counts.len() / LEVELS);
        levels.map(|level| f64::from(level.iter().sum::<u32>()) / f64::from(total)).collect()
    }

    /// What the fitter is told: whether a picture said so, and the shares.
    fn told(stage: &Stage) -> (bool, Vec<f64>) {
        let seen = stage.fitter.seen().expect("windows are told");
        (matches!(seen, Seen::Picture(_)), shares(&seen.need().expect("a grid")))
    }

    fn draw(stage: &mut Stage, target: &RenderTarget) {
        stage.draw(target);
        assert_eq!(stage.problem(), None);
        stage.gpu().device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
    }

    #[test]
    fn a_view_that_follows_no_other_is_seen_by_rays_and_the_next_ones_by_pictures_which_agree() {
        let gpu = pollster::block_on(Gpu::headless(AdapterChoice::Software)).expect("the software adapter");
        for samples in [1, 4] {
            let mut stage = Stage::new(gpu.clone(), default_scene(), samples).expect("the default scene");
            stage.read_depths(samples);
            let technique = Technique { need: NeedSource::LastFrame, ..stage.settings.technique };
            stage.settings.technique = Technique { fit: technique.fit.with_kind(FitKind::Windows), ..technique };
            let target = stage.target([640, 360]);
            draw(&mut stage, &target);
            let (is_picture, by_rays) = told(&stage);
            assert!(!is_picture);
            draw(&mut stage, &target);
            let (is_picture, by_picture) = told(&stage);
            assert!(is_picture);
            for (level, (a, b)) in by_rays.iter().zip(&by_picture).enumerate() {
                assert!((a - b).abs() < 0.03, "octave {level}: {a} of the rays, {b} of the pixels");
            }
            stage.settings.technique.filter = shadowfit::settings::FilterKind::Point;
            draw(&mut stage, &target);
            assert!(!told(&stage).0, "another technique begins anew, whatever is on its way");
        }
    }
}
