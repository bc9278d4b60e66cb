//! The shadow map as a GPU resource: textures, clears, bind groups, and one pass per map.

use core::fmt;

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::{BiasSettings, FilterKind, MapFormat, Settings};
use shadowfit::{CascadeMap, CasterPolicy, CasterVolume, DepthConvention, FitKind, LightFit};

use crate::uniform::{CasterUniform, ReceiverUniform};

/// Most maps (array layers) that one [`ShadowMap`] holds.
pub const MAX_MAPS: usize = 8;

/// Widths and heights that a map may have, in texels.
pub const RESOLUTIONS: core::ops::RangeInclusive<u32> = 256..=8192;

/// What a [`ShadowMap`] is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShadowMapDescriptor {
    /// Width and height of each map, in texels, within [`RESOLUTIONS`].
    pub resolution: [u32; 2],
    /// Number of maps, 1..=[`MAX_MAPS`].
    pub maps: u32,
    /// Storage of the depths.
    pub format: MapFormat,
    /// Filter of the look-up.
    pub filter: FilterKind,
    /// Depth convention of the fits: 0..1, plain or reversed; wgpu has no -1..1.
    pub depth: DepthConvention,
    /// Whether casters before the near plane are kept, flattened onto it ("pancaking"), as fits with
    /// [`CasterPolicy::DepthClamp`] need it. The device needs
    /// [`wgpu::Features::DEPTH_CLIP_CONTROL`].
    pub depth_clamp: bool,
}

impl Default for ShadowMapDescriptor {
    fn default() -> Self {
        Self {
            resolution: [2048; 2],
            maps: 1,
            format: MapFormat::Depth32Float,
            filter: FilterKind::default(),
            depth: DepthConvention::ZeroToOne,
            depth_clamp: false,
        }
    }
}

/// A fitted map, and the points that choose it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapFit {
    /// Where it lies.
    pub fit: LightFit,
    /// View depth, in metres, below which the map is a choice: a point reads the first map for
    /// which that holds and which covers it. `f32::MAX` for no end.
    pub far: f32,
}

impl From<LightFit> for MapFit {
    /// A single map, for all view depths.
    fn from(fit: LightFit) -> Self {
        Self { fit, far: f32::MAX }
    }
}

impl From<&CascadeMap> for MapFit {
    fn from(map: &CascadeMap) -> Self {
        Self { fit: map.fit, far: map.far }
    }
}

/// From where the maps are looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapView {
    /// World position that all positions in the shaders are relative to, in metres.
    pub origin: DVec3,
    /// World position of the eye that view depths are counted from, in metres.
    pub eye: DVec3,
    /// Unit direction in which that eye looks, world axes.
    pub forward: Vec3,
}

impl MapView {
    /// Everything relative to an eye that looks along `forward` (unit, world axes).
    pub fn from_eye(eye: DVec3, forward: Vec3) -> Self {
        Self { origin: eye, eye, forward }
    }
}

/// Why a [`ShadowMap`] could not be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShadowMapError {
    /// Width or height outside [`RESOLUTIONS`] or above the device's limit, which is given.
    Resolution {
        /// The resolution asked for, in texels.
        resolution: [u32; 2],
        /// The device's greatest texture width and height, in texels.
        device_limit: u32,
    },
    /// Number of maps outside 1..=[`MAX_MAPS`].
    Maps(u32),
    /// A depth convention that wgpu's clip space does not have.
    Depth(DepthConvention),
    /// Depth clamp on a device without [`wgpu::Features::DEPTH_CLIP_CONTROL`].
    DepthClamp,
    /// A fit has more texels than a layer, or another depth convention: biases and comparisons
    /// would be wrong.
    Fit {
        /// Index of the fit.
        index: usize,
        /// Its resolution, in texels, and depth convention.
        fit: ([u32; 2], DepthConvention),
        /// Those of the layers.
        map: ([u32; 2], DepthConvention),
    },
}

impl From<&Settings> for ShadowMapDescriptor {
    /// One map that the settings' fits match.
    fn from(settings: &Settings) -> Self {
        Self {
            resolution: settings.fit.resolution.to_array(),
            maps: 1,
            format: settings.format,
            filter: settings.filter,
            depth: settings.fit.depth,
            // The XNA sample's fit has no caster policy.
            depth_clamp: settings.fit.casters == CasterPolicy::DepthClamp && settings.fit.kind != FitKind::XnaSample,
        }
    }
}

