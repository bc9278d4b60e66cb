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

/// The meshes of an engine and their instances of the frame, for shaders with [`rays_wgsl`](crate::rays_wgsl).
///
/// Adding meshes or images, and setting more instances, may make other buffers: record passes that trace, with
/// [`Self::group`], after it, and submit refits that were recorded before it.
#[derive(Debug)]
pub struct RayScene {
    device: wgpu::Device,
    queue: wgpu::Queue,
    layout: wgpu::BindGroupLayout,
    group: wgpu::BindGroup,
    /// What the group binds, in the order of its bindings.
    bound: [wgpu::Buffer; BUFFERS],
    /// Place of the nodes of instances, but for the first ones.
    top_nodes: Range<u32>,
    instance_records: Records,
    nodes: Pool,
    triangles: Pool,
    cut_outs: Pool,
    images: Pool,
    image_ranges: HashMap<ImageId, Range<u32>>,
    /// Images that were ever added.
    images_added: u32,
    meshes: Meshes,
    refit: Option<RefitPass>,
    origin: DVec3,
    instances: Vec<RayInstance>,
    top: TopLevel,
    /// Longest stack of the meshes of the instances.
    mesh_stack: usize,
    /// Those that differ from the last frame's; kept so that frames do not allocate.
    changed: Vec<u32>,
    uploaded: u64,
}

impl RayScene {
    /// An empty scene, which blocks no ray.
    ///
    /// # Errors
    ///
    /// [`RayError::Unsupported`] if the device has no compute shaders or too few storage buffers.
    /// [`RayError::Device`] if it is out of memory.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, RayError> {
        check(&device.limits())?;
        let instance_records = Records::new::<InstanceRecord>(device, queue, "instances")?;
        let mut nodes = Pool::new::<NodeRecord>(device, queue, "nodes")?;
        // Shaders find the root of the instances at the beginning.
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
    /// [`RayError::TooDeep`], [`RayError::TooLarge`], and [`RayError::Device`] if the device is out of memory.
    pub fn add_mesh(&mut self, mesh: &RayMesh) -> Result<MeshId, RayError> {
        let placed = self.place(mesh)?;
        Ok(self.meshes.add(placed))
    }

    /// Uploads a mesh whose vertices will move, by [`Self::refit`]; until then it has the shape that it was built with.
    /// A character needs a mesh of its own where each has a pose of its own. `bounds` are the least and greatest corner
    /// of a box that holds all poses, in the space of the mesh.
    ///
    /// # Errors
    ///
    /// As [`Self::add_mesh`], and [`RayError::Bounds`].
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

    /// Gives a mesh another shape, which its instances have at once: for what the CPU deforms or edits. Only as many
    /// nodes, triangles and cut-outs take no other room. A deforming mesh keeps its shape from now on.
    ///
    /// # Errors
    ///
    /// [`RayError::NoMesh`], and those of [`Self::add_mesh`]. The mesh has its old shape then.
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

    /// Removes a mesh. What still stands of it blocks nothing, and must be gone from the next [`Self::set_instances`].
    ///
    /// # Errors
    ///
    /// [`RayError::NoMesh`] if it is not in the scene.
    pub fn remove_mesh(&mut self, mesh: MeshId) -> Result<(), RayError> {
        let placed = self.meshes.remove(mesh).ok_or(RayError::NoMesh)?;
        self.give(&placed.ranges);
        for index in 0..self.instances.len() {
            if self.instances[index].mesh == mesh {
                // Differs from whatever is set next.
                self.instances[index].mesh = MeshId::NONE;
                self.top.set(index, None);
            }
        }
        self.upload();
        Ok(())
    }

    /// Uploads an image, for the cut-outs of meshes that are built from now on.
    ///
    /// # Errors
    ///
    /// [`RayError::TooLarge`], and [`RayError::Device`] if the device is out of memory.
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

    /// Removes an image, after the meshes with cut-outs of it: these would read another one.
    ///
    /// # Errors
    ///
    /// [`RayError::NoImage`] if it is not in the scene.
    pub fn remove_image(&mut self, image: ImageId) -> Result<(), RayError> {
        let range = self.image_ranges.remove(&image).ok_or(RayError::NoImage)?;
        self.images.give(range);
        Ok(())
    }

    /// Sets the instances of a frame: their transforms are relative to `origin` (world space, metres), which should be
    /// near what is looked at. Instances whose transform is singular or not finite are never met.
    ///
    /// Made to be called in every frame: it uploads nothing where nothing has changed; where instances have moved, it
    /// fits the boxes above them, without allocating, and builds the hierarchy of instances again where their number has
    /// changed or a ray would cost much more than when it was built.
    ///
    /// # Errors
    ///
    /// [`RayError::NoMeshOfInstance`], [`RayError::TooDeep`], [`RayError::TooLarge`], and [`RayError::Device`] if the
    /// device is out of memory. The instances of the frame before stay then.
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

