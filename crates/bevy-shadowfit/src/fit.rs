//! System that fits the cascades of all lights with [`FittedShadows`], for all views.

use std::f32::consts::SQRT_2;

use bevy::camera::visibility::RenderLayers;
use bevy::ecs::query::QueryData;
use bevy::light::cascade::{Cascade, CascadeShadowConfig, Cascades};
use bevy::light::{DirectionalLight, DirectionalLightShadowMap};
use bevy::pbr::MAX_CASCADES_PER_LIGHT;
use bevy::prelude::*;
use shadowfit::glam as fit_glam;
use shadowfit::settings::MAX_MAPS;
use shadowfit::{Boxes, FitInput, FittedMap, ShadowFitter, ViewFrustum};
use shadowfit_wgpu::demand::DemandView;

use crate::bias::{Biases, WINDOWS_MAX_TANGENT, WINDOWS_SLOPE_BIAS};
use crate::cascade::cascade;
use crate::clusters::LARGE;
use crate::histogram::{CountedView, Sightings, Wanted};
use crate::memory::FitMemory;
use crate::problem::Problem;
use crate::settings::{Fit, FitBias, FitSplits, FittedShadows, Reading};
use crate::view::{Receivers, Scene, View};
use crate::windows_shader::WindowsShader;

/// A light whose cascades are fitted.
#[derive(QueryData)]
#[query_data(mutable)]
pub(crate) struct FittedLight {
    entity: Entity,
    fitted: &'static FittedShadows,
    transform: &'static GlobalTransform,
    layers: Option<&'static RenderLayers>,
    memory: &'static mut FitMemory,
    light: &'static mut DirectionalLight,
    config: &'static mut CascadeShadowConfig,
    cascades: &'static mut Cascades,
}

/// Replaces the cascades that Bevy computed in this frame.
pub(crate) fn fit_cascades(
    mut lights: Query<FittedLight>,
    scene: Scene,
    maps: Res<DirectionalLightShadowMap>,
    sightings: Res<Sightings>,
    shader: Res<WindowsShader>,
    mut wanted: ResMut<Wanted>,
) {
    wanted.0.clear();
    let shadowed = lights.iter().filter(|item| item.light.shadow_maps_enabled);
    let ends = shadowed.filter_map(|item| item.config.bounds.last().copied());
    let Some(farthest) = ends.reduce(f32::max) else { return };
    let views = scene.views(farthest * LARGE);
    for mut item in &mut lights {
        if !item.light.shadow_maps_enabled {
            continue;
        }
        let result = views.as_ref().map_err(|problem| problem.to_string()).and_then(|views| {
            let layers = item.layers.cloned().unwrap_or_default();
            let views: Vec<&View> = views.iter().filter(|view| view.layers.intersects(&layers)).collect();
            let sun = Sun::new(&item, *shader, maps.size as u32, &views).map_err(|p| p.to_string())?;
            for (camera, demand) in sun.demand(&views) {
                let key = CountedView { light: item.entity, camera };
                if let Some(seen) = sightings.take(key) {
                    item.memory.fitter_of(camera, sun.fitted.fit).set_visible_demand(seen);
                }
                wanted.0.push((key, demand));
            }
            sun.fit(&views, &mut item).map_err(|p| p.to_string())
        });
        item.memory.tell(item.entity, result.err());
    }
}

/// Returns a light to Bevy when its [`FittedShadows`] are removed.
pub(crate) fn forget(
    removed: On<Remove<FittedShadows>>,
    mut lights: Query<(&mut FitMemory, &mut CascadeShadowConfig, &mut DirectionalLight)>,
    mut commands: Commands,
) {
    let light = removed.event_target();
    if let Ok((mut memory, mut config, mut sun)) = lights.get_mut(light) {
        memory.give_back(&mut config, &mut sun);
    }
    if let Ok(mut light) = commands.get_entity(light) {
        light.try_remove::<FitMemory>();
    }
}

impl FittedShadows {
    /// Returns these settings with a fit that the shader can read.
    fn with_shader(self, shader: WindowsShader) -> Self {
        let fit = if self.fit == Fit::Windows && shader != WindowsShader::Ready { Fit::Calm } else { self.fit };
        Self { fit, ..self }
    }
}

impl FitMemory {
    /// Returns the fitter that receives a camera's visible demand.
    fn fitter_of(&mut self, camera: Entity, fit: Fit) -> &mut ShadowFitter {
        if fit != Fit::Windows {
            return &mut self.bounds;
        }
        let fitters = self.views.entry(camera).or_default();
        fitters.resize_with(1, ShadowFitter::default);
        &mut fitters[0]
    }

    /// Logs once why a light keeps Bevy's cascades.
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
    /// Direction of travel in world axes.
    direction: fit_glam::Vec3,
    /// Bounds set by the user, in metres of view depth, ascending. Shadows end at the last one.
    bounds: Vec<f32>,
    overlap: f32,
    resolution: u32,
    reading: Reading,
    biases: Biases,
}

