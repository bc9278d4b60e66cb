//! A scene made ready: uploaded, with boxes for fits, and with rays that are made when they are first needed.

use core::cell::{OnceCell, RefCell};
use core::fmt;

use glam::DVec3;
use shadowfit::settings::ReceiverSource;
use shadowfit::{Aabb, PerspectiveCamera};
use shadowfit_render::{Gpu, GpuScene};
use shadowfit_scene::{AlphaMode, Instance, Pose, Scene};

use crate::SceneRays;
use crate::boxes::SceneBoxes;

/// Greatest coordinate of a scene's middle, in metres, up to which its rays are relative to the world's own origin: f32
/// positions are that near to it exact to about a tenth of the rays' offset of a millimetre.
const NEAR_THE_ORIGIN: f32 = 1000.0;

/// What rays are relative to: the world's own origin, or the middle of a scene that is far from it.
fn origin_of(bounds: &Aabb) -> DVec3 {
    let middle = (bounds.min + bounds.max) * 0.5;
    if middle.abs().max_element() <= NEAR_THE_ORIGIN { DVec3::ZERO } else { middle.as_dvec3().round() }
}

/// A scene without triangles, by its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NothingToDraw(pub String);

impl fmt::Display for NothingToDraw {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: the scene has no triangles, so there is nothing to show", self.0)
    }
}

impl core::error::Error for NothingToDraw {}

/// A scene in a pose, ready to be drawn, traced and fitted to.
#[derive(Debug)]
pub struct PreparedScene {
    /// On the GPU.
    pub(crate) gpu_scene: GpuScene,
    scene: Scene,
    pose: Pose,
    bounds: Aabb,
    clusters: SceneBoxes,
    objects: SceneBoxes,
    origin: DVec3,
    rays: OnceCell<SceneRays>,
    /// Rays of an earlier pose, which take less time to be moved than new ones to be made.
    earlier_rays: RefCell<Option<SceneRays>>,
}

