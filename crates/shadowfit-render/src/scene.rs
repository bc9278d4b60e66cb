//! A scene on the GPU: its parts, its materials, and for each frame the instances that each pass draws.
//! Deformed primitives (skins, morph targets) are deformed on the CPU, so that ray tracers use exactly the
//! same triangles.

use core::sync::atomic::{AtomicU64, Ordering};
use std::collections::HashMap;

use bytemuck::cast_slice;
use glam::{DVec3, Mat4, Vec3};
use shadowfit::Aabb;
use shadowfit_rays::{RayError, RayScene};
use shadowfit_scene::{Casting, Deformed, Instance, Pose, Scene};
use shadowfit_wgpu::Casters;

use crate::casters::{CasterDraw, SceneCasters, transformed};
use crate::maker::INSTANCES;
use crate::material::upload_materials;
use crate::part::{Part, PartKey, TwinKey};
use crate::rays::{RayPart, SceneRays};
use crate::uniform::InstanceData;
use crate::upload::Upload;
use crate::{DeviceFault, Gpu};

/// A scene that can be drawn.
#[derive(Debug)]
pub struct GpuScene {
    pub(crate) parts: Vec<Part>,
    pub(crate) materials: Vec<wgpu::BindGroup>,
    instances: Vec<SceneInstance>,
    casters: SceneCasters,
    /// Origin of the current frame's positions, in world space, in metres.
    eye: DVec3,
    /// Bounds of all instances, relative to the eye.
    boxes: Vec<shadowfit::Aabb>,
    data: Vec<InstanceData>,
    /// [`InstanceData::first_map`] of each instance, in frames that show it; otherwise empty.
    first_maps: Vec<u32>,
    pub(crate) instance_buffer: wgpu::Buffer,
    /// Number of the pose, unique among all poses of all scenes.
    pose: u64,
    /// Created when edges are first traced.
    rays: Option<SceneRays>,
}

/// Smallest side of textures that are halved to save memory, in texels. Smaller ones take almost no memory.
const LEAST_TEXTURE: u32 = 32;

/// Next unused pose number.
static POSES: AtomicU64 = AtomicU64::new(0);

#[derive(Clone, Copy, Debug)]
struct SceneInstance {
    instance: Instance,
    /// Number of its first triangle, counting only surfaces that cast.
    first_triangle: u32,
    world_from_mesh: Mat4,
    bounds: Aabb,
}

/// A draw call: a part and a range of the instance buffer.
#[derive(Clone, Debug)]
pub struct Draw {
    /// Key of its pipeline.
    pub key: PartKey,
    pub(crate) part: usize,
    pub(crate) instances: core::ops::Range<u32>,
    /// Distance from the eye to the nearest instance's centre, for sorting blended parts.
    pub(crate) distance: f32,
}

