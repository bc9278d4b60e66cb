//! Meshes and their instances on the GPU, in buffers that all shaders read.

use std::collections::HashMap;
use std::ops::Range;

use glam::{DVec3, Vec3};
use shadowfit_gpu::bindings;

use super::deform::{Deforming, RefitPass, Refitted, VertexBuffer};
use super::device::{BUFFERS, LABEL, caught, check};
use super::instance::RayInstance;
use super::placed::{MeshId, Meshes, Placed};
use super::pool::{Pool, Records};
use super::ranges::MeshRanges;
use super::top::{Instance, TopLevel};
use crate::STACK;
use crate::cut_out::{AlphaImage, ImageId};
use crate::error::RayError;
use crate::hierarchy::WIDTH;
use crate::mesh::RayMesh;
use crate::records::{CutOutRecord, InstanceRecord, NodeRecord, TriangleRecord};

/// The meshes of an engine and their instances in a frame, for shaders with [`rays_wgsl`](crate::rays_wgsl).
///
/// Adding meshes or images, and setting more instances, may replace the buffers. Make these changes after
/// earlier recorded refits were submitted, and before you record passes that bind [`Self::group`].
#[derive(Debug)]
pub struct RayScene {
    device: wgpu::Device,
    queue: wgpu::Queue,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    /// The bound buffers, in the order of the bindings.
    bound: [wgpu::Buffer; BUFFERS],
    /// Place of the nodes of instances, except the first group.
    top_nodes: Range<u32>,
    instance_records: Records,
    nodes: Pool,
    triangles: Pool,
    cut_outs: Pool,
    images: Pool,
    image_ranges: HashMap<ImageId, Range<u32>>,
    /// Number of images that were ever added.
    images_added: u32,
    meshes: Meshes,
    refit: Option<RefitPass>,
    origin: DVec3,
    instances: Vec<RayInstance>,
    top: TopLevel,
    /// Longest stack of the meshes of the instances.
    mesh_stack: usize,
    /// Instances that differ from the last frame. Kept so that frames do not allocate.
    changed: Vec<u32>,
    uploaded: u64,
}

