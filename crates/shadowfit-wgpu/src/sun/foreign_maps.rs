//! Maps that other code fits, drawn and cached as in [`SunShadows`].

use shadowfit::{FitInput, FittedMap, FittedMaps, ShadowFitter};

use super::{SunFrame, SunShadows, SunShadowsError};
use crate::{MapView, ShadowMapError};

/// # Maps that other code fits
impl SunShadows {
    /// Fits the maps to an input and to the visible points that have arrived from earlier frames. It is the
    /// first half of [`Self::update`], for engines that fit to boxes other than the casters that they draw,
    /// or that inspect the maps before they are drawn.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Fit`] for invalid views, light or boxes, and [`SunShadowsError::Demand`] if the
    /// device was lost.
    pub fn fit(&mut self, input: &FitInput<'_>) -> Result<&FittedMaps, SunShadowsError> {
        if let Some(pass) = &mut self.demand.pass
            && let Some(seen) = pass.take()?
        {
            self.see(seen);
        }
        Ok(self.fitter.fit(input)?)
    }

    /// Finds the regions that must be drawn, and writes the uniforms. It is the second half of
    /// [`Self::update`]. The maps come from [`Self::fit`], from an earlier frame, or from other code, with
    /// the same number of texels. Maps that are selected by view depth must be sorted by their ends. Maps
    /// with a [grid position](FittedMap::grid_position) can be kept. Others are redrawn in each frame. The
    /// maps' [`texel_offset`](FittedMap::texel_offset) and the frame's receivers are ignored.
    ///
    /// # Errors
    ///
    /// The errors of [`ShadowMap::prepare`](crate::ShadowMap::prepare), and [`ShadowMapError::View`] for
    /// invalid views. Then the frame has no passes, and shaders read the maps of the previous frame.
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

    /// Writes the uniforms for another image with the same maps, relative to another origin or with view
    /// depths from another eye. The maps stay as they were drawn. Do not draw their passes after this call.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError::Forward`] for a direction that is not of unit length. On an error, no uniform is
    /// written.
    pub fn set_view(&mut self, queue: &wgpu::Queue, view: &MapView) -> Result<(), ShadowMapError> {
        self.maps.set_view(queue, view)?;
        if let Some((other, share)) = self.faded() {
            self.maps.fade_from(queue, &other.maps, view, share);
        }
        Ok(())
    }

    /// Returns the fitter of the maps.
    pub fn fitter(&self) -> &ShadowFitter {
        &self.fitter
    }

    /// Returns the fitter of the maps, for changes: to [set visible demand](ShadowFitter::set_visible_demand)
    /// that [`Self::record_demand`] did not find, or another technique with the same layers, such as one with
    /// fewer maps.
    pub fn fitter_mut(&mut self) -> &mut ShadowFitter {
        &mut self.fitter
    }
}
