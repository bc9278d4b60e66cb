//! Shadow maps as a GPU resource: textures, clears, bind groups, and one pass per map.

use core::mem::offset_of;

use shadowfit::glam::UVec2;
use shadowfit::scroll::{StoredRect, TexelRect};
use shadowfit::settings::{CasterPolicy, FilterKind};
use shadowfit::{CasterVolume, DepthConvention, FittedMap, LightProjection};
use shadowfit_gpu::bindings::{
    UNIFORM, group_entries, group_from, layout_entries, layout_from, texture_array, uniform_buffer,
};
use shadowfit_gpu::catch_errors;

use super::texture::is_array;
use super::uniform::{self, CasterUniform, FadingUniform, ReceiverUniform};
use super::view::check;
use crate::{MapTexture, MapView, ShadowMapDescriptor, ShadowMapError};

/// Shadow maps of one light: layers of equal size in one texture array, with their passes and bind groups.
#[derive(Debug)]
pub struct ShadowMap {
    descriptor: ShadowMapDescriptor,
    /// Layer of the first map in the array.
    first_layer: u32,
    clamps_in_fragment: bool,
    layers: Vec<Layer>,
    view: wgpu::TextureView,
    sampler: wgpu::Sampler,
    caster_layout: wgpu::BindGroupLayout,
    receiver_layout: wgpu::BindGroupLayout,
    receiver_group: wgpu::BindGroup,
    receiver_uniform: wgpu::Buffer,
    volumes: Vec<CasterVolume>,
    /// Texture of the engine that contains the maps, if there is one.
    texture: Option<MapTexture>,
}

/// One map of the array.
#[derive(Debug)]
struct Layer {
    /// Depth attachment: the map itself, or the depth buffer that belongs to a colour map.
    depth: wgpu::TextureView,
    /// Colour attachment of colour formats.
    color: Option<wgpu::TextureView>,
    caster_uniform: wgpu::Buffer,
    caster_group: wgpu::BindGroup,
    /// Width and height of the corner that the current map uses, and the position of its first texel, in
    /// texels.
    used: UVec2,
    texel_offset: UVec2,
}

impl ShadowMap {
    /// Creates the textures and bind groups.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError`] if the descriptor is invalid, or not supported by this device.
    pub fn new(device: &wgpu::Device, descriptor: &ShadowMapDescriptor) -> Result<Self, ShadowMapError> {
        descriptor.check(device)?;
        Self::made(device, descriptor, &Textures::new(device, descriptor, None)?)
    }

    /// Creates the maps in a texture that the engine owns. [`ShadowMapDescriptor::texture`] describes the
    /// required texture. Only the layers from [`MapTexture::base_layer`] on are cleared, written and read,
    /// one per map. For colour formats, a depth buffer is created in addition.
    ///
    /// # Errors
    ///
    /// The errors of [`Self::new`], and [`ShadowMapError::Texture`] if the texture cannot hold the maps.
    pub fn in_texture(
        device: &wgpu::Device,
        descriptor: &ShadowMapDescriptor,
        texture: &MapTexture,
    ) -> Result<Self, ShadowMapError> {
        descriptor.check(device)?;
        texture.check(device, descriptor)?;
        Self::made(device, descriptor, &Textures::new(device, descriptor, Some(texture))?)
    }

    fn made(
        device: &wgpu::Device,
        descriptor: &ShadowMapDescriptor,
        textures: &Textures,
    ) -> Result<Self, ShadowMapError> {
        catch_errors(device, || Self::with_textures(device, descriptor, textures))
            .map_err(|error| ShadowMapError::Device(error.to_string()))
    }

    fn with_textures(device: &wgpu::Device, descriptor: &ShadowMapDescriptor, textures: &Textures) -> Self {
        let caster_layout = caster_layout(device, descriptor);
        let (first, types) = (descriptor.first_binding, receiver_types(descriptor));
        let receiver_layout = layout_from(device, "shadowfit receiver", first, RECEIVER_STAGES, types);
        let layers = layers(device, descriptor, &caster_layout, textures, 0);
        let view = textures.read.view(wgpu::TextureViewDimension::D2Array, 0, descriptor.layers());
        let receiver_uniform = if descriptor.cross_fades {
            uniform_buffer::<FadingUniform>(device, "shadowfit uniform")
        } else {
            uniform_buffer::<ReceiverUniform>(device, "shadowfit uniform")
        };
        let sampler = comparison_sampler(device, descriptor);
        let resources = receiver_resources(&receiver_uniform, &view, &sampler);
        let resources = &resources[..types.len()];
        let receiver_group = group_from(device, "shadowfit receiver", first, &receiver_layout, resources);
        let has_clamp = device.features().contains(wgpu::Features::DEPTH_CLIP_CONTROL);
        Self {
            descriptor: *descriptor,
            first_layer: 0,
            clamps_in_fragment: descriptor.depth_clamp && !has_clamp,
            layers,
            view,
            sampler,
            caster_layout,
            receiver_layout,
            receiver_group,
            receiver_uniform,
            volumes: Vec::new(),
            texture: textures.is_handed_in.then(|| textures.read.clone()),
        }
    }