impl GpuScene {
    /// Uploads a scene in a pose. `layout` is [`material_layout`](crate::passes::material_layout).
    ///
    /// # Errors
    ///
    /// [`DeviceFault`] if the device is out of memory.
    pub fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout, scene: &Scene, pose: &Pose) -> Result<Self, DeviceFault> {
        Self::with_textures(gpu, layout, scene, pose, u32::MAX)
    }

    /// Uploads a scene, with textures halved until it fits into the device's memory. Also returns the
    /// resulting limit of a texture's side, in texels, if any textures were halved.
    ///
    /// # Errors
    ///
    /// [`DeviceFault`] if the triangles alone need too much memory.
    pub fn within_memory(
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        scene: &Scene,
        pose: &Pose,
    ) -> Result<(Self, Option<u32>), DeviceFault> {
        let make = |side| Self::with_textures(gpu, layout, scene, pose, side);
        let fault = match make(u32::MAX) {
            Ok(made) => return Ok((made, None)),
            Err(fault) => fault,
        };
        let largest = scene.images.iter().map(|image| image.width.max(image.height)).max().unwrap_or(0);
        let mut side = largest.next_power_of_two() / 2;
        while matches!(fault, DeviceFault::OutOfMemory(_)) && side >= LEAST_TEXTURE {
            // Failed attempts are freed only once the device is done with them.
            gpu.submit([]);
            let _ = gpu.device.poll(wgpu::PollType::wait_indefinitely());
            if let Ok(made) = make(side) {
                return Ok((made, Some(side)));
            }
            side /= 2;
        }
        Err(fault)
    }

    fn with_textures(
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        scene: &Scene,
        pose: &Pose,
        side: u32,
    ) -> Result<Self, DeviceFault> {
        let upload = Upload::new(gpu);
        let instances: Vec<Instance> = scene.instances();
        let parts = parts(&upload, scene, pose, &instances);
        let count = instances.len();
        let casters = casters(scene, &instances, &parts);
        let gpu_scene = Self {
            parts,
            materials: upload_materials(&upload, layout, scene, side),
            instances: numbered(scene, instances),
            casters,
            eye: DVec3::ZERO,
            boxes: Vec::new(),
            data: Vec::new(),
            first_maps: Vec::new(),
            instance_buffer: instance_buffer(&gpu.device, count.max(1)),
            pose: 0,
            rays: None,
        };
        let mut gpu_scene = upload.result(gpu_scene)?;
        gpu_scene.set_pose(gpu, scene, pose);
        Ok(gpu_scene)
    }

    /// Moves all instances to a pose of the same scene.
    pub fn set_pose(&mut self, gpu: &Gpu, scene: &Scene, pose: &Pose) {
        self.pose = POSES.fetch_add(1, Ordering::Relaxed);
        for part in &self.parts {
            for &member in &part.members {
                let entry = &mut self.instances[member];
                entry.world_from_mesh = pose.world_from_instance(scene, &entry.instance);
                let local = match pose.deform(scene, &entry.instance) {
                    Some(deformed) => {
                        let Deformed { positions, normals, tangents } = &deformed;
                        let streams: [&[u8]; 3] = [cast_slice(positions), cast_slice(normals), cast_slice(tangents)];
                        for (buffer, stream) in part.streams.iter().zip(streams) {
                            gpu.queue.write_buffer(buffer, 0, stream);
                        }
                        if let Some(unrolled) = &part.unrolled {
                            let primitive = &scene.meshes[entry.instance.mesh].primitives[entry.instance.primitive];
                            unrolled.write(gpu, &primitive.indices, streams);
                        }
                        Aabb::from_points(deformed.positions)
                    }
                    None => part.local_bounds,
                };
                entry.bounds = local.map_or(Aabb::EMPTY, |local| transformed(&local, &entry.world_from_mesh));
            }
        }
        let (parts, instances) = (&self.parts, &self.instances);
        self.casters.set_boxes(|part, instance, cluster| {
            let (clusters, instance) = (&parts[part].clusters, &instances[instance]);
            // A deforming part is one cluster, with the bounds of its pose.
            if clusters.len() == 1 {
                instance.bounds
            } else {
                transformed(&clusters[cluster].bounds, &instance.world_from_mesh)
            }
        });
        // If rays cannot follow the pose, edges are not traced.
        if self.rays.is_some() && self.pose_rays(gpu).is_err() {
            self.rays = None;
        }
    }

    /// Prepares the casters for rays on the GPU, unless they are prepared. `origin` is the world position
    /// near the scene that they are relative to, in metres. `scene` must be the scene that this was created
    /// from.
    ///
    /// # Errors
    ///
    /// [`RayError`] if the scene is too large for the device, or the device lacks compute shaders.
    pub fn make_rays(&mut self, gpu: &Gpu, scene: &Scene, origin: DVec3) -> Result<(), RayError> {
        if self.rays.is_some() {
            return Ok(());
        }
        let part = |part: &Part| {
            let instance = &self.instances[part.members[0]].instance;
            let primitive = &scene.meshes[instance.mesh].primitives[instance.primitive];
            RayPart { primitive, deforms: part.deforms }
        };
        self.rays = Some(SceneRays::new(gpu, scene, origin, self.parts.iter().map(part))?);
        let posed = self.pose_rays(gpu);
        if posed.is_err() {
            self.rays = None;
        }
        posed
    }

    /// Returns the casters for rays, if they were [prepared](Self::make_rays).
    pub fn rays(&self) -> Option<&RayScene> {
        self.rays.as_ref().map(|rays| &rays.scene)
    }

    /// Moves the casters for rays to the current pose.
    fn pose_rays(&mut self, gpu: &Gpu) -> Result<(), RayError> {
        let Some(rays) = &mut self.rays else { return Ok(()) };
        let (parts, instances) = (&self.parts, &self.instances);
        let of_part = |(index, part): (usize, &Part)| part.members.iter().map(move |member| (index, *member)).collect();
        let members = parts.iter().enumerate().flat_map(|part| -> Vec<(usize, usize)> { of_part(part) });
        rays.set_instances(members.map(|(part, member)| {
            let instance = &instances[member];
            (part, instance.world_from_mesh, parts[part].deforms.then_some(instance.bounds))
        }))?;
        let deformed = parts.iter().enumerate().filter(|(_, part)| part.deforms);
        rays.refit(gpu, deformed.map(|(index, part)| (index, &part.streams[0])))
    }

    /// Returns the number of the current pose, unique among all poses of all scenes.
    pub fn pose(&self) -> u64 {
        self.pose
    }

    /// Starts a frame's instance list, for positions relative to `eye` (world space, metres).
    pub fn begin_frame(&mut self, eye: DVec3) {
        self.data.clear();
        self.first_maps.clear();
        self.eye = eye;
        let relative = |point: Vec3| (point.as_dvec3() - eye).as_vec3();
        let boxes = self.instances.iter().map(|instance| instance.bounds);
        self.boxes.clear();
        self.boxes.extend(boxes.map(|bounds| shadowfit::Aabb::new(relative(bounds.min), relative(bounds.max))));
    }

    /// Returns all casters, by number, in world space. Nodes with an animation, and their descendants, count
    /// as moving.
    pub fn casters(&self) -> Casters<'_> {
        self.casters.by_number()
    }

    /// Sets which maps hold the casters of this frame. Bit i of a caster's mask means map i.
    pub(crate) fn set_maps_by_caster(&mut self, masks: &[u8]) {
        self.first_maps.clear();
        self.first_maps.resize(self.instances.len(), 0);
        let mut of_instances = vec![None; self.instances.len()];
        self.casters.merge_masks(masks, &mut of_instances);
        for (stored, mask) in self.first_maps.iter_mut().zip(of_instances) {
            *stored = match mask {
                None => 0,
                Some(0) => 1,
                Some(mask) => 2 + u8::trailing_zeros(mask),
            };
        }
    }

    /// Adds casters, nearest to the light first, and returns their draws.
    pub(crate) fn caster_draws(&mut self, numbers: &[u32], draws: &mut Vec<CasterDraw>) {
        let Self { parts, instances, casters, data, eye, .. } = self;
        let indices = |part: usize, cluster: usize| parts[part].clusters[cluster].indices.clone();
        let add = |instance: usize| {
            let SceneInstance { world_from_mesh, first_triangle, .. } = &instances[instance];
            data.push(instance_data(world_from_mesh, *eye, *first_triangle));
            data.len() - 1
        };
        casters.draws(numbers, indices, add, draws);
    }

    /// Adds the instances inside a frustum, and returns their draws. Opaque parts are sorted nearest first,
    /// so that hidden surfaces are not shaded, and blended parts farthest first. `clip_from_world` applies to
    /// positions relative to the frame's eye.
    pub fn seen(&mut self, clip_from_world: Mat4) -> [Vec<Draw>; 2] {
        let keep = in_frustum(clip_from_world);
        let mut opaque = self.visible(&keep, |part| !part.is_blended());
        opaque.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let mut blended = self.visible(&keep, Part::is_blended);
        blended.sort_by(|a, b| b.distance.total_cmp(&a.distance));
        [opaque, blended]
    }

    /// Adds the instances of a pass, and returns its draws. `keep` is called with an instance's bounds
    /// relative to the frame's eye.
    fn visible(&mut self, keep: impl Fn(&shadowfit::Aabb) -> bool, takes: impl Fn(&Part) -> bool) -> Vec<Draw> {
        let mut draws = Vec::new();
        for (part_index, part) in self.parts.iter().enumerate().filter(|(_, part)| takes(part)) {
            let start = self.data.len() as u32;
            let mut distance = f32::INFINITY;
            for &member in &part.members {
                let (instance, bounds) = (&self.instances[member], &self.boxes[member]);
                if !bounds.is_empty() && keep(bounds) {
                    distance = distance.min(((bounds.min + bounds.max) * 0.5).length());
                    let data = instance_data(&instance.world_from_mesh, self.eye, instance.first_triangle);
                    let first_map = self.first_maps.get(member).copied().unwrap_or(0);
                    self.data.push(InstanceData { first_map, ..data });
                }
            }
            let instances = start..self.data.len() as u32;
            if !instances.is_empty() {
                draws.push(Draw { key: PartKey::of(part), part: part_index, instances, distance });
            }
        }
        draws
    }

    /// Adds all instances whose node satisfies `wants`, and returns their draws. Blended surfaces are left
    /// out.
    pub fn drawn_of(&mut self, wants: impl Fn(usize) -> bool) -> Vec<Draw> {
        let mut draws = Vec::new();
        for (part_index, part) in self.parts.iter().enumerate().filter(|(_, part)| !part.is_blended()) {
            let start = self.data.len() as u32;
            let members = part.members.iter().map(|member| &self.instances[*member]);
            let wanted = members.filter(|member| wants(member.instance.node));
            self.data
                .extend(wanted.map(|member| instance_data(&member.world_from_mesh, self.eye, member.first_triangle)));
            let instances = start..self.data.len() as u32;
            if !instances.is_empty() {
                draws.push(Draw { key: PartKey::of(part), part: part_index, instances, distance: 0.0 });
            }
        }
        draws
    }

    /// Draws a part. Sets its material as a bind group if a group is given.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>, draw: &Draw, material_group: Option<u32>) {
        let part = &self.parts[draw.part];
        if let Some(group) = material_group {
            pass.set_bind_group(group, &self.materials[part.material], &[]);
        }
        for (stream, slot) in part.streams.iter().zip(0..) {
            pass.set_vertex_buffer(slot, stream.slice(..));
        }
        pass.set_vertex_buffer(INSTANCES, self.instance_buffer.slice(..));
        pass.set_index_buffer(part.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..part.index_count, 0, draw.instances.clone());
    }

    /// Draws a part of a probe, with its material as a bind group, with a pipeline for its
    /// [`Numbering`](crate::unrolled::Numbering).
    pub fn draw_probed(&self, pass: &mut wgpu::RenderPass<'_>, draw: &Draw, material_group: u32) {
        let part = &self.parts[draw.part];
        let Some(unrolled) = &part.unrolled else { return self.draw(pass, draw, Some(material_group)) };
        pass.set_bind_group(material_group, &self.materials[part.material], &[]);
        pass.set_vertex_buffer(INSTANCES, self.instance_buffer.slice(..));
        unrolled.draw(pass, &part.streams, draw.instances.clone());
    }

    /// Uploads the frame's instance list.
    pub fn end_frame(&mut self, gpu: &Gpu) {
        let bytes: &[u8] = cast_slice(&self.data);
        if bytes.len() as u64 > self.instance_buffer.size() {
            self.instance_buffer = instance_buffer(&gpu.device, self.data.len().next_power_of_two());
        }
        gpu.queue.write_buffer(&self.instance_buffer, 0, bytes);
    }

    /// Returns the world bounds of an instance in the current pose, in metres, by its index in
    /// [`Scene::instances`]; `None` if it has no vertices. They hold all its vertices, after deformation. If
    /// its node is rotated, they are larger than the smallest box, because they enclose the rotated box of
    /// the mesh.
    pub fn instance_bounds(&self, index: usize) -> Option<Aabb> {
        let bounds = self.instances.get(index)?.bounds;
        (!bounds.is_empty()).then_some(bounds)
    }

    /// Returns the world bounds of all instances in the current pose, in metres, including blended surfaces;
    /// `None` for a scene without vertices. They are the union of [`Self::instance_bounds`]: they hold every
    /// vertex, but may be larger than necessary.
    pub fn bounds(&self) -> Option<Aabb> {
        self.instances.iter().map(|instance| instance.bounds).filter(|bounds| !bounds.is_empty()).reduce(Aabb::union)
    }
}