impl Sun {
    fn new(item: &FittedLightItem, shader: WindowsShader, resolution: u32, views: &[&View]) -> Result<Self, Problem> {
        let FittedLightItem { transform, light, config, .. } = item;
        let fitted = item.fitted.with_shader(shader);
        let count = config.bounds.len();
        let is_ascending = config.bounds.iter().all(|bound| bound.is_finite() && *bound > 0.0)
            && config.bounds.windows(2).all(|pair| pair[0] <= pair[1]);
        if !(1..=MAX_CASCADES_PER_LIGHT).contains(&count) || !is_ascending {
            return Err(Problem::Cascades(count));
        }
        // Direction that Bevy's shader lights by. It may differ from the rotation's direction if a transform
        // mirrors.
        let forward = -transform.affine().matrix3.z_axis;
        let direction = forward.try_normalize().ok_or(Problem::Light)?;
        let biases = match fitted.bias {
            // Bevy's own code reads a single cascade.
            FitBias::Ours if fitted.fit == Fit::Windows && count > 1 => Biases::OF_WINDOWS,
            FitBias::Ours => Biases::OF_CASCADES,
            FitBias::Bevys => Biases::of(light),
        };
        Ok(Self {
            fitted,
            direction: fit_glam::Vec3::from_array(direction.to_array()),
            bounds: config.bounds.clone(),
            overlap: config.overlap_proportion.clamp(0.0, 1.0),
            resolution,
            reading: Reading::new(views.iter().map(|view| view.filter), biases.normal),
            biases,
        })
    }

    /// Returns the shadow distance, in metres of view depth.
    fn max_distance(&self) -> f32 {
        self.bounds[self.bounds.len() - 1]
    }

    /// Fits all cascades of all views. If one fit fails, no cascade changes.
    fn fit(&self, views: &[&View], item: &mut FittedLightItem) -> Result<(), Problem> {
        let FittedLightItem { memory, light, config, cascades, .. } = item;
        let shadowed = self.shadowed(views)?;
        if shadowed.is_empty() {
            return Ok(());
        }
        let has_windows = self.fitted.fit == Fit::Windows;
        let bounds =
            if has_windows { vec![self.max_distance(); self.bounds.len()] } else { self.bounds(&shadowed, memory)? };
        memory.views.retain(|camera, _| views.iter().any(|view| view.camera == *camera));
        let farthest = memory.farthest.unwrap_or(f32::MAX);
        let mut fitted = Vec::with_capacity(shadowed.len());
        for part in &shadowed {
            let camera = part.view.camera;
            let Some(bevys) = cascades.cascades.get(&camera) else { continue };
            let fitters = memory.views.entry(camera).or_default();
            let cascades = if has_windows {
                self.windows(part, fitters)?
            } else {
                self.cascades(part, &bounds, fitters, bevys, farthest)?
            };
            fitted.push((camera, cascades));
        }
        cascades.cascades.extend(fitted);
        memory.lend(bounds, self.biases, config, light);
        Ok(())
    }

    /// Returns the cameras whose visible demand decides windows or bounds, each with its view to count.
    fn demand(&self, views: &[&View]) -> Vec<(Entity, DemandView)> {
        let is_wanted = match self.fitted.fit {
            Fit::Windows => true,
            // All views share one list of bounds.
            fit => fit.uses_histogram() && self.fitted.splits == FitSplits::Ours && views.len() == 1,
        };
        let counted = views.iter().filter(|view| is_wanted && view.has_prepass);
        let demand = |view: &&View| {
            let frustum = view.frustum(self.max_distance()).ok().filter(|frustum| !frustum.is_empty())?;
            Some((view.camera, view.demand(&frustum, self.direction, self.max_distance())))
        };
        counted.filter_map(demand).collect()
    }

    /// Fits the windows of a view.
    fn windows(&self, part: &ShadowedView, fitters: &mut Vec<ShadowFitter>) -> Result<Vec<Cascade>, Problem> {
        let technique = Fit::for_windows(self.bounds.len(), self.max_distance(), self.resolution, self.reading);
        fitters.resize_with(1, || ShadowFitter::new(&technique));
        let fitter = &mut fitters[0];
        if *fitter.technique() != technique {
            fitter.set_technique(&technique);
        }
        let Receivers { boxes, has_unknown } = &part.view.receivers;
        let receivers = (!has_unknown).then_some(Boxes::world(boxes));
        let views = [part.frustum];
        let maps = fitter.fit(&FitInput { receivers, ..FitInput::new(&views, self.direction) })?;
        Ok(maps.iter().map(|map| self.cascade(map)).collect())
    }

