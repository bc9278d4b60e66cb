//! What the viewer shows, without a window: scene, camera, settings, animation, artefact, renderer.

mod judge;

use core::fmt;

use glam::{DVec3, Mat4, Vec3};
use shadowfit::figures::Figures;
use shadowfit::settings::{CasterPolicy, FitSettings, LightSettings, Settings};
use shadowfit::{Bias, DepthConvention, FitError, LightFit, PerspectiveCamera, ViewFrustum, diagnostics};
use shadowfit_egui::Artefact;
use shadowfit_render::{
    Atmosphere, FlyCamera, FlyInput, Frame, Gpu, GpuScene, Inset, Line, RenderTarget, Renderer, Statistics,
};
use shadowfit_scene::{Aabb, Lens, Pose, Scene};
use shadowfit_wgpu::{MapFit, ShadowMapDescriptor, ShadowMapError};

use crate::boxes::SceneBoxes;
use crate::rays::SceneRays;
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
    NothingToDraw(String),
    /// The shadow map could not be made.
    ShadowMap(ShadowMapError),
}

impl fmt::Display for StageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NothingToDraw(name) => write!(f, "{name}: the scene has no triangles, so there is nothing to show"),
            Self::ShadowMap(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for StageError {}

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
    renderer: Renderer,
    scene: Scene,
    gpu_scene: GpuScene,
    pose: Pose,
    seconds: f32,
    bounds: Aabb,
    boxes: SceneBoxes,
    triangles: u64,
    home: (Settings, FlyCamera),
    before_artefact: Option<(Settings, FlyCamera)>,
    shown: Option<Shown>,
    frozen: Option<Fitted>,
    problem: Option<String>,
    notice: Option<&'static str>,
    rays: Option<SceneRays>,
    statistics: Statistics,
}

/// The part of the view that is shadowed, and the maps fitted to it.
#[derive(Clone, Debug, Default)]
struct Fitted {
    frustum: Option<ViewFrustum>,
    fits: Vec<LightFit>,
}

impl Stage {
    /// Sets up a scene with settings that suit its size, seen by its own camera or from a place
    /// that shows all of it. Pictures get `samples` per pixel (1 or 4).
    ///
    /// # Errors
    ///
    /// [`StageError`] if the scene is empty or the shadow map impossible.
    pub fn new(gpu: Gpu, scene: Scene, samples: u32) -> Result<Self, StageError> {
        let settings = Settings::default();
        let renderer = Renderer::new(&gpu, &map_descriptor(&settings), samples).map_err(StageError::ShadowMap)?;
        let loaded = Loaded::new(&gpu, &renderer, scene)?;
        Ok(Self {
            settings: loaded.home.0,
            camera: loaded.home.1,
            animation: 0,
            gpu,
            renderer,
            scene: loaded.scene,
            gpu_scene: loaded.gpu_scene,
            pose: loaded.pose,
            seconds: 0.0,
            bounds: loaded.bounds,
            boxes: loaded.boxes,
            triangles: loaded.triangles,
            home: loaded.home,
            before_artefact: None,
            shown: None,
            frozen: None,
            problem: None,
            notice: None,
            rays: None,
            statistics: Statistics::default(),
        })
    }

    /// Shows another scene. On an error the old one stays.
    ///
    /// # Errors
    ///
    /// [`StageError`] if the scene is empty.
    pub fn set_scene(&mut self, scene: Scene) -> Result<(), StageError> {
        let loaded = Loaded::new(&self.gpu, &self.renderer, scene)?;
        (self.settings, self.camera) = loaded.home;
        self.home = loaded.home;
        self.scene = loaded.scene;
        self.gpu_scene = loaded.gpu_scene;
        self.pose = loaded.pose;
        self.bounds = loaded.bounds;
        self.boxes = loaded.boxes;
        self.triangles = loaded.triangles;
        (self.seconds, self.rays, self.shown, self.before_artefact, self.frozen) = (0.0, None, None, None, None);
        self.notice = None;
        Ok(())
    }

    /// The scene on show.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Number of the scene's triangles, every instance counted.
    pub fn triangles(&self) -> u64 {
        self.triangles
    }

    /// World bounds of the scene in its present pose, in metres.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The GPU that draws.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// A picture that this stage can draw into.
    pub fn picture(&self, size: [u32; 2]) -> RenderTarget {
        self.renderer.target(&self.gpu, size)
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
        if self.settings.view.play && self.animation < self.scene.animations.len() {
            self.set_time(self.seconds + seconds);
        }
    }

