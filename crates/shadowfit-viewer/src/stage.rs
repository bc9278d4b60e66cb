//! The stage: all that the viewer shows, without a window: scene, camera, settings, animation, artefact, and one
//! technique or two.

pub(crate) mod artefact;
mod boards;
mod compare;
mod demand_view;
mod figures;
mod fitted;
mod home;
mod inset;
mod judge;
mod live;
mod outside;
mod sample;
mod shot;
mod shown;
mod side;
mod why;

#[cfg(test)]
mod depth_tests;
#[cfg(test)]
mod edges_tests;
#[cfg(test)]
mod file_tests;
#[cfg(test)]
mod live_tests;
#[cfg(all(test, target_os = "linux"))]
mod own_process_memory_tests;

use core::fmt;

use shadowfit::{Aabb, Camera, FittedMap};
use shadowfit_params::tool::{CameraSettings, Settings};
use shadowfit_render::{FlyCamera, FlyInput, Gpu, RenderTarget};
use shadowfit_scene::{BlendedCasters, Scene};
use shadowfit_study::{PrepareError, PreparedScene, View};
use shadowfit_wgpu::ShadowMapError;

use compare::Other;
pub(crate) use compare::compared_with;
pub(crate) use live::judged_figures;
pub(crate) use sample::SampleShow;
use shot::Shot;
pub use shown::Shown;
pub(crate) use shown::{ArtefactShow, changes};
use side::Side;

/// Why a stage could not be set up.
#[derive(Clone, Debug, PartialEq)]
pub enum StageError {
    /// The scene has no triangles to draw, or the device has no memory for it.
    Scene(PrepareError),
    /// The shadow map could not be made.
    ShadowMap(ShadowMapError),
}

