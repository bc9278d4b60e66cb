//! The edge pass: its device requirements, its pipelines, and the recording of a frame.

use shadowfit_gpu::bindings::{UNIFORM, group, layout, storage, texture, uniform_buffer, written_texture};
use shadowfit_gpu::{ReadBackRing, catch_errors, compute_pipeline, make_at_once, wgsl_module};
use shadowfit_rays::RayScene;

use super::any_hit::AnyHit;
use super::error::EdgeError;
use super::group::{COUNTS, FLOATS, Kept, Layouts, SURFACE_GROUPS, Target, factors};
use super::outcome::{EdgeCounts, EdgeOutcome, FallbackReason};
use super::pyramid::{BOUNDS, Pyramids};
use super::shader::{self, Shape};
use super::source::Source;
use super::uniform::EdgeUniform;
use super::view::EdgeView;
use crate::demand::{Unsupported, supported};
use crate::pixels::check;
use crate::uniforms::FadingUniform;
use crate::{ShadowMapDescriptor, SunShadows};

/// Label of the passes and their resources, for graphics debuggers.
const LABEL: &str = "shadowfit edges";
/// Width of a classifying workgroup, in pixels, as in the WGSL.
const SQUARE: u32 = 8;
/// Number of frames whose counts may be on their way back at once: one more than a GPU may lag behind.
const FRAMES: usize = 4;
/// Storage buffers of the pass that traces: the buffers of the rays, and the list.
const STORAGE_BUFFERS: u32 = 6;

/// Pass that computes the shadow factors of a view; see the [module](super). Create one for each view.
#[derive(Debug)]
pub struct EdgePass {
    device: wgpu::Device,
    queue: wgpu::Queue,
    unsupported: Option<Unsupported>,
    any_hit: Option<AnyHit>,
    layouts: Layouts,
    pipelines: Option<Pipelines>,
    uniform: wgpu::Buffer,
    receiver: wgpu::Buffer,
    /// Sampler that gathers the texels of maps, which may wrap around.
    texels: wgpu::Sampler,
    target: Option<Target>,
    /// Created for the first sun with a radius.
    pyramids: Option<Pyramids>,
    /// Bound instead of the pyramids for a sun without a radius.
    no_bounds: wgpu::TextureView,
    /// View and bind group for shaders if no edges are traced: a single pixel that selects the filter.
    nothing: (wgpu::TextureView, wgpu::BindGroup),
    result: EdgeOutcome,
    counts: ReadBackRing<()>,
}

/// Pipelines for one descriptor of maps and one shape of views.
#[derive(Debug)]
struct Pipelines {
    key: (ShadowMapDescriptor, Shape),
    layout: wgpu::BindGroupLayout,
    trace_layout: wgpu::BindGroupLayout,
    classify: wgpu::ComputePipeline,
    arguments: wgpu::ComputePipeline,
    select: wgpu::ComputePipeline,
    surfaces: wgpu::ComputePipeline,
    trace: wgpu::ComputePipeline,
}

/// Bind group layouts that other objects own.
struct PassLayouts<'a> {
    receiver: &'a wgpu::BindGroupLayout,
    rays: &'a wgpu::BindGroupLayout,
    arguments: &'a wgpu::BindGroupLayout,
    select: &'a wgpu::BindGroupLayout,
}

/// Bind groups of a frame. The list of pixels is writable in one and read-only in the others.
struct Groups {
    receiver: wgpu::BindGroup,
    classify: wgpu::BindGroup,
    surfaces: wgpu::BindGroup,
    trace: wgpu::BindGroup,
}

