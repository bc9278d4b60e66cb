//! Casters drawn into maps of any format: triangles, and boxes as instances of a cube. Also reads the depths
//! of the maps.

use shadowfit::FittedMap;
use shadowfit::glam::Vec3;
use shadowfit_wgpu::{ShadowMap, ShadowMapDescriptor, SunShadows, WgslOptions, caster_wgsl, receiver_wgsl};

use super::{Engine, Pipeline, vertices};

const CASTER: &str = "
struct Drawn_PREFIX {
    @builtin(position) clip: vec4<f32>,
    @location(0) depth: f32,
}
fn drawn_PREFIX(position: vec3<f32>) -> Drawn_PREFIX {
    return Drawn_PREFIX(PREFIX_caster_position(position), PREFIX_caster_depth(position));
}
@vertex fn triangles_PREFIX(@location(0) position: vec3<f32>) -> Drawn_PREFIX {
    return drawn_PREFIX(position);
}
@vertex fn boxes_PREFIX(
    @location(0) corner: vec3<f32>, @location(1) low: vec3<f32>, @location(2) high: vec3<f32>,
) -> Drawn_PREFIX {
    return drawn_PREFIX(mix(low, high, corner));
}
@fragment fn clamped_PREFIX(in: Drawn_PREFIX) -> @builtin(frag_depth) f32 {
    return PREFIX_clamped_depth(in.depth);
}
";

/// Fragment shaders for the formats with a colour target.
const COLOR: &str = "
struct Color_PREFIX {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}
@fragment fn color_PREFIX(in: Drawn_PREFIX) -> @location(0) vec4<f32> {
    return PREFIX_caster_color(in.clip.z);
}
@fragment fn clamped_color_PREFIX(in: Drawn_PREFIX) -> Color_PREFIX {
    let depth = PREFIX_clamped_depth(in.depth);
    return Color_PREFIX(PREFIX_caster_color(depth), depth);
}
";

/// Geometry of casters. The names are prefixes of the vertex shader's name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    Triangles,
    Boxes,
}

/// Casters in buffers, by number.
pub(crate) enum Casters {
    /// Triangles of each caster.
    Triangles(Vec<wgpu::Buffer>),
    /// Triangles of a unit cube, and the lower and upper corner of each box.
    Boxes { cube: wgpu::Buffer, boxes: wgpu::Buffer },
}

impl Casters {
    /// Creates casters from the triangles of each one.
    pub(crate) fn triangles(engine: &Engine, casters: impl IntoIterator<Item = impl AsRef<[Vec3]>>) -> Self {
        let buffer = |corners: &[Vec3]| engine.buffer(corners, wgpu::BufferUsages::VERTEX);
        Self::Triangles(casters.into_iter().map(|corners| buffer(corners.as_ref())).collect())
    }

    /// Creates casters from the lower and upper corner of each box.
    pub(crate) fn boxes(engine: &Engine, corners: &[[Vec3; 2]]) -> Self {
        let [cube, boxes] = [unit_cube().as_slice(), corners.as_flattened()]
            .map(|corners| engine.buffer(corners, wgpu::BufferUsages::VERTEX));
        Self::Boxes { cube, boxes }
    }

    /// Draws the casters with these numbers.
    pub(crate) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline, numbers: &[u32]) {
        pass.set_pipeline(pipeline);
        match self {
            Self::Triangles(buffers) => {
                for buffer in numbers.iter().map(|number| &buffers[*number as usize]) {
                    pass.set_vertex_buffer(0, buffer.slice(..));
                    // The buffer of an empty caster is too small for a triangle.
                    pass.draw(0..(buffer.size() / size_of::<Vec3>() as u64) as u32, 0..1);
                }
            }
            Self::Boxes { cube, boxes } => {
                pass.set_vertex_buffer(0, cube.slice(..));
                pass.set_vertex_buffer(1, boxes.slice(..));
                for number in numbers {
                    pass.draw(0..36, *number..number + 1);
                }
            }
        }
    }

    /// Draws the casters of a sun's passes, with its matrices at bind group 0.
    pub(crate) fn draw_sun(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::RenderPipeline,
        sun: &SunShadows,
    ) {
        sun.render(encoder, 0, |pass, region| self.draw(pass, pipeline, region.casters));
    }
}