impl fmt::Display for StageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Scene(error) => error.fmt(f),
            Self::ShadowMap(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for StageError {}

impl From<PrepareError> for StageError {
    fn from(error: PrepareError) -> Self {
        Self::Scene(error)
    }
}

impl From<ShadowMapError> for StageError {
    fn from(error: ShadowMapError) -> Self {
        Self::ShadowMap(error)
    }
}

/// Scene, camera and settings, with the renderers that draw them.
#[derive(Debug)]
pub struct Stage {
    /// Everything that the panel edits; its technique is that of the first side.
    pub settings: Settings,
    /// The camera.
    pub camera: FlyCamera,
    /// Index of the animation that plays, if the scene has it.
    pub animation: usize,
    /// Place of the bar between two techniques, as a share of the picture's width.
    pub split: f32,
    gpu: Gpu,
    samples: u32,
    scene: PreparedScene,
    side: Side,
    other: Option<Other>,
    seconds: f32,
    /// Seconds since the stage was set up: the clock for blinking marks, the resting pointer and the age of figures.
    clock: f32,
    home: (Settings, FlyCamera),
    artefact: ArtefactShow,
    why: why::PixelQuestion,
    reads_depths: bool,
    /// Whether nothing shows the verdicts of the next pictures.
    is_unseen: bool,
    sample: Option<SampleShow>,
    /// Number of the file's camera whose lens the settings have taken.
    followed: Option<u32>,
}

/// Views that a technique is tuned for.
const TUNE_VIEWS: u32 = 4;
/// Flight from one of them to the next, in seconds at the camera's speed.
const TUNE_STEP: f32 = 0.02;
/// Turn from one of them to the next, in radians.
const TUNE_TURN: f32 = 0.004;

/// How often marks blink, in turns a second.
const BLINKS: f32 = 1.2;

impl Stage {
    /// Sets up a scene with settings that suit its size, seen by its own camera or from a position
    /// that shows all of it. Pictures get `samples` per pixel (1 or 4).
    ///
    /// # Errors
    ///
    /// [`StageError`] if the scene is empty or the shadow map impossible.
    pub fn new(gpu: Gpu, scene: Scene, samples: u32) -> Result<Self, StageError> {
        let side = Side::new(&gpu, &Settings::default().technique, samples)?;
        let scene = PreparedScene::new(&gpu, side.evaluator.renderer.material_layout(), scene)?;
        let home = home::home(&scene);
        Ok(Self {
            settings: home.0,
            camera: home.1,
            followed: home.0.camera.file,
            animation: 0,
            split: 0.5,
            gpu,
            samples,
            scene,
            side,
            other: None,
            seconds: 0.0,
            clock: 0.0,
            home,
            artefact: ArtefactShow::default(),
            why: why::PixelQuestion::default(),
            reads_depths: false,
            is_unseen: false,
            sample: None,
        })
    }

    /// A stage with a placeholder, until [`Self::set_prepared`] brings a scene.
    pub(crate) fn empty(gpu: Gpu, samples: u32) -> Result<Self, StageError> {
        let triangle = [glam::Vec3::ZERO, glam::Vec3::X, glam::Vec3::Z];
        Self::new(gpu, Scene::from_objects("empty", &[vec![triangle]]), samples)
    }

    /// Shows another scene. On an error the old one stays.
    ///
    /// # Errors
    ///
    /// [`StageError`] if the scene is empty.
    pub fn set_scene(&mut self, scene: Scene) -> Result<(), StageError> {
        self.set_prepared(PreparedScene::new(&self.gpu, self.material_layout(), scene)?);
        Ok(())
    }

    /// Shows a scene that was prepared elsewhere, with [`Self::material_layout`].
    pub fn set_prepared(&mut self, scene: PreparedScene) {
        self.scene = scene;
        self.home = home::home(&self.scene);
        (self.settings, self.camera) = self.home;
        self.followed = self.settings.camera.file;
        (self.seconds, self.animation) = (0.0, 0);
        self.artefact = ArtefactShow::default();
        self.why = why::PixelQuestion::default();
        self.other = None;
        self.sample = None;
        self.side.scene_changed();
    }

    /// Goes on with another device, after the first one was lost: scene, pose, camera and settings stay as they are.
    ///
    /// # Errors
    ///
    /// [`StageError`] if the device has no memory for as much. The stage stays with the old one then.
    pub fn move_to(&mut self, gpu: Gpu) -> Result<(), StageError> {
        let side = self.side.anew(&gpu, self.samples)?;
        self.scene.move_to(&gpu, side.evaluator.renderer.material_layout())?;
        (self.gpu, self.side) = (gpu, side);
        self.side.cut(self.settings.view.freeze_fit);
        self.why = why::PixelQuestion::default();
        if let Some(show) = &mut self.sample {
            show.move_to(&self.gpu, self.samples);
        }
        if let Some(other) = self.other.take() {
            self.compare_with(Some(other.technique));
        }
        Ok(())
    }

    /// Layout of the scene's materials, for scenes that are prepared elsewhere.
    pub fn material_layout(&self) -> &wgpu::BindGroupLayout {
        self.side.evaluator.renderer.material_layout()
    }

    /// From now on, visible points are counted in depth buffers and not by rays: for pictures that follow each other in
    /// a window. Counts come a frame or two late, whenever the GPU is done, so pictures may differ from run to run.
    /// Static casters are kept in the shadow maps, too, and nothing waits for rays.
    pub fn read_depths(&mut self) {
        self.reads_depths = true;
        self.side.follow();
    }

    /// From now on, each picture waits for its rays: for pictures that are made one by one.
    pub fn wait_for_rays(&mut self) {
        self.side.live.waits = true;
    }

    /// Leaves the next pictures without verdicts where each picture [waits](Self::wait_for_rays) for its own: nothing
    /// shows them.
    pub(crate) fn set_unseen(&mut self, is_unseen: bool) {
        self.is_unseen = is_unseen;
    }

    /// The scene on show.
    pub fn scene(&self) -> &Scene {
        self.scene.scene()
    }

    /// The scene on show, prepared for drawing and judging.
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
        self.side.evaluator.renderer.target(&self.gpu, size)
    }

    /// Why the settings cannot be shown as they are, as a readable line.
    pub fn problem(&self) -> Option<&str> {
        if self.draws_sample() {
            return self.sample_message();
        }
        let other = self.other.as_ref().and_then(Other::problem);
        self.side.problem.as_deref().or(other)
    }

    /// Why the device has no compute shaders, if it has none.
    pub(crate) fn no_compute(&self) -> Option<&'static str> {
        let reason = "This takes compute shaders, which this browser draws without: it has WebGL2 and no WebGPU";
        (!self.gpu.can_compute()).then_some(reason)
    }

    /// The settings that the scene was opened with.
    pub fn home_settings(&self) -> Settings {
        self.home.0
    }

    /// Moves camera, sun and animation on by `seconds`.
    pub fn update(&mut self, input: &FlyInput, seconds: f32) {
        let input = self.steer_sample(input, seconds);
        if input.moves() {
            self.settings.camera.file = None;
        }
        self.camera.update(&mut self.settings.camera, &input, seconds);
        self.settings.light.advance(seconds);
        self.clock += seconds;
        if self.plays() {
            self.set_time(self.seconds + seconds);
        }
        self.follow_file();
    }

    /// Whether an animation moves the scene from frame to frame.
    fn plays(&self) -> bool {
        self.settings.view.play && self.animation < self.scene().animations.len()
    }

    /// Poses the scene at a time of its animation, in seconds, with the sun and camera of the file where they are followed.
    pub fn set_time(&mut self, seconds: f32) {
        self.seconds = seconds;
        self.scene.set_time(&self.gpu, self.animation, seconds);
        self.follow_file();
    }

    /// Time of the animation, in seconds.
    pub fn seconds(&self) -> f32 {
        self.seconds
    }

    /// How long the animation takes, in seconds; `None` without one.
    pub fn duration(&self) -> Option<f32> {
        self.scene().animations.get(self.animation).map(|animation| animation.duration)
    }

    /// Back to the settings and the view that the scene was opened with.
    pub fn reset(&mut self) {
        (self.settings, self.camera) = self.home;
        self.followed = self.settings.camera.file;
        self.artefact = ArtefactShow::default();
        self.side.fitted = None;
        if let Some(show) = &mut self.sample {
            show.reset();
        }
    }

    /// Puts the camera back to the view that the scene was opened with. Settings stay, except for the height of an
    /// orthographic picture, which flying changes. Where that view follows a camera of the file, it takes the whole lens.
    pub fn reset_camera(&mut self) {
        self.set_camera(self.sample_reset().unwrap_or(self.home.1));
        let (home, now) = (self.home.0.camera, &mut self.settings.camera);
        *now = match home.file {
            Some(_) => CameraSettings { speed: now.speed, ..home },
            None => CameraSettings { height: home.height, ..*now },
        };
        self.followed = home.file;
    }

    /// Levels the camera: takes its roll away. It follows no camera of the file any more.
    pub fn level_camera(&mut self) {
        self.camera.roll = 0.0;
        self.settings.camera.file = None;
    }

    /// Puts the camera somewhere else: the next view starts a new path, and follows no camera of the file.
    pub fn set_camera(&mut self, camera: FlyCamera) {
        self.camera = camera;
        self.settings.camera.file = None;
        let is_frozen = self.settings.view.freeze_fit;
        self.side.cut(is_frozen);
        if let Some(other) = &mut self.other {
            other.cut(is_frozen);
        }
    }

    /// Makes the present settings and view those to go back to, with the camera and the sun of the file that they name.
    pub fn set_home(&mut self) {
        self.follow_file();
        self.home = (self.settings, self.camera);
    }

    /// The camera with its lens, for a picture of the given size.
    pub fn camera_of(&self, size: [u32; 2]) -> Camera {
        self.camera.camera(&self.settings.camera, size[0] as f32 / size[1] as f32)
    }

    /// The present view as it is fitted and judged, for a picture of the given size.
    fn view(&self, size: [u32; 2]) -> View {
        View { camera: self.camera_of(size), direction: self.settings.light.direction(), is_first: false }
    }

    /// Views to tune a technique for: the present one, and those of a short flight from it, so that crawl is measured too.
    pub(crate) fn views_to_tune(&self, size: [u32; 2]) -> Vec<View> {
        let direction = self.settings.light.direction();
        let step = self.settings.camera.speed * TUNE_STEP;
        let views = (0..TUNE_VIEWS).map(|index| {
            let mut camera = self.camera;
            let along = camera.right() * 0.6 + camera.forward() * 0.4;
            camera.position += (along * (step * index as f32)).as_dvec3();
            camera.yaw += TUNE_TURN * index as f32;
            let camera = camera.camera(&self.settings.camera, size[0] as f32 / size[1] as f32);
            View { camera, direction, is_first: index == 0 }
        });
        views.collect()
    }

    /// The maps of the present view and settings; none where there is nothing to fit, with the
    /// reason as [`Self::problem`].
    pub fn maps(&mut self, size: [u32; 2]) -> Vec<FittedMap> {
        self.follow_casters();
        let (side, mut shot) = self.shot(size);
        side.fit(&mut shot).maps.to_vec()
    }

    /// Draws the present view into a target: the first technique up to the bar and the second one from there, where two
    /// are compared; a sample as its source does.
    pub fn draw(&mut self, target: &RenderTarget) {
        self.follow_casters();
        if self.sample.is_some() {
            self.side.forget_picture();
            self.draw_sample(target);
        } else {
            self.draw_side(target);
        }
    }

    fn draw_side(&mut self, target: &RenderTarget) {
        if self.reads_depths {
            // Results that fits and figures use when they have arrived.
            self.scene.take_rays();
            self.scene.request_rays();
        }
        let split = self.other.is_some().then(|| compare::left_part(self.split, target.size));
        let (side, mut shot) = self.shot(target.size);
        shot.scissor = split;
        side.draw(&mut shot, target);
        self.draw_other(target);
        // Both techniques know the size of the whole picture.
        self.side.read_picture(&self.gpu, target);
        if let Some(other) = &mut self.other {
            other.read_picture(&self.gpu, target);
        }
    }

    /// Lets blended surfaces cast as the settings say. What the frames before found out is forgotten if that changes.
    fn follow_casters(&mut self) {
        let casts = self.settings.view.blended_cast;
        let blended = if casts { BlendedCasters::WhereOpaque } else { BlendedCasters::Never };
        if self.scene().blended_casters == blended {
            return;
        }
        let layout = self.side.evaluator.renderer.material_layout();
        if let Err(error) = self.scene.set_blended_casters(&self.gpu, layout, blended) {
            self.settings.view.blended_cast = !casts;
            self.side.problem = Some(error.to_string());
            return;
        }
        self.side.scene_changed();
        self.why = why::PixelQuestion::default();
        if let Some(other) = self.other.take() {
            self.compare_with(Some(other.technique));
        }
    }

    /// Draws the camera, the maps and their casters from outside, whatever the view is.
    pub fn draw_beside(&mut self, target: &RenderTarget) {
        let (side, mut shot) = self.shot(target.size);
        let Some(fitted) = side.fitted.clone() else { return };
        side.forget_picture();
        let statistics = side.statistics;
        side.draw_outside(&mut shot, &fitted, true, target);
        side.statistics = statistics;
    }

    /// The first side, and the shot that it draws into a picture of a size.
    fn shot(&mut self, size: [u32; 2]) -> (&mut Side, Shot<'_>) {
        self.follow_file();
        let camera = self.camera_of(size);
        let (plays, blink) = (self.plays(), self.blink());
        let shot = Shot {
            gpu: &self.gpu,
            scene: &mut self.scene,
            settings: &self.settings,
            camera,
            // The distance of the scene's first view, so that no demonstration changes the haze.
            sight: self.home.0.camera.far,
            plays,
            seconds: self.seconds,
            scissor: None,
            clock: self.clock,
            blink,
            is_unseen: self.is_unseen,
        };
        (&mut self.side, shot)
    }

    /// Strength of blinking marks at present, 0..=1.
    fn blink(&self) -> f32 {
        0.5 - 0.5 * (self.clock * BLINKS * core::f32::consts::TAU).cos()
    }
}
