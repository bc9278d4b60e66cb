//! A scene prepared for drawing and judging: uploaded, with boxes for fits, and with rays that are built on
//! first use or on a thread.

use core::fmt;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use shadowfit::{Aabb, Camera};
use shadowfit_params::BoxSource;
use shadowfit_render::{DeviceFault, Gpu, GpuScene, RayError};
use shadowfit_scene::{BlendedCasters, Casting, Instance, Pose, Primitive, Scene};

use crate::SceneRays;
use crate::boxes::SceneBoxes;
use crate::file_camera::{camera_reaches, file_camera};
use crate::posed_rays::{Posed, PosedRays};

/// Greatest coordinate of a scene's middle, in metres, up to which its rays are relative to the world's
/// origin. That near to it, f32 positions are exact to about a tenth of the rays' offset of a millimetre.
const NEAR_THE_ORIGIN: f32 = 1000.0;

/// Returns the origin of the rays: the world's origin, or the middle of a scene that is far from it.
fn origin_of(bounds: &Aabb) -> DVec3 {
    let middle = (bounds.min + bounds.max) * 0.5;
    if middle.abs().max_element() <= NEAR_THE_ORIGIN { DVec3::ZERO } else { middle.as_dvec3().round() }
}

/// Distance above the surface at which shadow rays start, in metres, in scenes of 2 m to 1 km.
const RAY_OFFSET: f64 = 1e-3;
/// Greatest ratio of this distance to a scene's size, so that rays start below the next surface of a small
/// model.
const RAY_OFFSET_PER_SIZE: f64 = 5e-4;
/// Smallest ratio of this distance to the greatest coordinate, about 16 times the rounding of an f32
/// position.
const RAY_OFFSET_PER_COORDINATE: f64 = 1e-6;

/// Returns the distance above the surface at which shadow rays start, in metres, for a scene with these
/// bounds and rays relative to `origin`. It is a millimetre, less in models below 2 m, and more if
/// coordinates exceed 1 km.
fn ray_offset(bounds: &Aabb, origin: DVec3) -> f64 {
    let size = f64::from((bounds.max - bounds.min).length());
    let farthest = |corner: Vec3| (corner.as_dvec3() - origin).abs().max_element();
    let coordinate = farthest(bounds.min).max(farthest(bounds.max));
    // A scene without a size has no surfaces whose distance matters.
    let largest = if size > 0.0 { size * RAY_OFFSET_PER_SIZE } else { RAY_OFFSET };
    RAY_OFFSET.min(largest).max(coordinate * RAY_OFFSET_PER_COORDINATE)
}

/// Reason why a scene cannot be prepared, with its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PrepareError {
    /// The scene has no triangles.
    NothingToDraw(String),
    /// The device is out of memory for the scene, even with the smallest textures, or refuses it.
    Device(String, DeviceFault),
}

impl fmt::Display for PrepareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NothingToDraw(name) => write!(f, "{name}: the scene has no triangles, so there is nothing to show"),
            Self::Device(name, fault) => {
                write!(
                    f,
                    "{name}: the scene cannot be uploaded to the graphics device: {fault}; use one with fewer triangles"
                )
            }
        }
    }
}

impl core::error::Error for PrepareError {}

/// A scene in a pose, ready to be drawn, traced and fitted to.
///
/// Callers that can wait use its [`rays`](PosedScene::rays). A window uses the latest rays in each frame, and
/// a thread builds missing ones:
///
/// ```no_run
/// # fn frame(scene: &mut shadowfit_study::PreparedScene) {
/// scene.take_rays();
/// scene.request_rays();
/// if let Some((rays, is_of_present_pose)) = scene.latest_rays() {
///     println!("{} triangles, of this very pose: {is_of_present_pose}", rays.tracer.len());
/// }
/// # }
/// ```
///
/// It can be created on one thread and used on another.
#[derive(Debug)]
pub struct PreparedScene {
    /// The scene on the GPU.
    pub gpu_scene: GpuScene,
    /// Reason why its casters cannot be traced, once known.
    no_gpu_rays: Option<RayError>,
    posed: PosedScene,
}

/// A scene in a pose, ready to be traced and fitted to: the part of a [`PreparedScene`] that needs no GPU.
#[derive(Debug)]
pub struct PosedScene {
    scene: Arc<Scene>,
    pose: Pose,
    bounds: Aabb,
    clusters: SceneBoxes,
    objects: SceneBoxes,
    origin: DVec3,
    ray_offset: f64,
    /// Far distance of each camera in the file, in metres.
    reaches: Vec<f32>,
    rays: PosedRays,
}

