//! The live figures of the stage's frames.

use glam::{DVec3, Vec3};
use shadowfit::figures::{Figures, MapFigures};
use shadowfit::{DepthConvention, LightFit, PerspectiveCamera, diagnostics};

use super::Stage;
use crate::fitted::Fitted;

impl Stage {
    /// The live figures of the last frame, for a picture of the given size.
    pub fn figures(&mut self, size: [u32; 2]) -> Figures {
        let fitted = match &self.fitted {
            Some(fitted) => fitted.clone(),
            None => self.fit(size),
        };
        let (statistics, times) = (self.statistics, self.evaluator.renderer.pass_times());
        let mut figures = Figures {
            shadow_pass_ms: times.shadow_ms,
            scene_pass_ms: times.scene_ms,
            shadow_draws: Some(statistics.shadow_draws),
            shadow_triangles: Some(statistics.shadow_triangles),
            ..Figures::default()
        };
        for ((figures, map), drawn) in figures.maps.iter_mut().zip(fitted.maps.iter()).zip(&statistics.maps) {
            *figures = Some(MapFigures {
                casters: Some(drawn.casters),
                draws: Some(drawn.draws),
                triangles: Some(drawn.triangles),
                ..MapFigures::new(map, fitted.end, self.settings.technique.format)
            });
        }
        if let Some((map, pixels_per_texel)) = self.ahead(&fitted, size) {
            (figures.map_ahead, figures.pixels_per_texel) = (Some(map as u32), pixels_per_texel);
        }
        figures
    }

    /// The map that is read where the middle of the picture meets the scene, and its pixels per texel there. Left open
    /// while the scene plays, which would need new rays in each frame.
    fn ahead(&self, fitted: &Fitted, size: [u32; 2]) -> Option<(usize, Option<f32>)> {
        if self.plays() {
            return None;
        }
        let camera = self.perspective(size);
        let rays = self.scene.rays();
        let eye = self.scene.camera_for_rays(&camera).eye;
        let hit = rays.tracer.first_hit(eye.as_vec3(), camera.forward)?;
        let normal = rays.tracer.normal(hit.triangle);
        let point = camera.forward * hit.distance;
        let map = fitted.read_at(camera.eye + DVec3::from(point))?;
        Some((map, pixels_per_texel(&fitted.maps[map].fit, &camera, size, point, normal)))
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
