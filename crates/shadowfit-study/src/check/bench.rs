//! The setup that all checks share: the built-in courtyard along a short walk, drawn by the program's own
//! renderer.

use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result, ensure};
use glam::{DVec3, Vec3};
use shadowfit::{FittedMap, PerspectiveCamera, ShadowFitter, Technique};
use shadowfit_params::Inputs;
use shadowfit_render::{Culling, Frame, Gpu, ProbeTargets, Renderer};
use shadowfit_scene::builtin::{default_camera, default_scene};
use shadowfit_truth::PixelTruth;
use shadowfit_wgpu::{ShadowMapDescriptor, ShadowMapError};

use super::numbers::Point;
use super::outcome::Cancelled;
use super::twin::LEAST_COSINE;
use crate::{Evaluator, Judging, PreparedScene, View, next_turn};

/// Size of the pictures, in pixels: large enough for thousands of pixels at edges, small enough for software
/// adapters.
pub(super) const SIZE: [u32; 2] = [320, 180];

/// Step between the points of [`Bench::points`], across and down, in pixels.
const POINT_STEP: usize = 2;

/// Width and height of the maps, in texels.
pub(super) const TEXELS: u32 = 512;

/// Shadow distance, in metres: beyond the courtyard's walls.
const DISTANCE: f32 = 80.0;

/// Length of a step of the walk, in metres, and its turn, in radians: a frame of a brisk walk at ten frames
/// per second.
const STEP: f64 = 0.15;
const TURN: f32 = 0.03;

/// The light's direction of travel.
const DIRECTION: Vec3 = Vec3::new(0.42, -0.78, 0.46);

/// A device with a scene.
pub(super) struct Bench<'a> {
    pub(super) gpu: &'a Gpu,
    pub(super) scene: PreparedScene,
    is_cancelled: &'a AtomicBool,
}

impl<'a> Bench<'a> {
    /// Uploads the scene.
    ///
    /// # Errors
    ///
    /// If the device is out of memory.
    pub(super) fn new(gpu: &'a Gpu, is_cancelled: &'a AtomicBool) -> Result<Self> {
        let renderer = Renderer::new(gpu, &ShadowMapDescriptor::from(&technique()), 1)?;
        let scene = PreparedScene::new(gpu, renderer.material_layout(), default_scene())?;
        Ok(Self { gpu, scene, is_cancelled })
    }

    /// Lets a browser draw and take input. Ends the check if it was cancelled or the device was lost.
    ///
    /// # Errors
    ///
    /// [`Cancelled`], or the loss of the device.
    pub(super) async fn pause(&self) -> Result<()> {
        next_turn().await;
        if self.is_cancelled.load(Ordering::Relaxed) {
            return Err(Cancelled.into());
        }
        let lost = self.gpu.lost();
        ensure!(lost.is_none(), "the device was lost: {}", lost.unwrap_or_default());
        Ok(())
    }

    /// Returns the view after a number of steps of the walk.
    pub(super) fn view(step: u32) -> View {
        let (eye, target) = default_camera();
        let turn = glam::Quat::from_rotation_y(-TURN * step as f32);
        let forward = turn * (target - eye).normalize();
        let camera = PerspectiveCamera {
            eye: eye.as_dvec3() + forward.with_y(0.0).normalize().as_dvec3() * STEP * f64::from(step),
            forward,
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: SIZE[0] as f32 / SIZE[1] as f32,
            near: 0.1,
            far: DISTANCE,
        };
        View { camera: camera.into(), direction: DIRECTION.normalize(), is_first: step == 0 }
    }

    /// Creates a renderer, boxed because it is large and checks keep it across await points.
    ///
    /// # Errors
    ///
    /// If its shadow map cannot be created on this device.
    pub(super) fn renderer(&self, descriptor: &ShadowMapDescriptor) -> Result<Box<Renderer>, ShadowMapError> {
        Renderer::new(self.gpu, descriptor, 1).map(Box::new)
    }

    /// Creates an evaluator for the pictures of a technique.
    ///
    /// # Errors
    ///
    /// As for [`Self::renderer`].
    pub(super) fn evaluator(&self, technique: &Technique) -> Result<Box<Evaluator>, ShadowMapError> {
        let renderer = Renderer::new(self.gpu, &ShadowMapDescriptor::from(technique), 1)?;
        Ok(Box::new(Evaluator::new(renderer, self.judging())))
    }

    /// Returns the settings for judging pictures.
    pub(super) fn judging(&self) -> Judging {
        Judging { size: SIZE, ray_offset: self.scene.ray_offset(), crawl: false, ..Judging::default() }
    }

    /// Fits the maps of a view, independent of other frames.
    ///
    /// # Errors
    ///
    /// If the technique is invalid.
    pub(super) fn fit(&self, technique: &Technique, inputs: Inputs, view: &View) -> Result<Vec<FittedMap>> {
        let maps = self.scene.fit_alone(&mut ShadowFitter::new(technique), inputs, view);
        Ok(maps.context("no maps could be fitted")?.to_vec())
    }

    /// Draws only maps, with all casters that they can hold.
    ///
    /// # Errors
    ///
    /// If the maps do not match the renderer's shadow map.
    pub(super) fn draw_maps(&mut self, renderer: &mut Renderer, view: &View, maps: &[FittedMap]) -> Result<()> {
        let targets = ProbeTargets::new(&self.gpu.device, [1, 1]);
        let atmosphere = view.atmosphere();
        let frame = Frame { culling: Culling::WholeMap, ..Frame::new(view.camera, view.direction, maps, &atmosphere) };
        Ok(renderer.draw_probe(self.gpu, &mut self.scene.gpu_scene, &frame, &targets)?)
    }

    /// Returns points on the view's surfaces that face the light, found by rays on the CPU, relative to the
    /// eye.
    pub(super) fn points(&self, view: &View) -> Vec<Point> {
        let judging = self.judging();
        let rays = self.scene.rays();
        let (camera, settings) = (judging.pixel_camera(rays.origin, view), judging.truth_settings(view));
        let truth = PixelTruth { tracer: &rays.tracer, camera: &camera, settings: &settings };
        let [width, height] = SIZE.map(|side| side as usize);
        let pixels = (0..height).step_by(POINT_STEP).flat_map(|y| (0..width).step_by(POINT_STEP).map(move |x| (x, y)));
        let points = pixels.filter_map(|(x, y)| truth.point(y * width + x));
        let to_eye: DVec3 = rays.origin - view.camera.eye;
        points
            .filter(|point| point.facing > LEAST_COSINE && point.view_depth < 0.99 * f64::from(DISTANCE))
            .map(|point| Point {
                position: (point.position + to_eye).as_vec3().to_array(),
                normal: point.normal.as_vec3().to_array(),
            })
            .collect()
    }
}

/// Returns the recommended technique with small maps and without a fade at the shadow distance.
pub(super) fn technique() -> Technique {
    small(&Technique::default())
}

/// Returns a technique with small maps and without a fade at the shadow distance.
pub(super) fn small(technique: &Technique) -> Technique {
    technique.with_resolution(TEXELS, TEXELS).with_max_distance(DISTANCE).with_fade(0.0)
}