impl PreparedScene {
    /// Prepares a scene in its rest pose, with boxes and without rays. `layout` is
    /// [`shadowfit_render::passes::material_layout`], the same for all renderers.
    ///
    /// # Errors
    ///
    /// [`PrepareError`] if the scene has no triangles or the device lacks the memory. If smaller textures fit
    /// into memory, the scene gets these and a note instead.
    pub fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout, mut scene: Scene) -> Result<Self, PrepareError> {
        let pose = scene.pose(None, 0.0);
        let Some(bounds) = scene.bounds(&pose) else {
            return Err(PrepareError::NothingToDraw(scene.name));
        };
        let (gpu_scene, side) = GpuScene::within_memory(gpu, layout, &scene, &pose)
            .map_err(|fault| PrepareError::Device(scene.name.clone(), fault))?;
        if let Some(side) = side {
            scene
                .notes
                .push(format!("textures halved to at most {side} texels a side: the GPU has no memory for more"));
        }
        let [mut clusters, mut objects] = [SceneBoxes::new(&scene, &pose), SceneBoxes::of_instances(&scene)];
        for boxes in [&mut clusters, &mut objects] {
            boxes.set_pose(|index| gpu_scene.instance_bounds(index));
        }
        let reaches = camera_reaches(&scene, &bounds);
        let posed = PosedScene {
            scene: Arc::new(scene),
            pose,
            bounds,
            clusters,
            objects,
            origin: origin_of(&bounds),
            ray_offset: ray_offset(&bounds, origin_of(&bounds)),
            reaches,
            rays: PosedRays::default(),
        };
        Ok(Self { gpu_scene, no_gpu_rays: None, posed })
    }

    /// Uploads the scene in its current pose to another device, for example after the loss of a device.
    ///
    /// # Errors
    ///
    /// [`PrepareError`] as for [`Self::new`]. The scene cannot be drawn then.
    pub fn move_to(&mut self, gpu: &Gpu, layout: &wgpu::BindGroupLayout) -> Result<(), PrepareError> {
        let Self { gpu_scene, no_gpu_rays, posed } = self;
        let (moved, _) = GpuScene::within_memory(gpu, layout, &posed.scene, &posed.pose)
            .map_err(|fault| PrepareError::Device(posed.scene.name.clone(), fault))?;
        (*gpu_scene, *no_gpu_rays) = (moved, None);
        Ok(())
    }

    /// Poses the scene at a time of an animation, in seconds, or in its rest pose if there is no such
    /// animation. Does nothing if the scene already has that pose.
    pub fn set_time(&mut self, gpu: &Gpu, animation: usize, seconds: f32) {
        let Self { gpu_scene, posed, .. } = self;
        let pose = posed.scene.pose(Some(animation), seconds);
        if pose == posed.pose {
            return;
        }
        posed.pose = pose;
        gpu_scene.set_pose(gpu, &posed.scene, &posed.pose);
        for boxes in [&mut posed.clusters, &mut posed.objects] {
            boxes.set_pose(|index| gpu_scene.instance_bounds(index));
        }
        posed.bounds = gpu_scene.bounds().unwrap_or(posed.bounds);
        posed.rays.change_pose();
    }

    /// Sets whether blended surfaces cast shadows. If that changes, uploads the scene again in its current
    /// pose.
    ///
    /// # Errors
    ///
    /// [`PrepareError`] as for [`Self::new`]. The scene is then unchanged.
    pub fn set_blended_casters(
        &mut self,
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        blended: BlendedCasters,
    ) -> Result<(), PrepareError> {
        if self.scene().blended_casters == blended {
            return Ok(());
        }
        let mut scene = Arc::clone(&self.posed.scene);
        Arc::make_mut(&mut scene).blended_casters = blended;
        let (gpu_scene, _) = GpuScene::within_memory(gpu, layout, &scene, &self.posed.pose)
            .map_err(|fault| PrepareError::Device(scene.name.clone(), fault))?;
        let (rest, posed) = (scene.pose(None, 0.0), &mut self.posed);
        (posed.clusters, posed.objects) = (SceneBoxes::new(&scene, &rest), SceneBoxes::of_instances(&scene));
        for boxes in [&mut posed.clusters, &mut posed.objects] {
            boxes.set_pose(|index| gpu_scene.instance_bounds(index));
        }
        (posed.scene, posed.rays) = (scene, PosedRays::default());
        (self.gpu_scene, self.no_gpu_rays) = (gpu_scene, None);
        Ok(())
    }

    /// Prepares the scene for traced edges, unless it is prepared.
    ///
    /// # Errors
    ///
    /// [`RayError`] if the scene is too large for the device, or the device lacks compute shaders. Edges are
    /// filtered then.
    pub fn make_gpu_rays(&mut self, gpu: &Gpu) -> Result<(), RayError> {
        if let Some(error) = &self.no_gpu_rays {
            return Err(error.clone());
        }
        let made = self.gpu_scene.make_rays(gpu, &self.posed.scene, self.posed.origin);
        self.no_gpu_rays = made.as_ref().err().cloned();
        made
    }
}

