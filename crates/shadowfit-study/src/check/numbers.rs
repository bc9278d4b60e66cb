//! Numbers that shaders compute, read back: shadow factors at points, the texels of maps, and a depth buffer.
//! Each number is a pixel of an integer picture with the float's bits, which every device can draw.

use anyhow::Result;
use shadowfit_render::{Gpu, ReadBack, bindings};
use shadowfit_wgpu::demand::Depths;
use shadowfit_wgpu::{ShadowMap, WgslOptions, receiver_wgsl, stored_wgsl};
use wgpu::util::DeviceExt;

use super::texels::Texels;

/// A position relative to the maps' origin, in metres, and a unit normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Point {
    pub(super) position: [f32; 3],
    pub(super) normal: [f32; 3],
}

/// Points per row of their picture. A power of two keeps the centres of pixels exact.
const ROW: u32 = 256;

/// Format of the pictures, for the bits of floats.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// Draws a point into each pixel, and computes the factor there.
const POINTS: &str = "
struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) position: vec3<f32>,
    @location(1) @interpolate(flat) normal: vec3<f32>,
}
@vertex fn vs(
    @builtin(vertex_index) index: u32, @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>,
) -> Varying {
    let pixel = vec2<f32>(f32(index % ROW), f32(index / ROW)) + 0.5;
    let ndc = pixel / vec2<f32>(f32(ROW), f32(ROWS)) * vec2<f32>(2.0, -2.0) + vec2<f32>(-1.0, 1.0);
    return Varying(vec4<f32>(ndc, 0.0, 1.0), position, normal);
}
@fragment fn fs(in: Varying) -> @location(0) u32 {
    return bitcast<u32>(shadowfit_factor(in.position, in.normal));
}
";

/// Draws a triangle over the whole picture.
const WHOLE: &str = "
@vertex fn vs(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.5, 1.0);
}
";

/// Writes the texels of all maps, one map below the other.
const TEXELS: &str = "
@fragment fn fs(@builtin(position) pixel: vec4<f32>) -> @location(0) u32 {
    let at = vec2<i32>(pixel.xy);
    return bitcast<u32>(shadowfit_stored(at.y / HEIGHT, vec2<i32>(at.x, at.y % HEIGHT)));
}
";

/// Writes the depths of a depth buffer.
const DEPTHS: &str = "
@group(0) @binding(0) var depths: texture_depth_2d;
@fragment fn fs(@builtin(position) pixel: vec4<f32>) -> @location(0) u32 {
    return bitcast<u32>(textureLoad(depths, vec2<i32>(pixel.xy), 0));
}
";

/// Draws one triangle into each cell of four by four pixels, each moved to the right by another fraction of a
/// pixel. At the cell's second pixel across and down, it writes the distance of its middle from that pixel's
/// centre, in pixels.
const MOVED: &str = "
struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) across: f32,
}
@vertex fn vs(@builtin(vertex_index) index: u32) -> Varying {
    let cell = index / 3u;
    let corner = select(vec2<f32>(select(-1.25, 1.25, index % 3u == 1u), -1.25), vec2<f32>(0.0, 1.25), index % 3u == 2u);
    let moved = (f32(cell) / f32(PARTS) - 0.5) * RANGE;
    let middle = vec2<f32>(f32(cell % COLUMNS), f32(cell / COLUMNS)) * 4.0 + vec2<f32>(1.5 + moved, 1.5);
    let ndc = (middle + corner) / vec2<f32>(f32(WIDTH), f32(HEIGHT)) * vec2<f32>(2.0, -2.0) + vec2<f32>(-1.0, 1.0);
    return Varying(vec4<f32>(ndc, 0.0, 1.0), corner.x);
}
@fragment fn fs(in: Varying) -> @location(0) u32 {
    return bitcast<u32>(in.across);
}
";

/// A picture of numbers.
struct Numbers<'a> {
    label: &'static str,
    wgsl: &'a str,
    bound: (&'a wgpu::BindGroupLayout, &'a wgpu::BindGroup),
    /// Bytes of the vertices and their number, if the picture is drawn by points.
    points: Option<(&'a [u8], u32)>,
    /// Number of triangles without vertex buffers, if it is not.
    triangles: u32,
    size: [u32; 2],
}

impl Numbers<'_> {
    /// Draws the picture and reads it back, rows from the top.
    async fn read(&self, gpu: &Gpu) -> Result<Vec<f32>> {
        let pipeline = self.pipeline(&gpu.device);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let texture = bindings::plain_texture(&gpu.device, self.label, self.size, FORMAT, usage);
        let view = texture.create_view(&Default::default());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(self.label),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, self.bound.1, &[]);
        match self.points {
            Some((contents, count)) => {
                let usage = wgpu::BufferUsages::VERTEX;
                let descriptor = wgpu::util::BufferInitDescriptor { label: Some(self.label), contents, usage };
                pass.set_vertex_buffer(0, gpu.device.create_buffer_init(&descriptor).slice(..));
                pass.draw(0..count, 0..1);
            }
            None => pass.draw(0..3 * self.triangles, 0..1),
        }
        drop(pass);
        gpu.submit([encoder.finish()]);
        let bytes = ReadBack::new(gpu, &texture, self.size, 4).arrive(gpu).await?;
        Ok(bytes.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect())
    }

    fn pipeline(&self, device: &wgpu::Device) -> wgpu::RenderPipeline {
        let source = wgpu::ShaderSource::Wgsl(self.wgsl.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(self.label), source });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(self.label),
            bind_group_layouts: &[Some(self.bound.0)],
            immediate_size: 0,
        });
        let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];
        let buffers = [Some(wgpu::VertexBufferLayout {
            array_stride: 24,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        })];
        let topology = match self.points {
            Some(_) => wgpu::PrimitiveTopology::PointList,
            None => wgpu::PrimitiveTopology::TriangleList,
        };
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.label),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vs"),
                compilation_options: Default::default(),
                buffers: if self.points.is_some() { &buffers } else { &[] },
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fs"),
                compilation_options: Default::default(),
                targets: &[Some(FORMAT.into())],
            }),
            primitive: wgpu::PrimitiveState { topology, ..Default::default() },
            depth_stencil: None,
            multisample: Default::default(),
            multiview_mask: None,
            cache: None,
        })
    }
}