    /// Returns the views that begin within the shadow distance.
    fn shadowed<'a>(&self, views: &[&'a View]) -> Result<Vec<ShadowedView<'a>>, Problem> {
        let mut shadowed = Vec::with_capacity(views.len());
        for view in views {
            let frustum = view.frustum(self.max_distance())?;
            // An empty frustum lies beyond the shadow distance.
            if !frustum.is_empty() {
                shadowed.push(ShadowedView { view, frustum });
            }
        }
        Ok(shadowed)
    }

    /// Returns the bounds of the cascades of all views, in metres of view depth.
    fn bounds(&self, views: &[ShadowedView], memory: &mut FitMemory) -> Result<Vec<f32>, Problem> {
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
        let frusta: Vec<ViewFrustum> = views.iter().map(|part| part.frustum).collect();
        let all: Vec<shadowfit::Aabb>;
        let boxes = match views {
            [part] => &part.view.receivers.boxes,
            _ => {
                all = views.iter().flat_map(|part| part.view.receivers.boxes.iter().copied()).collect();
                &all
            }
        };
        let has_unknown = views.iter().any(|part| part.view.receivers.has_unknown);
        let receivers = (!has_unknown).then_some(Boxes::world(boxes));
        let fitted = fitter.fit(&FitInput { receivers, ..FitInput::new(&frusta, self.direction) })?;
        let mut bounds = Vec::with_capacity(count);
        let mut last = 0.0_f32;
        for map in fitted.iter() {
            // The last map has no end, and a map without a range ends before all others.
            last = last.max(map.shader_end()).min(self.max_distance());
            bounds.push(last);
        }
        bounds[count - 1] = self.max_distance();
        Ok(bounds)
    }

    /// Returns bounds by Bevy's rule, with equal ratios from the first one on. They extend to the farthest
    /// receiver in view instead of the shadow distance. Nearer bounds are sharper, but more pixels move from
    /// one map to the next when the camera moves.
    fn spaced_bounds(&self, views: &[ShadowedView], held: &mut Option<f32>) -> Vec<f32> {
        let (first, end) = (self.bounds[0], self.max_distance());
        let farthest = |part: &ShadowedView| part.view.receivers.farthest(part.frustum.origin.as_vec3());
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

    /// Returns the cascades of a view. If no point of the view lies between two bounds, Bevy's cascade is
    /// kept.
    fn cascades(
        &self,
        shadowed: &ShadowedView,
        bounds: &[f32],
        fitters: &mut Vec<ShadowFitter>,
        bevys: &[Cascade],
        farthest: f32,
    ) -> Result<Vec<Cascade>, Problem> {
        let ShadowedView { view, frustum } = shadowed;
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
            // Points within rounding of a bound may read either map.
            let (from, mut to) = (near - near.abs() * ROUNDING, far + far.abs() * ROUNDING);
            if is_stable && *far == self.max_distance() {
                // No receiver lies beyond.
                to = to.min(farthest);
            }
            near = frustum.near.max(far * (1.0 - self.overlap));
            let Ok(part) = frustum.slice(from, to) else { continue };
            boxes.clear();
            boxes.extend(depths.between(from, to));
            // Visible receivers would change the size of maps that must stay still.
            let knows_receivers = !view.receivers.has_unknown && self.fitted.fit != Fit::Stable;
            let receivers = knows_receivers.then_some(Boxes::world(&boxes));
            let parts = [part];
            let maps = fitter.fit(&FitInput { receivers, ..FitInput::new(&parts, self.direction) })?;
            *cascade_of = self.cascade(&maps[0]);
        }
        Ok(cascades)
    }

    /// Returns the cascade of a map, with room for receivers that biases move toward the light.
    fn cascade(&self, map: &FittedMap) -> Cascade {
        let texel = map.projection.texel_size.max_element();
        let by_slope = if self.fitted.fit == Fit::Windows { WINDOWS_SLOPE_BIAS * WINDOWS_MAX_TANGENT } else { 0.0 };
        let texels = self.biases.normal.max(0.0) * SQRT_2 + by_slope + 1.0;
        cascade(map, self.biases.depth.max(0.0) + texels * texel)
    }
}

/// New bounds of still maps, and the greatest bounds that are kept, as multiples of the farthest receiver's
/// distance. Changing bounds moves all edges.
const FAR_ROOM: f32 = 1.25;
const MAX_FAR_WASTE: f32 = 2.5;

/// Relative error of a view depth in Bevy's shader: f32 rounding, including its matrices.
const ROUNDING: f32 = 1e-5;

/// A view that begins within the shadow distance.
struct ShadowedView<'a> {
    view: &'a View,
    /// Frustum of the view up to the shadow distance.
    frustum: ViewFrustum,
}

/// Receivers of a view with their view depths.
struct Depths<'a> {
    boxes: &'a [shadowfit::Aabb],
    ranges: Vec<DepthRange>,
}

/// Range of a receiver's view depths, in metres.
struct DepthRange {
    near: f32,
    far: f32,
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
            DepthRange { near: depth - reach - rounding, far: depth + reach + rounding }
        };
        Self { boxes, ranges: boxes.iter().map(range).collect() }
    }

    /// Returns the boxes that may lie partly between two view depths.
    fn between(&self, near: f32, far: f32) -> impl Iterator<Item = shadowfit::Aabb> {
        let is_in = move |range: &DepthRange| range.far >= near && range.near <= far;
        self.ranges.iter().zip(self.boxes).filter(move |(range, _)| is_in(range)).map(|(_, aabb)| *aabb)
    }
}

const _: () = assert!(MAX_CASCADES_PER_LIGHT <= MAX_MAPS);
