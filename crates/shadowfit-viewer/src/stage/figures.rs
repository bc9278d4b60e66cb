//! The live figures of the stage's frames.

use glam::Vec3;
use shadowfit::figures::Figures;
use shadowfit::{DepthConvention, LightFit, PerspectiveCamera, diagnostics};
use shadowfit_wgpu::MapFit;

use super::Stage;

impl Stage {
    /// The live figures of the last frame, for a picture of the given size.
    pub fn figures(&mut self, size: [u32; 2]) -> Figures {
        let (statistics, times) = (self.statistics, self.evaluator.renderer.pass_times());
        let mut figures = Figures {
            shadow_pass_ms: times.shadow_ms,
            scene_pass_ms: times.scene_ms,
            shadow_draws: Some(statistics.shadow_draws),
            shadow_triangles: Some(statistics.shadow_triangles),
            ..Figures::default()
        };
        let maps = match &self.fitted {
            Some(fitted) => fitted.maps.clone(),
            None => self.maps(size),
        };
        if let Some(MapFit { fit, .. }) = maps.first() {
            figures.set_by = Some(fit.set_by);
            figures.is_empty = Some(fit.is_empty);
            figures.texel_size = Some(fit.texel_size.to_array());
            figures.depth_range = Some(fit.depth_range);
            figures.depth_step = Some(diagnostics::depth_step(self.settings.format, fit.depth_range));
            figures.pixels_per_texel = self.pixels_per_texel_ahead(fit, size);
        }
        figures
    }

    /// Pixels per texel where the middle of the picture meets the scene.
    fn pixels_per_texel_ahead(&self, fit: &LightFit, size: [u32; 2]) -> Option<f32> {
        // A scene that moves would need new rays each frame; its figure is left open.
        if self.settings.view.play && !self.scene().animations.is_empty() {
            return None;
        }
        let camera = self.perspective(size);
        let rays = self.scene.rays();
        let eye = self.scene.camera_for_rays(&camera).eye;
        let hit = rays.tracer.first_hit(eye.as_vec3(), camera.forward)?;
        let normal = rays.tracer.normal(hit.triangle);
        pixels_per_texel(fit, &camera, size, camera.forward * hit.distance, normal)
    }
}

/// Pixels per texel along the worse axis at a point relative to the eye.
fn pixels_per_texel(
    fit: &LightFit,
    camera: &PerspectiveCamera,
    size: [u32; 2],
    point: Vec3,
    normal: Vec3,
) -> Option<f32> {
    let clip = camera.clip_from_world(DepthConvention::Reversed);
    let fit = fit.relative_to(camera.eye);
    let figures = diagnostics::pixels_per_texel(&fit, &clip, size.into(), point, normal).ok()??;
    Some(figures.worse_axis)
}
