//! Measures what the halves show in the background: about once a second while it changes, and once when it stands.

use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use bevy::light::cascade::Cascade;
use bevy::light::{CascadeShadowConfig, Cascades, DirectionalLightShadowMap};
use bevy::prelude::*;
use bevy::tasks::futures::check_ready;
use bevy::tasks::{AsyncComputeTaskPool, Task};
use shadowfit::PerspectiveCamera;
use shadowfit::glam as fit_glam;
use shadowfit_truth::Tracer;

use crate::content::Content;
use crate::halves::Side;
use crate::lookup::{LightMaps, ShadowMap};
use crate::measure::{Figures, Shown};
use crate::rays;

/// Time from the beginning of a measurement to that of the next one, at least.
const INTERVAL: Duration = Duration::from_secs(1);

/// What is measured of both halves.
#[derive(Resource)]
pub(crate) struct Measured {
    content: Arc<Content>,
    /// Made by the first measurement.
    tracer: Arc<OnceLock<Tracer>>,
    halves: [Half; 2],
}

#[derive(Default)]
struct Half {
    /// What the last measurement is of, when it began, and its figures.
    begun: Option<(Shown, Instant)>,
    task: Option<Task<Figures>>,
    figures: Option<Figures>,
    /// Whether the figures are those of what is shown.
    is_current: bool,
}

impl Measured {
    /// The latest figures of a half, once there are some.
    pub(crate) fn figures(&self, side: Side) -> Option<Figures> {
        self.halves[side.index()].figures
    }

    /// Whether both halves show what their figures were measured of.
    pub(crate) fn is_current(&self) -> bool {
        self.halves.iter().all(|half| half.is_current)
    }
}

/// Adds the measurements.
pub(crate) fn plugin(app: &mut App, content: Arc<Content>) {
    let measured = Measured { content, tracer: Arc::default(), halves: Default::default() };
    // From the fit to the end of the frame, lights have the bounds and biases that the shader gets.
    app.insert_resource(measured).add_systems(Last, measure);
}

type SunParts<'a> = (&'a Side, &'a GlobalTransform, &'a DirectionalLight, &'a CascadeShadowConfig, &'a Cascades);

fn measure(
    mut measured: ResMut<Measured>,
    cameras: Query<(Entity, &Side, &Camera, &Projection, &GlobalTransform)>,
    suns: Query<SunParts>,
    maps: Res<DirectionalLightShadowMap>,
) {
    for (entity, side, camera, projection, transform) in &cameras {
        let Some(sun) = suns.iter().find(|(sun, ..)| *sun == side) else { continue };
        let (Some(size), Some(maps)) = (camera.physical_viewport_size(), light_maps(entity, sun, maps.size)) else {
            continue;
        };
        let Projection::Perspective(lens) = projection else { continue };
        let shown = Shown { camera: pinhole(lens, transform, size), height: size.y, light: maps };
        measured.update(*side, shown);
    }
}

impl Measured {
    fn update(&mut self, side: Side, shown: Shown) {
        let half = &mut self.halves[side.index()];
        if let Some(figures) = half.task.as_mut().and_then(check_ready) {
            half.task = None;
            half.figures = Some(figures);
        }
        let is_of_this = half.begun.as_ref().is_some_and(|(begun, _)| *begun == shown);
        half.is_current = is_of_this && half.task.is_none();
        let is_early = half.begun.as_ref().is_some_and(|(_, at)| at.elapsed() < INTERVAL);
        if is_of_this || is_early || half.task.is_some() {
            return;
        }
        half.begun = Some((shown.clone(), Instant::now()));
        let (tracer, content) = (self.tracer.clone(), self.content.clone());
        half.task = Some(AsyncComputeTaskPool::get().spawn(async move {
            let tracer = tracer.get_or_init(|| rays::tracer(&content));
            shown.measure(tracer, content.extent().into())
        }));
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

/// The maps of a sun in the view of a camera; `None` before the first ones are made.
fn light_maps(camera: Entity, sun: SunParts<'_>, size: usize) -> Option<LightMaps> {
    let (_, transform, light, config, cascades) = sun;
    let map = |(cascade, bound): (&Cascade, &f32)| ShadowMap {
        clip_from_world: fit_glam::DMat4::from_cols_array(&cascade.clip_from_world.to_cols_array().map(f64::from)),
        texel: cascade.texel_size.into(),
        bound: (*bound).into(),
    };
    let to_light = fit_glam::DVec3::from_array(transform.back().to_array().map(f64::from));
    Some(LightMaps {
        maps: cascades.cascades.get(&camera)?.iter().zip(&config.bounds).map(map).collect(),
        size: size as u32,
        overlap: config.overlap_proportion.into(),
        depth_bias: light.shadow_depth_bias.into(),
        normal_bias: light.shadow_normal_bias.into(),
        to_light: to_light.normalize(),
    })
}