    /// Creates the second set of maps for a descriptor that [cross-fades](ShadowMapDescriptor::cross_fades),
    /// with the textures and the look-up of the first set.
    pub(crate) fn second(&self, device: &wgpu::Device) -> Self {
        let Layer { depth, color, .. } = &self.layers[0];
        let texture = |view: &wgpu::TextureView, base_layer| MapTexture { texture: view.texture().clone(), base_layer };
        let base_layer = self.texture.as_ref().map_or(0, |texture| texture.base_layer);
        let textures = Textures {
            read: texture(color.as_ref().unwrap_or(depth), base_layer),
            beside: color.as_ref().map(|_| texture(depth, 0)),
            is_handed_in: self.texture.is_some(),
        };
        let first_layer = self.descriptor.maps;
        Self {
            descriptor: self.descriptor,
            first_layer,
            clamps_in_fragment: self.clamps_in_fragment,
            layers: layers(device, &self.descriptor, &self.caster_layout, &textures, first_layer),
            view: self.view.clone(),
            sampler: self.sampler.clone(),
            caster_layout: self.caster_layout.clone(),
            receiver_layout: self.receiver_layout.clone(),
            receiver_group: self.receiver_group.clone(),
            receiver_uniform: self.receiver_uniform.clone(),
            volumes: Vec::new(),
            texture: self.texture.clone(),
        }
    }

    /// Returns the descriptor of the maps.
    pub fn descriptor(&self) -> &ShadowMapDescriptor {
        &self.descriptor
    }

    /// Returns the engine's texture that contains the maps, if it [passed one in](Self::in_texture).
    pub fn texture(&self) -> Option<&MapTexture> {
        self.texture.as_ref()
    }

    /// Returns a view of all maps as an array, for debug views.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// Returns the layout of the bind group that [`crate::caster_wgsl`] reads.
    pub fn caster_layout(&self) -> &wgpu::BindGroupLayout {
        &self.caster_layout
    }

    /// Returns the layout of the bind group that [`crate::receiver_wgsl`] reads, for vertex, fragment and
    /// compute shaders.
    pub fn receiver_layout(&self) -> &wgpu::BindGroupLayout {
        &self.receiver_layout
    }

    /// Returns the bind group that [`crate::receiver_wgsl`] reads.
    pub fn receiver_group(&self) -> &wgpu::BindGroup {
        &self.receiver_group
    }

    /// Returns the entries of [`Self::receiver_layout`], for a layout of the engine with further entries,
    /// such as another sun, the camera or materials. They begin at [`ShadowMapDescriptor::first_binding`].
    ///
    /// | binding | content | type |
    /// |---|---|---|
    /// | first | [`ReceiverUniform`], which [`Self::prepare`] writes; [`FadingUniform`] if the look-up [cross-fades](ShadowMapDescriptor::cross_fades) | uniform buffer |
    /// | first + 1 | the maps, one layer each | array of depth textures, or of unfilterable float textures for colour formats |
    /// | first + 2 | comparison of depths, only for depth formats | comparison sampler |
    pub fn receiver_layout_entries(&self) -> Vec<wgpu::BindGroupLayoutEntry> {
        layout_entries(self.descriptor.first_binding, RECEIVER_STAGES, receiver_types(&self.descriptor))
    }