impl PreparedScene {
    /// Makes a scene ready, in its rest pose. `layout` comes from [`shadowfit_render::Renderer::material_layout`];
    /// those of all renderers are alike.
    ///
    /// # Errors
    ///
    /// [`NothingToDraw`] for a scene without triangles.
    pub fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout, scene: Scene) -> Result<Self, NothingToDraw> {
        let pose = scene.pose(None, 0.0);
        let Some(bounds) = scene.bounds(&pose) else {
            return Err(NothingToDraw(scene.name));
        };
        let gpu_scene = GpuScene::new(gpu, layout, &scene, &pose);
        let [mut clusters, mut objects] = [SceneBoxes::new(&scene, &pose), SceneBoxes::of_instances(&scene)];
        for boxes in [&mut clusters, &mut objects] {
            boxes.set_pose(|index| gpu_scene.instance_bounds(index));
        }
        Ok(Self {
            gpu_scene,
            scene,
            pose,
            bounds,
            clusters,
            objects,
            origin: origin_of(&bounds),
            rays: OnceCell::new(),
            earlier_rays: RefCell::default(),
        })
    }

    /// Poses the scene at a time of an animation, in seconds; in its rest pose where it has no such animation.
    pub fn set_time(&mut self, gpu: &Gpu, animation: usize, seconds: f32) {
        self.pose = self.scene.pose(Some(animation), seconds);
        self.gpu_scene.set_pose(gpu, &self.scene, &self.pose);
        for boxes in [&mut self.clusters, &mut self.objects] {
            boxes.set_pose(|index| self.gpu_scene.instance_bounds(index));
        }
        self.bounds = self.gpu_scene.bounds().unwrap_or(self.bounds);
        if let Some(rays) = self.rays.take() {
            *self.earlier_rays.get_mut() = Some(rays);
        }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Where its nodes are at present.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// World bounds in the present pose, in metres.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// World bounds of the scene's subject in the present pose, in metres; those of the scene where it has none.
    pub fn subject_bounds(&self) -> Aabb {
        let subject = self.scene.subject.and_then(|subject| self.scene.node_bounds(&self.pose, subject));
        subject.unwrap_or(self.bounds)
    }

    /// World position that [`Self::rays`] are relative to, in metres.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// The casters in their present pose, for rays: made when first asked for after the pose has changed.
    pub fn rays(&self) -> &SceneRays {
        self.rays.get_or_init(|| match self.earlier_rays.take() {
            Some(mut rays) => {
                rays.set_pose(&self.scene, &self.pose);
                rays
            }
            None => SceneRays::from_origin(&self.scene, &self.pose, self.origin),
        })
    }

    /// Calls a function with rays of the present pose if they exist, else with those of an earlier pose, which cost
    /// nothing while the scene moves; new ones are made only where there are none at all.
    pub(crate) fn with_late_rays<T>(&self, call: impl FnOnce(&SceneRays) -> T) -> T {
        let earlier = self.earlier_rays.borrow();
        if let (None, Some(rays)) = (self.rays.get(), &*earlier) {
            return call(rays);
        }
        drop(earlier);
        call(self.rays())
    }

    /// A camera as rays see it: relative to their origin.
    pub fn camera_for_rays(&self, camera: &PerspectiveCamera) -> PerspectiveCamera {
        PerspectiveCamera { eye: camera.eye - self.origin, ..*camera }
    }

    /// Number of triangles, every instance counted.
    pub fn triangles(&self) -> u64 {
        self.count(|_| true)
    }

    /// Number of triangles that cast: all but those of blended surfaces.
    pub fn casting_triangles(&self) -> u64 {
        self.count(|alpha| alpha != AlphaMode::Blend)
    }

    fn count(&self, wanted: impl Fn(AlphaMode) -> bool) -> u64 {
        let triangles = |instance: &Instance| {
            let primitive = &self.scene.meshes[instance.mesh].primitives[instance.primitive];
            let is_wanted = wanted(self.scene.materials[primitive.material].alpha);
            if is_wanted { primitive.indices.len() as u64 / 3 } else { 0 }
        };
        self.scene.instances().iter().map(triangles).sum()
    }

    /// Whether each instance counts in sums: all, or those of the scene's subject if it has one.
    pub(crate) fn counted_instances(&self, subject_only: bool) -> Vec<bool> {
        let root = self.scene.subject.filter(|_| subject_only);
        let counts = |node| root.is_none_or(|root| self.scene.is_descendant(node, root));
        self.scene.instances().iter().map(|instance| counts(instance.node)).collect()
    }

    pub(crate) fn boxes(&self, receivers: ReceiverSource) -> &SceneBoxes {
        match receivers {
            ReceiverSource::Objects => &self.objects,
            ReceiverSource::Clusters => &self.clusters,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shadowfit_render::{AdapterChoice, Renderer};
    use shadowfit_scene::builtin::default_scene;
    use shadowfit_wgpu::ShadowMapDescriptor;

    fn prepared(scene: Scene) -> (Gpu, Result<PreparedScene, NothingToDraw>) {
        let gpu = pollster::block_on(Gpu::headless(AdapterChoice::Software)).expect("the software adapter");
        let renderer = Renderer::new(&gpu, &ShadowMapDescriptor::default(), 1).expect("a renderer");
        let prepared = PreparedScene::new(&gpu, renderer.material_layout(), scene);
        (gpu, prepared)
    }

    #[test]
    fn gpu_rays_that_are_there_follow_the_pose_as_new_ones_would() {
        let (gpu, prepared) = prepared(default_scene());
        let mut prepared = prepared.expect("the default scene");
        let rest = prepared.rays().triangles.clone();
        prepared.set_time(&gpu, 0, 0.8);
        let anew = SceneRays::from_origin(prepared.scene(), prepared.pose(), prepared.origin());
        assert_eq!(prepared.rays().triangles, anew.triangles);
        assert_ne!(prepared.rays().triangles, rest, "the figure walks");
        let vertices =
            |rays: &SceneRays| -> Vec<_> { (0..rays.tracer.len()).map(|i| rays.tracer.normal(i as u32)).collect() };
        assert_eq!(vertices(prepared.rays()), vertices(&anew));
    }

    #[test]
    fn gpu_a_scene_without_triangles_is_refused_by_its_name() {
        let scene = Scene::from_objects("bare", &[]);
        assert_eq!(prepared(scene).1.expect_err("nothing to draw"), NothingToDraw("bare".to_owned()));
    }

    #[test]
    fn gpu_triangles_of_blended_surfaces_do_not_cast() {
        let mut scene = default_scene();
        let triangles = prepared(scene.clone()).1.expect("the default scene").triangles();
        for material in &mut scene.materials {
            material.alpha = AlphaMode::Blend;
        }
        let blended = prepared(scene).1.expect("the default scene");
        assert_eq!((blended.triangles(), blended.casting_triangles()), (triangles, 0));
    }
}