/// Uploads the parts of all instances: one for each primitive, and one for each deforming instance.
fn parts(upload: &Upload<'_>, scene: &Scene, pose: &Pose, instances: &[Instance]) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let (mut shared, mut twins) = (HashMap::new(), HashMap::new());
    for (index, instance) in instances.iter().enumerate() {
        let primitive = &scene.meshes[instance.mesh].primitives[instance.primitive];
        let mirrored = pose.is_mirrored(scene, instance);
        let deforms = is_deformed(scene, instance);
        let key = (instance.mesh, instance.primitive, mirrored, if deforms { index } else { usize::MAX });
        let part = *shared.entry(key).or_insert_with(|| {
            let twin = TwinKey::of(scene, primitive);
            let known = twins.get(&twin).filter(|_| !deforms).map(|&known: &usize| &parts[known]);
            let part = known.map(|known| known.twin(scene, primitive, mirrored));
            parts.push(part.unwrap_or_else(|| Part::new(upload, scene, primitive, mirrored, deforms)));
            if !deforms {
                twins.entry(twin).or_insert(parts.len() - 1);
            }
            parts.len() - 1
        });
        parts[part].members.push(index);
    }
    parts
}

/// Returns whether a box relative to the eye may be visible: not completely outside one of the six clip
/// planes (Gribb and Hartmann, 2001).
fn in_frustum(clip_from_world: Mat4) -> impl Fn(&shadowfit::Aabb) -> bool {
    let row = |index| clip_from_world.row(index);
    let planes = [row(3) + row(0), row(3) - row(0), row(3) + row(1), row(3) - row(1), row(2), row(3) - row(2)];
    move |bounds| {
        planes.iter().all(|plane| {
            let normal = plane.truncate();
            let farthest = Vec3::select(normal.cmpge(Vec3::ZERO), bounds.max, bounds.min);
            normal.dot(farthest) + plane.w >= 0.0
        })
    }
}

