//! What draws one technique's shadows and has them judged, frame by frame along a path.

use anyhow::{Context, Result};
use glam::{DMat4, DVec2, DVec3, Vec3};
use shadowfit::{CascadeFitter, PerspectiveCamera, SplitScheme, Workspace, bias};
use shadowfit_render::{Atmosphere, Frame, Gpu, ProbePixel, ProbeTargets, RenderTarget, Renderer};
use shadowfit_truth::gpu::GpuPixel;
use shadowfit_truth::peers::{FitMap, ShadowMap};
use shadowfit_truth::{Judged, MapsBefore, MapsSeen, PixelCamera, Truth, TruthSettings, crawl, judge};
use shadowfit_wgpu::{MapFit, ShadowMapDescriptor};

use crate::study::live::{LiveInput, LiveTruth};
use crate::study::{SeenDepths, Subject, Technique};

/// Stands for no end of a map's view depths.
const NO_END: f64 = 1e9;

/// A camera and a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shot {
    /// Eye and lens.
    pub camera: PerspectiveCamera,
    /// Unit direction of travel of the light, world axes.
    pub direction: Vec3,
    /// Whether a path begins here, so that nothing before it counts.
    pub is_first: bool,
}

/// The truth of a frame, for all contenders: traced when the first of them has said which triangles are seen.
#[derive(Debug, Default)]
pub struct SharedTruth(Option<Truth>);

impl SharedTruth {
    /// The truth, once a contender has been judged.
    pub fn get(&self) -> Option<&Truth> {
        self.0.as_ref()
    }
}

/// How pictures are judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judging {
    /// Width and height, in pixels.
    pub size: [u32; 2],
    /// Start of shadow rays over the surface, in metres.
    pub ray_offset: f64,
    /// Angular radius of the sun, in radians; 0 for hard shadows.
    pub sun_radius: f64,
    /// Rays to a sun that is no point.
    pub sun_rays: u32,
    /// Whether crawl is measured, which draws each frame once more.
    pub crawl: bool,
}

impl Default for Judging {
    fn default() -> Self {
        Self { size: [1280, 720], ray_offset: 1e-3, sun_radius: 0.0, sun_rays: 64, crawl: true }
    }
}

/// Maps of the frame before.
#[derive(Debug)]
struct Before {
    maps: Vec<MapFit>,
    eye: DVec3,
    forward: Vec3,
}

/// One of several that are compared: a renderer with its own shadow map.
#[derive(Debug)]
pub struct Contender {
    renderer: Renderer,
    judging: Judging,
    targets: ProbeTargets,
    picture: Option<RenderTarget>,
    before: Option<Before>,
}

impl Contender {
    /// A contender whose maps are made of `descriptor`.
    ///
    /// # Errors
    ///
    /// When the shadow map cannot be made.
    pub fn new(gpu: &Gpu, descriptor: &ShadowMapDescriptor, judging: Judging) -> Result<Self> {
        let renderer = Renderer::new(gpu, descriptor, 1)?;
        let targets = ProbeTargets::new(&gpu.device, judging.size);
        Ok(Self { renderer, judging, targets, picture: None, before: None })
    }

    /// Layout of the scenes' materials, for [`Subject::new`].
    pub fn material_layout(&self) -> &wgpu::BindGroupLayout {
        self.renderer.material_layout()
    }

    /// Draws the maps of a frame (in order of their `far`) and judges the shadows that they give.
    ///
    /// # Errors
    ///
    /// When a map does not suit the shadow map, or the device cannot tell triangles apart.
    pub fn judge(
        &mut self,
        gpu: &Gpu,
        subject: &mut Subject,
        shot: &Shot,
        maps: &[MapFit],
        truth: &mut SharedTruth,
    ) -> Result<Judged> {
        if shot.is_first {
            self.before = None;
        }
        let pixels = self.probe(gpu, subject, shot, maps, None)?;
        let truth = truth.0.get_or_insert_with(|| trace(subject, shot, &self.judging, &pixels));
        let factors = factors(&pixels);
        let measured = measured(maps, shot.direction, subject.rays.origin);
        let mut judged = judge(&subject.rays.tracer, truth, &self.seen(&measured), &factors, |_| true);
        let (forward, origin) = (shot.camera.forward.normalize(), subject.rays.origin);
        if let Some(before) = self.before.take().filter(|_| self.judging.crawl) {
            let pixels = self.probe(gpu, subject, shot, &before.maps, Some((before.eye, before.forward)))?;
            let factors_before = self::factors(&pixels);
            let before = MapsBefore {
                maps: &self::measured(&before.maps, shot.direction, origin),
                eye: before.eye - origin,
                forward: before.forward.as_dvec3(),
                factors: &factors_before,
            };
            let (different, compared) = crawl(truth, &judged, &factors, &before);
            judged.tally.add_crawl((different, compared));
        }
        self.before = Some(Before { maps: maps.to_vec(), eye: shot.camera.eye, forward });
        Ok(judged)
    }

