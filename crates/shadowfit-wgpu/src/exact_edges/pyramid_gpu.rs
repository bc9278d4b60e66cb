//! Compares pyramids with bounds that the CPU computes, in maps with hand-written texels.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::settings::{Edges, FilterKind, MapFormat};
use shadowfit::{Aabb, Boxes, DepthConvention, PerspectiveCamera, Technique};
use shadowfit_gpu::bindings::storage;
use shadowfit_testing::{TestGpu, test_gpu};

use super::*;
use crate::{Casters, MapTexture, SunFrame, SunShadowsDescriptor};

/// Maps with hand-written texels. No caster is drawn into them.
struct Bench {
    device: wgpu::Device,
    queue: wgpu::Queue,
    sun: SunShadows,
    texture: wgpu::Texture,
    size: [u32; 2],
    is_reversed: bool,
    pyramids: Option<Pyramids>,
}

/// Depths of a layer, in rows.
type Texels = Vec<f32>;

impl Bench {
    fn new(size: [u32; 2], depth: DepthConvention, format: MapFormat) -> Self {
        let TestGpu { device, queue, .. } = test_gpu();
        let mut technique = Technique::preset("stable-4").expect("a preset").with_resolution(size[0], size[1]);
        technique.fit.depth = depth;
        let technique = technique
            .with_max_distance(30.0)
            .with_filter(FilterKind::Vogel8)
            .with_format(format)
            .with_edges(Edges::Traced { samples: 4 });
        let needed = ShadowMapDescriptor::from(&technique).texture();
        let texture = device
            .create_texture(&wgpu::TextureDescriptor { usage: needed.usage | wgpu::TextureUsages::COPY_DST, ..needed });
        let maps = MapTexture { texture: texture.clone(), base_layer: 0 };
        let in_texture = SunShadowsDescriptor { texture: Some(maps), ..technique.into() };
        let sun = SunShadows::new(&device, &queue, &in_texture).expect("maps");
        let is_reversed = depth == DepthConvention::Reversed;
        Self { device, queue, sun, texture, size, is_reversed, pyramids: None }
    }

    /// Updates the sun with a frame of two static boxes, near and far.
    fn update(&mut self) {
        let near = Aabb::new(Vec3::new(-0.5, 0.0, -3.5), Vec3::new(0.5, 1.0, -2.5));
        let boxes = [near, Aabb::new(Vec3::new(-0.5, 0.0, -25.0), Vec3::new(0.5, 1.0, -24.0))];
        let boxes = Boxes { origin: DVec3::ZERO, boxes: &boxes };
        let camera = PerspectiveCamera {
            eye: DVec3::Y,
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: 0.9,
            aspect: 1.5,
            near: 0.1,
            far: 60.0,
        };
        let views = [camera.frustum().expect("a camera")];
        let frame = SunFrame::new(&views, Vec3::new(0.3, -1.0, 0.2).normalize(), boxes, Casters::fixed(boxes));
        self.sun.update(&self.queue, &frame.with_origin(DVec3::ZERO)).expect("a good frame");
    }