/// Returns instances with the numbers of their first triangles.
fn numbered(scene: &Scene, instances: Vec<Instance>) -> Vec<SceneInstance> {
    let mut triangles = 0;
    let number = |instance: Instance| {
        let primitive = &scene.meshes[instance.mesh].primitives[instance.primitive];
        let first_triangle = triangles;
        if scene.casting(primitive) != Casting::Nothing {
            triangles += primitive.indices.len() as u32 / 3;
        }
        SceneInstance { instance, first_triangle, world_from_mesh: Mat4::IDENTITY, bounds: Aabb::EMPTY }
    };
    instances.into_iter().map(number).collect()
}

/// Returns the casters of a scene.
fn casters(scene: &Scene, instances: &[Instance], parts: &[Part]) -> SceneCasters {
    let moves = animated(scene);
    let mut casters = SceneCasters::default();
    for (index, part) in parts.iter().enumerate().filter(|(_, part)| part.casts()) {
        for &member in &part.members {
            let moves = moves[instances[member].node] || is_deformed(scene, &instances[member]);
            casters.push(index, member, part.clusters.len(), moves);
        }
    }
    casters
}

/// Returns for each node whether it or an ancestor has an animation.
fn animated(scene: &Scene) -> Vec<bool> {
    let mut moves = vec![false; scene.nodes.len()];
    for channel in scene.animations.iter().flat_map(|animation| &animation.channels) {
        if let Some(moves) = moves.get_mut(channel.node) {
            *moves = true;
        }
    }
    // Parents come before their children.
    for node in 0..moves.len() {
        moves[node] |= scene.nodes[node].parent.is_some_and(|parent| moves[parent]);
    }
    moves
}

