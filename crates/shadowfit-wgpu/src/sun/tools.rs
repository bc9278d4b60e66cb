//! Access to a sun's maps for debug tools, and the proof that the maps have no holes.

use shadowfit::glam::DVec2;
use shadowfit::proof::{CoverageProof, CoverageQuery, Margins, prove};
use shadowfit::{FittedMap, FittedMaps, Scratch, ShadowFitter, Technique};

use super::{SunFrame, SunShadows, SunShadowsError};
use crate::demand::DemandPass;
use crate::{Casters, MapView};
use shadowfit::cache::UpdatedRect;

/// # For tools and debug assertions
impl SunShadows {
    /// Returns the technique.
    pub fn technique(&self) -> &Technique {
        self.fitter.technique()
    }

    /// Returns the maps that were fitted last.
    pub fn fitted(&self) -> &FittedMaps {
        self.fitter.fitted()
    }

    /// Returns the maps that shaders read in this frame. For a map that waits for another frame, this is the
    /// map that was drawn last.
    pub fn maps(&self) -> &[FittedMap] {
        self.maps.maps()
    }

    /// Returns the view of the look-ups: the origin of positions, and the eye and direction for view depths.
    /// Returns `None` before the first frame, and while the sun is [off](Self::turn_off).
    pub fn map_view(&self) -> Option<&MapView> {
        self.maps.view()
    }

    /// Returns the rectangles that are drawn in this frame, in the order of the passes, for debug views. Some
    /// may overlap. During a [light step](Self::set_light_steps) they include both sets of maps.
    pub fn updates(&self) -> Vec<UpdatedRect> {
        let mut updates = self.maps.updates();
        updates.extend(self.other.iter().flat_map(|other| other.maps.updates()));
        updates
    }

    /// Returns a mask for each caster, by its number: bit i is set if map i contains the caster. A map that
    /// is kept contains all static casters inside it. Any other map contains the casters that can shadow
    /// visible points. Without maps all masks are 0.
    pub fn maps_by_caster(&self, casters: &Casters<'_>) -> Vec<u8> {
        self.maps.maps_by_caster(casters)
    }

    /// Proves that no map has a hole, for the frame that was passed to [`Self::update`]. Use it in debug
    /// assertions. Returns the proof of the first map that fails. The proof includes the rounding of
    /// positions in shaders, which are relative to [`SunFrame::origin`]. A frame whose views all begin beyond
    /// the shadow distance needs no map.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Fit`] as [`prove`], and [`SunShadowsError::NoFrame`] before the first frame and
    /// while the sun is [off](Self::turn_off).
    pub fn prove(&self, frame: &SunFrame<'_>) -> Result<CoverageProof, SunShadowsError> {
        let mut proof = Err(SunShadowsError::NoFrame);
        if self.map_view().is_some() && !self.is_shadowed(frame) {
            return Ok(CoverageProof::Proven(Margins { planes: [f32::INFINITY; 6], casters: f32::INFINITY }));
        }
        let faded = self.faded().map(|(other, _)| (&other.fitter, &other.maps));
        for (fitter, maps) in [(&self.fitter, &self.maps)].into_iter().chain(faded) {
            // Light steps hold the direction.
            let held = fitter.fitted().first().filter(|_| self.steps.is_some());
            let direction = held.map_or(frame.direction, |map| map.projection.direction);
            let found = prove_set(&SunFrame { direction, ..*frame }, fitter, maps.maps());
            if !found.as_ref().is_ok_and(CoverageProof::is_proven) {
                return found;
            }
            proof = found;
        }
        proof
    }

    /// Waits for the GPU, so that the next [`Self::update`] uses the visible points of the last frame. Use it
    /// in headless runs whose images must be reproducible.
    ///
    /// # Errors
    ///
    /// [`SunShadowsError::Demand`] if the device was lost.
    pub fn wait_for_demand(&mut self) -> Result<(), SunShadowsError> {
        let seen = self.demand.pass.as_mut().map_or(Ok(None), DemandPass::wait)?;
        if let Some(seen) = seen {
            self.see(seen);
        }
        Ok(())
    }

    /// Returns whether a part of a frame's views lies within the shadow distance.
    fn is_shadowed(&self, frame: &SunFrame<'_>) -> bool {
        let distance = self.technique().fit.max_distance;
        frame.views.iter().any(|view| view.begins_before(distance))
    }
}

/// Proves that no map of a set has a hole, for a frame that the set was fitted to.
fn prove_set(
    frame: &SunFrame<'_>,
    fitter: &ShadowFitter,
    maps: &[FittedMap],
) -> Result<CoverageProof, SunShadowsError> {
    let mut storage = vec![DVec2::ZERO; frame.input().scratch()];
    let (technique, mut proof) = (fitter.technique(), Err(SunShadowsError::NoFrame));
    for (fitted, read) in fitter.fitted().iter().zip(maps) {
        // A waiting map is read as it was drawn. Shaders round positions relative to the frame's origin.
        let FittedMap { projection, bias, .. } = read.relative_to(frame.origin);
        let map = FittedMap { projection, bias, ..*fitted };
        let query = CoverageQuery::of_map(&map, technique, technique.filter_radius_in(&map.projection))
            .with_normal_offset(map.bias.normal_offset);
        let found = prove(&frame.input(), &map.projection, &query, &mut Scratch::new(&mut storage))?;
        if !found.is_proven() {
            return Ok(found);
        }
        proof = Ok(found);
    }
    proof
}