    /// Records the passes that fit a deforming mesh to positions that the engine has written, or writes earlier in this
    /// encoder. A mesh may be refitted once in a submission. Vertices have the order of the positions that the mesh was
    /// built from.
    ///
    /// # Errors
    ///
    /// [`RayError::NoMesh`], [`RayError::NotDeforming`], [`RayError::Vertices`], and [`RayError::TooLarge`]. Nothing is
    /// recorded then.
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

    /// Layout of the bind group: five storage buffers that compute and fragment shaders read.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The bind group that [`rays_wgsl`](crate::rays_wgsl) reads.
    pub fn group(&self) -> &wgpu::BindGroup {
        &self.group
    }

    /// What instances and rays are relative to, world space, metres.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Least and greatest corner of a box that holds all instances, in world axes, in metres, relative to the origin;
    /// `None` where nothing can be met.
    pub fn bounds(&self) -> Option<[Vec3; 2]> {
        self.top.bounds()
    }

    /// Number of instances.
    pub fn instances(&self) -> usize {
        self.instances.len()
    }

    /// Number of triangles of all meshes, each counted once.
    pub fn triangles(&self) -> u64 {
        self.meshes.iter().map(|mesh| mesh.ranges.triangles.len() as u64).sum()
    }

    /// Where a mesh's triangles lie among those of the scene, in leaf order; `None` if it is not in the scene.
    pub fn slots(&self, mesh: MeshId) -> Option<Range<u32>> {
        self.meshes.get(mesh).map(|mesh| mesh.ranges.triangles.clone())
    }

    /// Bytes on the GPU.
    pub fn bytes(&self) -> u64 {
        let deforming = self.meshes.iter().filter_map(|mesh| mesh.deforming.as_ref());
        self.bound.iter().map(wgpu::Buffer::size).chain(deforming.map(Deforming::bytes)).sum()
    }

    /// Bytes that the last [`Self::set_instances`] uploaded.
    pub fn uploaded(&self) -> u64 {
        self.uploaded
    }

    /// Finds the instances that differ from those of the frame before, which are as many. Returns whether the hierarchy
    /// of these can be kept: not where rays could go deeper than the stack.
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

    /// Moves those that differ.
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

    /// Sets other instances.
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

    /// Finds room for a mesh, and uploads it.
    fn place(&mut self, mesh: &RayMesh) -> Result<Placed, RayError> {
        let stack = mesh.hierarchy.stack;
        if stack > STACK {
            return Err(RayError::TooDeep { top: 0, mesh: stack, limit: STACK });
        }
        let mut ranges = MeshRanges::default();
        let taken = self.take(mesh, &mut ranges).and_then(|()| self.rebind());
        if let Err(error) = taken {
            self.give(&ranges);
            // The buffers that have grown already are the ones to read.
            self.rebind()?;
            return Err(error);
        }
        self.write(mesh, &ranges);
        Ok(Placed { ranges, stack, bounds: mesh.bounds().unwrap_or_default(), deforming: None })
    }

    /// Uploads a mesh where it has its room.
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

    /// Takes room in the three buffers, as far as there is.
    fn take(&mut self, mesh: &RayMesh, ranges: &mut MeshRanges) -> Result<(), RayError> {
        ranges.nodes = self.nodes.take(mesh.hierarchy.nodes.len())?;
        ranges.triangles = self.triangles.take(mesh.triangles.len())?;
        ranges.cut_outs = self.cut_outs.take(mesh.cut_outs.len())?;
        Ok(())
    }

    /// Gives the room of a mesh back.
    fn give(&mut self, ranges: &MeshRanges) {
        self.nodes.give(ranges.nodes.clone());
        self.triangles.give(ranges.triangles.clone());
        self.cut_outs.give(ranges.cut_outs.clone());
    }

    /// Makes the bind group again if a buffer is another one.
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

/// Layout of [`RayScene::group`], for pipelines that are made before there is a scene.
pub fn rays_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
    bindings::layout(device, LABEL, stages, &[bindings::storage(true); BUFFERS])
}

fn bind(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, buffers: &[wgpu::Buffer; BUFFERS]) -> wgpu::BindGroup {
    bindings::group(device, LABEL, layout, &buffers.each_ref().map(wgpu::Buffer::as_entire_binding))
}
