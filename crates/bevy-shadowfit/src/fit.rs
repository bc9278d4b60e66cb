//! The system: cascades of all lights that have [`FittedShadows`], for all views.

use std::f32::consts::SQRT_2;

use bevy::camera::visibility::RenderLayers;
use bevy::light::cascade::{Cascade, CascadeShadowConfig, Cascades};
use bevy::light::{DirectionalLight, DirectionalLightShadowMap};
use bevy::pbr::MAX_CASCADES_PER_LIGHT;
use bevy::prelude::*;
use shadowfit::glam as fit_glam;
use shadowfit::settings::MAX_MAPS;
use shadowfit::{Boxes, FitInput, FittedMap, ShadowFitter, ViewFrustum};
use shadowfit_wgpu::demand::DemandView;

use crate::bias;
use crate::cascade::cascade;
use crate::clusters::LARGE;
use crate::histogram::{Sightings, Wanted};
use crate::memory::FitMemory;
use crate::problem::Problem;
use crate::settings::{Fit, FitBias, FitSplits, FittedShadows, Reading};
use crate::view::{Scene, View};
use crate::windows_shader::WindowsShader;

/// Lights whose cascades are fitted.
type Lights<'w, 's> = Query<
    'w,
    's,
    (
        Entity,
        &'static FittedShadows,
        &'static GlobalTransform,
        Option<&'static RenderLayers>,
        &'static mut FitMemory,
        &'static mut DirectionalLight,
        &'static mut CascadeShadowConfig,
        &'static mut Cascades,
    ),
>;

/// Replaces the cascades that Bevy has made in this frame.
pub(crate) fn fit_cascades(
    mut lights: Lights,
    scene: Scene,
    maps: Res<DirectionalLightShadowMap>,
    sightings: Res<Sightings>,
    shader: Res<WindowsShader>,
    mut wanted: ResMut<Wanted>,
) {
    wanted.0.clear();
    let shadowed = lights.iter().filter(|(.., light, _, _)| light.shadow_maps_enabled);
    let ends = shadowed.filter_map(|(.., config, _)| config.bounds.last().copied());
    let Some(farthest) = ends.reduce(f32::max) else { return };
    let views = scene.views(farthest * LARGE);
    for (entity, fitted, transform, layers, mut memory, mut light, mut config, mut cascades) in &mut lights {
        if !light.shadow_maps_enabled {
            continue;
        }
        let result = views.as_ref().map_err(|problem| problem.to_string()).and_then(|views| {
            let layers = layers.cloned().unwrap_or_default();
            let views: Vec<&View> = views.iter().filter(|view| view.layers.intersects(&layers)).collect();
            let fitted = fitted.with_shader(*shader);
            let sun =
                Sun::new(&fitted, transform, &light, &config, maps.size as u32, &views).map_err(|p| p.to_string())?;
            for (camera, demand) in sun.demand(&views) {
                if let Some(seen) = sightings.take((entity, camera)) {
                    memory.fitter_of(camera, sun.fitted.fit).see(seen);
                }
                wanted.0.push(((entity, camera), demand));
            }
            sun.fit(&views, &mut memory, &mut light, &mut config, &mut cascades).map_err(|p| p.to_string())
        });
        memory.tell(entity, result.err());
    }
}

impl FittedShadows {
    /// The same with a fit that the shader can read.
    fn with_shader(self, shader: WindowsShader) -> Self {
        let fit = if self.fit == Fit::Windows && shader != WindowsShader::Ready { Fit::Calm } else { self.fit };
        Self { fit, ..self }
    }
}

impl FitMemory {
    /// The fitter that is told what a camera's picture shows.
    fn fitter_of(&mut self, camera: Entity, fit: Fit) -> &mut ShadowFitter {
        if fit != Fit::Windows {
            return &mut self.bounds;
        }
        let fitters = self.views.entry(camera).or_default();
        fitters.resize_with(1, ShadowFitter::default);
        &mut fitters[0]
    }

    /// Says once why a light keeps Bevy's cascades.
    fn tell(&mut self, light: Entity, problem: Option<String>) {
        if problem != self.told {
            if let Some(problem) = &problem {
                warn!("the directional light {light} keeps Bevy's own cascades: {problem}");
            }
            self.told = problem;
        }
    }
}

