//! The only place where a technique's maps are fitted to a scene, view after view.

use glam::DVec2;
use shadowfit::{FitError, FittedMaps, MapFitter, Technique, Workspace};
use shadowfit_wgpu::MapFit;
use shadowfit_wgpu::need::SeenNeed;

use crate::{PosedScene, Seen, View};

/// Views that a fit works with: held maps are fitted to the views of two frames ahead as well.
const VIEWS: usize = 3;

/// Which rays find what the frame before showed, for techniques that are told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RayUse {
    /// Those of the scene's present pose, which are made where they are not there.
    #[default]
    Wait,
    /// In [`TechniqueFitter::fit`] those of an earlier pose too, where those of the present one are not there; some are
    /// made only where there are none at all. That costs sharpness, never coverage.
    Late,
    /// Only those that are there, of whichever pose: none are ever made. Without any, the fit goes on by the scene's
    /// boxes alone.
    IfReady,
}

/// Fits a technique's maps frame by frame, and remembers what held maps, histograms and windows need of the frame before.
#[derive(Debug)]
pub struct TechniqueFitter {
    /// Which rays find what a view shows.
    pub rays: RayUse,
    /// Whether [`Self::tell`] tells what the frame before showed, in [`Self::fit`], so that no rays look for it.
    pub is_told: bool,
    technique: Technique,
    maps: MapFitter,
    fitted: FittedMaps,
    seen: Option<Seen>,
    storage: Vec<DVec2>,
}

impl TechniqueFitter {
    /// A fitter that remembers no frame.
    pub fn new(technique: Technique) -> Self {
        Self {
            rays: RayUse::default(),
            is_told: false,
            technique,
            maps: MapFitter::new(),
            fitted: FittedMaps::default(),
            seen: None,
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
            *self = Self { rays: self.rays, is_told: self.is_told, ..Self::new(*technique) };
        }
    }

    /// The maps of the last view, with the view depths that they are read at; none before the first fit.
    pub fn fitted(&self) -> &FittedMaps {
        &self.fitted
    }

    /// The maps of a view on which the camera has just been set, as a running program has them as soon as it has seen
    /// that view: nothing is held from other views, and what the frame before showed is this one.
    ///
    /// # Errors
    ///
    /// As [`Self::fit`].
    pub fn fit_alone(&mut self, scene: &PosedScene, view: &View) -> Result<Vec<MapFit>, FitError> {
        self.maps.reset();
        self.seen = self.see(scene, view, self.rays == RayUse::IfReady)?;
        self.fit_maps(scene, view)
    }

    /// The maps of a view, in order of their `far`.
    ///
    /// # Errors
    ///
    /// When the camera or the settings make no sense.
    pub fn fit(&mut self, scene: &PosedScene, view: &View) -> Result<Vec<MapFit>, FitError> {
        if view.is_first {
            self.maps.reset();
            self.seen = None;
        }
        let maps = self.fit_maps(scene, view)?;
        if !self.is_told {
            self.seen = self.see(scene, view, self.rays != RayUse::Wait)?;
        }
        Ok(maps)
    }

    /// Tells what the depth buffer of a picture before the next view showed.
    pub fn tell(&mut self, seen: SeenNeed) {
        self.seen = Some(Seen::Picture(seen));
    }

    /// What the next maps are told of the views before; `None` where the technique is told nothing.
    pub fn seen(&self) -> Option<&Seen> {
        self.seen.as_ref()
    }

    /// The maps of a view, from what is remembered.
    fn fit_maps(&mut self, scene: &PosedScene, view: &View) -> Result<Vec<MapFit>, FitError> {
        let boxes = scene.boxes(self.technique.receivers);
        self.storage.resize(boxes.required(VIEWS), DVec2::ZERO);
        let frusta = [view.camera.frustum()?];
        let mut input = boxes.input(&frusta, view.direction);
        input.histogram = self.seen.as_ref().and_then(Seen::histogram);
        let need = self.seen.as_ref().and_then(Seen::need);
        input.need = need.as_slice();
        let workspace = &mut Workspace::new(&mut self.storage);
        self.maps.fit_into(&input, &self.technique, workspace, &mut self.fitted)?;
        Ok(self.fitted.iter().map(MapFit::from).collect())
    }

