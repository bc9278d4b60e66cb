//! What the viewer shows, without a window: scene, camera, settings, animation, artefact, renderer.

mod figures;
mod home;
mod inset;
mod judge;
mod last_picture;
mod maps;

use core::fmt;

use shadowfit::tool::{InsetMaps, Settings, ViewMode};
use shadowfit::{Aabb, PerspectiveCamera};
use shadowfit_egui::Artefact;
use shadowfit_render::{Culling, FlyCamera, FlyInput, Gpu, Overlay, RenderTarget, Renderer, Statistics};
use shadowfit_scene::Scene;
use shadowfit_study::{Evaluator, FrameOptions, Judging, NothingToDraw, PreparedScene, TechniqueFitter, View};
use shadowfit_wgpu::need::NeedPass;
use shadowfit_wgpu::{MapFit, ShadowMapDescriptor, ShadowMapError};

use crate::fitted::Fitted;
use crate::{artefact, outside};

/// Shown when no view of a scene shows an artefact.
const NOT_FOUND: &str =
    "No place in this scene shows this well: nothing throws a shadow on a surface that faces the light.";

/// The artefact on show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// Which one.
    pub artefact: Artefact,
    /// Whether its cure has been applied.
    pub fixed: bool,
}

/// Why a stage could not be set up.
#[derive(Clone, Debug, PartialEq)]
pub enum StageError {
    /// The scene has no triangles to draw.
    NothingToDraw(NothingToDraw),
    /// The shadow map could not be made.
    ShadowMap(ShadowMapError),
}