impl fmt::Display for ShadowMapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Resolution { resolution: [width, height], device_limit } => write!(
                f,
                "shadow map of {width} × {height} texels: each side must be {} to {} texels, and this device allows \
                 at most {device_limit}",
                RESOLUTIONS.start(),
                RESOLUTIONS.end(),
            ),
            Self::Maps(maps) => write!(f, "{maps} shadow maps: between 1 and {MAX_MAPS} are possible"),
            Self::Depth(depth) => {
                write!(f, "depth convention {depth:?}: wgpu's clip space has 0..1, plain or reversed")
            }
            Self::DepthClamp => write!(
                f,
                "depth clamp: this device has no DEPTH_CLIP_CONTROL; let the fit place its near plane by another caster \
                 policy"
            ),
            Self::Fit { index, fit, map } => write!(
                f,
                "fit {index} was made for {:?} texels and depth {:?}, the shadow map has {:?} and {:?}: give both the \
                 same depth, and the map no fewer texels",
                fit.0, fit.1, map.0, map.1,
            ),
        }
    }
}

impl core::error::Error for ShadowMapError {}

/// Shadow maps of one light: equal layers of one texture array, their passes and bind groups.
#[derive(Debug)]
pub struct ShadowMap {
    descriptor: ShadowMapDescriptor,
    layers: Vec<Layer>,
    view: wgpu::TextureView,
    caster_layout: wgpu::BindGroupLayout,
    receiver_layout: wgpu::BindGroupLayout,
    receiver_group: wgpu::BindGroup,
    receiver_uniform: wgpu::Buffer,
    volumes: Vec<CasterVolume>,
}

/// One map of the array.
#[derive(Debug)]
struct Layer {
    /// Depth attachment: the map itself, or the depth buffer beside a colour map.
    depth: wgpu::TextureView,
    /// Colour attachment of colour formats.
    color: Option<wgpu::TextureView>,
    caster_uniform: wgpu::Buffer,
    caster_group: wgpu::BindGroup,
    /// Width and height of the corner that the present map uses, in texels.
    used: [u32; 2],
}