impl EdgePass {
    /// Creates a pass. On devices without compute shaders, and on OpenGL, whose shaders cannot load depth,
    /// all edges are filtered, and [`Self::record`] returns the reason.
    ///
    /// # Errors
    ///
    /// [`EdgeError::Device`] if the device is out of memory.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, EdgeError> {
        Self::with(device, queue, None)
    }

    /// Creates a pass with the engine's own alpha test of ray hits. Devices that cannot trace ignore it.
    ///
    /// # Errors
    ///
    /// [`EdgeError::AnyHit`] for WGSL that is invalid together with the pass's WGSL, and
    /// [`EdgeError::Device`] if the device is out of memory. Whether the layout matches the WGSL and the
    /// device is checked with the first frame.
    pub fn with_any_hit(device: &wgpu::Device, queue: &wgpu::Queue, any_hit: AnyHit) -> Result<Self, EdgeError> {
        let pass = Self::with(device, queue, Some(any_hit))?;
        if pass.unsupported.is_none() {
            let shape = Shape { samples: 1, normals: None };
            let wgsl = shader::trace(&ShadowMapDescriptor::default(), shape, pass.counts_wgsl());
            catch_errors(device, || wgsl_module(device, LABEL, wgsl)).map_err(|error| pass.refused(&error))?;
        }
        Ok(pass)
    }

    fn with(device: &wgpu::Device, queue: &wgpu::Queue, any_hit: Option<AnyHit>) -> Result<Self, EdgeError> {
        let unsupported = unsupported(device);
        let made = || {
            let layouts = Layouts::new(device, unsupported.is_none());
            let texture = factors(device, [1, 1]);
            let nothing = (texture.clone(), layouts.group(device, &texture));
            let size = wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 };
            let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4), rows_per_image: None };
            queue.write_texture(texture.texture().as_image_copy(), bytemuck::bytes_of(&-1.0_f32), layout, size);
            Self {
                device: device.clone(),
                queue: queue.clone(),
                unsupported,
                any_hit,
                layouts,
                pipelines: None,
                uniform: uniform_buffer::<EdgeUniform>(device, LABEL),
                receiver: uniform_buffer::<FadingUniform>(device, LABEL),
                texels: device.create_sampler(&wgpu::SamplerDescriptor {
                    label: Some(LABEL),
                    address_mode_u: wgpu::AddressMode::Repeat,
                    address_mode_v: wgpu::AddressMode::Repeat,
                    ..Default::default()
                }),
                target: None,
                pyramids: None,
                no_bounds: no_bounds(&texture),
                nothing,
                result: EdgeOutcome::Filtered(FallbackReason::Picture),
                counts: ReadBackRing::new(device, "shadowfit read back", COUNTS as u64 * 4, FRAMES),
            }
        };
        catch_errors(device, made).map_err(|error| EdgeError::Device(error.to_string()))
    }

    /// Returns the layout of the bind group that [`exact_factor_wgsl`](super::exact_factor_wgsl) reads, for
    /// fragment and compute shaders.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layouts.read
    }

    /// Returns the bind group that [`exact_factor_wgsl`](super::exact_factor_wgsl) reads. Call it after
    /// [`Self::record`] in each frame: the bind group changes with the size of the view, and when edges
    /// change from traced to filtered or back.
    pub fn group(&self) -> &wgpu::BindGroup {
        let traced = self.target.as_ref().filter(|_| self.result == EdgeOutcome::Traced);
        traced.map_or(&self.nothing.1, |target| &target.group)
    }

    /// Returns the factors of the last traced frame: an `R32Float` texture of the depth texture's size. A
    /// factor is the share of the light that reaches a pixel, 0..=1, or -1 where the filter decides. The
    /// lowest bit of a factor is set if the pixel was traced. If edges are filtered, the texture is a single
    /// pixel.
    pub fn factors(&self) -> &wgpu::TextureView {
        let traced = self.target.as_ref().filter(|_| self.result == EdgeOutcome::Traced);
        traced.map_or(&self.nothing.0, |target| &target.factors)
    }

    /// Returns the missing capability of the device. If there is one, all edges are filtered.
    pub fn unsupported(&self) -> Option<Unsupported> {
        self.unsupported
    }

    /// Returns the result of the last frame.
    pub fn result(&self) -> EdgeOutcome {
        self.result
    }

    /// Filters the edges of the next frame, for a frame without a depth pre-pass.
    pub fn skip(&mut self) {
        self.result = EdgeOutcome::Filtered(FallbackReason::Picture);
    }

    /// Records the passes. Call it after the passes of the maps and the depth pre-pass, and before the main
    /// pass. It uses the sun's maps of the last update. `rays` must contain the casters of this frame.
    ///
    /// Returns whether edges are traced or filtered. If they are filtered, no pass is recorded.
    ///
    /// # Errors
    ///
    /// [`EdgeError`] for an invalid view or texture, and if the device is out of memory. Edges are filtered
    /// then.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        sun: &SunShadows,
        rays: Option<&RayScene>,
        view: &EdgeView<'_>,
    ) -> Result<EdgeOutcome, EdgeError> {
        self.record_timed(encoder, sun, rays, view, None)
    }

    /// Calls [`Self::record`] with timestamps at the beginning and the end of the passes.
    ///
    /// # Errors
    ///
    /// The errors of [`Self::record`].
    pub fn record_timed(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        sun: &SunShadows,
        rays: Option<&RayScene>,
        view: &EdgeView<'_>,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) -> Result<EdgeOutcome, EdgeError> {
        self.result = EdgeOutcome::Filtered(FallbackReason::Picture);
        let why = match (self.fallback_reason(sun), rays) {
            (None, Some(rays)) => {
                self.trace(encoder, sun, rays, view, timestamps)?;
                self.result = EdgeOutcome::Traced;
                return Ok(self.result);
            }
            (Some(why), _) => why,
            (None, None) => FallbackReason::Rays,
        };
        self.result = EdgeOutcome::Filtered(why);
        Ok(self.result)
    }

    fn fallback_reason(&self, sun: &SunShadows) -> Option<FallbackReason> {
        if !sun.map().descriptor().edges.are_traced() {
            Some(FallbackReason::Technique)
        } else if let Some(lack) = self.unsupported {
            Some(FallbackReason::Device(lack))
        } else if sun.map_view().is_none() {
            Some(FallbackReason::NoMaps)
        } else {
            sun.is_fading().then_some(FallbackReason::Fading)
        }
    }

    /// Returns the WGSL of the engine's alpha test of ray hits.
    fn counts_wgsl(&self) -> Option<&str> {
        self.any_hit.as_ref().map(|any_hit| any_hit.wgsl.as_str())
    }

    /// Converts the error of a pipeline. The pass's own WGSL is valid, so that the engine's WGSL is the
    /// cause.
    fn refused(&self, error: &wgpu::Error) -> EdgeError {
        match error {
            wgpu::Error::Validation { .. } if self.any_hit.is_some() => EdgeError::AnyHit(error.to_string()),
            _ => EdgeError::Device(error.to_string()),
        }
    }

    fn trace(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        sun: &SunShadows,
        rays: &RayScene,
        view: &EdgeView<'_>,
        timestamps: Option<wgpu::ComputePassTimestampWrites<'_>>,
    ) -> Result<(), EdgeError> {
        check_textures(view)?;
        self.check_any_hit(view)?;
        let Some(map_view) = sun.map_view() else { return Ok(()) };
        let source = Source::new(sun, map_view, view, rays.origin())?;
        self.make(sun, rays, view, map_view.frame)?;
        let (Some(target), Some(pipelines)) = (&self.target, &self.pipelines) else { return Ok(()) };
        let kept = target.kept.as_ref().filter(|_| view.budget.is_some());
        self.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&source.edges));
        self.queue.write_buffer(&self.receiver, 0, &source.receiver);
        let is_soft = sun.map().descriptor().filter.is_soft();
        let traced = kept.map_or(&target.list, |kept| &kept.list);
        let groups = Groups {
            receiver: sun.map().receiver_group_with(&self.device, &self.receiver),
            classify: self.bind(&pipelines.layout, target, &target.list, view),
            surfaces: self.bind(&pipelines.layout, target, traced, view),
            trace: self.bind(&pipelines.trace_layout, target, traced, view),
        };
        for list in [&target.list, traced] {
            encoder.clear_buffer(list, 0, Some(COUNTS as u64 * 4));
        }
        let label = Some(LABEL);
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes: timestamps });
        if let Some(pyramids) = self.pyramids.as_mut().filter(|_| is_soft) {
            pyramids.renew(&mut pass, sun, &groups.receiver);
        }
        pipelines.classify(&mut pass, target, &groups, source.edges.size);
        if let Some(kept) = kept {
            pipelines.select(&mut pass, target, kept);
        }
        pipelines.trace(&mut pass, target, &groups, rays, view.any_hit);
        drop(pass);
        self.counts.record(encoder, traced, ());
        Ok(())
    }

    /// Refuses a view whose bind group for the alpha test is missing or has no layout.
    fn check_any_hit(&self, view: &EdgeView<'_>) -> Result<(), EdgeError> {
        let has_layout = self.any_hit.as_ref().is_some_and(|any_hit| any_hit.layout.is_some());
        if has_layout == view.any_hit.is_some() { Ok(()) } else { Err(EdgeError::AnyHitGroup(has_layout)) }
    }

    /// Creates the missing resources of a frame.
    fn make(&mut self, sun: &SunShadows, rays: &RayScene, view: &EdgeView<'_>, frame: u32) -> Result<(), EdgeError> {
        let shape = Shape {
            samples: view.depth.texture().sample_count(),
            normals: view.normals.map(|normals| normals.encoding),
        };
        let size = [view.depth.texture().width(), view.depth.texture().height()];
        if self.target.as_ref().is_none_or(|target| target.size != size) {
            self.target = None;
            self.target = Some(Target::new(&self.device, &self.layouts, size)?);
        }
        self.make_pipelines(sun, rays, shape)?;
        if sun.map().descriptor().filter.is_soft() {
            self.pyramids = Some(Pyramids::of(self.pyramids.take(), &self.device, sun)?);
        }
        if let (Some(budget), Some(target)) = (view.budget, &mut self.target) {
            target.keep(&self.device, &self.queue, &self.layouts, budget, frame)?;
        }
        Ok(())
    }

    /// Returns the counts of the newest frame that the GPU has finished, a frame or two late. The counts of a
    /// frame are returned once. `None` if no new counts have arrived. Never waits.
    pub fn take_counts(&mut self) -> Option<EdgeCounts> {
        // This only polls. The read-backs below show which frames are finished.
        let _status = self.device.poll(wgpu::PollType::Poll);
        let ((), counts) = self.counts.take(bytemuck::pod_read_unaligned::<[u32; COUNTS]>).ok()??;
        let [traced, facing, filtered, before] = counts;
        let unsure = before.max(traced);
        Some(EdgeCounts { facing, unsure, traced, filtered: filtered + unsure - traced })
    }

    fn bind(
        &self,
        layout: &wgpu::BindGroupLayout,
        target: &Target,
        list: &wgpu::Buffer,
        view: &EdgeView<'_>,
    ) -> wgpu::BindGroup {
        let normals = view.normals.map_or(&self.nothing.0, |normals| normals.view);
        let resources = [
            self.uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(view.depth),
            wgpu::BindingResource::TextureView(normals),
            wgpu::BindingResource::TextureView(&target.factors),
            list.as_entire_binding(),
            wgpu::BindingResource::Sampler(&self.texels),
            wgpu::BindingResource::TextureView(self.pyramids.as_ref().map_or(&self.no_bounds, |made| &made.view)),
        ];
        group(&self.device, LABEL, layout, &resources)
    }

    fn make_pipelines(&mut self, sun: &SunShadows, rays: &RayScene, shape: Shape) -> Result<(), EdgeError> {
        // Resolution and fade do not change the WGSL, so the key contains fixed values for them.
        let of_all = ShadowMapDescriptor::default();
        let descriptor =
            ShadowMapDescriptor { resolution: of_all.resolution, fade: of_all.fade, ..*sun.map().descriptor() };
        if self.pipelines.as_ref().is_some_and(|pipelines| pipelines.key == (descriptor, shape)) {
            return Ok(());
        }
        let Layouts { arguments, select, .. } = &self.layouts;
        let layouts = PassLayouts { receiver: sun.map().receiver_layout(), rays: rays.layout(), arguments, select };
        let own = self.any_hit.as_ref();
        let made = catch_errors(&self.device, || Pipelines::new(&self.device, &descriptor, shape, &layouts, own));
        self.pipelines = Some(made.map_err(|error| self.refused(&error))?);
        Ok(())
    }
}