impl fmt::Display for StageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NothingToDraw(error) => error.fmt(f),
            Self::ShadowMap(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for StageError {}

impl From<NothingToDraw> for StageError {
    fn from(error: NothingToDraw) -> Self {
        Self::NothingToDraw(error)
    }
}

impl From<ShadowMapError> for StageError {
    fn from(error: ShadowMapError) -> Self {
        Self::ShadowMap(error)
    }
}

/// Scene, camera and settings, and what draws them.
#[derive(Debug)]
pub struct Stage {
    /// Everything that the panel edits.
    pub settings: Settings,
    /// Where the eye is.
    pub camera: FlyCamera,
    /// Which animation plays, if the scene has it.
    pub animation: usize,
    gpu: Gpu,
    scene: PreparedScene,
    fitter: TechniqueFitter,
    evaluator: Evaluator,
    seconds: f32,
    home: (Settings, FlyCamera),
    before_artefact: Option<(Settings, FlyCamera)>,
    shown: Option<Shown>,
    /// What was fitted last; fitted anew unless it is frozen.
    fitted: Option<Fitted>,
    /// Reads what the last pictures showed; rays find it where there is none.
    need_pass: Option<NeedPass>,
    problem: Option<String>,
    notice: Option<&'static str>,
    statistics: Statistics,
}

impl Stage {
    /// Sets up a scene with settings that suit its size, seen by its own camera or from a position
    /// that shows all of it. Pictures get `samples` per pixel (1 or 4).
    ///
    /// # Errors
    ///
    /// [`StageError`] if the scene is empty or the shadow map impossible.
    pub fn new(gpu: Gpu, scene: Scene, samples: u32) -> Result<Self, StageError> {
        let technique = Settings::default().technique;
        let renderer = Renderer::new(&gpu, &ShadowMapDescriptor::from(&technique), samples)?;
        let scene = PreparedScene::new(&gpu, renderer.material_layout(), scene)?;
        let evaluator = Evaluator::new(renderer, Judging { crawl: false, ..Judging::default() });
        let home = home::home(&scene);
        Ok(Self {
            settings: home.0,
            camera: home.1,
            animation: 0,
            gpu,
            scene,
            fitter: TechniqueFitter::new(technique),
            evaluator,
            seconds: 0.0,
            home,
            before_artefact: None,
            shown: None,
            fitted: None,
            need_pass: None,
            problem: None,
            notice: None,
            statistics: Statistics::default(),
        })
    }

    /// Shows another scene. On an error the old one stays.
    ///
    /// # Errors
    ///
    /// [`StageError`] if the scene is empty.
    pub fn set_scene(&mut self, scene: Scene) -> Result<(), StageError> {
        self.scene = PreparedScene::new(&self.gpu, self.evaluator.renderer.material_layout(), scene)?;
        self.evaluator.renderer.invalidate_maps();
        self.home = home::home(&self.scene);
        (self.settings, self.camera) = self.home;
        (self.seconds, self.shown, self.before_artefact, self.fitted) = (0.0, None, None, None);
        self.notice = None;
        Ok(())
    }

    /// The scene on show.
    pub fn scene(&self) -> &Scene {
        self.scene.scene()
    }

    /// The scene on show with all that was made from it.
    pub fn prepared_scene(&self) -> &PreparedScene {
        &self.scene
    }

    /// World bounds of the scene in its present pose, in metres.
    pub fn bounds(&self) -> Aabb {
        self.scene.bounds()
    }

    /// The GPU that draws.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// A target of the given width and height, in pixels, that this stage can draw into.
    pub fn target(&self, size: [u32; 2]) -> RenderTarget {
        self.evaluator.renderer.target(&self.gpu, size)
    }

    /// The artefact on show, if any.
    pub fn shown(&self) -> Option<Shown> {
        self.shown
    }

    /// Why the settings cannot be shown as they are, as a readable line.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// A readable note about what is shown, such as that no view of the scene shows the artefact.
    pub fn notice(&self) -> Option<&str> {
        self.notice
    }

    /// Moves camera, sun and animation on by `seconds`.
    pub fn update(&mut self, input: &FlyInput, seconds: f32) {
        self.camera.update(&mut self.settings.camera, input, seconds);
        self.settings.light.advance(seconds);
        if self.plays() {
            self.set_time(self.seconds + seconds);
        }
    }

    /// Whether an animation moves the scene from frame to frame.
    fn plays(&self) -> bool {
        self.settings.view.play && self.animation < self.scene().animations.len()
    }

    /// Poses the scene at a time of its animation, in seconds.
    pub fn set_time(&mut self, seconds: f32) {
        self.seconds = seconds;
        self.scene.set_time(&self.gpu, self.animation, seconds);
    }

    /// Back to the settings and the view that the scene was opened with.
    pub fn reset(&mut self) {
        (self.settings, self.camera) = self.home;
        (self.shown, self.before_artefact, self.fitted, self.notice) = (None, None, None, None);
    }

    /// Back to the view that the scene was opened with; settings stay.
    pub fn reset_camera(&mut self) {
        self.camera = self.home.1;
        self.cut();
    }

    /// Starts again with a view that is unrelated to the one before; a frozen fit stays.
    fn cut(&mut self) {
        self.fitted = self.fitted.take().filter(|_| self.settings.view.freeze_fit);
    }

    /// Takes the present settings and view as those to go back to.
    pub fn set_home(&mut self) {
        self.home = (self.settings, self.camera);
    }

    /// Moves camera and settings so that an artefact is plainly visible.
    pub fn show_artefact(&mut self, artefact: Artefact) {
        let before = self.before_artefact.unwrap_or((self.settings, self.camera));
        self.before_artefact = Some(before);
        (self.settings, self.camera) = before;
        self.fitted = None;
        self.notice = (!artefact::show(self, artefact)).then_some(NOT_FOUND);
        self.shown = Some(Shown { artefact, fixed: false });
    }

    /// Cures an artefact: shows it first if it is not on show.
    pub fn fix_artefact(&mut self, artefact: Artefact) {
        if self.shown.is_none_or(|shown| shown.artefact != artefact) {
            self.show_artefact(artefact);
        }
        let before = self.before_artefact.unwrap_or((self.settings, self.camera)).0.technique;
        artefact::fix(self, artefact, &before);
        self.shown = Some(Shown { artefact, fixed: true });
    }

    /// The camera with its lens, for a picture of the given size.
    pub fn perspective(&self, size: [u32; 2]) -> PerspectiveCamera {
        self.camera.perspective(&self.settings.camera, size[0] as f32 / size[1] as f32)
    }

    /// The present view as it is fitted and judged, for a picture of the given size.
    fn view(&self, size: [u32; 2]) -> View {
        View { camera: self.perspective(size), direction: self.settings.light.direction(), is_first: false }
    }

    /// Draws the present view into a target.
    pub fn draw(&mut self, target: &RenderTarget) {
        self.problem = None;
        self.take_last_picture();
        let fitted = self.fit(target.size);
        let maps: Vec<MapFit> = fitted.maps.iter().map(MapFit::from).collect();
        let seen = self.view(target.size);
        // A frozen fit was made for another camera, whose view depths may still choose among its maps.
        let view = View { camera: fitted.camera.unwrap_or(seen.camera), ..seen };
        let settings = self.settings.view;
        let is_outside = settings.mode == ViewMode::Outside;
        let outside = is_outside.then(|| outside::camera(&seen.camera, &fitted));
        let from_elsewhere = outside.or_else(|| (view.camera != seen.camera).then_some(seen.camera));
        let lines = if is_outside { outside::lines(&fitted) } else { Vec::new() };
        let shown = settings.inset_index(maps.len() as u32);
        let inset = maps.get(shown).filter(|_| settings.inset != InsetMaps::Off);
        let inset = inset.map(|map| inset::inset(shown, &map.fit, &self.bounds(), target.size));
        let options = FrameOptions {
            outside: from_elsewhere,
            // Maps that are themselves looked at from elsewhere hold all their casters, not only those of this
            // picture's shadows.
            culling: if from_elsewhere.is_some() { Culling::WholeMap } else { Culling::Swept },
            overlay: if settings.mode == ViewMode::Maps { Overlay::MapTint } else { Overlay::None },
            lines: &lines,
            insets: inset.as_slice(),
            shadows: settings.shadows,
            sight: Some(self.sight(outside.as_ref())),
            ..FrameOptions::default()
        };
        match self.evaluator.draw(&self.gpu, &mut self.scene, &view, &maps, &options, target) {
            Ok(statistics) => {
                self.statistics = statistics;
                if from_elsewhere.is_none() {
                    self.record_picture(&view, target);
                }
            }
            Err(error) => self.problem = Some(error.to_string()),
        }
    }

    /// Distance that the haze suits, in metres: that of the scene's first view, so that no demonstration changes it.
    fn sight(&self, outside: Option<&PerspectiveCamera>) -> f32 {
        let visible = self.home.0.camera.far;
        outside.map_or(visible, |camera| camera.far.max(visible))
    }
}