impl ShadowMap {
    /// Makes the textures and bind groups.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError`] if the resolution, the number of maps, the depth convention or depth clamp
    /// is not possible.
    pub fn new(device: &wgpu::Device, descriptor: &ShadowMapDescriptor) -> Result<Self, ShadowMapError> {
        check(descriptor, device.limits().max_texture_dimension_2d)?;
        if descriptor.depth_clamp && !device.features().contains(wgpu::Features::DEPTH_CLIP_CONTROL) {
            return Err(ShadowMapError::DepthClamp);
        }
        let caster_layout = caster_layout(device);
        let receiver_layout = receiver_layout(device, descriptor);
        let depth_texture = texture(device, descriptor, wgpu::TextureFormat::Depth32Float);
        let color_texture = (descriptor.format == MapFormat::R32Float)
            .then(|| texture(device, descriptor, wgpu::TextureFormat::R32Float));
        let layers = (0..descriptor.maps)
            .map(|index| Layer::new(device, &caster_layout, &depth_texture, color_texture.as_ref(), index))
            .collect();
        let view = color_texture.as_ref().unwrap_or(&depth_texture).create_view(&wgpu::TextureViewDescriptor {
            label: Some("shadowfit map"),
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        let receiver_uniform = uniform_buffer(device, size_of::<ReceiverUniform>());
        let sampler = comparison_sampler(device, descriptor);
        let receiver_group = receiver_group(device, descriptor, &receiver_layout, &receiver_uniform, &view, &sampler);
        Ok(Self {
            descriptor: *descriptor,
            layers,
            view,
            caster_layout,
            receiver_layout,
            receiver_group,
            receiver_uniform,
            volumes: Vec::new(),
        })
    }

    /// What the map was made of.
    pub fn descriptor(&self) -> &ShadowMapDescriptor {
        &self.descriptor
    }

    /// View of all maps as an array, for looking at them.
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// Layout of the bind group that [`crate::caster_wgsl`] reads.
    pub fn caster_layout(&self) -> &wgpu::BindGroupLayout {
        &self.caster_layout
    }

    /// Layout of the bind group that [`crate::receiver_wgsl`] reads.
    pub fn receiver_layout(&self) -> &wgpu::BindGroupLayout {
        &self.receiver_layout
    }

    /// The bind group that [`crate::receiver_wgsl`] reads.
    pub fn receiver_group(&self) -> &wgpu::BindGroup {
        &self.receiver_group
    }

    /// Depth state of the engine's caster pipelines. No hardware bias: biases are applied in
    /// texels where the map is read, alike for every format.
    pub fn depth_stencil_state(&self) -> wgpu::DepthStencilState {
        wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(match self.descriptor.depth {
                DepthConvention::Reversed => wgpu::CompareFunction::GreaterEqual,
                _ => wgpu::CompareFunction::LessEqual,
            }),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }
    }

    /// Primitive state of the engine's caster pipelines, of triangle lists: both sides are drawn, and
    /// depth is clamped where the descriptor says so.
    pub fn primitive_state(&self) -> wgpu::PrimitiveState {
        wgpu::PrimitiveState { unclipped_depth: self.descriptor.depth_clamp, ..Default::default() }
    }

    /// Colour target of the engine's caster pipelines, if the format has one. Their fragment
    /// shader then writes `saturate(@builtin(position).z)` to location 0: depth clamp leaves that
    /// value as it is, outside 0..1 for casters before the near plane.
    pub fn color_target(&self) -> Option<wgpu::ColorTargetState> {
        (self.descriptor.format == MapFormat::R32Float).then(|| wgpu::TextureFormat::R32Float.into())
    }

    /// Volumes of the prepared maps' casters, relative to the origin of [`Self::prepare`].
    pub fn volumes(&self) -> &[CasterVolume] {
        &self.volumes
    }

    /// Depth of the far plane, to which the maps are cleared.
    pub fn far_depth(&self) -> f32 {
        if self.descriptor.depth == DepthConvention::Reversed { 0.0 } else { 1.0 }
    }

    /// Writes the uniforms for this frame's maps, in order of their `far`. Positions in the shaders
    /// are relative to the view's origin. A fit with fewer texels than a layer uses the corner of
    /// it. Maps past the number of layers are left out; a layer without a map is neither drawn nor
    /// read.
    ///
    /// # Errors
    ///
    /// [`ShadowMapError::Fit`] if a fit has more texels than a layer or another depth convention;
    /// nothing is written then.
    pub fn prepare(
        &mut self,
        queue: &wgpu::Queue,
        view: &MapView,
        maps: &[MapFit],
        bias: &BiasSettings,
    ) -> Result<(), ShadowMapError> {
        self.check_fits(maps)?;
        let maps = &maps[..maps.len().min(self.layers.len())];
        for (layer, map) in self.layers.iter_mut().zip(maps) {
            let uniform = CasterUniform::new(&map.fit, view.origin);
            queue.write_buffer(&layer.caster_uniform, 0, bytemuck::bytes_of(&uniform));
            layer.used = map.fit.resolution.to_array();
        }
        let uniform = ReceiverUniform::new(maps, view, bias);
        queue.write_buffer(&self.receiver_uniform, 0, bytemuck::bytes_of(&uniform));
        let casters = if self.descriptor.depth_clamp { CasterPolicy::DepthClamp } else { CasterPolicy::None };
        self.volumes.clear();
        self.volumes.extend(maps.iter().map(|map| CasterVolume::of_map(&map.fit.relative_to(view.origin), casters)));
        Ok(())
    }

    fn check_fits(&self, maps: &[MapFit]) -> Result<(), ShadowMapError> {
        let map = (self.descriptor.resolution, self.descriptor.depth);
        let suits = |fit: &([u32; 2], DepthConvention)| {
            fit.1 == map.1 && fit.0.iter().zip(&map.0).all(|(fit, layer)| (1..=*layer).contains(fit))
        };
        let mut made_for = maps.iter().map(|map| (map.fit.resolution.to_array(), map.fit.depth)).enumerate();
        match made_for.find(|(_, fit)| !suits(fit)) {
            Some((index, fit)) => Err(ShadowMapError::Fit { index, fit, map }),
            None => Ok(()),
        }
    }

    /// Records one pass a prepared map: cleared to the far value, group 0 set to the map's caster
    /// uniform, then `draw(pass, map index, volume)`, which draws every caster that the volume
    /// (relative to the origin) keeps.
    pub fn render(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        mut draw: impl FnMut(&mut wgpu::RenderPass<'_>, usize, &CasterVolume),
    ) {
        for (index, volume) in self.volumes.iter().enumerate() {
            let mut pass = self.begin_pass(encoder, index, None);
            draw(&mut pass, index, volume);
        }
    }

    /// Opens the pass of one map, for engines that schedule passes themselves: cleared, with
    /// group 0 and the viewport set.
    ///
    /// # Panics
    ///
    /// If `index` is not below the descriptor's number of maps.
    pub fn begin_pass<'encoder>(
        &self,
        encoder: &'encoder mut wgpu::CommandEncoder,
        index: usize,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) -> wgpu::RenderPass<'encoder> {
        let layer = &self.layers[index];
        let far = self.far_depth();
        let color = layer.color.as_ref().map(|view| wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color { r: far.into(), g: 0.0, b: 0.0, a: 1.0 }),
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
        pass.set_bind_group(0, &layer.caster_group, &[]);
        let [width, height] = layer.used;
        pass.set_viewport(0.0, 0.0, width as f32, height as f32, 0.0, 1.0);
        pass
    }
}