/// Returns the shadow factors at points, computed by the look-up's WGSL.
pub(super) async fn factors(gpu: &Gpu, map: &ShadowMap, points: &[Point]) -> Result<Vec<f32>> {
    let count = points.len() as u32;
    let rows = count.div_ceil(ROW).max(1);
    let constants = format!("const ROW = {ROW}u; const ROWS = {rows}u;");
    let wgsl = [&receiver_wgsl(map.descriptor(), &WgslOptions::group(0)), POINTS, &constants].concat();
    let values = points.iter().flat_map(|point| [point.position, point.normal]).flatten();
    let bytes: Vec<u8> = values.flat_map(f32::to_le_bytes).collect();
    let numbers = Numbers {
        label: "factors",
        wgsl: &wgsl,
        bound: (map.receiver_layout(), map.receiver_group()),
        points: Some((&bytes, count)),
        triangles: 0,
        size: [ROW, rows],
    };
    let mut factors = numbers.read(gpu).await?;
    factors.truncate(points.len());
    Ok(factors)
}

/// Returns the depths that the maps store, as the look-up finds them: without the texel offset of maps that
/// are stored with a shift.
pub(super) async fn texels(gpu: &Gpu, map: &ShadowMap) -> Result<Vec<Texels>> {
    let descriptor = map.descriptor();
    let [width, height] = descriptor.resolution;
    let options = WgslOptions::group(0);
    let stored = stored_wgsl(descriptor, &options, gpu.adapter.get_info().backend);
    let fragment = TEXELS.replace("HEIGHT", &height.to_string());
    let wgsl = [&receiver_wgsl(descriptor, &options), &stored, WHOLE, &fragment].concat();
    let numbers = Numbers {
        label: "texels",
        wgsl: &wgsl,
        bound: (map.receiver_layout(), map.receiver_group()),
        points: None,
        triangles: 1,
        size: [width, height * descriptor.maps],
    };
    let depths = numbers.read(gpu).await?;
    let maps = depths.chunks_exact((width * height) as usize);
    Ok(maps.map(|depths| Texels { width, depths: depths.to_vec() }).collect())
}

/// Returns the values of a depth buffer with one sample per pixel. OpenGL's shaders cannot load them.
pub(super) async fn depths(gpu: &Gpu, view: &wgpu::TextureView) -> Result<Depths> {
    let size = [view.texture().width(), view.texture().height()];
    let sample_type = wgpu::TextureSampleType::Depth;
    let binding =
        wgpu::BindingType::Texture { sample_type, view_dimension: wgpu::TextureViewDimension::D2, multisampled: false };
    let layout = bindings::layout(&gpu.device, "depths", wgpu::ShaderStages::FRAGMENT, &[binding]);
    let group = bindings::group(&gpu.device, "depths", &layout, &[wgpu::BindingResource::TextureView(view)]);
    let wgsl = [WHOLE, DEPTHS].concat();
    let numbers = Numbers { label: "depths", wgsl: &wgsl, bound: (&layout, &group), points: None, triangles: 1, size };
    Ok(Depths { width: size[0], values: numbers.read(gpu).await? })
}

/// Range over which triangles are moved, in pixels, and the number of steps.
const RANGE: f32 = 0.5;
const PARTS: u32 = 512;

/// Returns the number of steps per pixel to which the device rounds corners of triangles, at most 1,024.
/// Direct3D guarantees 256, Vulkan 16.
pub(super) async fn steps_in_a_pixel(gpu: &Gpu) -> Result<u32> {
    // Powers of two keep the corners exact.
    let size @ [width, height] = [64, 256];
    let columns = width / 4;
    let constants = format!(
        "const PARTS = {PARTS}u; const RANGE = {RANGE:?}; const COLUMNS = {columns}u; const WIDTH = {width}u; \
         const HEIGHT = {height}u;"
    );
    let wgsl = [MOVED, &constants].concat();
    let layout = bindings::layout(&gpu.device, "moved", wgpu::ShaderStages::FRAGMENT, &[]);
    let group = bindings::group(&gpu.device, "moved", &layout, &[]);
    let (bound, triangles) = ((&layout, &group), PARTS + 1);
    let numbers = Numbers { label: "moved", wgsl: &wgsl, bound, points: None, triangles, size }.read(gpu).await?;
    let at = |cell: u32| numbers[((cell / columns * 4 + 1) * width + cell % columns * 4 + 1) as usize];
    let mut shown: Vec<f32> = (0..=PARTS).map(at).collect();
    shown.sort_by(f32::total_cmp);
    // Numbers closer than half of the finest step differ only by f32 rounding.
    let finest = RANGE / PARTS as f32;
    let steps = shown.windows(2).filter(|pair| pair[1] - pair[0] > 0.5 * finest).count();
    Ok((steps as f32 / RANGE) as u32)
}