/// Shader that draws casters into a map.
#[derive(Clone, Copy)]
pub(crate) struct CasterShader<'a> {
    pub(crate) map: &'a ShadowMap,
    pub(crate) shape: Shape,
    /// Bind group of the map's matrix.
    pub(crate) group: u32,
    /// Prefix of the names in WGSL.
    pub(crate) prefix: &'a str,
}

impl<'a> CasterShader<'a> {
    pub(crate) fn new(map: &'a ShadowMap, shape: Shape) -> Self {
        Self { map, shape, group: 0, prefix: "shadowfit" }
    }

    /// Returns the WGSL, which can share a module with WGSL of other prefixes.
    pub(crate) fn wgsl(&self) -> String {
        let options = WgslOptions::group(self.group).with_prefix(self.prefix).expect("a prefix");
        let color = if self.map.color_target().is_some() { COLOR } else { "" };
        caster_wgsl(self.map.descriptor(), &options) + &[CASTER, color].concat().replace("PREFIX", self.prefix)
    }

    /// Compiles the shader in a separate module.
    pub(crate) fn pipeline(&self, engine: &Engine) -> wgpu::RenderPipeline {
        self.pipeline_of(engine, &self.wgsl())
    }

    /// Compiles the shader in a module that contains its WGSL.
    pub(crate) fn pipeline_of(&self, engine: &Engine, wgsl: &str) -> wgpu::RenderPipeline {
        let Self { map, shape, group, prefix } = *self;
        let mut groups = vec![None; group as usize];
        groups.push(Some(map.caster_layout()));
        let color = map.color_target();
        let fragment = match (color.is_some(), map.clamps_in_fragment()) {
            (false, false) => None,
            (false, true) => Some("clamped"),
            (true, false) => Some("color"),
            (true, true) => Some("clamped_color"),
        };
        let corner = wgpu::vertex_attr_array![0 => Float32x3];
        let bounds = wgpu::vertex_attr_array![1 => Float32x3, 2 => Float32x3];
        let buffers =
            [vertices(&corner, wgpu::VertexStepMode::Vertex), vertices(&bounds, wgpu::VertexStepMode::Instance)];
        let (vertex, buffers) = match shape {
            Shape::Triangles => ("triangles", &buffers[..1]),
            Shape::Boxes => ("boxes", &buffers[..]),
        };
        Pipeline {
            layout: Some(&engine.layout(&groups)),
            vertex: &format!("{vertex}_{prefix}"),
            buffers,
            fragment: fragment.map(|entry| format!("{entry}_{prefix}")).as_deref(),
            targets: &color.map(Some).into_iter().collect::<Vec<_>>(),
            primitive: map.primitive_state(),
            depth: Some(map.depth_stencil_state()),
            ..Pipeline::new(wgsl)
        }
        .make(engine)
    }
}

/// Returns the WGSL of the look-up into maps, with a first line that differs for every layout of their bind group.
pub(crate) fn look_up_wgsl(map: &ShadowMapDescriptor, options: &WgslOptions<'_>) -> String {
    format!("// {:?}\n", map.format) + &receiver_wgsl(map, options)
}

/// Returns the triangles of a cube from 0 to 1, with any winding.
fn unit_cube() -> Vec<Vec3> {
    let face = |axis: usize, side: f32| {
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[u, v]| {
            let mut corner = [0.0; 3];
            (corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (side, u, v);
            Vec3::from(corner)
        })
    };
    (0..3).flat_map(|axis| [face(axis, 0.0), face(axis, 1.0)]).flatten().collect()
}

impl Engine {
    /// Returns the depths of each map of a sun, row by row as the look-up reads them, without their wrap.
    pub(crate) fn unwrapped(&self, sun: &SunShadows) -> Vec<Vec<f32>> {
        let texture = sun.map().view().texture();
        let [width, height] = [texture.width(), texture.height()];
        let depths: Vec<f32> = self.texels(texture);
        let layer = |(index, map): (u32, &FittedMap)| {
            let used = map.projection.resolution;
            let row = |y: u32| {
                let start = (index * height + (y + map.texel_offset.y) % used.y) * width;
                let (end, begin) = depths[start as usize..][..used.x as usize].split_at(map.texel_offset.x as usize);
                [begin, end].concat()
            };
            (0..used.y).map(row).collect::<Vec<_>>().concat()
        };
        (0..).zip(sun.maps()).map(layer).collect()
    }
}
