//! A scene ready to be drawn, traced and fitted to.

use glam::{DVec3, Vec3};
use shadowfit::PerspectiveCamera;
use shadowfit_render::{Gpu, GpuScene};
use shadowfit_scene::{Aabb, Pose, Scene};

use crate::boxes::SceneBoxes;
use crate::rays::SceneRays;
use crate::stage::StageError;
use crate::study::Knowledge;

/// Distance from the world's origin within which f32 positions are exact to a thousandth of the rays' offset of a
/// millimetre, or nearly, in metres.
const NEAR_THE_ORIGIN: f32 = 1000.0;

/// What rays are relative to: the world's own origin, or the middle of a scene that is far from it.
fn origin_of(bounds: &Aabb) -> DVec3 {
    let middle = (bounds.min + bounds.max) * 0.5;
    if middle.abs().max_element() <= NEAR_THE_ORIGIN { DVec3::ZERO } else { middle.as_dvec3().round() }
}

/// A scene in a pose, on the GPU, for rays and as boxes.
#[derive(Debug)]
pub struct Subject {
    /// The scene.
    pub scene: Scene,
    /// Its casters for rays.
    pub rays: SceneRays,
    pub(crate) gpu_scene: GpuScene,
    clusters: SceneBoxes,
    objects: SceneBoxes,
    bounds: Aabb,
}

impl Subject {
    /// Makes a scene ready. `layout` comes from [`shadowfit_render::Renderer::material_layout`]; those of all renderers
    /// are alike.
    ///
    /// # Errors
    ///
    /// [`StageError::NothingToDraw`] for a scene without triangles.
    pub fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout, scene: Scene) -> Result<Self, StageError> {
        let pose = scene.pose(None, 0.0);
        let Some(bounds) = scene.bounds(&pose) else {
            return Err(StageError::NothingToDraw(scene.name));
        };
        let gpu_scene = GpuScene::new(gpu, layout, &scene, &pose);
        let rays = SceneRays::from_origin(&scene, &pose, origin_of(&bounds));
        let [mut clusters, mut objects] = [SceneBoxes::new(&scene, &pose), SceneBoxes::of_instances(&scene)];
        for boxes in [&mut clusters, &mut objects] {
            boxes.set_pose(|index| gpu_scene.instance_bounds(index));
        }
        Ok(Self { scene, rays, gpu_scene, clusters, objects, bounds })
    }

    /// Poses the scene at a time of an animation, in seconds.
    pub fn set_time(&mut self, gpu: &Gpu, animation: usize, seconds: f32) {
        let pose: Pose = self.scene.pose(Some(animation), seconds);
        self.gpu_scene.set_pose(gpu, &self.scene, &pose);
        self.rays.set_pose(&self.scene, &pose);
        for boxes in [&mut self.clusters, &mut self.objects] {
            boxes.set_pose(|index| self.gpu_scene.instance_bounds(index));
        }
        self.bounds = self.gpu_scene.bounds().unwrap_or(self.bounds);
    }

    /// A camera as rays see it: relative to their origin.
    pub fn camera_for_rays(&self, camera: &PerspectiveCamera) -> PerspectiveCamera {
        PerspectiveCamera { eye: camera.eye - self.rays.origin, ..*camera }
    }

    /// World bounds, in metres.
    pub fn bounds(&self) -> [Vec3; 2] {
        [self.bounds.min, self.bounds.max]
    }

    /// Number of triangles that cast.
    pub fn triangles(&self) -> usize {
        self.rays.tracer.len()
    }

    pub(crate) fn boxes(&self, knowledge: Knowledge) -> &SceneBoxes {
        match knowledge {
            Knowledge::Objects => &self.objects,
            Knowledge::Clusters => &self.clusters,
        }
    }
}