impl Pipelines {
    fn new(
        device: &wgpu::Device,
        descriptor: &ShadowMapDescriptor,
        shape: Shape,
        layouts: &PassLayouts<'_>,
        any_hit: Option<&AnyHit>,
    ) -> Self {
        let PassLayouts { receiver, rays, arguments, select } = *layouts;
        let [layout, trace_layout] = [false, true].map(|read_only| picture_layout(device, shape, read_only));
        let counts = any_hit.map(|any_hit| any_hit.wgsl.as_str());
        let own = any_hit.and_then(|any_hit| any_hit.layout.as_ref());
        let [found, traced] = [&layout, &trace_layout]
            .map(|list| [receiver, list, rays].into_iter().chain(own).map(Some).collect::<Vec<_>>());
        let steps = [
            (vec![Some(receiver), Some(&layout)], shader::classify(descriptor, shape), "classify"),
            (vec![Some(arguments)], shader::arguments(descriptor), "count_groups"),
            (vec![Some(select)], shader::select(), "select_pixels"),
            (found, shader::surfaces(descriptor, shape, counts), "find_surfaces"),
            (traced, shader::trace(descriptor, shape, counts), "trace"),
        ];
        let make = |(layouts, wgsl, entry): &(Vec<_>, String, &str)| {
            compute_pipeline(device, LABEL, layouts, &wgsl_module(device, LABEL, wgsl.clone()), entry)
        };
        let mut made = make_at_once(device, &steps, make).into_iter();
        let [classify, arguments, select, surfaces, trace] =
            steps.each_ref().map(|step| made.next().unwrap_or_else(|| make(step)));
        Self { classify, arguments, select, surfaces, trace, key: (*descriptor, shape), layout, trace_layout }
    }