/// A light of this frame, checked.
struct Sun {
    fitted: FittedShadows,
    /// Direction of travel, in world axes.
    direction: fit_glam::Vec3,
    /// The user's bounds, in metres of view depth, ascending; shadows end at the last one.
    bounds: Vec<f32>,
    overlap: f32,
    resolution: u32,
    reading: Reading,
    biases: [f32; 2],
}

impl Sun {
    fn new(
        fitted: &FittedShadows,
        transform: &GlobalTransform,
        light: &DirectionalLight,
        config: &CascadeShadowConfig,
        resolution: u32,
        views: &[&View],
    ) -> Result<Self, Problem> {
        let count = config.bounds.len();
        let is_ascending = config.bounds.iter().all(|bound| bound.is_finite() && *bound > 0.0)
            && config.bounds.windows(2).all(|pair| pair[0] <= pair[1]);
        if !(1..=MAX_CASCADES_PER_LIGHT).contains(&count) || !is_ascending {
            return Err(Problem::Cascades(count));
        }
        // The direction that Bevy's shader lights by: it may differ from the rotation's where a transform mirrors.
        let forward = -transform.affine().matrix3.z_axis;
        let direction = forward.try_normalize().ok_or(Problem::Light)?;
        let biases = match fitted.bias {
            FitBias::Ours => bias::OURS,
            FitBias::Bevys => [light.shadow_depth_bias, light.shadow_normal_bias],
        };
        Ok(Self {
            fitted: *fitted,
            direction: fit_glam::Vec3::from_array(direction.to_array()),
            bounds: config.bounds.clone(),
            overlap: config.overlap_proportion.clamp(0.0, 1.0),
            resolution,
            reading: Reading::new(views.iter().map(|view| view.filter), biases[1]),
            biases,
        })
    }

    /// Where shadows end, in metres of view depth.
    fn max_distance(&self) -> f32 {
        self.bounds[self.bounds.len() - 1]
    }

    /// Fits all cascades of all views. Nothing is changed where one of them is refused.
    fn fit(
        &self,
        views: &[&View],
        memory: &mut FitMemory,
        light: &mut Mut<DirectionalLight>,
        config: &mut Mut<CascadeShadowConfig>,
        cascades: &mut Mut<Cascades>,
    ) -> Result<(), Problem> {
        let frusta = self.frusta(views)?;
        if frusta.is_empty() {
            return Ok(());
        }
        let has_windows = self.fitted.fit == Fit::Windows;
        let bounds =
            if has_windows { vec![self.max_distance(); self.bounds.len()] } else { self.bounds(&frusta, memory)? };
        memory.views.retain(|camera, _| views.iter().any(|view| view.camera == *camera));
        let farthest = memory.farthest.unwrap_or(f32::MAX);
        let mut fitted = Vec::with_capacity(frusta.len());
        for (view, frustum) in &frusta {
            let Some(bevys) = cascades.cascades.get(&view.camera) else { continue };
            let fitters = memory.views.entry(view.camera).or_default();
            let cascades = if has_windows {
                self.windows(view, frustum, fitters)?
            } else {
                self.cascades(view, frustum, &bounds, fitters, bevys, farthest)?
            };
            fitted.push((view.camera, cascades));
        }
        cascades.cascades.extend(fitted);
        memory.lend(bounds, self.biases, config, light);
        Ok(())
    }

    /// The cameras whose pictures tell where windows or bounds should be, and what to count in them.
    fn demand(&self, views: &[&View]) -> Vec<(Entity, DemandView)> {
        let is_wanted = match self.fitted.fit {
            Fit::Windows => true,
            // Bounds are one list for all views.
            fit => fit.uses_histogram() && self.fitted.splits == FitSplits::Ours && views.len() == 1,
        };
        let counted = views.iter().filter(|view| is_wanted && view.has_prepass);
        let demand = |view: &&View| {
            let frustum = view.frustum(self.max_distance()).ok().filter(|frustum| !frustum.is_empty())?;
            Some((view.camera, view.demand(&frustum, self.direction, self.max_distance())))
        };
        counted.filter_map(demand).collect()
    }