    /// Returns the resources for [`Self::receiver_layout_entries`], for a bind group of the engine. They do
    /// not change until the maps are recreated.
    pub fn receiver_entries(&self) -> Vec<wgpu::BindGroupEntry<'_>> {
        let resources = receiver_resources(&self.receiver_uniform, &self.view, &self.sampler);
        group_entries(self.descriptor.first_binding, &resources[..receiver_types(&self.descriptor).len()])
    }

    /// Returns the depth state of the engine's caster pipelines. It has no hardware bias, because biases are
    /// applied when the map is read, in the same way for every format.
    pub fn depth_stencil_state(&self) -> wgpu::DepthStencilState {
        wgpu::DepthStencilState {
            format: self.descriptor.depth_format(),
            depth_write_enabled: Some(true),
            depth_compare: Some(match self.descriptor.depth {
                DepthConvention::Reversed => wgpu::CompareFunction::GreaterEqual,
                _ => wgpu::CompareFunction::LessEqual,
            }),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }
    }

    /// Returns the primitive state of the engine's caster pipelines, for triangle lists. Both sides are
    /// drawn. Depth is clamped if the descriptor requires it and the device supports it.
    pub fn primitive_state(&self) -> wgpu::PrimitiveState {
        let unclipped_depth = self.descriptor.depth_clamp && !self.clamps_in_fragment;
        wgpu::PrimitiveState { unclipped_depth, ..Default::default() }
    }

    /// Returns the colour target of the engine's caster pipelines, if the format has one. Their fragment
    /// shader then writes `shadowfit_caster_color` of z of `@builtin(position)` to location 0. If it [clamps
    /// depth](Self::clamps_in_fragment), it passes the clamped depth instead.
    pub fn color_target(&self) -> Option<wgpu::ColorTargetState> {
        (!self.descriptor.format.is_depth()).then(|| self.descriptor.texture_format().into())
    }

    /// Returns whether the engine's caster pipelines must clamp depth, because the device lacks
    /// [`wgpu::Features::DEPTH_CLIP_CONTROL`]. Their vertex shader then passes
    /// `shadowfit_caster_depth(position)` on as a varying, and their fragment shader writes
    /// `shadowfit_clamped_depth` of it to `@builtin(frag_depth)`. `shadowfit_caster_position` returns a
    /// meaningless depth in this case, which is never clipped.
    pub fn clamps_in_fragment(&self) -> bool {
        self.clamps_in_fragment
    }

    /// Returns the caster volumes of the prepared maps, relative to the origin of [`Self::prepare`].
    pub fn volumes(&self) -> &[CasterVolume] {
        &self.volumes
    }

    /// Returns the depth of the far plane, to which the maps are cleared.
    pub fn far_depth(&self) -> f32 {
        if self.descriptor.depth == DepthConvention::Reversed { 0.0 } else { 1.0 }
    }

    /// Returns the bind group of a map's matrix, which [`crate::caster_wgsl`] reads, for engines that bind it
    /// themselves.
    ///
    /// # Panics
    ///
    /// If `index` is not below the descriptor's number of maps.
    pub fn caster_group(&self, index: usize) -> &wgpu::BindGroup {
        &self.layers[index].caster_group
    }

    /// Returns the depth attachment of a map.
    pub(crate) fn depth_attachment(&self, index: usize) -> &wgpu::TextureView {
        &self.layers[index].depth
    }

    /// Writes the uniforms for this frame's maps. Map i is drawn into layer i. Maps that are selected by view
    /// depth must be sorted by their `far`. Positions in the shaders are relative to the view's origin. A fit
    /// with fewer texels than a layer uses a corner of it. A layer without a map is neither drawn nor read.
    ///
    /// # Errors
    ///
    /// - [`ShadowMapError::TooManyFits`] for more fits than layers
    /// - [`ShadowMapError::Fit`] if a fit has more texels than a layer or another depth convention
    /// - [`ShadowMapError::Order`] if the ends of maps that are selected by view depth do not ascend
    /// - [`ShadowMapError::TexelOffset`] if a map that wraps around does not fill its layer, or begins
    ///   outside it
    /// - [`ShadowMapError::Bias`] for biases that are not finite
    /// - [`ShadowMapError::Forward`] for a direction that is not of unit length
    ///
    /// On an error, no uniform is written.
    pub fn prepare(&mut self, queue: &wgpu::Queue, view: &MapView, maps: &[FittedMap]) -> Result<(), ShadowMapError> {
        self.prepare_casters(queue, view, maps)?;
        self.write_receiver(queue, &uniform::receiver(maps, view, &self.descriptor));
        Ok(())
    }

    /// Prepares maps that the look-up does not read yet, or that fade out. The look-up's present set stays
    /// unchanged.
    pub(crate) fn prepare_casters(
        &mut self,
        queue: &wgpu::Queue,
        view: &MapView,
        maps: &[FittedMap],
    ) -> Result<(), ShadowMapError> {
        check(&self.descriptor, view, maps)?;
        for (layer, map) in self.layers.iter_mut().zip(maps) {
            let clamps_in_fragment = self.clamps_in_fragment.into();
            let uniform = CasterUniform { clamps_in_fragment, ..CasterUniform::new(&map.projection, view.origin) };
            queue.write_buffer(&layer.caster_uniform, 0, bytemuck::bytes_of(&uniform));
            (layer.used, layer.texel_offset) = (map.projection.resolution, map.texel_offset);
        }
        let depth_clamp = self.descriptor.depth_clamp;
        self.volumes.clear();
        self.volumes
            .extend(maps.iter().map(|map| stored_casters(&map.projection, depth_clamp).relative_to(view.origin)));
        Ok(())
    }

    /// Writes the uniform for a look-up into this set of maps alone.
    fn write_receiver(&self, queue: &wgpu::Queue, now: &ReceiverUniform) {
        queue.write_buffer(&self.receiver_uniform, 0, &self.of_set(now));
    }

    /// Returns the uniform of a look-up into this set of maps alone.
    fn of_set(&self, now: &ReceiverUniform) -> Vec<u8> {
        let (now, first_layer) = (now.in_layers(self.first_layer), self.first_layer);
        let fading = FadingUniform { now, share: 1.0, first_layer, ..FadingUniform::default() };
        if self.descriptor.cross_fades {
            bytemuck::bytes_of(&fading).to_vec()
        } else {
            bytemuck::bytes_of(&now).to_vec()
        }
    }

    /// Returns the layer of the first map in the texture.
    #[cfg(feature = "rays")]
    pub(crate) fn first_layer(&self) -> u32 {
        self.first_layer
    }

    /// Returns the uniform for a look-up into this set of maps alone, from a view other than the main pass.
    #[cfg(feature = "rays")]
    pub(crate) fn receiver_bytes(&self, view: &MapView, maps: &[FittedMap]) -> Vec<u8> {
        let Self { descriptor, .. } = self;
        let uniform = ReceiverUniform::on_planes(maps, &view.reader(), &descriptor.reading());
        self.of_set(&uniform.with_fade(descriptor.fade).with_frame(view.frame))
    }

    /// Creates a bind group with another uniform for the look-up.
    #[cfg(feature = "rays")]
    pub(crate) fn receiver_group_with(&self, device: &wgpu::Device, uniform: &wgpu::Buffer) -> wgpu::BindGroup {
        let resources = receiver_resources(uniform, &self.view, &self.sampler);
        let resources = &resources[..receiver_types(&self.descriptor).len()];
        group_from(device, "shadowfit edges", self.descriptor.first_binding, &self.receiver_layout, resources)
    }

    /// Blends another set of maps into the look-up, after [`Self::prepare`]. `share` is the share of this
    /// set.
    pub(crate) fn fade_from(&self, queue: &wgpu::Queue, before: &Self, maps: &[FittedMap], view: &MapView, share: f32) {
        let uniform = uniform::receiver(maps, view, &before.descriptor).in_layers(before.first_layer);
        let write = |offset: usize, bytes: &[u8]| queue.write_buffer(&self.receiver_uniform, offset as u64, bytes);
        write(offset_of!(FadingUniform, before), bytemuck::bytes_of(&uniform));
        write(offset_of!(FadingUniform, share), bytemuck::bytes_of(&share));
    }

    /// Changes the view depths between which shadows fade, in metres, from the next frame on.
    pub(crate) fn set_fade(&mut self, fade: [f32; 2]) {
        self.descriptor.fade = fade;
    }

    /// Turns the light off: all factors are 0 until maps are [prepared](Self::prepare) again, and
    /// [`Self::render`] draws no map.
    pub fn turn_off(&mut self, queue: &wgpu::Queue) {
        self.write_receiver(queue, &ReceiverUniform::off());
        self.volumes.clear();
    }

    /// Records one pass per prepared map. It clears the layer to the far value, binds the map's
    /// [`Self::caster_group`] at `group`, and calls `draw(pass, map index, volume)`, which must draw every
    /// caster that intersects the volume (relative to the origin). For a map that [wraps
    /// around](FittedMap::texel_offset), `draw` is called for each of its [`Self::parts`].
    pub fn render(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        group: u32,
        mut draw: impl FnMut(&mut wgpu::RenderPass<'_>, usize, &CasterVolume),
    ) {
        for (index, volume) in self.volumes.iter().enumerate() {
            let mut pass = self.begin_pass(encoder, index, group, None);
            let size = self.layers[index].used;
            for part in self.parts(index) {
                set_part(&mut pass, &part, size);
                draw(&mut pass, index, volume);
            }
        }
    }

    /// Returns the parts of a map that are drawn separately: one, or up to four for a map that [wraps
    /// around](FittedMap::texel_offset).
    ///
    /// # Panics
    ///
    /// If `index` is not below the descriptor's number of maps.
    pub fn parts(&self, index: usize) -> impl Iterator<Item = StoredRect> {
        let layer = &self.layers[index];
        TexelRect::all(layer.used).stored(layer.texel_offset, layer.used)
    }

    /// Opens the pass of one map, for engines that schedule passes themselves. The layer is cleared, the
    /// map's [`Self::caster_group`] is bound at `group`, and the viewport is set. A map that [wraps
    /// around](FittedMap::texel_offset) must be drawn once for each of its [`Self::parts`], with a viewport
    /// of the map's size that begins at [`StoredRect::viewport`], and the scissor rectangle
    /// [`StoredRect::stored`].
    ///
    /// # Panics
    ///
    /// If `index` is not below the descriptor's number of maps.
    pub fn begin_pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        index: usize,
        group: u32,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'encoder> {
        let layer = &self.layers[index];
        let far = self.far_depth();
        let color = layer.color.as_ref().map(|view| wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(self.descriptor.color_of(far)),
                store: wgpu::StoreOp::Store,
            },
        });
        let has_color = color.is_some();
        let color_attachments = [color];
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadowfit map"),
            color_attachments: &color_attachments[..usize::from(has_color)],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &layer.depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(far),
                    store: if has_color { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store },
                }),
                stencil_ops: None,
            }),
            timestamp_writes: timestamps,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_bind_group(group, &layer.caster_group, &[]);
        pass.set_viewport(0.0, 0.0, layer.used.x as f32, layer.used.y as f32, 0.0, 1.0);
        pass
    }
}