    /// What a view shows, where the technique is told of it; `late` takes rays of an earlier pose too.
    fn see(&self, scene: &PosedScene, view: &View, late: bool) -> Result<Option<Seen>, FitError> {
        if !Seen::is_used_by(&self.technique) {
            return Ok(None);
        }
        // A camera that makes no sense sees nothing.
        view.camera.frustum()?;
        let latest = if late { scene.latest_rays() } else { None };
        let rays = match latest {
            Some((rays, _)) => rays,
            None if self.rays == RayUse::IfReady => return Ok(None),
            None => scene.shared_rays(),
        };
        let camera = scene.camera_for_rays(&view.camera);
        Seen::trace(&self.technique, (&rays.tracer, scene.origin()), &camera, view.direction)
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, Vec3};
    use shadowfit::{FittedMaps, PerspectiveCamera};
    use shadowfit_render::{AdapterChoice, Gpu, Renderer};
    use shadowfit_scene::builtin::default_scene;
    use shadowfit_wgpu::ShadowMapDescriptor;

    use crate::PreparedScene;

    use super::*;

    fn scene() -> PreparedScene {
        let gpu = pollster::block_on(Gpu::headless(AdapterChoice::Software)).expect("the software adapter");
        let renderer = Renderer::new(&gpu, &ShadowMapDescriptor::default(), 1).expect("a renderer");
        PreparedScene::new(&gpu, renderer.material_layout(), default_scene()).expect("the default scene")
    }

    fn view(z: f64, is_first: bool) -> View {
        let camera = PerspectiveCamera {
            eye: DVec3::new(3.0, 2.0, z),
            forward: Vec3::new(-0.3, -0.2, -0.9),
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 1.6,
            near: 0.1,
            far: 150.0,
        };
        View { camera, direction: Vec3::new(0.4, -0.7, 0.3).normalize(), is_first }
    }

    #[test]
    fn gpu_windows_are_placed_by_the_frame_before_and_those_of_a_picture_alone_by_itself() {
        let scene = scene();
        let fitter = |name: &str| TechniqueFitter::new(Technique::preset(name).expect("a preset"));
        let alone = |name: &str| {
            let mut fitter = fitter(name);
            fitter.fit_alone(&scene, &view(9.0, false)).expect("maps");
            *fitter.fitted()
        };
        let along = |name: &str| -> Vec<FittedMaps> {
            let mut fitter = fitter(name);
            let frames = [view(9.0, true), view(8.9, false), view(8.8, false)];
            let fit = |view: &View| fitter.fit(&scene, view).map(|_| *fitter.fitted()).expect("maps");
            frames.iter().map(fit).collect()
        };
        let (seen, estimated) = (along("windows-4"), along("windows-boxes-4"));
        assert_ne!(alone("windows-4"), alone("windows-boxes-4"), "the picture's own needs count");
        assert_eq!(seen[0], estimated[0], "the first frame knows the boxes alone");
        assert_eq!(seen[0], alone("windows-boxes-4"));
        assert_ne!(seen[1], estimated[1], "the next one knows what the first one showed");
    }
    #[test]
    fn gpu_without_waiting_the_boxes_place_windows_until_rays_are_there() {
        let mut scene = scene();
        let fit = |scene: &PreparedScene, name: &str, rays: RayUse| {
            let mut fitter = TechniqueFitter::new(Technique::preset(name).expect("a preset"));
            fitter.rays = rays;
            fitter.fit_alone(scene, &view(9.0, false)).expect("maps");
            *fitter.fitted()
        };
        let by_boxes = fit(&scene, "windows-boxes-4", RayUse::IfReady);
        for name in ["windows-4", "histogram-4"] {
            let mut fitter = TechniqueFitter::new(Technique::preset(name).expect("a preset"));
            fitter.rays = RayUse::IfReady;
            for z in [9.0, 8.9] {
                fitter.fit(&scene, &view(z, false)).expect("maps");
            }
            assert!(fitter.seen().is_none() && scene.latest_rays().is_none(), "{name}");
        }
        assert_eq!(fit(&scene, "windows-4", RayUse::IfReady), by_boxes);
        scene.request_rays();
        while !scene.take_rays() {
            std::thread::yield_now();
        }
        let by_rays = fit(&scene, "windows-4", RayUse::IfReady);
        assert_ne!(by_rays, by_boxes);
        assert_eq!(by_rays, fit(&scene, "windows-4", RayUse::Wait));
    }
}
