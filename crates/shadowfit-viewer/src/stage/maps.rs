//! The maps of the stage's views: fitted, frozen, and made on the GPU.

use shadowfit::settings::{CasterPolicy, MapOverride};
use shadowfit::{DepthConvention, FitError, LightFit, PerspectiveCamera, Technique};
use shadowfit_study::RayUse;
use shadowfit_wgpu::{MapFit, ShadowMapDescriptor};

use super::Stage;
use crate::fitted::Fitted;

impl Stage {
    /// The maps of the present view and settings; none where there is nothing to fit, with the
    /// reason as [`Self::problem`].
    pub fn maps(&mut self, size: [u32; 2]) -> Vec<MapFit> {
        self.fit(size).maps.iter().map(MapFit::from).collect()
    }

    /// Fits the present view, unless what was fitted last is frozen.
    pub(super) fn fit(&mut self, size: [u32; 2]) -> Fitted {
        let technique = self.drawable_technique();
        if let Some(frozen) = self.fitted.as_ref().filter(|fitted| self.settings.view.freeze_fit && self.holds(fitted))
        {
            return Fitted { technique, ..frozen.clone() };
        }
        let fitted = self.fit_now(&technique, size).unwrap_or_else(|error| {
            self.problem = Some(format!("no shadow map: {error}"));
            Fitted::default()
        });
        self.fitted = Some(fitted.clone());
        fitted
    }

    fn fit_now(&mut self, technique: &Technique, size: [u32; 2]) -> Result<Fitted, FitError> {
        let view = self.view(size);
        self.fitter.rays = if self.plays() { RayUse::Late } else { RayUse::Wait };
        let goes_on = self.fitted.as_ref().and_then(|fitted| fitted.camera).is_some_and(|last| {
            let same_lens = PerspectiveCamera { eye: last.eye, forward: last.forward, ..view.camera } == last;
            same_lens && self.fitter.technique() == technique
        });
        if goes_on {
            self.fitter.fit(&self.scene, &view)?;
        } else {
            self.fitter.set_technique(technique);
            self.forget_pictures();
            self.fitter.fit_alone(&self.scene, &view)?;
        }
        Ok(Fitted::new(view.camera, technique, self.fitter.fitted()))
    }

    /// Whether the shadow map as it is can take fitted maps.
    fn holds(&self, fitted: &Fitted) -> bool {
        let map = self.evaluator.renderer.shadow_map().descriptor();
        let fits_into_a_layer =
            |fit: &LightFit| fit.resolution.cmple(map.resolution.into()).all() && fit.depth == map.depth;
        fitted.maps.len() <= map.maps as usize && fitted.maps.iter().all(|map| fits_into_a_layer(&map.fit))
    }

    /// The technique of the settings as far as it can be drawn, and its shadow map made. Where that is impossible, the
    /// old one stays and is fitted to, with the reason as [`Self::problem`].
    fn drawable_technique(&mut self) -> Technique {
        let mut technique = self.settings.technique;
        if technique.fit.depth == DepthConvention::NegativeOneToOne {
            self.problem = Some("depth -1 to 1 is OpenGL's: wgpu draws the map with 0 to 1 instead".to_owned());
            technique.fit.depth = DepthConvention::ZeroToOne;
        }
        let wanted = ShadowMapDescriptor::from(&technique);
        if let Err(error) = self.evaluator.renderer.set_shadow_map(&self.gpu, &wanted) {
            self.problem = Some(error.to_string());
            let map = self.evaluator.renderer.shadow_map().descriptor();
            technique.count = technique.count.min(map.maps);
            technique.overrides = technique.overrides.map(|own| MapOverride { resolution: None, ..own });
            let fit = &mut technique.fit;
            (fit.resolution, fit.depth) = (map.resolution.into(), map.depth);
            if fit.casters == CasterPolicy::DepthClamp && !map.depth_clamp {
                fit.casters = CasterPolicy::List;
            }
        }
        technique
    }
}
