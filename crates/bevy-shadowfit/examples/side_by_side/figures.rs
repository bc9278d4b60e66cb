//! Measures the maps of both halves against rays in the background: about once per second while they change,
//! and once after the last change.

use std::fmt;
use std::time::{Duration, Instant};

use bevy::light::{CascadeShadowConfig, Cascades, DirectionalLightShadowMap};
use bevy::prelude::*;
use bevy::tasks::futures::check_ready;
use bevy::tasks::{AsyncComputeTaskPool, Task};
use shadowfit::PerspectiveCamera;
use shadowfit::glam as fit_glam;
use shadowfit_report::contestant::{LookupFilter, ShadowLookup};
use shadowfit_truth::{PixelCamera, Truth, TruthSettings, judge};

use crate::halves::Side;
use crate::scene::{Content, Shown};
use crate::sun_maps::SunMaps;

/// Least time from the start of a measurement to the start of the next one.
const INTERVAL: Duration = Duration::from_secs(1);
/// Pixels of a measured image.
const PIXELS: f32 = 160.0 * 90.0;

/// Measurements of a half.
#[derive(Component, Default)]
pub(crate) struct Measured {
    /// Subject and start of the last measurement.
    begun: Option<(Subject, Instant)>,
    task: Option<Task<Figures>>,
    /// Latest figures.
    pub(crate) figures: Option<Figures>,
    /// Whether the figures belong to the current image.
    pub(crate) is_current: bool,
}

/// Camera and maps of a half. Together with the scene they decide its image.
#[derive(Clone, Debug, PartialEq)]
struct Subject {
    camera: PerspectiveCamera,
    /// Height of the half in pixels.
    height: u32,
    lookup: ShadowLookup,
}

/// Figures of a half. They are NaN if no surface faces the light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Figures {
    /// Window pixels per texel along the texel's worse axis: the 95% quantile.
    pixels_per_texel: f64,
    /// Share of the pixels facing the light that are wrong, in per cent.
    wrong: f64,
    /// Error of the sunlight, in per cent of the sunlight without shadows.
    light_error: f64,
}

impl fmt::Display for Figures {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { pixels_per_texel, wrong, light_error } = self;
        write!(f, "pixels per texel {pixels_per_texel:.2}   wrong {wrong:.2}%   light error {light_error:.2}%")
    }
}

type SunParts<'a> = (&'a Side, &'a GlobalTransform, &'a DirectionalLight, &'a CascadeShadowConfig, &'a Cascades);

/// Measures both halves. From the fit to the end of the frame, lights have the bounds and biases that the shader gets.
pub(crate) fn measure(
    mut cameras: Query<(Entity, &Side, &Camera, &Projection, &GlobalTransform, &mut Measured)>,
    suns: Query<SunParts>,
    shown: Res<Shown>,
    maps: Res<DirectionalLightShadowMap>,
) {
    for (entity, side, camera, projection, transform, mut measured) in &mut cameras {
        let Some((_, toward, light, config, cascades)) = suns.iter().find(|(of, ..)| *of == side) else { continue };
        let (Some(size), Some(cascades)) = (camera.physical_viewport_size(), cascades.cascades.get(&entity)) else {
            continue;
        };
        let Projection::Perspective(lens) = projection else { continue };
        let to_light = fit_glam::DVec3::from_array(toward.back().to_array().map(f64::from)).normalize();
        let sun_maps = SunMaps::new(cascades, config, light);
        let lookup = sun_maps.lookup(maps.size as u32, LookupFilter::Castano13, to_light);
        measured.update(Subject { camera: pinhole(lens, transform, size), height: size.y, lookup }, &shown);
    }
}

fn pinhole(lens: &PerspectiveProjection, transform: &GlobalTransform, size: UVec2) -> PerspectiveCamera {
    let axis = |axis: Dir3| fit_glam::Vec3::from_array(axis.to_array());
    PerspectiveCamera {
        eye: fit_glam::DVec3::from_array(transform.translation().to_array().map(f64::from)),
        forward: axis(transform.forward()),
        up: axis(transform.up()),
        fov_y: lens.fov,
        aspect: size.x as f32 / size.y as f32,
        near: lens.near,
        far: lens.far,
    }
}

impl Measured {
    fn update(&mut self, subject: Subject, shown: &Shown) {
        if let Some(figures) = self.task.as_mut().and_then(check_ready) {
            self.task = None;
            self.figures = Some(figures);
        }
        let is_same = self.begun.as_ref().is_some_and(|(begun, _)| *begun == subject);
        self.is_current = is_same && self.task.is_none();
        let is_early = self.begun.as_ref().is_some_and(|(_, at)| at.elapsed() < INTERVAL);
        if is_same || is_early || self.task.is_some() {
            return;
        }
        self.begun = Some((subject.clone(), Instant::now()));
        let content = shown.0.clone();
        self.task = Some(AsyncComputeTaskPool::get().spawn(async move { subject.measure(&content) }));
    }
}

impl Subject {
    fn measure(&self, content: &Content) -> Figures {
        let width = (PIXELS * self.camera.aspect).sqrt().round().max(1.0);
        let size = [width, (PIXELS / width).round().max(1.0)].map(|side| side as u32);
        let (camera, tracer) = (PixelCamera::new(self.camera, size), &content.rays().tracer);
        let max_distance = self.lookup.maps.last().map_or(0.0, |map| map.bound);
        let settings = TruthSettings { max_distance, ..TruthSettings::new(self.lookup.to_light) };
        let truth = Truth::trace(tracer, &camera, &settings, &Truth::seen_by_rays(tracer, &camera));
        let factors = self.lookup.factors(tracer, &truth, content.extent().into());
        let maps = self.lookup.light_maps();
        let figures = judge(tracer, &truth, &maps.picture_maps(), &factors, |_| true).tally.figures();
        // A pixel of the measured image is wider than a pixel of the window by this factor.
        let scale = f64::from(self.height) / f64::from(size[1]);
        let [_, texel, _] = figures.and_then(|figures| figures.pixels_per_texel).unwrap_or([f64::NAN; 3]);
        let [wrong, light_error] = figures.map_or([f64::NAN; 2], |figures| [figures.wrong, figures.light_error]);
        Figures { pixels_per_texel: texel * scale, wrong, light_error }
    }
}