    /// Poses the scene at a time of its animation, in seconds.
    pub fn set_time(&mut self, seconds: f32) {
        self.seconds = seconds;
        let animation = (self.animation < self.scene.animations.len()).then_some(self.animation);
        self.pose = self.scene.pose(animation, seconds);
        self.gpu_scene.set_pose(&self.gpu, &self.scene, &self.pose);
        self.bounds = self.gpu_scene.bounds().unwrap_or(self.bounds);
        self.boxes.set_pose(|index| self.gpu_scene.instance_bounds(index));
        self.rays = None;
    }

    /// Back to the settings and the view that the scene was opened with.
    pub fn reset(&mut self) {
        (self.settings, self.camera) = self.home;
        (self.shown, self.before_artefact, self.frozen, self.notice) = (None, None, None, None);
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
        self.frozen = None;
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

    /// Bounds that the eye should be on: the scene's subject, or all of it. World space, metres.
    pub fn subject_bounds(&self) -> Aabb {
        self.scene.subject.and_then(|subject| self.scene.node_bounds(&self.pose, subject)).unwrap_or(self.bounds)
    }

    /// The casters in their present pose, for rays.
    pub fn rays(&mut self) -> &SceneRays {
        self.rays.get_or_insert_with(|| SceneRays::new(&self.scene, &self.pose))
    }

    /// The fits of the present view and settings, nearest map first; empty where there is nothing
    /// to fit, with the reason as [`Self::problem`].
    pub fn fits(&mut self, size: [u32; 2]) -> Vec<LightFit> {
        self.update_shadow_map();
        self.fitted(size).fits
    }

    fn fitted(&mut self, size: [u32; 2]) -> Fitted {
        let map = self.renderer.shadow_map().descriptor();
        let suits = |fit: &LightFit| fit.resolution.to_array() == map.resolution && fit.depth == map.depth;
        if self.settings.view.freeze_fit
            && let Some(frozen) = &self.frozen
            && frozen.fits.iter().all(suits)
        {
            return frozen.clone();
        }
        let fitted = match self.fit_now(size) {
            Ok(fitted) => fitted,
            Err(error) => {
                self.problem = Some(format!("no shadow map: {error}"));
                Fitted::default()
            }
        };
        self.frozen = Some(fitted.clone());
        fitted
    }

    fn fit_now(&mut self, size: [u32; 2]) -> Result<Fitted, FitError> {
        let frustum = self.perspective(size).frustum()?;
        // The map as it is, should the one that the settings ask for not be possible.
        let map = self.renderer.shadow_map().descriptor();
        let casters = match self.settings.fit.casters {
            CasterPolicy::DepthClamp if !map.depth_clamp => CasterPolicy::List,
            casters => casters,
        };
        let fit_settings =
            FitSettings { resolution: map.resolution.into(), depth: map.depth, casters, ..self.settings.fit };
        let fit = self.boxes.fit(&frustum, self.settings.light.direction(), &fit_settings)?;
        let camera = &self.settings.camera;
        let shadowed = frustum.slice(camera.near, camera.far.min(fit_settings.max_distance)).ok();
        Ok(Fitted { frustum: shadowed, fits: vec![fit] })
    }

    /// Draws the present view into a picture.
    pub fn draw(&mut self, picture: &RenderTarget) {
        self.problem = None;
        self.update_shadow_map();
        let fitted = self.fitted(picture.size);
        let inner = self.perspective(picture.size);
        let (camera, lines) = if self.settings.view.outside {
            (
                outside::camera(&inner, fitted.frustum.as_ref(), &fitted.fits),
                outside::lines(fitted.frustum.as_ref(), &fitted.fits),
            )
        } else {
            (inner, Vec::new())
        };
        let inset = fitted.fits.first().filter(|_| self.settings.view.inset).map(|fit| self.inset(fit, picture.size));
        let atmosphere = self.atmosphere(&camera);
        let maps = map_fits(&fitted.fits, &self.settings);
        let frame = frame(&self.settings, &camera, &maps, &atmosphere, &lines, inset);
        match self.renderer.draw(&self.gpu, &mut self.gpu_scene, &frame, picture) {
            Ok(statistics) => self.statistics = statistics,
            Err(error) => self.problem = Some(error.to_string()),
        }
    }

    /// Haze suits the size of what is seen, so that a chair is not lost in it nor a town without.
    fn atmosphere(&self, camera: &PerspectiveCamera) -> Atmosphere {
        let atmosphere = Atmosphere::default();
        let visible = self.home.0.camera.far.max(1e-3);
        let outside = if self.settings.view.outside { visible / camera.far.max(visible) } else { 1.0 };
        let haze_per_metre = atmosphere.haze_per_metre * (Settings::default().camera.far / visible) * outside;
        Atmosphere { haze_per_metre, ..atmosphere }
    }

    /// Makes the shadow map that the settings ask for; the old one stays where that is impossible.
    fn update_shadow_map(&mut self) {
        if self.settings.fit.depth == DepthConvention::NegativeOneToOne {
            self.problem = Some("depth -1 to 1 is OpenGL's: wgpu draws the map with 0 to 1 instead".to_owned());
        }
        let mut descriptor = map_descriptor(&self.settings);
        if descriptor.depth_clamp && !self.gpu.has_depth_clamp() {
            descriptor.depth_clamp = false;
            self.problem = Some(NO_DEPTH_CLAMP.to_owned());
        }
        if let Err(error) = self.renderer.set_shadow_map(&self.gpu, &descriptor) {
            self.problem = Some(error.to_string());
        }
    }

    /// The shadow map in the lower left corner, with the depths of the scene stretched to grey.
    fn inset(&self, fit: &LightFit, size: [u32; 2]) -> Inset {
        let scale = (size[0] as f32 / FULL_INSET_WIDTH).min(1.0);
        let [width, height] = INSET_SIZE.map(|side| (side * scale).round());
        let margin = (INSET_MARGIN * scale).round();
        let depths = corners(&self.bounds).map(|corner| {
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

    /// The live figures of the last frame, for a picture of the given size.
    pub fn figures(&mut self, size: [u32; 2]) -> Figures {
        let (statistics, times) = (self.statistics, self.renderer.pass_times());
        let mut figures = Figures {
            shadow_pass_ms: times.shadow_ms,
            scene_pass_ms: times.scene_ms,
            shadow_draws: Some(statistics.shadow_draws),
            shadow_triangles: Some(statistics.shadow_triangles),
            ..Figures::default()
        };
        if let Some(fit) = self.fitted(size).fits.first() {
            figures.set_by = Some(fit.set_by);
            figures.is_empty = Some(fit.is_empty);
            figures.texel_size = Some(fit.texel_size.to_array());
            figures.depth_range = Some(fit.depth_range);
            figures.depth_step = Some(diagnostics::depth_step(self.settings.format, fit.depth_range));
            figures.pixels_per_texel = self.pixels_per_texel_ahead(fit, size);
        }
        figures
    }

    /// Pixels per texel where the middle of the picture meets the scene.
    fn pixels_per_texel_ahead(&mut self, fit: &LightFit, size: [u32; 2]) -> Option<f32> {
        // A scene that moves would need new rays each frame; its figure is left open.
        if self.rays.is_none() && self.settings.view.play && !self.scene.animations.is_empty() {
            return None;
        }
        let camera = self.perspective(size);
        let rays = self.rays();
        let hit = rays.tracer.first_hit(camera.eye.as_vec3(), camera.forward)?;
        let normal = rays.tracer.normal(hit.triangle);
        pixels_per_texel(fit, &camera, size, camera.forward * hit.distance, normal)
    }
}

/// Pixels per texel along the worse axis at a point relative to the eye.
fn pixels_per_texel(
    fit: &LightFit,
    camera: &PerspectiveCamera,
    size: [u32; 2],
    point: Vec3,
    normal: Vec3,
) -> Option<f32> {
    let clip = camera.clip_from_world(DepthConvention::Reversed);
    let fit = fit.relative_to(camera.eye);
    let figures = diagnostics::pixels_per_texel(&fit, &clip, size.into(), point, normal).ok()??;
    Some(figures.worse_axis)
}

fn frame<'a>(
    settings: &'a Settings,
    camera: &'a PerspectiveCamera,
    maps: &'a [MapFit],
    atmosphere: &'a Atmosphere,
    lines: &'a [Line],
    inset: Option<Inset>,
) -> Frame<'a> {
    let frame = Frame::new(camera, settings.light.direction(), maps, atmosphere);
    Frame { shadows: settings.view.shadows, lines, inset, ..frame }
}

fn map_fits(fits: &[LightFit], settings: &Settings) -> Vec<MapFit> {
    fits.iter().map(|fit| MapFit::new(*fit, Bias::from_texels(&settings.bias, fit))).collect()
}

/// The map that the settings ask for, with depths that wgpu can draw: it has no -1..1.
fn map_descriptor(settings: &Settings) -> ShadowMapDescriptor {
    let mut descriptor = ShadowMapDescriptor::from(settings);
    if descriptor.depth == DepthConvention::NegativeOneToOne {
        descriptor.depth = DepthConvention::ZeroToOne;
    }
    descriptor
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

/// A scene made ready: uploaded, posed, with the settings and the view that suit it.
struct Loaded {
    scene: Scene,
    gpu_scene: GpuScene,
    pose: Pose,
    bounds: Aabb,
    boxes: SceneBoxes,
    triangles: u64,
    home: (Settings, FlyCamera),
}

impl Loaded {
    fn new(gpu: &Gpu, renderer: &Renderer, scene: Scene) -> Result<Self, StageError> {
        let pose = scene.pose(None, 0.0);
        let Some(bounds) = scene.bounds(&pose) else {
            return Err(StageError::NothingToDraw(scene.name));
        };
        let gpu_scene = GpuScene::new(gpu, renderer.material_layout(), &scene, &pose);
        let mut boxes = SceneBoxes::new(&scene, &pose);
        boxes.set_pose(|index| gpu_scene.instance_bounds(index));
        let home = home(&scene, &pose, &bounds);
        let triangles = scene
            .instances()
            .iter()
            .map(|instance| scene.meshes[instance.mesh].primitives[instance.primitive].indices.len() as u64 / 3)
            .sum();
        Ok(Self { scene, gpu_scene, pose, bounds, boxes, triangles, home })
    }
}

/// Settings and view for a scene: its own camera and sun where it has them.
fn home(scene: &Scene, pose: &Pose, bounds: &Aabb) -> (Settings, FlyCamera) {
    let mut settings = Settings::default();
    if let Some(light) = scene.sun.and_then(|sun| LightSettings::from_direction(sun.direction).ok()) {
        settings.light = LightSettings { azimuth: light.azimuth, elevation: light.elevation, ..settings.light };
    }
    let radius = ((bounds.max - bounds.min).length() * 0.5).max(1e-3);
    if scene.subject.is_none() {
        // A scene of unknown units: everything follows from its size.
        settings.fit.max_distance = radius * 4.0;
        settings.fit.caster_extension = radius * 2.0;
        settings.camera.near = radius * 0.005;
        settings.camera.far = radius * 20.0;
        settings.camera.speed = radius * 0.4;
    }
    let camera = own_camera(scene, pose, &mut settings).unwrap_or_else(|| overview(bounds, radius, &settings));
    (settings, camera)
}

/// The scene's first perspective camera.
fn own_camera(scene: &Scene, pose: &Pose, settings: &mut Settings) -> Option<FlyCamera> {
    scene.cameras.iter().find_map(|camera| {
        let Lens::Perspective { fov_y, near, far } = camera.lens else { return None };
        let world: &Mat4 = pose.world_from_node.get(camera.node)?;
        let eye = world.w_axis.truncate();
        let forward = -world.z_axis.truncate();
        if !eye.is_finite() || !forward.is_finite() || forward == Vec3::ZERO {
            return None;
        }
        settings.camera.fov_y = fov_y.clamp(0.1, 2.5);
        if near > 0.0 && near < settings.camera.far {
            settings.camera.near = near;
        }
        if let Some(far) = far.filter(|far| *far > settings.camera.near * 2.0) {
            settings.camera.far = far;
        }
        let mut fly = FlyCamera { position: eye.as_dvec3(), yaw: 0.0, pitch: 0.0 };
        fly.look_along(forward);
        Some(fly)
    })
}

/// A view of everything, from a little above and on the lit side.
fn overview(bounds: &Aabb, radius: f32, settings: &Settings) -> FlyCamera {
    let center = (bounds.min + bounds.max) * 0.5;
    let to_light = -settings.light.direction();
    let level = Vec3::new(to_light.x, 0.0, to_light.z).normalize_or(Vec3::Z);
    let side = level.cross(Vec3::Y);
    let away = (level * 0.75 + side * 0.65 + Vec3::Y * 0.5).normalize();
    let distance = radius / (settings.camera.fov_y * 0.5).sin() * 0.75;
    let eye: DVec3 = (center + away * distance).as_dvec3();
    FlyCamera::look_at(eye, center.as_dvec3())
}
