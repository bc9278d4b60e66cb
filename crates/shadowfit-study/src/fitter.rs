//! The only place where a technique's maps are fitted to a scene, view after view.

use glam::DVec2;
use shadowfit::settings::SplitScheme;
use shadowfit::{FitError, FittedMaps, MapFitter, Technique, Workspace};
use shadowfit_wgpu::MapFit;

use crate::{PreparedScene, SceneRays, SeenDepths, View};

/// Views that a fit works with: held maps are fitted to the views of two frames ahead as well.
const VIEWS: usize = 3;

/// Fits a technique's maps frame by frame, and remembers what held maps and histograms need of the frame before.
#[derive(Debug)]
pub struct TechniqueFitter {
    /// Whether histograms may be of an earlier pose of the scene, in [`Self::fit`]: rays of the present pose take some
    /// milliseconds more for each hundred thousand triangles whenever the scene has moved. A late histogram costs
    /// sharpness, never coverage.
    pub takes_late_histograms: bool,
    technique: Technique,
    maps: MapFitter,
    fitted: FittedMaps,
    depths: Option<SeenDepths>,
    storage: Vec<DVec2>,
}

impl TechniqueFitter {
    /// A fitter that remembers no frame.
    pub fn new(technique: Technique) -> Self {
        Self {
            takes_late_histograms: false,
            technique,
            maps: MapFitter::new(),
            fitted: FittedMaps::default(),
            depths: None,
            storage: Vec::new(),
        }
    }

    /// What is fitted.
    pub fn technique(&self) -> &Technique {
        &self.technique
    }

    /// Goes on with a technique; with another one than before the fitter forgets all frames.
    pub fn set_technique(&mut self, technique: &Technique) {
        if self.technique != *technique {
            *self = Self { takes_late_histograms: self.takes_late_histograms, ..Self::new(*technique) };
        }
    }

    /// The maps of the last view, with the view depths that they are read at; none before the first fit.
    pub fn fitted(&self) -> &FittedMaps {
        &self.fitted
    }

    /// The maps of a view on which the camera has just been set, as a running program has them as soon as it has seen
    /// that view: nothing is held from other views, and the histogram is that of this one.
    ///
    /// # Errors
    ///
    /// As [`Self::fit`].
    pub fn fit_alone(&mut self, scene: &PreparedScene, view: &View) -> Result<Vec<MapFit>, FitError> {
        self.maps.reset();
        self.depths = self.see(scene, view, false)?;
        self.fit_maps(scene, view)
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
        let maps = self.fit_maps(scene, view)?;
        self.depths = self.see(scene, view, self.takes_late_histograms)?;
        Ok(maps)
    }

    /// The maps of a view, from what is remembered.
    fn fit_maps(&mut self, scene: &PreparedScene, view: &View) -> Result<Vec<MapFit>, FitError> {
        let boxes = scene.boxes(self.technique.receivers);
        self.storage.resize(boxes.required(VIEWS), DVec2::ZERO);
        let frusta = [view.camera.frustum()?];
        let mut input = boxes.input(&frusta, view.direction);
        input.histogram = self.depths.as_ref().map(SeenDepths::histogram);
        let workspace = &mut Workspace::new(&mut self.storage);
        self.maps.fit_into(&input, &self.technique, workspace, &mut self.fitted)?;
        Ok(self.fitted.iter().map(MapFit::from).collect())
    }

    /// The histogram of a view, where the technique uses one.
    fn see(&self, scene: &PreparedScene, view: &View, late: bool) -> Result<Option<SeenDepths>, FitError> {
        if self.technique.splits != SplitScheme::FromHistogram {
            return Ok(None);
        }
        // A camera that makes no sense sees nothing.
        view.camera.frustum()?;
        let camera = scene.camera_for_rays(&view.camera);
        let trace = |rays: &SceneRays| SeenDepths::trace(&rays.tracer, &camera, view.direction);
        Ok(Some(if late { scene.with_late_rays(trace) } else { trace(scene.rays()) }))
    }
}
