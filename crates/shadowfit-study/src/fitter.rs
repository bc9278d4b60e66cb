//! The one place where a technique's maps are fitted to a scene, view after view.

use glam::DVec2;
use shadowfit::{FitError, MapFitter, SplitScheme, Technique, Workspace};
use shadowfit_wgpu::MapFit;

use crate::{PreparedScene, SeenDepths, View};

/// Views that a fit works with: held maps are fitted to the views of two frames ahead as well.
const VIEWS: usize = 3;

/// Fits a technique's maps frame by frame, and remembers what held maps and histograms need of the frame before.
#[derive(Debug)]
pub struct TechniqueFitter {
    technique: Technique,
    maps: MapFitter,
    depths: Option<SeenDepths>,
    storage: Vec<DVec2>,
}

impl TechniqueFitter {
    /// A fitter that remembers no frame.
    pub fn new(technique: Technique) -> Self {
        Self { technique, maps: MapFitter::new(), depths: None, storage: Vec::new() }
    }

    /// What is fitted.
    pub fn technique(&self) -> &Technique {
        &self.technique
    }

    /// Goes on with a technique; with another one than before the fitter forgets all frames.
    pub fn set_technique(&mut self, technique: &Technique) {
        if self.technique != *technique {
            *self = Self::new(*technique);
        }
    }

    /// The maps of a view, in order of their `far`.
    ///
    /// # Errors
    ///
    /// When the camera or the settings make no sense.
    pub fn fit(&mut self, scene: &PreparedScene, view: &View) -> Result<Vec<MapFit>, FitError> {
        if view.is_first {
            self.maps.reset();
            self.depths = None;
        }
        let boxes = scene.boxes(self.technique.receivers);
        self.storage.resize(boxes.required(VIEWS), DVec2::ZERO);
        let frusta = [view.camera.frustum()?];
        let mut input = boxes.input(&frusta, view.direction);
        input.histogram = self.depths.as_ref().map(SeenDepths::histogram);
        let maps = self.maps.fit(&input, &self.technique, &mut Workspace::new(&mut self.storage))?;
        if self.technique.splits == SplitScheme::FromHistogram {
            let camera = scene.camera_for_rays(&view.camera);
            self.depths = Some(SeenDepths::trace(&scene.rays().tracer, &camera, view.direction));
        }
        Ok(maps.iter().map(MapFit::from).collect())
    }
}
