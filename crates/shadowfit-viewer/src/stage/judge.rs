//! Judging the current view against rays, to test the demonstrations and their cures.

use shadowfit_study::{Judging, SharedTruth, View};
use shadowfit_truth::Judged;

use super::Stage;

impl Stage {
    /// Draws the current view's shadow decisions at the given size and judges them against rays. With
    /// `subject_only`, only pixels of the scene's subject count in the sums. `None` if the view cannot be
    /// drawn, with the reason in [`Self::problem`].
    pub fn judge(&mut self, size: [u32; 2], subject_only: bool) -> Option<Judged> {
        Some(self.judge_with_truth(size, subject_only)?.1)
    }

    /// Returns the pixels per texel along the worse axis at each pixel of the current view, at the given
    /// size, that borders on an edge of the true shadow.
    pub fn pixels_per_texel_at_edges(&mut self, size: [u32; 2]) -> Vec<f32> {
        let Some((truth, judged)) = self.judge_with_truth(size, false) else { return Vec::new() };
        let Some(truth) = truth.get() else { return Vec::new() };
        let at_edge = |pixel: &usize| truth.transition_distance(*pixel) <= 0.5 && judged.counted[*pixel];
        (0..truth.points.len()).filter(at_edge).map(|pixel| judged.pixels_per_texel[pixel]).collect()
    }

    fn judge_with_truth(&mut self, size: [u32; 2], subject_only: bool) -> Option<(SharedTruth, Judged)> {
        let maps = self.maps(size);
        // A single picture, without crawl against earlier ones.
        let view = View { is_first: true, ..self.view(size) };
        let ray_offset = self.ray_offset();
        let evaluator = &mut self.side.evaluator;
        evaluator.judging = Judging { size, subject_only, crawl: false, ray_offset, ..evaluator.judging };
        let mut truth = SharedTruth::default();
        match evaluator.judge(&self.gpu, &mut self.scene, &view, &maps, &mut truth) {
            Ok(judged) => Some((truth, judged)),
            Err(error) => {
                self.side.problem = Some(format!("{error:#}"));
                None
            }
        }
    }
}
