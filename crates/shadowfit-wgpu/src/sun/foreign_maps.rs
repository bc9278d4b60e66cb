//! Maps that other code fits, drawn and kept by the rules of [`SunShadows`].

use shadowfit::{FitInput, FittedMap, FittedMaps, ShadowFitter};

use super::{SunFrame, SunShadows, SunShadowsError};
use crate::{MapView, ShadowMapError};

/// # Maps that other code fits
impl SunShadows {
    /// Fits the maps to an input and to the counts that have arrived of earlier pictures: the first half of
    /// [`Self::update`], for engines that fit to other boxes than those of the casters that they draw, or look at the
    /// maps before they are drawn.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Fit`] for views, light and boxes that make no sense; [`SunShadowsError::Demand`] if the device
    /// was lost.
    pub fn fit(&mut self, input: &FitInput<'_>) -> Result<&FittedMaps, SunShadowsError> {
        if let Some(pass) = &mut self.demand.pass
            && let Some(seen) = pass.take()?
        {
            self.see(seen);
        }
        Ok(self.fitter.fit(input)?)
    }

    /// Finds which parts of maps must be drawn, and writes the uniforms: the second half of [`Self::update`]. The maps
    /// are those of [`Self::fit`], or any others with as many texels: of a frozen frame, or fitted by other code. Maps
    /// that are read by view depth are in the order of their ends. Maps with a
    /// [grid position](FittedMap::grid_position) can be kept; others are redrawn in each frame. Their
    /// [`texel_offset`](FittedMap::texel_offset) and the frame's receivers are ignored.
    ///
    /// # Errors
    ///
    /// As [`ShadowMap::prepare`](crate::ShadowMap::prepare), and [`ShadowMapError::View`] for views that make no sense. There is nothing to draw
    /// then, and the shaders read the maps of the frame before.
    pub fn prepare(
        &mut self,
        queue: &wgpu::Queue,
        frame: &SunFrame<'_>,
        maps: &[FittedMap],
    ) -> Result<(), ShadowMapError> {
        self.skip();
        self.end_step();
        self.prepare_present(queue, frame, maps)
    }

    /// Writes the uniforms for another picture with the same maps, whose positions are relative to another origin or
    /// whose view depths are counted from another eye. The maps stay as they were drawn: their passes must not be drawn
    /// after this.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError::Forward`] for a direction that is not of unit length; nothing is written then.
    pub fn set_view(&mut self, queue: &wgpu::Queue, view: &MapView) -> Result<(), ShadowMapError> {
        self.maps.set_view(queue, view)?;
        if let Some((other, share)) = self.faded() {
            self.maps.fade_from(queue, &other.maps, view, share);
        }
        Ok(())
    }

    /// The fitter of the maps.
    pub fn fitter(&self) -> &ShadowFitter {
        &self.fitter
    }

    /// The fitter of the maps, for visible points that were [found](ShadowFitter::set_visible_demand) by other means than
    /// [`Self::record_demand`], or for another technique with the same layers, such as one with fewer maps.
    pub fn fitter_mut(&mut self) -> &mut ShadowFitter {
        &mut self.fitter
    }
}