    /// Writes new depths into all maps, and returns them.
    fn write(&self, seed: u32) -> Vec<Texels> {
        let [width, height] = self.size;
        let noise = |index: u32| (index.wrapping_mul(0x9E37_79B9) ^ seed).wrapping_mul(0x85EB_CA6B) >> 8;
        let depth = |index: u32| noise(index) as f32 / 16_777_216.0;
        let layers: Vec<Texels> = (0..self.texture.depth_or_array_layers())
            .map(|layer| (0..width * height).map(|texel| depth(layer * width * height + texel)).collect())
            .collect();
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(width * 4), rows_per_image: Some(height) };
        let all = layers.concat();
        self.queue.write_texture(self.texture.as_image_copy(), bytemuck::cast_slice(&all), layout, self.texture.size());
        layers
    }

    /// Clears all texels of all maps, which have a depth format, to the same depth.
    fn clear(&self, depth: f32) -> Vec<Texels> {
        let layers = 0..self.texture.depth_or_array_layers();
        let mut encoder = self.device.create_command_encoder(&Default::default());
        for layer in layers.clone() {
            let view = self.texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            });
            let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(depth), store: wgpu::StoreOp::Store };
            drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &view,
                    depth_ops: Some(ops),
                    stencil_ops: None,
                }),
                ..Default::default()
            }));
        }
        self.queue.submit([encoder.finish()]);
        layers.map(|_| vec![depth; (self.size[0] * self.size[1]) as usize]).collect()
    }

    fn renew(&mut self) {
        let mut pyramids = Pyramids::of(self.pyramids.take(), &self.device, &self.sun).expect("room");
        let mut encoder = self.device.create_command_encoder(&Default::default());
        pyramids.renew(&mut encoder.begin_compute_pass(&Default::default()), &self.sun, self.sun.receiver_group());
        self.queue.submit([encoder.finish()]);
        self.pyramids = Some(pyramids);
    }

    /// Returns the bounds of each block of a level of a layer, in rows, and the number of blocks per row.
    fn read(&self, layer: usize, level: usize) -> (Vec<[f32; 2]>, u32) {
        let pyramids = self.pyramids.as_ref().expect("made");
        let [width, height] = pyramids.layers[layer].sizes[level];
        let bytes = u64::from(width * height) * 8;
        let buffer = |usage| {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: bytes,
                usage,
                mapped_at_creation: false,
            })
        };
        let values = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
        let read = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
        let layout = layout(&self.device, "read", wgpu::ShaderStages::COMPUTE, &[BOUNDS, storage(false)]);
        let resources = [wgpu::BindingResource::TextureView(&pyramids.view), values.as_entire_binding()];
        let group = group(&self.device, "read", &layout, &resources);
        let wgsl = READ.replace("LAYER", &layer.to_string()).replace("LEVEL", &level.to_string());
        let module = wgsl_module(&self.device, "read", wgsl);
        let pipeline = compute_pipeline(&self.device, "read", &[Some(&layout)], &module, "read");
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(width, height, 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&values, 0, &read, 0, bytes);
        self.queue.submit([encoder.finish()]);
        read.slice(..).map_async(wgpu::MapMode::Read, |result| result.expect("mapped"));
        self.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device works");
        (bytemuck::pod_collect_to_vec(&read.slice(..).get_mapped_range().expect("mapped")), width)
    }

    /// Returns the nearest and the farthest depth of the texels of a block.
    fn bounds(&self, texels: &Texels, side: u32, [x, y]: [u32; 2]) -> [f32; 2] {
        let [width, height] = self.size;
        let rows = y * side..((y + 1) * side).min(height);
        let of_row = |row: u32| &texels[(row * width + x * side) as usize..][..side.min(width - x * side) as usize];
        let all = rows.flat_map(of_row).copied();
        let [least, most] = [all.clone().fold(f32::MAX, f32::min), all.fold(f32::MIN, f32::max)];
        if self.is_reversed { [most, least] } else { [least, most] }
    }

    /// Asserts that all levels of a layer contain the bounds of these texels, and that each level covers all
    /// texels.
    fn assert_bounds(&self, layer: usize, texels: &Texels) {
        let levels = self.pyramids.as_ref().expect("made").layers[layer].sizes.len();
        for level in 0..levels {
            let side = BLOCK << level;
            let (found, columns) = self.read(layer, level);
            let [across, down] = self.size.map(|texels| texels.div_ceil(side));
            assert!(across <= columns && down <= found.len() as u32 / columns, "level {level} of {:?}", self.size);
            for (x, y) in (0..down).flat_map(|y| (0..across).map(move |x| (x, y))) {
                let wanted = self.bounds(texels, side, [x, y]);
                let bounds = found[(y * columns + x) as usize];
                assert_eq!(bounds, wanted, "block ({x}, {y}), level {level}, layer {layer}, {:?}", self.size);
            }
        }
        assert!(self.size.map(|texels| texels.div_ceil(BLOCK << (levels - 1))).iter().all(|side| *side <= COARSEST));
    }
}

const READ: &str = "
@group(0) @binding(0) var bounds: texture_2d_array<f32>;
@group(0) @binding(1) var<storage, read_write> values: array<vec2<f32>>;
@compute @workgroup_size(1) fn read(@builtin(global_invocation_id) id: vec3<u32>) {
    values[id.y * textureDimensions(bounds, LEVEL).x + id.x] = textureLoad(bounds, id.xy, LAYER, LEVEL).xy;
}
";

#[test]
fn each_level_has_the_nearest_and_the_farthest_depth_of_each_block_in_both_conventions() {
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed] {
        // The last two sizes are not multiples of the block size, at any level or at the coarser levels.
        for size in [[256, 256], [512, 256], [260, 301], [404, 404]] {
            let mut bench = Bench::new(size, depth, MapFormat::R32Float);
            bench.update();
            let layers = bench.write(1);
            bench.renew();
            for (layer, texels) in layers.iter().enumerate() {
                bench.assert_bounds(layer, texels);
            }
        }
    }
}

#[test]
fn the_pyramids_of_maps_that_were_drawn_are_renewed_and_no_others() {
    let mut bench = Bench::new([256, 256], DepthConvention::Reversed, MapFormat::Depth32Float);
    let mut held = bench.clear(0.0);
    let (mut renewed, mut kept) = (0, 0);
    for frame in 1..5_u8 {
        let before = *bench.sun.cached().drawn();
        if frame == 3 {
            // A change far from the eye, in an area that not all maps cover.
            bench.sun.invalidate(&Aabb::new(Vec3::new(-0.2, 0.0, -24.8), Vec3::new(0.2, 0.5, -24.2)), DVec3::ZERO);
        }
        bench.update();
        let cleared = bench.clear(f32::from(frame) * 0.125);
        bench.renew();
        for (layer, texels) in cleared.into_iter().enumerate() {
            if before[layer] == bench.sun.cached().drawn()[layer] {
                kept += 1;
            } else {
                held[layer] = texels;
                renewed += usize::from(frame > 1);
            }
            bench.assert_bounds(layer, &held[layer]);
        }
    }
    // All maps are drawn in the first frame, some in the third, and none in the second and the last.
    assert!((1..4).contains(&renewed) && renewed + kept == 12, "{renewed} renewed, {kept} kept");
}