    /// Lists the pixels whose texels disagree, and counts their workgroups.
    fn classify(&self, pass: &mut wgpu::ComputePass<'_>, target: &Target, groups: &Groups, size: [u32; 2]) {
        pass.set_pipeline(&self.classify);
        pass.set_bind_group(0, &groups.receiver, &[]);
        pass.set_bind_group(1, &groups.classify, &[]);
        let [x, y] = size.map(|side| side.div_ceil(SQUARE));
        pass.dispatch_workgroups(x, y, 1);
        pass.set_pipeline(&self.arguments);
        pass.set_bind_group(0, &target.arguments, &[]);
        pass.dispatch_workgroups(1, 1, 1);
    }

    /// Keeps listed pixels within the budget, and counts their workgroups.
    fn select(&self, pass: &mut wgpu::ComputePass<'_>, target: &Target, kept: &Kept) {
        pass.set_pipeline(&self.select);
        pass.set_bind_group(0, &kept.group, &[]);
        pass.dispatch_workgroups_indirect(&target.groups, 0);
        pass.set_pipeline(&self.arguments);
        pass.set_bind_group(0, &kept.arguments, &[]);
        pass.dispatch_workgroups(1, 1, 1);
    }

    /// Finds the triangles of the listed pixels, and traces their rays.
    fn trace(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        target: &Target,
        groups: &Groups,
        rays: &RayScene,
        any_hit: Option<&wgpu::BindGroup>,
    ) {
        for (pipeline, group, arguments) in
            [(&self.surfaces, &groups.surfaces, SURFACE_GROUPS), (&self.trace, &groups.trace, 0)]
        {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &groups.receiver, &[]);
            pass.set_bind_group(1, group, &[]);
            pass.set_bind_group(2, rays.group(), &[]);
            if let Some(group) = any_hit {
                pass.set_bind_group(AnyHit::GROUP, group, &[]);
            }
            pass.dispatch_workgroups_indirect(&target.groups, arguments);
        }
    }
}

