//! Depth bounds of maps for suns with a radius: a pyramid with the bounds of blocks of texels, then of blocks
//! of blocks. It is recomputed for maps that were drawn.

use shadowfit_gpu::bindings::{UNIFORM, group, layout, texture_array, written_texture};
use shadowfit_gpu::{catch_errors, compute_pipeline, wgsl_module};

use super::error::EdgeError;
use super::group::FLOATS;
use super::shader::{BLOCK, pyramid};
use crate::{MAX_MAPS, ShadowMapDescriptor, SunShadows};

/// Label of the pyramids' resources, for graphics debuggers.
const LABEL: &str = "shadowfit pyramid";
/// Width of a workgroup, in threads.
const SQUARE: u32 = 8;
/// Format of the bounds: nearest and farthest depth.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Float;
/// Binding of the bounds of maps.
pub(super) const BOUNDS: wgpu::BindingType = texture_array(wgpu::TextureSampleType::Float { filterable: false });
/// Blocks along the longer side of the coarsest level. A wider region is read in blocks of this level.
const COARSEST: u32 = 4;

/// Pyramids of all maps of a sun.
#[derive(Debug)]
pub(super) struct Pyramids {
    descriptor: ShadowMapDescriptor,
    /// View of the maps that the pyramids belong to.
    maps: wgpu::TextureView,
    /// View of all levels of all layers.
    pub(super) view: wgpu::TextureView,
    layers: Vec<Layer>,
    blocks: wgpu::ComputePipeline,
    levels: wgpu::ComputePipeline,
    /// Draw count of each map when its pyramid was computed.
    made: [Option<u64>; 2 * MAX_MAPS],
}

/// Bind groups of a layer: for the finest level, and from each level to the next.
#[derive(Debug)]
struct Layer {
    blocks: wgpu::BindGroup,
    levels: Vec<wgpu::BindGroup>,
    sizes: Vec<[u32; 2]>,
}

impl Pyramids {
    /// Returns the pyramids of a sun's maps, and keeps the present ones if they belong to the same maps.
    pub(super) fn of(present: Option<Self>, device: &wgpu::Device, sun: &SunShadows) -> Result<Self, EdgeError> {
        let (map, key) = (sun.map(), wgsl_key(sun.map().descriptor()));
        if let Some(present) = present.filter(|present| present.maps == *map.view() && present.descriptor == key) {
            return Ok(present);
        }
        catch_errors(device, || Self::new(device, sun, key)).map_err(|error| EdgeError::Device(error.to_string()))
    }

    fn new(device: &wgpu::Device, sun: &SunShadows, descriptor: ShadowMapDescriptor) -> Self {
        let (map, stages) = (sun.map(), wgpu::ShaderStages::COMPUTE);
        let written = written_texture(FORMAT);
        let of_blocks = layout(device, LABEL, stages, &[UNIFORM, written]);
        let of_levels = layout(device, LABEL, stages, &[FLOATS, written]);
        let pipeline = |layouts: &[_], wgsl, entry| {
            compute_pipeline(device, LABEL, layouts, &wgsl_module(device, LABEL, wgsl), entry)
        };
        let [blocks, levels] = pyramid(&descriptor);
        let texture = texture(device, &descriptor);
        let layers =
            (0..descriptor.layers()).map(|layer| Layer::new(device, &texture, [&of_blocks, &of_levels], layer));
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..Default::default()
        });
        Self {
            layers: layers.collect(),
            maps: map.view().clone(),
            view,
            blocks: pipeline(&[Some(map.receiver_layout()), Some(&of_blocks)], blocks, "gather_blocks"),
            levels: pipeline(&[Some(&of_levels)], levels, "join_blocks"),
            made: [None; 2 * MAX_MAPS],
            descriptor,
        }
    }

    /// Recomputes the pyramids of maps that were drawn since. `receiver` is a bind group of the look-up.
    pub(super) fn renew(&mut self, pass: &mut wgpu::ComputePass<'_>, sun: &SunShadows, receiver: &wgpu::BindGroup) {
        let first = sun.map().first_layer() as usize;
        let drawn = sun.cached().drawn();
        for (index, drawn) in drawn.iter().enumerate().take(sun.maps().len()) {
            let layer = first + index;
            if self.made[layer] == Some(*drawn) {
                continue;
            }
            self.made[layer] = Some(*drawn);
            let Layer { blocks, levels, sizes } = &self.layers[layer];
            pass.set_pipeline(&self.blocks);
            pass.set_bind_group(0, receiver, &[]);
            pass.set_bind_group(1, blocks, &[]);
            dispatch(pass, sizes[0]);
            pass.set_pipeline(&self.levels);
            for (group, size) in levels.iter().zip(&sizes[1..]) {
                pass.set_bind_group(0, group, &[]);
                dispatch(pass, *size);
            }
        }
    }
}

fn dispatch(pass: &mut wgpu::ComputePass<'_>, size: [u32; 2]) {
    let [x, y] = size.map(|side| side.div_ceil(SQUARE));
    pass.dispatch_workgroups(x, y, 1);
}

/// Returns the parts of the descriptor that the WGSL and the size of the pyramids depend on.
fn wgsl_key(descriptor: &ShadowMapDescriptor) -> ShadowMapDescriptor {
    let ShadowMapDescriptor { resolution, maps, format, depth, cross_fades, first_binding, .. } = *descriptor;
    ShadowMapDescriptor { resolution, maps, format, depth, cross_fades, first_binding, ..Default::default() }
}

fn texture(device: &wgpu::Device, descriptor: &ShadowMapDescriptor) -> wgpu::Texture {
    let blocks = descriptor.resolution.map(|side| side.div_ceil(BLOCK));
    let coarser = blocks[0].max(blocks[1]).div_ceil(COARSEST).next_power_of_two().ilog2();
    // Mip levels round down. Without this padding, the last blocks of a level would be missing in the next
    // one.
    let [width, height] = blocks.map(|side| side.next_multiple_of(1 << coarser));
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(LABEL),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: descriptor.layers() },
        mip_level_count: coarser + 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

impl Layer {
    fn new(
        device: &wgpu::Device,
        texture: &wgpu::Texture,
        [of_blocks, of_levels]: [&wgpu::BindGroupLayout; 2],
        layer: u32,
    ) -> Self {
        let levels = 0..texture.mip_level_count();
        let view = |level: u32| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_mip_level: level,
                mip_level_count: Some(1),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let views: Vec<wgpu::TextureView> = levels.clone().map(view).collect();
        let number = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(LABEL),
            size: 16,
            usage: wgpu::BufferUsages::UNIFORM,
            mapped_at_creation: true,
        });
        if let Ok(mut bytes) = number.slice(..).get_mapped_range_mut() {
            bytes.copy_from_slice(bytemuck::bytes_of(&[layer, 0, 0, 0]));
        }
        number.unmap();
        let blocks = [number.as_entire_binding(), wgpu::BindingResource::TextureView(&views[0])];
        let join = |pair: &[wgpu::TextureView; 2]| {
            let resources = pair.each_ref().map(wgpu::BindingResource::TextureView);
            group(device, LABEL, of_levels, &resources)
        };
        let size = |level: u32| [texture.width(), texture.height()].map(|side| side >> level);
        Self {
            blocks: group(device, LABEL, of_blocks, &blocks),
            levels: views.array_windows().map(join).collect(),
            sizes: levels.map(size).collect(),
        }
    }
}

#[cfg(test)]
#[path = "pyramid_gpu.rs"]
mod gpu;