/// Sets viewport and scissor rectangle of a part of a map of this size.
pub(crate) fn set_part(pass: &mut wgpu::RenderPass<'_>, part: &StoredRect, size: UVec2) {
    let (first, size, rect) = (part.viewport().as_vec2(), size.as_vec2(), part.stored);
    pass.set_viewport(first.x, first.y, size.x, size.y, 0.0, 1.0);
    pass.set_scissor_rect(rect.min.x, rect.min.y, rect.size.x, rect.size.y);
}

/// Returns the volume of the casters that a map can store.
pub(crate) fn stored_casters(fit: &LightProjection, depth_clamp: bool) -> CasterVolume {
    CasterVolume::of_map(fit, if depth_clamp { CasterPolicy::DepthClamp } else { CasterPolicy::None })
}

/// Creates the layers of a set of maps, from layer `first` of the array on.
fn layers(
    device: &wgpu::Device,
    descriptor: &ShadowMapDescriptor,
    layout: &wgpu::BindGroupLayout,
    textures: &Textures,
    first: u32,
) -> Vec<Layer> {
    (first..first + descriptor.maps).map(|index| Layer::new(device, descriptor, layout, textures, index)).collect()
}

impl Layer {
    fn new(
        device: &wgpu::Device,
        descriptor: &ShadowMapDescriptor,
        layout: &wgpu::BindGroupLayout,
        textures: &Textures,
        index: u32,
    ) -> Self {
        let view = |texture: &MapTexture, index| texture.view(wgpu::TextureViewDimension::D2, index, 1);
        let caster_uniform = uniform_buffer::<CasterUniform>(device, "shadowfit uniform");
        let resources = [caster_uniform.as_entire_binding()];
        let first = descriptor.first_binding;
        let caster_group = group_from(device, "shadowfit caster", first, layout, &resources);
        // The depth buffers of colour maps are not stored, so that both sets of maps can share them.
        let beside = textures.beside.as_ref().map(|texture| view(texture, index % descriptor.maps));
        let read = view(&textures.read, index);
        let (depth, color) = beside.map_or_else(|| (read.clone(), None), |beside| (beside, Some(read.clone())));
        Self {
            depth,
            color,
            caster_uniform,
            caster_group,
            used: descriptor.resolution.into(),
            texel_offset: UVec2::ZERO,
        }
    }
}

