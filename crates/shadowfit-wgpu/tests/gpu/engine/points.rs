//! WGSL evaluated at points: each point is a pixel of a texture of answers.

use super::{Engine, Pipeline, cleared, vertices};

/// A position relative to the origin, in metres, and a unit normal.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct Point {
    pub(crate) position: [f32; 3],
    pub(crate) normal: [f32; 3],
}

/// The values that the WGSL's `answer` returns for a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Values {
    pub(crate) one: [f32; 4],
    pub(crate) other: [f32; 4],
}

/// A bind group with its layout.
#[derive(Clone, Copy)]
pub(crate) struct Bound<'a> {
    pub(crate) layout: &'a wgpu::BindGroupLayout,
    pub(crate) group: &'a wgpu::BindGroup,
}

/// Format of a texture of answers.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

const POINTS: &str = "
struct Varying {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) position: vec3<f32>,
    @location(1) @interpolate(flat) normal: vec3<f32>,
}
struct Answer {
    @location(0) one: vec4<f32>,
    @location(1) other: vec4<f32>,
}
@vertex fn vs(
    @builtin(vertex_index) index: u32, @location(0) position: vec3<f32>, @location(1) normal: vec3<f32>,
) -> Varying {
    let pixel = vec2<f32>(f32(index % ROW), f32(index / ROW)) + 0.5;
    let ndc = pixel / vec2<f32>(f32(ROW), f32(ROWS)) * vec2<f32>(2.0, -2.0) + vec2<f32>(-1.0, 1.0);
    return Varying(vec4<f32>(ndc, 0.0, 1.0), position, normal);
}
@fragment fn fs(in: Varying) -> Answer {
    return answer(in.position, in.normal, in.clip.xy);
}
";

impl Engine {
    /// Evaluates the function `answer` of some WGSL at points: `fn answer(position: vec3<f32>, normal:
    /// vec3<f32>, pixel: vec2<f32>) -> Answer`. Point i is pixel (i mod `row`, i / `row`).
    pub(crate) fn ask(&self, wgsl: &str, bound: &[Bound<'_>], points: &[Point], row: u32) -> Vec<Values> {
        if bound.len() > 1 {
            self.require_bindings();
        }
        let rows = (points.len() as u32).div_ceil(row).max(1);
        let wgsl = format!("{wgsl}{POINTS}const ROW = {row}u; const ROWS = {rows}u;");
        let layouts: Vec<_> = bound.iter().map(|bound| Some(bound.layout)).collect();
        let pipeline = Pipeline {
            layout: Some(&self.layout(&layouts)),
            buffers: &[vertices(
                &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3],
                wgpu::VertexStepMode::Vertex,
            )],
            targets: &[Some(FORMAT.into()), Some(FORMAT.into())],
            primitive: wgpu::PrimitiveState { topology: wgpu::PrimitiveTopology::PointList, ..Default::default() },
            ..Pipeline::new(&wgsl)
        }
        .make(self);
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let targets = [(); 2].map(|()| self.texture([row, rows], 1, FORMAT, usage));
        let buffer = self.buffer(points, wgpu::BufferUsages::VERTEX);
        let mut encoder = self.encoder();
        let mut pass = cleared(&mut encoder, &targets.each_ref(), None);
        pass.set_pipeline(&pipeline);
        for (index, bound) in (0..).zip(bound) {
            pass.set_bind_group(index, bound.group, &[]);
        }
        pass.set_vertex_buffer(0, buffer.slice(..));
        pass.draw(0..points.len() as u32, 0..1);
        drop(pass);
        self.submit(encoder);
        let [one, other] = targets.map(|target| self.texels::<[f32; 4]>(target.texture()));
        one.into_iter().zip(other).map(|(one, other)| Values { one, other }).take(points.len()).collect()
    }
}
