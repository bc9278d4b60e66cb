//! The stage: everything that the viewer draws, without a window: scene, camera, settings, animation,
//! artefact, and one or two techniques.

pub(crate) mod artefact;
mod boards;
mod compare;
mod demand_view;
mod figures;
mod fitted;
mod flip;
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

/// Reason why a stage could not be set up.
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
    /// All settings that the panel edits. The technique belongs to the first side.
    pub settings: Settings,
    /// The camera.
    pub camera: FlyCamera,
    /// Index of the animation to play, if the scene has it.
    pub animation: usize,
    /// Position of the bar between two techniques, as a share of the picture's width.
    pub split: f32,
    gpu: Gpu,
    samples: u32,
    scene: PreparedScene,
    side: Side,
    other: Option<Other>,
    seconds: f32,
    /// Seconds since the stage was set up: the clock for blinking marks, the resting pointer and the age of
    /// figures.
    clock: f32,
    home: (Settings, FlyCamera),
    artefact: ArtefactShow,
    why: why::PixelQuestion,
    reads_depths: bool,
    /// Whether the verdicts of the next pictures are not shown.
    is_unseen: bool,
    sample: Option<SampleShow>,
    /// Number of the file's camera whose lens is already in the settings.
    followed: Option<u32>,
}

/// Number of views for auto-tune.
const TUNE_VIEWS: u32 = 4;
/// Flight from one of these views to the next, in seconds at the camera's speed.
const TUNE_STEP: f32 = 0.02;
/// Turn from one of these views to the next, in radians.
const TUNE_TURN: f32 = 0.004;

/// Blinks of marks per second.
const BLINKS: f32 = 1.2;

impl Stage {
    /// Sets up a scene with settings that suit its size, viewed by its own camera or from a position that
    /// shows all of it. Pictures get `samples` per pixel (1 or 4).
    ///
    /// # Errors
    ///
    /// [`StageError`] if the scene is empty or the shadow map cannot be made.
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

    /// Makes a stage with a placeholder scene, until [`Self::set_prepared`] sets one.
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

    /// Shows a scene that was prepared elsewhere with [`Self::material_layout`].
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

    /// Continues with another device after the first one was lost. Scene, pose, camera and settings stay.
    ///
    /// # Errors
    ///
    /// [`StageError`] if the new device has too little memory. The stage keeps the old device then.
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

    /// Returns the layout of the scene's materials, for scenes that are prepared elsewhere.
    pub fn material_layout(&self) -> &wgpu::BindGroupLayout {
        self.side.evaluator.renderer.material_layout()
    }

    /// Counts visible points in depth buffers instead of by rays from now on, for consecutive pictures in a
    /// window. Counts arrive a frame or two late, as soon as the GPU is done, so pictures may differ from run
    /// to run. Static casters are kept in the shadow maps, too, and nothing waits for rays.
    pub fn read_depths(&mut self) {
        self.reads_depths = true;
        self.side.follow();
    }

    /// Makes each picture wait for its rays from now on, for pictures that are made one by one.
    pub fn wait_for_rays(&mut self) {
        self.side.live.waits = true;
    }

    /// Skips the verdicts of the next pictures, which are not shown, if each picture
    /// [waits](Self::wait_for_rays) for its own.
    pub(crate) fn set_unseen(&mut self, is_unseen: bool) {
        self.is_unseen = is_unseen;
    }

    /// Returns the current scene.
    pub fn scene(&self) -> &Scene {
        self.scene.scene()
    }

    /// Returns the current scene, prepared for drawing and judging.
    pub fn prepared_scene(&self) -> &PreparedScene {
        &self.scene
    }

    /// Returns the world bounds of the scene in its current pose, in metres.
    pub fn bounds(&self) -> Aabb {
        self.scene.bounds()
    }

    /// Returns the GPU that draws.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Makes a target of the given width and height, in pixels, for this stage.
    pub fn target(&self, size: [u32; 2]) -> RenderTarget {
        self.side.evaluator.renderer.target(&self.gpu, size)
    }

    /// Returns why the settings cannot be shown unchanged, as a readable line.
    pub fn problem(&self) -> Option<&str> {
        if self.draws_sample() {
            return self.sample_message();
        }
        let other = self.other.as_ref().and_then(Other::problem);
        self.side.problem.as_deref().or(other)
    }