    /// The shaded picture of a frame: sRGB pixels, four bytes each, rows from the top.
    ///
    /// # Errors
    ///
    /// When a map does not suit the shadow map.
    pub fn picture(&mut self, gpu: &Gpu, subject: &mut Subject, shot: &Shot, maps: &[MapFit]) -> Result<Vec<u8>> {
        let picture = self.picture.take().unwrap_or_else(|| self.renderer.target(gpu, self.judging.size));
        let atmosphere = atmosphere(&shot.camera);
        let frame = frame(shot, maps, &atmosphere, None);
        let drawn = self.renderer.draw(gpu, &mut subject.gpu_scene, &frame, &picture);
        let pixels = picture.read(gpu);
        self.picture = Some(picture);
        drawn?;
        Ok(pixels?)
    }

    /// Draws a frame and judges it on the GPU.
    ///
    /// # Errors
    ///
    /// As for [`Self::judge`], and when the sun is no point.
    pub fn judge_live(
        &mut self,
        gpu: &Gpu,
        subject: &mut Subject,
        shot: &Shot,
        maps: &[MapFit],
        live: &mut LiveTruth,
    ) -> Result<Vec<GpuPixel>> {
        self.with_live_input(gpu, subject, shot, maps, |input| live.judge(gpu, input))
    }

    /// Mean time of judging a frame on the GPU, drawing aside, in milliseconds.
    ///
    /// # Errors
    ///
    /// As for [`Self::judge_live`].
    pub fn time_live(
        &mut self,
        gpu: &Gpu,
        subject: &mut Subject,
        shot: &Shot,
        maps: &[MapFit],
        (live, repeats): (&mut LiveTruth, u32),
    ) -> Result<f64> {
        self.with_live_input(gpu, subject, shot, maps, |input| live.time(gpu, input, repeats))
    }

    fn with_live_input<T>(
        &mut self,
        gpu: &Gpu,
        subject: &mut Subject,
        shot: &Shot,
        maps: &[MapFit],
        judge: impl FnOnce(&LiveInput<'_>) -> Result<T>,
    ) -> Result<T> {
        let atmosphere = Atmosphere::default();
        let frame = frame(shot, maps, &atmosphere, None);
        self.renderer.draw_probe(gpu, &mut subject.gpu_scene, &frame, &self.targets)?;
        let measured = measured(maps, shot.direction, subject.rays.origin);
        judge(&LiveInput {
            camera: PixelCamera::new(&subject.camera_for_rays(&shot.camera), self.judging.size),
            settings: truth_settings(shot, &self.judging),
            maps: self.seen(&measured),
            seen: &self.targets.view,
        })
    }

    fn seen<'a>(&self, maps: &'a [ShadowMap]) -> MapsSeen<'a> {
        maps_seen(maps, self.renderer.shadow_map().descriptor())
    }

    fn probe(
        &mut self,
        gpu: &Gpu,
        subject: &mut Subject,
        shot: &Shot,
        maps: &[MapFit],
        choice: Option<(DVec3, Vec3)>,
    ) -> Result<Vec<Option<ProbePixel>>> {
        let atmosphere = Atmosphere::default();
        let frame = frame(shot, maps, &atmosphere, choice);
        Ok(self.renderer.probe(gpu, &mut subject.gpu_scene, &frame, &self.targets)?.pixels)
    }
}

fn frame<'a>(
    shot: &'a Shot,
    maps: &'a [MapFit],
    atmosphere: &'a Atmosphere,
    choice: Option<(DVec3, Vec3)>,
) -> Frame<'a> {
    Frame { choice, ..Frame::new(&shot.camera, shot.direction, maps, atmosphere) }
}

/// Haze that suits what is seen, so that a chair is not lost in it nor a town without.
fn atmosphere(camera: &PerspectiveCamera) -> Atmosphere {
    let atmosphere = Atmosphere::default();
    let usual = shadowfit::settings::CameraSettings::default().far;
    Atmosphere { haze_per_metre: atmosphere.haze_per_metre * usual / camera.far.max(1e-3), ..atmosphere }
}