impl RayScene {
    /// Returns an empty scene, which blocks no ray.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::Unsupported`] if the device has no compute shaders or too few storage buffers, and
    /// [`RayError::Device`] if it is out of memory.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, RayError> {
        check(&device.limits())?;
        let instance_records = Records::new::<InstanceRecord>(device, queue, "instances")?;
        let mut nodes = Pool::new::<NodeRecord>(device, queue, "nodes")?;
        // Shaders read the root of the instances from the beginning of the buffer.
        nodes.take(WIDTH)?;
        let top_nodes = nodes.take(TopLevel::room(1))?;
        let triangles = Pool::new::<TriangleRecord>(device, queue, "triangles")?;
        let cut_outs = Pool::new::<CutOutRecord>(device, queue, "cut-outs")?;
        let images = Pool::new::<u32>(device, queue, "cut-out images")?;
        let pools = [&nodes, &triangles, &cut_outs, &images].map(|pool| pool.records.buffer());
        let bound = [pools[0], instance_records.buffer(), pools[1], pools[2], pools[3]];
        let bound = bound.map(Clone::clone);
        let layout = caught(device, || rays_layout(device))?;
        let group = caught(device, || bind(device, &layout, &bound))?;
        let mut scene = Self {
            device: device.clone(),
            queue: queue.clone(),
            layout,
            group,
            bound,
            top: TopLevel::new(&[], 0, top_nodes.start)?,
            top_nodes,
            instance_records,
            nodes,
            triangles,
            cut_outs,
            images,
            image_ranges: HashMap::new(),
            images_added: 0,
            meshes: Meshes::default(),
            refit: None,
            origin: DVec3::ZERO,
            instances: Vec::new(),
            mesh_stack: 0,
            changed: Vec::new(),
            uploaded: 0,
        };
        scene.upload();
        Ok(scene)
    }

    /// Uploads a mesh, for any number of instances.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::TooDeep`], [`RayError::TooLarge`], and [`RayError::Device`] if the device is out
    /// of memory.
    pub fn add_mesh(&mut self, mesh: &RayMesh) -> Result<MeshId, RayError> {
        let placed = self.place(mesh)?;
        Ok(self.meshes.add(placed))
    }

    /// Uploads a mesh whose vertices [`Self::refit`] will move. It has its built shape before the first
    /// refit. Characters need separate meshes if their poses differ. `bounds` are the least and greatest
    /// corner of a box that holds all poses, in the space of the mesh.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Self::add_mesh`], and [`RayError::Bounds`].
    pub fn add_deforming_mesh(&mut self, mesh: &RayMesh, bounds: [Vec3; 2]) -> Result<MeshId, RayError> {
        let [least, most] = bounds;
        if !(least.is_finite() && most.is_finite() && least.cmple(most).all()) {
            return Err(RayError::Bounds { least, most });
        }
        let placed = self.place(mesh)?;
        let made = caught(&self.device, || {
            self.refit.get_or_insert_with(|| RefitPass::new(&self.device));
            Deforming::new(&self.device, &self.queue, mesh, &placed.ranges)
        });
        match made {
            Ok(deforming) => Ok(self.meshes.add(Placed { bounds, deforming: Some(deforming), ..placed })),
            Err(error) => {
                self.give(&placed.ranges);
                Err(error)
            }
        }
    }

    /// Replaces the shape of a mesh, and so of all its instances, for meshes that the CPU deforms or edits.
    /// The mesh keeps its place if the numbers of nodes, triangles and cut-outs are unchanged. A deforming
    /// mesh becomes a rigid one.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::NoMesh`] and the errors of [`Self::add_mesh`]. On an error the mesh keeps its old
    /// shape.
    pub fn update_mesh(&mut self, id: MeshId, mesh: &RayMesh) -> Result<(), RayError> {
        self.uploaded = 0;
        let stack = mesh.hierarchy.stack;
        if self.top.stack() + stack > STACK {
            return Err(RayError::TooDeep { top: self.top.stack(), mesh: stack, limit: STACK });
        }
        let before = self.meshes.get(id).ok_or(RayError::NoMesh)?;
        let bounds = mesh.bounds().unwrap_or_default();
        let before = before.ranges.clone();
        let placed = if before.fit(mesh) {
            self.write(mesh, &before);
            Placed { ranges: before, stack, bounds, deforming: None }
        } else {
            let placed = self.place(mesh)?;
            self.give(&before);
            placed
        };
        let root = placed.ranges.root();
        if let Some(stored) = self.meshes.get_mut(id) {
            *stored = placed;
        }
        self.mesh_stack = self.mesh_stack.max(stack);
        for (index, instance) in self.instances.iter().enumerate().filter(|(_, instance)| instance.mesh == id) {
            self.top.set(index, instance.placed(root, bounds));
        }
        self.top.refit(self.mesh_stack);
        self.upload();
        Ok(())
    }

    /// Removes a mesh. Its remaining instances do not block rays. The next [`Self::set_instances`] must not
    /// contain them.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::NoMesh`] if it is not in the scene.
    pub fn remove_mesh(&mut self, mesh: MeshId) -> Result<(), RayError> {
        let placed = self.meshes.remove(mesh).ok_or(RayError::NoMesh)?;
        self.give(&placed.ranges);
        for index in 0..self.instances.len() {
            if self.instances[index].mesh == mesh {
                // Makes it differ from the next instance in its place.
                self.instances[index].mesh = MeshId::NONE;
                self.top.set(index, None);
            }
        }
        self.upload();
        Ok(())
    }

    /// Uploads an image, for the cut-outs of meshes that are built later.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::TooLarge`], and [`RayError::Device`] if the device is out of memory.
    pub fn add_image(&mut self, image: AlphaImage<'_>) -> Result<ImageId, RayError> {
        let words = image.words();
        let taken = self.images.take(words.len());
        self.rebind()?;
        let range = taken?;
        self.images.records.write_all(range.start, words.into_iter());
        self.images_added += 1;
        let id = ImageId { first: range.start, generation: self.images_added };
        self.image_ranges.insert(id, range);
        Ok(id)
    }

    /// Removes an image. First remove the meshes whose cut-outs use it, because they would read another
    /// image.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::NoImage`] if it is not in the scene.
    pub fn remove_image(&mut self, image: ImageId) -> Result<(), RayError> {
        let range = self.image_ranges.remove(&image).ok_or(RayError::NoImage)?;
        self.images.give(range);
        Ok(())
    }

    /// Sets the instances of a frame. Their transforms are relative to `origin` (world space, metres), which
    /// should be near the camera. Rays never hit instances whose transform is singular or not finite.
    ///
    /// Call it in every frame. Without changes it uploads nothing. If instances have moved, it refits the
    /// boxes of the hierarchy without allocating. It rebuilds the hierarchy of instances if their number has
    /// changed, or if a ray would cost much more than after the last build.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::NoMeshOfInstance`], [`RayError::TooDeep`], [`RayError::TooLarge`], and
    /// [`RayError::Device`] if the device is out of memory. On an error the instances of the previous frame
    /// stay.
    pub fn set_instances(&mut self, origin: DVec3, instances: &[RayInstance]) -> Result<(), RayError> {
        self.uploaded = 0;
        let fits = instances.len() == self.instances.len() && self.find_changed(instances)?;
        if !fits {
            self.replace_instances(instances)?;
        } else if !self.changed.is_empty() {
            self.move_instances(instances);
        }
        self.origin = origin;
        Ok(())
    }

    /// Records the passes that fit a deforming mesh to positions in the engine's vertex buffer. The positions
    /// must be written before these passes run, for example by earlier passes of this encoder. Refit a mesh
    /// at most once per submission. Vertices are in the order of the positions that the mesh was built from.
    ///
    /// # Errors
    ///
    /// Returns [`RayError::NoMesh`], [`RayError::NotDeforming`], [`RayError::Vertices`], and
    /// [`RayError::TooLarge`]. On an error it records no pass.
    pub fn refit(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        mesh: MeshId,
        vertices: &VertexBuffer<'_>,
    ) -> Result<(), RayError> {
        let placed = self.meshes.get_mut(mesh).ok_or(RayError::NoMesh)?;
        let (Some(deforming), Some(refit)) = (&mut placed.deforming, &self.refit) else {
            return Err(RayError::NotDeforming);
        };
        let scene = Refitted { triangles: self.triangles.records.buffer(), nodes: self.nodes.records.buffer() };
        refit.record(&self.device, &self.queue, encoder, deforming, &scene, vertices)
    }

    /// Returns the layout of the bind group: five storage buffers for compute and fragment shaders.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// Returns the bind group that [`rays_wgsl`](crate::rays_wgsl) reads.
    pub fn group(&self) -> &wgpu::BindGroup {
        &self.group
    }

    /// Returns the origin of instances and rays, in world space, in metres.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Returns the least and greatest corner of a box that holds all instances, in world axes, in metres,
    /// relative to the origin. `None` if rays cannot hit any instance.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        self.top.bounds()
    }

    /// Returns the number of instances.
    pub fn instances(&self) -> usize {
        self.instances.len()
    }

    /// Returns the number of triangles of all meshes. A mesh with several instances counts once.
    pub fn triangles(&self) -> u64 {
        self.meshes.iter().map(|mesh| mesh.ranges.triangles.len() as u64).sum()
    }

    /// Returns the range of a mesh's triangles among all triangles of the scene, in leaf order. `None` if the
    /// mesh is not in the scene.
    pub fn slots(&self, mesh: MeshId) -> Option<Range<u32>> {
        self.meshes.get(mesh).map(|mesh| mesh.ranges.triangles.clone())
    }

    /// Returns the bytes on the GPU.
    pub fn bytes(&self) -> u64 {
        let deforming = self.meshes.iter().filter_map(|mesh| mesh.deforming.as_ref());
        self.bound.iter().map(wgpu::Buffer::size).chain(deforming.map(Deforming::bytes)).sum()
    }

    /// Returns the bytes that the last [`Self::set_instances`] uploaded.
    pub fn uploaded(&self) -> u64 {
        self.uploaded
    }

    /// Finds the instances that differ from the previous frame, which has the same number of instances.
    /// Returns whether the hierarchy of instances can be kept. It cannot if rays could exceed the stack.
    fn find_changed(&mut self, instances: &[RayInstance]) -> Result<bool, RayError> {
        self.changed.clear();
        let mut mesh_stack = self.mesh_stack;
        for (index, (instance, before)) in instances.iter().zip(&self.instances).enumerate() {
            if instance != before {
                let mesh = self.meshes.get(instance.mesh).ok_or(RayError::NoMeshOfInstance(index))?;
                mesh_stack = mesh_stack.max(mesh.stack);
                self.changed.push(index as u32);
            }
        }
        let fits = self.top.stack() + mesh_stack <= STACK;
        if fits {
            self.mesh_stack = mesh_stack;
        }
        Ok(fits)
    }

    /// Moves the changed instances.
    fn move_instances(&mut self, instances: &[RayInstance]) {
        for index in &self.changed {
            let index = *index as usize;
            let instance = &instances[index];
            let placed =
                self.meshes.get(instance.mesh).and_then(|mesh| instance.placed(mesh.ranges.root(), mesh.bounds));
            self.top.set(index, placed);
            self.instances[index] = *instance;
        }
        self.top.refit(self.mesh_stack);
        self.upload();
    }

    /// Replaces all instances.
    fn replace_instances(&mut self, instances: &[RayInstance]) -> Result<(), RayError> {
        let mut mesh_stack = 0;
        let placed: Result<Vec<Instance>, RayError> = instances
            .iter()
            .enumerate()
            .map(|(index, instance)| {
                let mesh = self.meshes.get(instance.mesh).ok_or(RayError::NoMeshOfInstance(index))?;
                mesh_stack = mesh_stack.max(mesh.stack);
                Ok(instance.placed(mesh.ranges.root(), mesh.bounds))
            })
            .collect();
        let placed = placed?;
        let top_nodes = self.nodes.take(TopLevel::room(placed.len()))?;
        let made = TopLevel::new(&placed, mesh_stack, top_nodes.start)
            .and_then(|top| self.instance_records.reserve(top.records()).map(|()| top));
        let bound = self.rebind();
        match bound.and(made) {
            Ok(top) => self.top = top,
            Err(error) => {
                self.nodes.give(top_nodes);
                return Err(error);
            }
        }
        self.mesh_stack = mesh_stack;
        self.nodes.give(std::mem::replace(&mut self.top_nodes, top_nodes));
        self.instances.clear();
        self.instances.extend_from_slice(instances);
        self.upload();
        Ok(())
    }

    fn upload(&mut self) {
        self.uploaded += self.top.upload(&self.nodes.records, &self.instance_records);
    }

    /// Allocates room for a mesh and uploads it.
    fn place(&mut self, mesh: &RayMesh) -> Result<Placed, RayError> {
        let stack = mesh.hierarchy.stack;
        if stack > STACK {
            return Err(RayError::TooDeep { top: 0, mesh: stack, limit: STACK });
        }
        let mut ranges = MeshRanges::default();
        let taken = self.take(mesh, &mut ranges).and_then(|()| self.rebind());
        if let Err(error) = taken {
            self.give(&ranges);
            // Some buffers may have been replaced by larger ones. Bind these.
            self.rebind()?;
            return Err(error);
        }
        self.write(mesh, &ranges);
        Ok(Placed { ranges, stack, bounds: mesh.bounds().unwrap_or_default(), deforming: None })
    }

    /// Uploads a mesh to its ranges.
    fn write(&self, mesh: &RayMesh, ranges: &MeshRanges) {
        let nodes = mesh.hierarchy.nodes.iter().map(|node| {
            let base = if node.count > 0 { ranges.triangles.start } else { ranges.nodes.start };
            if node.is_none() { *node } else { NodeRecord { first: base + node.first, ..*node } }
        });
        let triangles = mesh.triangles.iter().map(|triangle| {
            let base = if triangle.cut_out > 0 { ranges.cut_outs.start } else { 0 };
            TriangleRecord { cut_out: base + triangle.cut_out, ..*triangle }
        });
        self.nodes.records.write_all(ranges.nodes.start, nodes);
        self.triangles.records.write_all(ranges.triangles.start, triangles);
        self.cut_outs.records.write_all(ranges.cut_outs.start, mesh.cut_outs.iter().copied());
    }

    /// Takes ranges in the three buffers. On an error, `ranges` has the ranges taken so far.
    fn take(&mut self, mesh: &RayMesh, ranges: &mut MeshRanges) -> Result<(), RayError> {
        ranges.nodes = self.nodes.take(mesh.hierarchy.nodes.len())?;
        ranges.triangles = self.triangles.take(mesh.triangles.len())?;
        ranges.cut_outs = self.cut_outs.take(mesh.cut_outs.len())?;
        Ok(())
    }

    /// Returns the ranges of a mesh to the pools.
    fn give(&mut self, ranges: &MeshRanges) {
        self.nodes.give(ranges.nodes.clone());
        self.triangles.give(ranges.triangles.clone());
        self.cut_outs.give(ranges.cut_outs.clone());
    }

    /// Recreates the bind group if a buffer was replaced.
    fn rebind(&mut self) -> Result<(), RayError> {
        let pools = [&self.nodes, &self.triangles, &self.cut_outs, &self.images].map(|pool| pool.records.buffer());
        let now = [pools[0], self.instance_records.buffer(), pools[1], pools[2], pools[3]];
        if self.bound.each_ref() != now {
            let bound = now.map(Clone::clone);
            self.group = caught(&self.device, || bind(&self.device, &self.layout, &bound))?;
            self.bound = bound;
        }
        Ok(())
    }
}

/// Returns the layout of [`RayScene::group`], for pipelines that are created before a scene.
pub fn rays_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
    bindings::layout(device, LABEL, stages, &[bindings::storage(true); BUFFERS])
}

fn bind(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, buffers: &[wgpu::Buffer; BUFFERS]) -> wgpu::BindGroup {
    bindings::group(device, LABEL, layout, &buffers.each_ref().map(wgpu::Buffer::as_entire_binding))
}