/// Textures of the maps.
struct Textures {
    /// Texture that shaders read.
    read: MapTexture,
    /// Depth buffers that belong to the colour maps of a colour format.
    beside: Option<MapTexture>,
    /// Whether the engine created the texture that shaders read.
    is_handed_in: bool,
}

impl Textures {
    /// Creates the textures that the engine did not pass in.
    fn new(
        device: &wgpu::Device,
        descriptor: &ShadowMapDescriptor,
        handed_in: Option<&MapTexture>,
    ) -> Result<Self, ShadowMapError> {
        let ShadowMapDescriptor { resolution, maps, format, .. } = *descriptor;
        let why = |why: String| ShadowMapError::Format { format, why };
        let features = descriptor.texture_format().guaranteed_format_features(device.features());
        let missing = USAGES - features.allowed_usages;
        if handed_in.is_none() && !missing.is_empty() {
            return Err(why(format!("{:?} has no {missing:?}", descriptor.texture_format())));
        }
        let made = |format, layers| MapTexture { texture: texture(device, descriptor, format, layers), base_layer: 0 };
        // Shaders read an array. One more layer makes it an array where the backend would not.
        let layers = descriptor.layers();
        let layers = layers + u32::from(!is_array(resolution, layers, device.adapter_info().backend));
        // Devices below WebGPU's level may lack more than these flags say.
        catch_errors(device, || Self {
            read: handed_in.cloned().unwrap_or_else(|| made(descriptor.texture_format(), layers)),
            beside: (!format.is_depth()).then(|| made(descriptor.depth_format(), maps)),
            is_handed_in: handed_in.is_some(),
        })
        .map_err(|error| match error {
            wgpu::Error::OutOfMemory { .. } => {
                ShadowMapError::OutOfMemory { resolution, maps: descriptor.layers(), format }
            }
            error => why(error.to_string()),
        })
    }
}