/// The shadow factor of each pixel.
pub(crate) fn factors(pixels: &[Option<ProbePixel>]) -> Vec<f32> {
    pixels.iter().map(|pixel| pixel.map_or(1.0, |pixel| pixel.factor)).collect()
}

/// The triangle of each pixel.
pub(crate) fn triangles(pixels: &[Option<ProbePixel>]) -> Vec<Option<u32>> {
    pixels.iter().map(|pixel| pixel.map(|pixel| pixel.triangle)).collect()
}

/// How the maps of a shadow map are read.
pub(crate) fn maps_seen<'a>(maps: &'a [ShadowMap], descriptor: &ShadowMapDescriptor) -> MapsSeen<'a> {
    MapsSeen { maps, reach: bias::reach(descriptor.filter), depth_clamp: descriptor.depth_clamp }
}

fn trace(subject: &Subject, shot: &Shot, judging: &Judging, pixels: &[Option<ProbePixel>]) -> Truth {
    let settings = truth_settings(shot, judging);
    let seen = triangles(pixels);
    let camera = PixelCamera::new(&subject.camera_for_rays(&shot.camera), judging.size);
    Truth::trace(&subject.rays.tracer, &camera, &settings, &seen)
}

fn truth_settings(shot: &Shot, judging: &Judging) -> TruthSettings {
    TruthSettings {
        to_light: -shot.direction.as_dvec3().normalize(),
        ray_offset: judging.ray_offset,
        sun_radius: judging.sun_radius,
        sun_rays: judging.sun_rays,
        max_distance: f64::from(shot.camera.far),
    }
}

/// The maps as the measures take them, for positions relative to a world position.
pub(crate) fn measured(maps: &[MapFit], direction: Vec3, origin: DVec3) -> Vec<ShadowMap> {
    let from_origin = |map: &MapFit| FitMap { view_proj: clip_from(map, origin).to_cols_array(), ..fit_map(map) };
    maps.iter().map(|map| ShadowMap::new(&from_origin(map), -direction.as_dvec3())).collect()
}

/// A map as fit files have it: the f32 matrix that the renderer gets, made absolute in f64.
pub fn fit_map(map: &MapFit) -> FitMap {
    FitMap {
        view_proj: clip_from(map, DVec3::ZERO).to_cols_array(),
        resolution: map.fit.resolution.x,
        resolution_xy: (map.fit.resolution.x != map.fit.resolution.y).then(|| map.fit.resolution.to_array()),
        split_near: 0.0,
        split_far: f64::from(map.far).min(NO_END),
    }
}

/// Clip space from positions relative to a world position.
fn clip_from(map: &MapFit, origin: DVec3) -> DMat4 {
    map.fit.clip_from_world.as_dmat4() * DMat4::from_translation(origin - map.fit.origin)
}

/// Fits a technique's maps frame by frame.
#[derive(Debug)]
pub struct Fitter {
    technique: Technique,
    cascades: CascadeFitter,
    depths: Option<SeenDepths>,
    storage: Vec<DVec2>,
}

impl Fitter {
    /// A fitter that knows no frame yet.
    pub fn new(technique: &Technique) -> Self {
        Self { technique: technique.clone(), cascades: CascadeFitter::new(), depths: None, storage: Vec::new() }
    }

    /// The maps of a frame, in order of their `far`.
    ///
    /// # Errors
    ///
    /// When the camera or the settings make no sense.
    pub fn fit(&mut self, subject: &Subject, shot: &Shot) -> Result<Vec<MapFit>> {
        if shot.is_first {
            self.cascades.reset();
            self.depths = None;
        }
        let boxes = subject.boxes(self.technique.receivers);
        // Held maps are fitted to the views of two frames ahead as well.
        self.storage.resize(boxes.required(3), DVec2::ZERO);
        let views = [shot.camera.frustum().context("the camera")?];
        let mut input = boxes.input(&views, shot.direction);
        input.histogram = self.depths.as_ref().map(SeenDepths::histogram);
        let fitted = self.cascades.fit(&input, &self.technique.maps, &mut Workspace::new(&mut self.storage));
        let maps = fitted.with_context(|| format!("technique {}", self.technique.name))?;
        if self.technique.maps.splits == SplitScheme::FromHistogram {
            self.depths =
                Some(SeenDepths::trace(&subject.rays.tracer, &subject.camera_for_rays(&shot.camera), shot.direction));
        }
        Ok(maps.iter().map(|map| MapFit::from_texels(map, &self.technique.bias)).collect())
    }
}
