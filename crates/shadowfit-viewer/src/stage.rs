//! What the viewer shows, without a window: scene, camera, settings, animation, artefact, renderer.

mod figures;
mod home;
mod judge;

use core::fmt;

use glam::Vec3;
use shadowfit::settings::{CasterPolicy, Settings, SplitScheme, Stabilise};
use shadowfit::{Aabb, Technique, DepthConvention, FitError, LightFit, PerspectiveCamera, ViewFrustum};
use shadowfit_egui::Artefact;
use shadowfit_render::{FlyCamera, FlyInput, Gpu, Inset, Picture, Renderer, Statistics};
use shadowfit_scene::Scene;
use shadowfit_study::{
    Evaluator, FrameOptions, Judging, NothingToDraw, PreparedScene, ReceiverSource, Technique, TechniqueFitter, View,
};
use shadowfit_wgpu::{MapFit, ShadowMapError};

use crate::{artefact, outside};

/// Width of a picture, in pixels, from which on the inset has its full 300×200; smaller pictures
/// have a smaller one.
const FULL_INSET_WIDTH: f32 = 960.0;
/// Full size of the inset, in pixels.
const INSET_SIZE: [f32; 2] = [300.0, 200.0];
/// Distance of the inset from the picture's corner, in pixels, at full size.
const INSET_MARGIN: f32 = 12.0;

/// Told when a scene has no place that shows an artefact.
const NOT_FOUND: &str =
    "No place in this scene shows this well: nothing throws a shadow on a surface that faces the light.";

/// Told when the GPU lacks what a caster policy needs.
const NO_DEPTH_CLAMP: &str = "this GPU has no depth clamp: the objects place the map's near plane instead";

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
    problem: Option<String>,
    notice: Option<&'static str>,
    statistics: Statistics,
}

/// The part of the view that is shadowed, and the maps fitted to it, in order of their `far`.
#[derive(Clone, Debug, Default)]
struct Fitted {
    frustum: Option<ViewFrustum>,
    maps: Vec<MapFit>,
}