impl Layer {
    fn new(
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        depth: &wgpu::Texture,
        color: Option<&wgpu::Texture>,
        index: u32,
    ) -> Self {
        let view = |texture: &wgpu::Texture| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: index,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let caster_uniform = uniform_buffer(device, size_of::<CasterUniform>());
        let caster_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadowfit caster"),
            layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: caster_uniform.as_entire_binding() }],
        });
        let used = [depth.width(), depth.height()];
        Self { depth: view(depth), color: color.map(view), caster_uniform, caster_group, used }
    }
}

fn check(descriptor: &ShadowMapDescriptor, device_limit: u32) -> Result<(), ShadowMapError> {
    let resolution = descriptor.resolution;
    if resolution.iter().any(|side| !RESOLUTIONS.contains(side) || *side > device_limit) {
        return Err(ShadowMapError::Resolution { resolution, device_limit });
    }
    if !(1..=MAX_MAPS as u32).contains(&descriptor.maps) {
        return Err(ShadowMapError::Maps(descriptor.maps));
    }
    if descriptor.depth == DepthConvention::NegativeOneToOne {
        return Err(ShadowMapError::Depth(descriptor.depth));
    }
    Ok(())
}

fn texture(device: &wgpu::Device, descriptor: &ShadowMapDescriptor, format: wgpu::TextureFormat) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("shadowfit map"),
        size: wgpu::Extent3d {
            width: descriptor.resolution[0],
            height: descriptor.resolution[1],
            depth_or_array_layers: descriptor.maps,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT
            | wgpu::TextureUsages::TEXTURE_BINDING
            | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

fn uniform_buffer(device: &wgpu::Device, size: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("shadowfit uniform"),
        size: size as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn comparison_sampler(device: &wgpu::Device, descriptor: &ShadowMapDescriptor) -> wgpu::Sampler {
    let filter = match descriptor.filter {
        FilterKind::Point => wgpu::FilterMode::Nearest,
        FilterKind::Hardware2x2 | FilterKind::Pcf3x3 | FilterKind::Pcf5x5 => wgpu::FilterMode::Linear,
    };
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("shadowfit comparison"),
        mag_filter: filter,
        min_filter: filter,
        compare: Some(match descriptor.depth {
            DepthConvention::Reversed => wgpu::CompareFunction::GreaterEqual,
            _ => wgpu::CompareFunction::LessEqual,
        }),
        ..Default::default()
    })
}

fn uniform_entry(visibility: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

fn caster_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("shadowfit caster"),
        entries: &[uniform_entry(wgpu::ShaderStages::VERTEX)],
    })
}

fn receiver_layout(device: &wgpu::Device, descriptor: &ShadowMapDescriptor) -> wgpu::BindGroupLayout {
    let is_depth = descriptor.format == MapFormat::Depth32Float;
    let texture = wgpu::BindGroupLayoutEntry {
        binding: 1,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: if is_depth {
                wgpu::TextureSampleType::Depth
            } else {
                wgpu::TextureSampleType::Float { filterable: false }
            },
            view_dimension: wgpu::TextureViewDimension::D2Array,
            multisampled: false,
        },
        count: None,
    };
    let sampler = wgpu::BindGroupLayoutEntry {
        binding: 2,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison),
        count: None,
    };
    let entries = [uniform_entry(wgpu::ShaderStages::FRAGMENT), texture, sampler];
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("shadowfit receiver"),
        entries: &entries[..if is_depth { 3 } else { 2 }],
    })
}

fn receiver_group(
    device: &wgpu::Device,
    descriptor: &ShadowMapDescriptor,
    layout: &wgpu::BindGroupLayout,
    uniform: &wgpu::Buffer,
    view: &wgpu::TextureView,
    sampler: &wgpu::Sampler,
) -> wgpu::BindGroup {
    let entries = [
        wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() },
        wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(view) },
        wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::Sampler(sampler) },
    ];
    let used = if descriptor.format == MapFormat::Depth32Float { 3 } else { 2 };
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("shadowfit receiver"),
        layout,
        entries: &entries[..used],
    })
}
