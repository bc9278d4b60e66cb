//! Bevy's renderer as a contestant of the report. Each technique is one of the entrants.

use anyhow::Result;
use shadowfit::glam::DVec3;
use shadowfit_report::contestant::{Contestant, Drawn, LightMaps, LitSurface, LookupFilter, Redraw, Shadows};
use shadowfit_report::geometry::Corners;
use shadowfit_report::peers::Frame;

use crate::entrant::Entrant;
use crate::stage::Stage;
use crate::sun_maps::SunMaps;

/// Least cosine toward the eye in Bevy's shader.
const MIN_TO_EYE: f64 = 1e-4;

/// Bevy's renderer, and the entrants that it draws.
pub(crate) struct Renderer {
    pub(crate) stage: Stage,
    pub(crate) entrants: Vec<Entrant>,
    /// Updates of the app per frame.
    pub(crate) settle: u32,
    pub(crate) filter: LookupFilter,
}

impl Contestant for Renderer {
    type Maps = SunMaps;

    fn techniques(&self) -> Vec<String> {
        self.entrants.iter().map(Entrant::name).collect()
    }

    fn set_scene(&mut self, objects: &[Vec<Corners>]) -> Result<()> {
        self.stage.set_scene(objects);
        Ok(())
    }

    fn begin_path(&mut self, technique: usize, first: &Frame) -> Result<()> {
        self.stage.set_light(first, self.entrants[technique]);
        Ok(())
    }

    fn draw(&mut self, frame: &Frame) -> Result<Drawn<SunMaps>> {
        self.stage.set_camera(frame);
        self.stage.settle(self.settle.saturating_sub(1));
        let shadows = Shadows::Brightness(self.stage.draw()?);
        Ok(Drawn { shadows, maps: self.stage.maps()? })
    }

    fn redraw(&mut self, redraw: &Redraw<'_, SunMaps>) -> Result<Option<Vec<f32>>> {
        self.stage.set_camera(redraw.frame);
        self.stage.set_view_depths(redraw.view_depths_of);
        let picture = match redraw.maps {
            Some(maps) => self.stage.draw_with(maps),
            None => self.stage.draw_unshadowed(),
        };
        self.stage.set_view_depths(None);
        picture.map(Some)
    }

    fn light_maps(&self, maps: &SunMaps, to_light: DVec3) -> LightMaps {
        maps.lookup(self.stage.map_size(), self.filter, to_light).light_maps()
    }

    /// Returns the brightness of a white, fully rough surface by B. Burley's diffuse reflection ("Physically
    /// based shading at Disney", 2012), as in Bevy's shader.
    fn brightness(&self, LitSurface { normal, to_eye, to_light }: &LitSurface) -> f64 {
        let (light, eye) = (normal.dot(*to_light).clamp(0.0, 1.0), normal.dot(*to_eye).max(MIN_TO_EYE));
        let half = (to_light + to_eye).normalize_or_zero().dot(*to_light).clamp(0.0, 1.0);
        let f90 = 0.5 + 2.0 * half * half;
        let scatter = |cosine: f64| 1.0 + (f90 - 1.0) * (1.0 - cosine).powi(5);
        light * scatter(light) * scatter(eye)
    }
}