impl Stage {
    /// Sets up a scene with settings that suit its size, seen by its own camera or from a place
    /// that shows all of it. Pictures get `samples` per pixel (1 or 4).
    ///
    /// # Errors
    ///
    /// [`StageError`] if the scene is empty or the shadow map impossible.
    pub fn new(gpu: Gpu, scene: Scene, samples: u32) -> Result<Self, StageError> {
        let technique = technique(&Settings::default());
        let renderer = Renderer::new(&gpu, &technique.descriptor(), samples)?;
        let scene = PreparedScene::new(&gpu, renderer.material_layout(), scene)?;
        let evaluator = Evaluator::new(renderer, technique.bias, Judging { crawl: false, ..Judging::default() });
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

    /// A picture that this stage can draw into.
    pub fn picture(&self, size: [u32; 2]) -> Picture {
        self.evaluator.renderer.picture(&self.gpu, size)
    }

    /// The artefact on show, if any.
    pub fn shown(&self) -> Option<Shown> {
        self.shown
    }

    /// What keeps the settings from being shown as they are, for people.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// What people should know about what is shown, such as that the scene has no place for it.
    pub fn notice(&self) -> Option<&str> {
        self.notice
    }

    /// Moves camera, sun and animation on by `seconds`.
    pub fn update(&mut self, input: &FlyInput, seconds: f32) {
        self.camera.update(&mut self.settings.camera, input, seconds);
        if self.settings.light.animate {
            let light = &mut self.settings.light;
            let turned = light.azimuth + light.animate_speed * seconds;
            light.azimuth = (turned + core::f32::consts::PI).rem_euclid(core::f32::consts::TAU) - core::f32::consts::PI;
        }
        if self.settings.view.play && self.animation < self.scene().animations.len() {
            self.set_time(self.seconds + seconds);
        }
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
        artefact::fix(self, artefact);
        self.shown = Some(Shown { artefact, fixed: true });
    }

    /// The camera with its lens, for a picture of the given size.
    pub fn perspective(&self, size: [u32; 2]) -> PerspectiveCamera {
        self.camera.perspective(&self.settings.camera, size[0] as f32 / size[1] as f32)
    }

    /// The present view as it is fitted and judged, for a picture of the given size.
    fn view(&self, size: [u32; 2]) -> View {
        let is_first = self.fitted.is_none();
        View { camera: self.perspective(size), direction: self.settings.light.direction(), is_first }
    }

    /// The maps of the present view and settings, in order of their `far`; none where there is nothing
    /// to fit, with the reason as [`Self::problem`].
    pub fn maps(&mut self, size: [u32; 2]) -> Vec<MapFit> {
        self.fit(size).maps
    }

    /// Fits the present view, unless what was fitted last is frozen.
    fn fit(&mut self, size: [u32; 2]) -> Fitted {
        let technique = self.drawable_technique();
        let map = self.evaluator.renderer.shadow_map().descriptor();
        let suits =
            |map_fit: &MapFit| map_fit.fit.resolution.to_array() == map.resolution && map_fit.fit.depth == map.depth;
        if self.settings.view.freeze_fit
            && let Some(frozen) = &self.fitted
            && frozen.maps.len() <= map.maps as usize
            && frozen.maps.iter().all(suits)
        {
            return frozen.clone();
        }
        let fitted = match self.fit_now(&technique, size) {
            Ok(fitted) => fitted,
            Err(error) => {
                self.problem = Some(format!("no shadow map: {error}"));
                Fitted::default()
            }
        };
        self.fitted = Some(fitted.clone());
        fitted
    }

    fn fit_now(&mut self, technique: &Technique, size: [u32; 2]) -> Result<Fitted, FitError> {
        let view = self.view(size);
        self.fitter.set_technique(technique);
        let maps = self.fitter.fit(&self.scene, &view)?;
        let frustum = view.camera.frustum()?;
        let far = view.camera.far.min(technique.maps.fit.max_distance);
        Ok(Fitted { frustum: frustum.slice(view.camera.near, far).ok(), maps })
    }

    /// Draws the present view into a picture.
    pub fn draw(&mut self, picture: &RenderTarget) {
        self.problem = None;
        let Fitted { frustum, maps } = self.fit(picture.size);
        let view = self.view(picture.size);
        let is_outside = self.settings.view.outside;
        let outside = is_outside.then(|| outside::camera(&view.camera, frustum.as_ref(), &maps));
        let lines = if is_outside { outside::lines(frustum.as_ref(), &maps) } else { Vec::new() };
        let inset = maps.first().filter(|_| self.settings.view.inset).map(|map| self.inset(&map.fit, picture.size));
        let options = FrameOptions {
            outside,
            lines: &lines,
            inset,
            shadows: self.settings.view.shadows,
            sight: Some(self.sight(outside.as_ref())),
        };
        match self.evaluator.draw(&self.gpu, &mut self.scene, &view, &maps, &options, picture) {
            Ok(statistics) => self.statistics = statistics,
            Err(error) => self.problem = Some(error.to_string()),
        }
    }

    /// Distance that the haze suits, in metres: that of the scene's first view, so that no demonstration changes it.
    fn sight(&self, outside: Option<&PerspectiveCamera>) -> f32 {
        let visible = self.home.0.camera.far;
        outside.map_or(visible, |camera| camera.far.max(visible))
    }

    /// The technique that the settings ask for, as far as it can be drawn, and its shadow map made. Where that is
    /// impossible, the old one stays and is fitted to, with the reason as [`Self::problem`].
    fn drawable_technique(&mut self) -> Technique {
        let mut technique = technique(&self.settings);
        let fit = &mut technique.maps.fit;
        if fit.depth == DepthConvention::NegativeOneToOne {
            self.problem = Some("depth -1 to 1 is OpenGL's: wgpu draws the map with 0 to 1 instead".to_owned());
            fit.depth = DepthConvention::ZeroToOne;
        }
        if technique.descriptor().depth_clamp && !self.gpu.has_depth_clamp() {
            self.problem = Some(NO_DEPTH_CLAMP.to_owned());
            technique.maps.fit.casters = CasterPolicy::List;
        }
        self.evaluator.bias = technique.bias;
        if let Err(error) = self.evaluator.renderer.set_shadow_map(&self.gpu, &technique.descriptor()) {
            self.problem = Some(error.to_string());
            let map = self.evaluator.renderer.shadow_map().descriptor();
            technique.maps.count = technique.maps.count.min(map.maps);
            let fit = &mut technique.maps.fit;
            (fit.resolution, fit.depth) = (map.resolution.into(), map.depth);
            if fit.casters == CasterPolicy::DepthClamp && !map.depth_clamp {
                fit.casters = CasterPolicy::List;
            }
        }
        technique
    }

    /// The shadow map in the lower left corner, with the depths of the scene stretched to grey.
    fn inset(&self, fit: &LightFit, size: [u32; 2]) -> Inset {
        let scale = (size[0] as f32 / FULL_INSET_WIDTH).min(1.0);
        let [width, height] = INSET_SIZE.map(|side| (side * scale).round());
        let margin = (INSET_MARGIN * scale).round();
        let depths = corners(&self.bounds()).map(|corner| {
            fit.uv_from_world.transform_point3((corner.as_dvec3() - fit.origin).as_vec3()).z.clamp(0.0, 1.0)
        });
        let low = depths.iter().copied().fold(1.0, f32::min);
        let high = depths.iter().copied().fold(0.0, f32::max);
        Inset {
            rectangle: [margin, size[1] as f32 - height - margin, width, height],
            depth_range: if low < high { [low, high] } else { [0.0, 1.0] },
            map: 0,
        }
    }
}

/// The technique of the settings: one map.
fn technique(settings: &Settings) -> Technique {
    let maps = Technique {
        fit: settings.fit,
        count: 1,
        splits: SplitScheme::Logarithmic,
        stabilise: Stabilise::Off,
        ..Technique::default()
    };
    Technique {
        name: String::new(),
        what: String::new(),
        receivers: ReceiverSource::Clusters,
        maps,
        bias: settings.bias,
        filter: settings.filter,
        format: settings.format,
    }
}

fn corners(bounds: &Aabb) -> [Vec3; 8] {
    core::array::from_fn(|index| {
        let pick = |bit: usize, low: f32, high: f32| if index >> bit & 1 == 0 { low } else { high };
        Vec3::new(
            pick(0, bounds.min.x, bounds.max.x),
            pick(1, bounds.min.y, bounds.max.y),
            pick(2, bounds.min.z, bounds.max.z),
        )
    })
}