impl core::ops::Deref for PreparedScene {
    type Target = PosedScene;

    fn deref(&self) -> &PosedScene {
        &self.posed
    }
}

impl core::ops::DerefMut for PreparedScene {
    fn deref_mut(&mut self) -> &mut PosedScene {
        &mut self.posed
    }
}

impl PosedScene {
    /// Returns a copy of the scene in its current pose for another thread, with the existing rays.
    #[must_use]
    pub fn snapshot(&self) -> Self {
        Self {
            scene: Arc::clone(&self.scene),
            pose: self.pose.clone(),
            bounds: self.bounds,
            clusters: self.clusters.clone(),
            objects: self.objects.clone(),
            origin: self.origin,
            ray_offset: self.ray_offset,
            reaches: self.reaches.clone(),
            rays: self.rays.snapshot(),
        }
    }

    /// Returns the scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns the scene, to share with threads.
    pub fn shared_scene(&self) -> Arc<Scene> {
        Arc::clone(&self.scene)
    }

    /// Returns the current pose of its nodes.
    pub fn pose(&self) -> &Pose {
        &self.pose
    }

    /// Returns the world bounds in the current pose, in metres.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Returns the world bounds of the scene's subject in the current pose, in metres, or of the scene if it
    /// has no subject.
    pub fn subject_bounds(&self) -> Aabb {
        let subject = self.scene.subject.and_then(|subject| self.scene.node_bounds(&self.pose, subject));
        subject.unwrap_or(self.bounds)
    }

    /// Returns the default distance above the surface at which shadow rays start, in metres: a millimetre,
    /// less for a scene below 2 m, and more if coordinates exceed 1 km. It stays constant while the scene
    /// moves.
    pub fn ray_offset(&self) -> f64 {
        self.ray_offset
    }

    /// Returns a camera of the file by its index, in the current pose, like [`file_camera`]. Near and far
    /// plane stay constant while the scene moves. `None` without such a camera, or if its node has no size.
    pub fn file_camera(&self, index: usize, aspect: f32) -> Option<Camera> {
        file_camera(self.scene.cameras.get(index)?, &self.pose, *self.reaches.get(index)?, aspect)
    }

    /// Returns the world position that [`Self::rays`] are relative to, in metres.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Returns the casters in their current pose, for rays, to callers that can wait. The first call after a
    /// change of pose builds them, which takes at least a tenth of a second per million triangles.
    pub fn rays(&self) -> &SceneRays {
        self.rays.get_or_make(self.posed())
    }

    /// Returns the rays like [`Self::rays`], to share with threads.
    pub fn shared_rays(&self) -> Arc<SceneRays> {
        Arc::clone(self.rays.get_or_make(self.posed()))
    }

    /// Returns the rays for the current pose, if they exist. Builds nothing.
    pub fn ready_rays(&self) -> Option<Arc<SceneRays>> {
        self.rays.ready()
    }

    /// Returns the latest rays, and whether they are for the current pose. Builds nothing.
    pub fn latest_rays(&self) -> Option<(Arc<SceneRays>, bool)> {
        self.rays.latest()
    }

    /// Starts a thread that builds the rays for the current pose, for [`Self::take_rays`] in a later frame.
    /// Does nothing if they exist, or while a thread still builds rays for an earlier pose. Called in each
    /// frame of an animation, it builds one set of rays after another, which lag behind by a few frames.
    pub fn request_rays(&mut self) {
        let Self { rays, scene, pose, origin, .. } = self;
        rays.request(Posed { scene, pose, origin: *origin });
    }

    /// Takes the rays that a thread has built, without waiting, and returns whether there were any. They may
    /// be for an earlier pose and are then returned by [`Self::latest_rays`].
    pub fn take_rays(&mut self) -> bool {
        self.rays.take()
    }