    /// Returns why the device has no compute shaders, if it has none.
    pub(crate) fn no_compute(&self) -> Option<&'static str> {
        let reason = "This needs compute shaders, which this browser lacks: it has WebGL2 and no WebGPU";
        (!self.gpu.can_compute()).then_some(reason)
    }

    /// Returns the initial settings of the scene.
    pub fn home_settings(&self) -> Settings {
        self.home.0
    }

    /// Moves camera, sun and animation by `seconds`.
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

    /// Returns whether an animation moves the scene from frame to frame.
    fn plays(&self) -> bool {
        self.settings.view.play && self.animation < self.scene().animations.len()
    }

    /// Poses the scene at a time of its animation, in seconds, with the followed sun and camera of the file.
    pub fn set_time(&mut self, seconds: f32) {
        self.seconds = seconds;
        self.scene.set_time(&self.gpu, self.animation, seconds);
        self.follow_file();
    }

    /// Returns the time of the animation, in seconds.
    pub fn seconds(&self) -> f32 {
        self.seconds
    }

    /// Returns the duration of the animation, in seconds; `None` without one.
    pub fn duration(&self) -> Option<f32> {
        self.scene().animations.get(self.animation).map(|animation| animation.duration)
    }

    /// Restores the initial settings and view of the scene.
    pub fn reset(&mut self) {
        (self.settings, self.camera) = self.home;
        self.followed = self.settings.camera.file;
        self.artefact = ArtefactShow::default();
        self.side.fitted = None;
        if let Some(show) = &mut self.sample {
            show.reset();
        }
    }

    /// Restores the initial view of the scene. Settings stay, except for the height of an orthographic
    /// picture, which flying changes. If that view follows a camera of the file, its whole lens is restored.
    pub fn reset_camera(&mut self) {
        self.set_camera(self.sample_reset().unwrap_or(self.home.1));
        let (home, now) = (self.home.0.camera, &mut self.settings.camera);
        *now = match home.file {
            Some(_) => CameraSettings { speed: now.speed, ..home },
            None => CameraSettings { height: home.height, ..*now },
        };
        self.followed = home.file;
    }

    /// Removes the camera's roll, and stops following a camera of the file.
    pub fn level_camera(&mut self) {
        self.camera.roll = 0.0;
        self.settings.camera.file = None;
    }

    /// Moves the camera elsewhere. The next view starts a new path, and follows no camera of the file.
    pub fn set_camera(&mut self, camera: FlyCamera) {
        self.camera = camera;
        self.settings.camera.file = None;
        let is_frozen = self.settings.view.freeze_fit;
        self.side.cut(is_frozen);
        if let Some(other) = &mut self.other {
            other.cut(is_frozen);
        }
    }

    /// Makes the current settings and view the initial ones, with the camera and the sun of the file that
    /// they name.
    pub fn set_home(&mut self) {
        self.follow_file();
        self.home = (self.settings, self.camera);
    }

    /// Returns the camera with its lens, for a picture of the given size.
    pub fn camera_of(&self, size: [u32; 2]) -> Camera {
        self.camera.camera(&self.settings.camera, size[0] as f32 / size[1] as f32)
    }

    /// Returns the current view for fitting and judging, for a picture of the given size.
    fn view(&self, size: [u32; 2]) -> View {
        View { camera: self.camera_of(size), direction: self.settings.light.direction(), is_first: false }
    }

    /// Returns the views for which a technique is tuned: the current one, and those of a short flight from
    /// it, so that crawl is measured too.
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

    /// Returns the maps of the current view and settings. If fitting fails there are none, and
    /// [`Self::problem`] gives the reason.
    pub fn maps(&mut self, size: [u32; 2]) -> Vec<FittedMap> {
        self.follow_casters();
        let (side, mut shot) = self.shot(size);
        side.fit(&mut shot).maps.to_vec()
    }

    /// Draws the current view into a target. In a comparison, the first technique is drawn up to the bar and
    /// the second one after it. A sample is drawn as in its source.
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
            // Results for fits and figures, used when they arrive.
            self.scene.take_rays();
            self.scene.request_rays();
        }
        let split = self.other.is_some().then(|| compare::left_part(self.split, target.size));
        let (side, mut shot) = self.shot(target.size);
        shot.scissor = split;
        side.draw(&mut shot, target);
        self.draw_other(target);
        // Both techniques use the size of the whole picture.
        self.side.read_picture(&self.gpu, target);
        if let Some(other) = &mut self.other {
            other.read_picture(&self.gpu, target);
        }
    }

    /// Applies the setting for blended surfaces as casters. If it changes, results of earlier frames are
    /// discarded.
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

    /// Draws the camera, the maps and their casters from outside, in any view mode.
    pub fn draw_beside(&mut self, target: &RenderTarget) {
        let (side, mut shot) = self.shot(target.size);
        let Some(fitted) = side.fitted.clone() else { return };
        side.forget_picture();
        let statistics = side.statistics;
        side.draw_outside(&mut shot, &fitted, true, target);
        side.statistics = statistics;
    }

    /// Returns the first side, and its shot for a picture of a size.
    fn shot(&mut self, size: [u32; 2]) -> (&mut Side, Shot<'_>) {
        self.follow_file();
        let camera = self.camera_of(size);
        let (plays, blink) = (self.plays(), self.blink());
        let shot = Shot {
            gpu: &self.gpu,
            scene: &mut self.scene,
            settings: &self.settings,
            camera,
            // The distance of the initial view, so that no demonstration changes the haze.
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

    /// Returns the current strength of blinking marks, 0..=1.
    fn blink(&self) -> f32 {
        0.5 - 0.5 * (self.clock * BLINKS * core::f32::consts::TAU).cos()
    }
}