    /// The windows of a view.
    fn windows(
        &self,
        view: &View,
        frustum: &ViewFrustum,
        fitters: &mut Vec<ShadowFitter>,
    ) -> Result<Vec<Cascade>, Problem> {
        let technique = Fit::for_windows(self.bounds.len(), self.max_distance(), self.resolution, self.reading);
        fitters.resize_with(1, || ShadowFitter::new(&technique));
        let fitter = &mut fitters[0];
        if *fitter.technique() != technique {
            fitter.set_technique(&technique);
        }
        let receivers = (!view.receivers.has_unknown).then_some(Boxes::world(&view.receivers.boxes));
        let views = [*frustum];
        let maps = fitter.fit(&FitInput { receivers, ..FitInput::new(&views, self.direction) })?;
        Ok(maps.iter().map(|map| self.cascade(map)).collect())
    }

    /// The views of which a part is shadowed.
    fn frusta<'a>(&self, views: &[&'a View]) -> Result<Vec<(&'a View, ViewFrustum)>, Problem> {
        let mut frusta = Vec::with_capacity(views.len());
        for view in views {
            let frustum = view.frustum(self.max_distance())?;
            // An empty one lies beyond the shadows.
            if !frustum.is_empty() {
                frusta.push((*view, frustum));
            }
        }
        Ok(frusta)
    }

    /// Bounds of the cascades of all views, in metres of view depth.
    fn bounds(&self, views: &[(&View, ViewFrustum)], memory: &mut FitMemory) -> Result<Vec<f32>, Problem> {
        let count = self.bounds.len();
        if self.fitted.splits == FitSplits::Bevys {
            return Ok(self.bounds.clone());
        }
        if self.fitted.fit == Fit::Stable {
            return Ok(self.spaced_bounds(views, &mut memory.farthest));
        }
        if count == 1 {
            return Ok(self.bounds.clone());
        }
        let fitter = &mut memory.bounds;
        let technique = self.fitted.fit.for_bounds(count, self.max_distance(), self.resolution, self.reading);
        if *fitter.technique() != technique {
            fitter.set_technique(&technique);
        }
        let frusta: Vec<ViewFrustum> = views.iter().map(|(_, frustum)| *frustum).collect();
        let all: Vec<shadowfit::Aabb>;
        let boxes = match views {
            [(view, _)] => &view.receivers.boxes,
            _ => {
                all = views.iter().flat_map(|(view, _)| view.receivers.boxes.iter().copied()).collect();
                &all
            }
        };
        let has_unknown = views.iter().any(|(view, _)| view.receivers.has_unknown);
        let receivers = (!has_unknown).then_some(Boxes::world(boxes));
        let fitted = fitter.fit(&FitInput { receivers, ..FitInput::new(&frusta, self.direction) })?;
        let mut bounds = Vec::with_capacity(count);
        let mut last = 0.0_f32;
        for map in fitted.iter() {
            // The last one has no end, and one without a range ends before all others.
            last = last.max(map.far).min(self.max_distance());
            bounds.push(last);
        }
        bounds[count - 1] = self.max_distance();
        Ok(bounds)
    }

    /// Bounds by Bevy's rule, equal ratios from the first one on, up to the farthest receiver in view instead of where
    /// shadows end: nearer ones are sharper, but more pixels pass from one map to the next when the camera moves.
    fn spaced_bounds(&self, views: &[(&View, ViewFrustum)], held: &mut Option<f32>) -> Vec<f32> {
        let (first, end) = (self.bounds[0], self.max_distance());
        let farthest = |(view, frustum): &(&View, ViewFrustum)| view.receivers.farthest(frustum.origin.as_vec3());
        let last = views.iter().map(farthest).fold(first, f32::max).min(end);
        let is_kept = |far: &f32| *far >= last && *far <= last * MAX_FAR_WASTE;
        let far = held.filter(is_kept).unwrap_or(last * FAR_ROOM).min(end);
        *held = Some(far);
        let count = self.bounds.len();
        let ratio = (far / first).powf(1.0 / (count - 1).max(1) as f32);
        let mut bounds: Vec<f32> = (0..count).map(|i| first * ratio.powi(i as i32)).collect();
        bounds[count - 1] = end;
        bounds
    }

    /// The cascades of a view; Bevy's where no point of the view lies between their bounds.
    fn cascades(
        &self,
        view: &View,
        frustum: &ViewFrustum,
        bounds: &[f32],
        fitters: &mut Vec<ShadowFitter>,
        bevys: &[Cascade],
        farthest: f32,
    ) -> Result<Vec<Cascade>, Problem> {
        let technique = self.fitted.fit.for_cascade(self.resolution, self.reading);
        fitters.resize_with(bounds.len(), || ShadowFitter::new(&technique));
        let depths = Depths::of(view, frustum);
        let is_stable = self.fitted.fit == Fit::Stable && self.fitted.splits == FitSplits::Ours;
        let mut cascades = bevys.to_vec();
        let mut near = frustum.near;
        let mut boxes = Vec::with_capacity(view.receivers.boxes.len());
        for ((fitter, far), cascade_of) in fitters.iter_mut().zip(bounds).zip(&mut cascades) {
            if *fitter.technique() != technique {
                fitter.set_technique(&technique);
            }
            // Points within rounding of a bound may read either side.
            let (from, mut to) = (near - near.abs() * ROUNDING, far + far.abs() * ROUNDING);
            if is_stable && *far == self.max_distance() {
                // Nothing receives beyond.
                to = to.min(farthest);
            }
            near = frustum.near.max(far * (1.0 - self.overlap));
            let Ok(part) = frustum.slice(from, to) else { continue };
            boxes.clear();
            boxes.extend(depths.between(from, to));
            // What is in view would change the size of the maps that are to stand still.
            let knows_receivers = !view.receivers.has_unknown && self.fitted.fit != Fit::Stable;
            let receivers = knows_receivers.then_some(Boxes::world(&boxes));
            let parts = [part];
            let maps = fitter.fit(&FitInput { receivers, ..FitInput::new(&parts, self.direction) })?;
            *cascade_of = self.cascade(&maps[0]);
        }
        Ok(cascades)
    }

    /// The cascade of a map, with room for receivers that biases move toward the light.
    fn cascade(&self, map: &FittedMap) -> Cascade {
        let texel = map.projection.texel_size.max_element();
        cascade(map, self.biases[0].max(0.0) + (self.biases[1].max(0.0) * SQRT_2 + 1.0) * texel)
    }
}