/// Returns the capability that the device lacks for the passes.
fn unsupported(device: &wgpu::Device) -> Option<Unsupported> {
    let limits = device.limits();
    let has_buffers = limits.max_storage_buffers_per_shader_stage >= STORAGE_BUFFERS;
    let computes = supported(&limits, device.adapter_info().backend);
    computes.err().or((!has_buffers).then_some(Unsupported::StorageBuffers))
}

/// Returns a texture view to bind instead of bounds that are not read.
fn no_bounds(any: &wgpu::TextureView) -> wgpu::TextureView {
    let dimension = Some(wgpu::TextureViewDimension::D2Array);
    any.texture().create_view(&wgpu::TextureViewDescriptor { dimension, ..Default::default() })
}

/// Returns the layout of a frame's resources. The list is read-only, or writable.
fn picture_layout(device: &wgpu::Device, shape: Shape, read_only: bool) -> wgpu::BindGroupLayout {
    let factors = written_texture(wgpu::TextureFormat::R32Float);
    let depths = texture(wgpu::TextureSampleType::Depth, shape.samples > 1);
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering);
    let types = [UNIFORM, depths, FLOATS, factors, storage(read_only), sampler, BOUNDS];
    layout(device, LABEL, wgpu::ShaderStages::COMPUTE, &types)
}

/// Refuses textures that cannot be bound, and a view's rectangle that lies outside them.
fn check_textures(view: &EdgeView<'_>) -> Result<(), EdgeError> {
    let texture = view.depth.texture();
    check(texture, &[1, 4], view.part())?;
    let size = [texture.width(), texture.height()];
    if let Some(normals) = view.normals.map(|normals| normals.view.texture()) {
        let format = normals.format();
        let is_float = matches!(format.sample_type(None, None), Some(wgpu::TextureSampleType::Float { .. }));
        let is_readable = normals.usage().contains(wgpu::TextureUsages::TEXTURE_BINDING);
        let found = [normals.width(), normals.height()];
        if !is_float || !is_readable || normals.sample_count() != 1 || found != size {
            return Err(EdgeError::Normals { format, size: found, expected: size });
        }
    }
    Ok(())
}