    fn posed(&self) -> Posed<'_> {
        Posed { scene: &self.scene, pose: &self.pose, origin: self.origin }
    }

    /// Returns a camera relative to the origin of the rays.
    pub fn camera_for_rays(&self, camera: impl Into<Camera>) -> Camera {
        let camera = camera.into();
        Camera { eye: camera.eye - self.origin, ..camera }
    }

    /// Returns the number of triangles of all instances.
    pub fn triangles(&self) -> u64 {
        self.count(|_| true)
    }

    /// Returns the number of triangles that cast shadows, including triangles with holes.
    pub fn casting_triangles(&self) -> u64 {
        self.count(|primitive| self.scene.casting(primitive) != Casting::Nothing)
    }

    fn count(&self, wanted: impl Fn(&Primitive) -> bool) -> u64 {
        let triangles = |instance: &Instance| {
            let primitive = &self.scene.meshes[instance.mesh].primitives[instance.primitive];
            if wanted(primitive) { primitive.indices.len() as u64 / 3 } else { 0 }
        };
        self.scene.instances().iter().map(triangles).sum()
    }

    /// Returns whether each of the scene's instances counts in sums. With `subject_only`, only the subject's
    /// instances count, if the scene has a subject.
    pub fn counted_instances(&self, subject_only: bool) -> Vec<bool> {
        let root = self.scene.subject.filter(|_| subject_only);
        let counts = |node| root.is_none_or(|root| self.scene.is_descendant(node, root));
        self.scene.instances().iter().map(|instance| counts(instance.node)).collect()
    }

    pub(crate) fn boxes(&self, source: BoxSource) -> &SceneBoxes {
        match source {
            BoxSource::Objects => &self.objects,
            BoxSource::Clusters => &self.clusters,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shadowfit_render::Renderer;
    use shadowfit_scene::AlphaMode;
    use shadowfit_scene::builtin::default_scene;
    use shadowfit_testing::renderer_gpu;
    use shadowfit_wgpu::ShadowMapDescriptor;

    fn prepared(scene: Scene) -> (Gpu, Result<PreparedScene, PrepareError>) {
        let gpu = renderer_gpu();
        let renderer = Renderer::new(&gpu, &ShadowMapDescriptor::default(), 1).expect("a renderer");
        let prepared = PreparedScene::new(&gpu, renderer.material_layout(), scene);
        (gpu, prepared)
    }

    #[test]
    fn gpu_rays_that_are_there_follow_the_pose_as_new_ones_would() {
        let (gpu, prepared) = prepared(default_scene());
        let mut prepared = prepared.expect("the default scene");
        let corners =
            |rays: &SceneRays| -> Vec<_> { (0..rays.tracer.len()).map(|i| rays.tracer.corners(i as u32)).collect() };
        let rest = corners(prepared.rays());
        prepared.set_time(&gpu, 0, 0.8);
        let anew = SceneRays::from_origin(prepared.scene(), prepared.pose(), prepared.origin());
        assert_eq!(corners(prepared.rays()), corners(&anew));
        assert_ne!(corners(prepared.rays()), rest, "the figure walks");
        let vertices =
            |rays: &SceneRays| -> Vec<_> { (0..rays.tracer.len()).map(|i| rays.tracer.normal(i as u32)).collect() };
        assert_eq!(vertices(prepared.rays()), vertices(&anew));
    }

    #[test]
    fn a_scene_can_be_made_on_one_thread_and_used_on_another() {
        fn assert_send<T: Send>() {}
        assert_send::<PreparedScene>();
        assert_send::<Result<PreparedScene, PrepareError>>();
    }

    #[test]
    fn gpu_a_scene_is_made_without_rays_and_only_another_pose_makes_them_late() {
        let (gpu, prepared) = prepared(default_scene());
        let mut prepared = prepared.expect("the default scene");
        assert!(prepared.latest_rays().is_none());
        prepared.request_rays();
        prepared.rays();
        let is_ready = |prepared: &PreparedScene| prepared.ready_rays().is_some();
        assert!(is_ready(&prepared));
        let animation_that_is_not_there = 99;
        prepared.set_time(&gpu, animation_that_is_not_there, 1.0);
        assert!(is_ready(&prepared), "it is the same pose");
        prepared.set_time(&gpu, 0, 0.8);
        assert!(!is_ready(&prepared) && prepared.latest_rays().is_some_and(|(_, is_present)| !is_present));
    }

    #[test]
    fn gpu_a_scene_without_triangles_is_refused_by_its_name() {
        let scene = Scene::from_objects("bare", &[]);
        assert_eq!(prepared(scene).1.expect_err("nothing to draw"), PrepareError::NothingToDraw("bare".to_owned()));
    }

    #[test]
    fn gpu_blended_surfaces_cast_where_they_are_opaque_unless_they_never_do() {
        let mut scene = default_scene();
        for material in &mut scene.materials {
            material.alpha = AlphaMode::Blend;
        }
        let (gpu, prepared) = prepared(scene);
        let mut prepared = prepared.expect("the default scene");
        let renderer = Renderer::new(&gpu, &ShadowMapDescriptor::default(), 1).expect("a renderer");
        let triangles = prepared.triangles();
        for (blended, casting) in [(BlendedCasters::Never, 0), (BlendedCasters::WhereOpaque, triangles)] {
            prepared.set_blended_casters(&gpu, renderer.material_layout(), blended).expect("memory");
            assert_eq!((prepared.triangles(), prepared.casting_triangles()), (triangles, casting));
            assert_eq!(prepared.rays().tracer.len() as u64, casting);
            let casters = prepared.gpu_scene.casters().moves.len();
            assert_eq!(casters == 0, casting == 0, "{casters} casters");
        }
    }
}
