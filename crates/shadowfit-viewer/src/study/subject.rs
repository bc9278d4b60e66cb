//! A scene ready to be drawn, traced and fitted to.

use glam::Vec3;
use shadowfit_render::{Gpu, GpuScene};
use shadowfit_scene::{Aabb, Pose, Scene};

use crate::boxes::SceneBoxes;
use crate::rays::SceneRays;
use crate::stage::StageError;
use crate::study::Knowledge;

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
        let rays = SceneRays::new(&scene, &pose);
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