/// Usages of the textures that are created here. Copies are for debug tools.
const USAGES: wgpu::TextureUsages = ShadowMapDescriptor::USAGES.union(wgpu::TextureUsages::COPY_SRC);

/// Creates a texture with this number of layers.
pub(crate) fn texture(
    device: &wgpu::Device,
    descriptor: &ShadowMapDescriptor,
    format: wgpu::TextureFormat,
    layers: u32,
) -> wgpu::Texture {
    let mut of = descriptor.texture();
    of.size.depth_or_array_layers = layers;
    device.create_texture(&wgpu::TextureDescriptor { format, usage: USAGES, ..of })
}

fn comparison_sampler(device: &wgpu::Device, descriptor: &ShadowMapDescriptor) -> wgpu::Sampler {
    let filter = match descriptor.filter {
        FilterKind::Point => wgpu::FilterMode::Nearest,
        _ => wgpu::FilterMode::Linear,
    };
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("shadowfit comparison"),
        mag_filter: filter,
        min_filter: filter,
        // Maps may wrap around. Look-ups in other maps stay half a texel inside.
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        compare: Some(match descriptor.depth {
            DepthConvention::Reversed => wgpu::CompareFunction::GreaterEqual,
            _ => wgpu::CompareFunction::LessEqual,
        }),
        ..Default::default()
    })
}

fn caster_layout(device: &wgpu::Device, descriptor: &ShadowMapDescriptor) -> wgpu::BindGroupLayout {
    let stages = wgpu::ShaderStages::VERTEX;
    layout_from(device, "shadowfit caster", descriptor.first_binding, stages, &[UNIFORM])
}

/// Shader stages of the engine that may use the look-up.
const RECEIVER_STAGES: wgpu::ShaderStages = wgpu::ShaderStages::VERTEX_FRAGMENT.union(wgpu::ShaderStages::COMPUTE);

/// Returns the types of the look-up's bindings.
fn receiver_types(descriptor: &ShadowMapDescriptor) -> &'static [wgpu::BindingType] {
    const COLORS: wgpu::BindingType = texture_array(wgpu::TextureSampleType::Float { filterable: false });
    const SAMPLER: wgpu::BindingType = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison);
    const OF_DEPTH: [wgpu::BindingType; 3] = [UNIFORM, texture_array(wgpu::TextureSampleType::Depth), SAMPLER];
    const OF_COLOR: [wgpu::BindingType; 2] = [UNIFORM, COLORS];
    if descriptor.format.is_depth() { &OF_DEPTH } else { &OF_COLOR }
}

/// Returns the resources of the look-up's bindings. Colour formats have no sampler.
fn receiver_resources<'a>(
    uniform: &'a wgpu::Buffer,
    view: &'a wgpu::TextureView,
    sampler: &'a wgpu::Sampler,
) -> [wgpu::BindingResource<'a>; 3] {
    [uniform.as_entire_binding(), wgpu::BindingResource::TextureView(view), wgpu::BindingResource::Sampler(sampler)]
}
