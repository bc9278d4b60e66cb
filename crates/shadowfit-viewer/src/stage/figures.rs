//! The live figures of the stage's frames.

use glam::{DVec3, Vec3};
use shadowfit::{Camera, DepthConvention, LightProjection, diagnostics};
use shadowfit_params::figures::{Figures, JudgedFigures, MapFigures};

use shadowfit_wgpu::exact_edges::EdgeOutcome;

use super::Stage;
use super::fitted::Fitted;

impl Stage {
    /// Returns the live figures of the last frame, for a picture of the given size. `frame_ms` is the time of
    /// a whole frame.
    pub fn figures(&mut self, size: [u32; 2], frame_ms: Option<f32>) -> Figures {
        let (side, mut shot) = self.shot(size);
        let fitted = match &side.fitted {
            Some(fitted) => fitted.clone(),
            None => side.fit(&mut shot),
        };
        let (statistics, times) = (side.statistics, side.evaluator.renderer.pass_times());
        let is_traced = side.evaluator.renderer.edge_result() == EdgeOutcome::Traced;
        let traced = side.traced_share().filter(|_| is_traced);
        let judge_ms = times.probe_ms.map(|probe| probe + side.live.gpu_ms().unwrap_or(0.0));
        let format = self.settings.technique.format;
        let mut figures = Figures {
            frame_ms,
            shadow_pass_ms: times.shadow_ms,
            scene_pass_ms: times.scene_ms,
            edges_ms: times.edges_ms.filter(|_| is_traced),
            traced,
            judge_ms,
            shadow_draws: Some(statistics.shadow_draws),
            shadow_triangles: Some(statistics.shadow_triangles),
            shadow_texels: Some(statistics.shadow_texels),
            judged: self.judged_figures(),
            judged_other: self.other_figures(),
            ..Figures::default()
        };
        let drawn = statistics.maps.iter().zip(times.maps_ms);
        for ((index, figures), (map, (drawn, ms))) in
            figures.maps.iter_mut().enumerate().zip(fitted.maps.iter().zip(drawn))
        {
            *figures = Some(MapFigures {
                casters: Some(drawn.casters),
                draws: Some(drawn.draws),
                triangles: Some(drawn.triangles),
                texels: Some(drawn.texels),
                pass_ms: ms,
                waste: waste(&fitted, index),
                ..MapFigures::new(map, fitted.end, format)
            });
        }
        if let Some((map, pixels_per_texel)) = self.ahead(&fitted, size) {
            (figures.map_ahead, figures.pixels_per_texel) = (Some(map as u32), pixels_per_texel);
        }
        figures
    }

    /// Returns the figures of the last judged picture.
    pub fn judged_figures(&self) -> Option<JudgedFigures> {
        self.side.live.figures(self.clock)
    }

    /// Returns the map that is read where the middle of the picture meets the scene, and its pixels per texel
    /// there. `None` while the scene plays, which would need new rays in each frame.
    fn ahead(&self, fitted: &Fitted, size: [u32; 2]) -> Option<(usize, Option<f32>)> {
        if self.plays() {
            return None;
        }
        let camera = self.camera_of(size);
        let rays = self.scene.ready_rays()?;
        let eye = self.scene.camera_for_rays(camera).eye;
        let hit = rays.tracer.first_hit(eye.as_vec3(), camera.forward)?;
        let normal = rays.tracer.normal(hit.triangle);
        let point = camera.forward * hit.distance;
        let map = fitted.read_at(camera.eye + DVec3::from(point))?;
        Some((map, pixels_per_texel(&fitted.maps[map].projection, &camera, size, point, normal)))
    }
}

/// Returns the share of a map's area outside the part of the view that it serves; `None` for a map without
/// such a part.
fn waste(fitted: &Fitted, map: usize) -> Option<f32> {
    let slice = fitted.slice(map)?;
    let fit = fitted.maps.get(map)?.projection.relative_to(slice.origin);
    diagnostics::share_of_map(&fit, &slice.corners).ok().map(|share| 1.0 - share.min(1.0))
}

/// Returns the pixels per texel along the worse axis at a point relative to the eye.
fn pixels_per_texel(fit: &LightProjection, camera: &Camera, size: [u32; 2], point: Vec3, normal: Vec3) -> Option<f32> {
    let clip = camera.clip_from_world(DepthConvention::Reversed);
    let fit = fit.relative_to(camera.eye);
    let figures = diagnostics::pixels_per_texel(&fit, &clip, size.into(), point, normal).ok()??;
    Some(figures.worse_axis)
}
