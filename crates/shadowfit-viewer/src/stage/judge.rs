//! The present view judged against rays: what the demonstrations and their cures are held to.

use glam::DVec3;
use shadowfit_render::{Atmosphere, ProbeTargets};
use shadowfit_truth::{Judged, PixelCamera, Truth, TruthSettings, judge};

use super::{Stage, frame, map_fits};
use crate::study;

impl Stage {
    /// Draws the present view's shadow decisions at the given size and judges them against rays.
    /// With `subject_only`, only pixels of the scene's subject count in the sums. `None` where the
    /// GPU cannot tell triangles apart, with the reason as [`Self::problem`].
    pub fn judge(&mut self, size: [u32; 2], subject_only: bool) -> Option<Judged> {
        Some(self.judge_with_truth(size, subject_only)?.1)
    }

    /// Pixels per texel along the worse axis at each pixel of the present view, at the given size,
    /// that borders on a change of the true shadow.
    pub fn pixels_per_texel_at_edges(&mut self, size: [u32; 2]) -> Vec<f32> {
        let Some((truth, judged)) = self.judge_with_truth(size, false) else { return Vec::new() };
        let at_edge = |pixel: &usize| truth.transition_distance(*pixel) <= 0.5 && judged.counted[*pixel];
        (0..truth.points.len()).filter(at_edge).map(|pixel| judged.pixels_per_texel[pixel]).collect()
    }

    fn judge_with_truth(&mut self, size: [u32; 2], subject_only: bool) -> Option<(Truth, Judged)> {
        let maps = map_fits(&self.fits(size), &self.settings);
        let camera = self.perspective(size);
        let atmosphere = Atmosphere::default();
        let frame = frame(&self.settings, &camera, &maps, &atmosphere, &[], None);
        let targets = ProbeTargets::new(&self.gpu.device, size);
        let pixels = match self.renderer.probe(&self.gpu, &mut self.gpu_scene, &frame, &targets) {
            Ok(probe) => probe.pixels,
            Err(error) => {
                self.problem = Some(error.to_string());
                return None;
            }
        };
        let descriptor = *self.renderer.shadow_map().descriptor();
        let instance_counts = self.counted_instances(subject_only);
        let direction = self.settings.light.direction();
        let rays = self.rays();
        let truth_settings = TruthSettings::new(-direction.as_dvec3().normalize());
        let truth =
            Truth::trace(&rays.tracer, &PixelCamera::new(&camera, size), &truth_settings, &study::triangles(&pixels));
        let measured = study::measured(&maps, direction, DVec3::ZERO);
        let seen = study::maps_seen(&measured, &descriptor);
        let counts = |triangle: u32| instance_counts[rays.triangles[triangle as usize].instance as usize];
        let judged = judge(&rays.tracer, &truth, &seen, &study::factors(&pixels), counts);
        Some((truth, judged))
    }

    /// Which instances count in the shares.
    fn counted_instances(&self, subject_only: bool) -> Vec<bool> {
        let root = self.scene.subject.filter(|_| subject_only);
        let counts = |node| root.is_none_or(|root| self.scene.is_descendant(node, root));
        self.scene.instances().iter().map(|instance| counts(instance.node)).collect()
    }
}