/// How far beyond the farthest receiver new bounds of still maps reach, and when they are given up: bounds that change
/// move all edges.
const FAR_ROOM: f32 = 1.25;
const MAX_FAR_WASTE: f32 = 2.5;

/// Relative error of a view depth in Bevy's shader: f32, with room for the matrices that it goes through.
const ROUNDING: f32 = 1e-5;

/// The receivers of a view with their depths in it.
struct Depths<'a> {
    boxes: &'a [shadowfit::Aabb],
    ranges: Vec<(f32, f32)>,
}

impl<'a> Depths<'a> {
    fn of(view: &'a View, frustum: &ViewFrustum) -> Self {
        let boxes = &view.receivers.boxes;
        let forward = frustum.forward;
        let eye = frustum.origin.as_vec3().dot(forward);
        let range = |aabb: &shadowfit::Aabb| {
            let (centre, half) = ((aabb.min + aabb.max) * 0.5, (aabb.max - aabb.min) * 0.5);
            let (depth, reach) = (centre.dot(forward) - eye, half.dot(forward.abs()));
            let rounding = (centre.abs().max_element() + eye.abs()) * ROUNDING;
            (depth - reach - rounding, depth + reach + rounding)
        };
        Self { boxes, ranges: boxes.iter().map(range).collect() }
    }

    /// The boxes of which a part may lie between two view depths.
    fn between(&self, near: f32, far: f32) -> impl Iterator<Item = shadowfit::Aabb> {
        let is_in = move |range: &(f32, f32)| range.1 >= near && range.0 <= far;
        self.ranges.iter().zip(self.boxes).filter(move |(range, _)| is_in(range)).map(|(_, aabb)| *aabb)
    }
}

const _: () = assert!(MAX_CASCADES_PER_LIGHT <= MAX_MAPS);
