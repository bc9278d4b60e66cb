//! The fitter for engines, one per sun. It owns the technique, the history of earlier frames, and the working
//! memory of [`FitState`].

use alloc::vec::Vec;

use glam::DVec2;

use crate::{FitError, FitInput, FitState, FittedMaps, Maps, Scratch, Technique, VisibleDemand};

/// Scratch elements for the outline of a map's content. Most outlines have far fewer corners.
const OUTLINE: usize = 4096;

/// Fitter that computes a technique's maps frame by frame. Create one per sun.
///
/// It remembers earlier frames and owns its scratch memory, which grows once. It accepts the [visible
/// demand](VisibleDemand) of an earlier frame whenever that is known.
#[derive(Clone, Debug, Default)]
pub struct ShadowFitter {
    technique: Technique,
    history: FitState,
    fitted: FittedMaps,
    scratch: Vec<DVec2>,
    visible: Option<VisibleDemand>,
}

impl ShadowFitter {
    /// Creates a fitter without history.
    pub fn new(technique: &Technique) -> Self {
        Self { technique: *technique, ..Self::default() }
    }

    /// Returns the technique.
    pub fn technique(&self) -> &Technique {
        &self.technique
    }

    /// Sets another technique. The next fit keeps no map of the old technique.
    pub fn set_technique(&mut self, technique: &Technique) {
        self.technique = *technique;
    }

    /// Forgets all earlier frames. Call it after a camera cut or when a new level begins.
    pub fn reset(&mut self) {
        self.history.reset();
        self.visible = None;
    }

    /// Sets the visible demand of an earlier frame. It is used until it is replaced. Late or wrong counts
    /// cost sharpness, never coverage.
    pub fn set_visible_demand(&mut self, visible: VisibleDemand) {
        self.visible = Some(visible);
    }

    /// Forgets the visible demand. Later fits estimate it from the boxes.
    pub fn forget_visible_demand(&mut self) {
        self.visible = None;
    }

    /// Returns the visible demand that was set last.
    pub fn visible_demand(&self) -> Option<&VisibleDemand> {
        self.visible.as_ref()
    }

    /// Fits the maps of a frame. If the input has neither [`FitInput::demand`] nor [`FitInput::histogram`],
    /// the fit uses the visible demand that was [set](Self::set_visible_demand) last.
    ///
    /// # Errors
    ///
    /// As [`FitState::fit`]. An error leaves the history unchanged, and the frame has no maps.
    pub fn fit(&mut self, input: &FitInput) -> Result<&FittedMaps, FitError> {
        let told = self.visible.take();
        let visible = told.as_ref().filter(|_| input.demand.is_empty() && input.histogram.is_none());
        let grid = visible.map(VisibleDemand::demand);
        let fitted = self.fit_growing(&match visible {
            Some(visible) => FitInput { demand: grid.as_slice(), histogram: Some(visible.histogram()), ..*input },
            None => *input,
        });
        self.visible = told;
        if let Err(error) = fitted {
            self.fitted = FittedMaps::default();
            return Err(error);
        }
        Ok(&self.fitted)
    }

    /// Fits with the existing scratch memory, and grows it if it is too small. The theoretical upper bound is
    /// several times larger than fits ever need.
    fn fit_growing(&mut self, input: &FitInput) -> Result<(), FitError> {
        let least = self.usual_scratch(input);
        if self.scratch.len() < least {
            self.scratch.resize(least, DVec2::ZERO);
        }
        loop {
            let scratch = &mut Scratch::new(&mut self.scratch);
            let fitted = self.history.fit_into(input, &self.technique, scratch, &mut self.fitted);
            let Err(FitError::ScratchTooSmall { required, .. }) = fitted else { return fitted };
            let given = self.scratch.len();
            if given >= input.scratch().saturating_mul(2) {
                return fitted;
            }
            self.scratch.resize(given + required.max(given / 2), DVec2::ZERO);
        }
    }

    /// Returns the scratch elements that fits of an input usually need, without static boxes in view and long
    /// outlines.
    fn usual_scratch(&self, input: &FitInput) -> usize {
        let [receivers, casters] =
            [input.receivers, input.casters].map(|boxes| boxes.map_or(0, |list| list.boxes.len()));
        // View depths of receivers, all boxes along the light's axes, and the bounds of runs.
        let mut elements = receivers * input.views.len() + (receivers + casters) * 4;
        if !matches!(self.technique.maps, Maps::Windows(_)) {
            // Held maps are also fitted to the predicted views of two later frames.
            elements += receivers * (input.views.len() + 2) + receivers + casters;
        }
        elements + OUTLINE
    }

    /// Returns the maps of the last frame; none after an error.
    pub fn fitted(&self) -> &FittedMaps {
        &self.fitted
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};

    use super::*;
    use crate::demand::VisibleDemandSpace;
    use crate::{Aabb, Boxes, PerspectiveCamera, PlacementSource};

    #[test]
    fn what_was_seen_places_the_maps_until_the_fitter_forgets_it() {
        let camera = PerspectiveCamera {
            eye: DVec3::new(0.0, 2.0, 0.0),
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 1.6,
            near: 0.1,
            far: 200.0,
        };
        let views = [camera.frustum().expect("a camera")];
        let ground = [Aabb::new(Vec3::new(-100.0, -0.1, -200.0), Vec3::new(100.0, 0.0, 10.0))];
        let boxes = Boxes::world(&ground);
        let sun = Vec3::new(0.3, -0.8, 0.2);
        let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, sun) };
        let technique = Technique::default();
        let mut fitter = ShadowFitter::new(&technique);
        let by_boxes = *fitter.fit(&input).expect("maps");

        let space =
            VisibleDemandSpace::new(&views[0], sun, technique.fit.up, technique.fit.max_distance).expect("a space");
        let mut visible = VisibleDemand::new(space);
        let step = Vec3::X * 0.01;
        for metre in 100..140_u8 {
            let place = Vec3::new(0.0, -2.0, -f32::from(metre));
            visible.count_cell(space.demand.index(place, Vec3::Y, step, Vec3::Z * 0.01).expect("a cell"));
        }
        fitter.reset();
        fitter.set_visible_demand(visible.clone());
        let by_grid = *fitter.fit(&input).expect("maps");
        assert_ne!(by_grid, by_boxes);
        assert_eq!((by_boxes.placement, by_grid.placement), (PlacementSource::Boxes, PlacementSource::LastFrame));
        let holds = |maps: &FittedMaps| {
            (100..140_u8).any(|metre| maps[0].projection.covers(DVec3::new(0.0, 0.0, -f64::from(metre))))
        };
        assert!(holds(&by_grid) && !holds(&by_boxes), "the finest map covers the counted points");
        fitter.reset();
        assert_eq!(*fitter.fit(&input).expect("maps"), by_boxes);

        fitter.set_visible_demand(visible.clone());
        fitter.forget_visible_demand();
        assert_eq!(fitter.fit(&input).expect("maps").placement, PlacementSource::Boxes);

        // Demand of another light is ignored, and `placement` reports it.
        fitter.set_visible_demand(visible);
        let other = FitInput { direction: Vec3::new(-0.8, -0.3, 0.2), ..input };
        assert_eq!(fitter.fit(&other).expect("maps").placement, PlacementSource::Boxes);

        fitter.fit(&FitInput { direction: Vec3::ZERO, ..input }).expect_err("no direction");
        assert!(fitter.fitted().is_empty());
    }
}