fn is_deformed(scene: &Scene, instance: &Instance) -> bool {
    let primitive = &scene.meshes[instance.mesh].primitives[instance.primitive];
    scene.instance_skin(instance).is_some() || !primitive.morphs.is_empty()
}

fn instance_data(world_from_mesh: &Mat4, eye: DVec3, first_triangle: u32) -> InstanceData {
    let translation = (world_from_mesh.w_axis.truncate().as_dvec3() - eye).as_vec3();
    let relative = Mat4 { w_axis: translation.extend(1.0), ..*world_from_mesh };
    InstanceData {
        rows: [relative.row(0).to_array(), relative.row(1).to_array(), relative.row(2).to_array()],
        first_triangle,
        first_map: 0,
        padding: [0; 2],
    }
}

fn instance_buffer(device: &wgpu::Device, count: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("instances"),
        size: (count * size_of::<InstanceData>()) as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use shadowfit::PerspectiveCamera;

    fn keeps(center: Vec3) -> bool {
        let camera = PerspectiveCamera {
            eye: DVec3::ZERO,
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: 1.0,
            aspect: 1.0,
            near: 0.1,
            far: 100.0,
        };
        let keep = in_frustum(camera.clip_from_world(shadowfit::DepthConvention::Reversed));
        keep(&shadowfit::Aabb::new(center - 0.5, center + 0.5))
    }

    #[test]
    fn the_frustum_keeps_what_is_ahead_and_drops_the_rest() {
        assert!(keeps(Vec3::new(0.0, 0.0, -10.0)));
        assert!(keeps(Vec3::new(0.0, 0.0, -100.2)), "across the far plane");
        for outside in [Vec3::Z * 10.0, Vec3::NEG_Z * 101.0, Vec3::new(20.0, 0.0, -10.0), Vec3::new(0.0, -20.0, -10.0)]
        {
            assert!(!keeps(outside), "{outside}");
        }
    }
}
