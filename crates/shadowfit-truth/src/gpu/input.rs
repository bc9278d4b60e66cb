//! A picture to judge on the GPU, and the uniform that the shaders read for it.

use glam::DVec3;
use shadowfit::selection::MapOrder;

use super::error::GpuTruthError;
use super::uniform::{BeforeUniform, JudgeUniform, MAX_MAPS, MapUniform};
use crate::camera::PixelCamera;
use crate::light::TruthLight;
use crate::maps::{MapReading, MeasuredMap, PictureMaps};
use crate::truth::TruthSettings;

/// A picture to judge.
#[derive(Clone, Debug)]
pub struct GpuJudgeInput<'a> {
    /// Camera of the picture.
    pub camera: &'a PixelCamera,
    /// How the truth is traced. The light must be a sun with hard shadows.
    pub settings: &'a TruthSettings,
    /// The maps, at most [`MAX_MAPS`].
    pub maps: &'a PictureMaps<'a>,
    /// The maps of the previous frame, compared for [`GpuTally::crawl_compared`](super::GpuTally). `None`
    /// skips the comparison.
    pub before: Option<GpuBefore<'a>>,
    /// Timestamps of the start and the end of the pass, if wanted.
    pub timestamp_writes: Option<wgpu::ComputePassTimestampWrites<'a>>,
}

/// The maps of the previous frame, and their factors at the points of this frame. Like
/// [`MapsBefore`](crate::MapsBefore).
#[derive(Clone, Copy, Debug)]
pub struct GpuBefore<'a> {
    /// The previous frame's maps, at most [`MAX_MAPS`], and how they were read.
    pub maps: &'a PictureMaps<'a>,
    /// The previous frame's eye, world space, metres.
    pub eye: DVec3,
    /// The previous frame's unit view direction, world axes. Selection by view depth uses view depths along
    /// it.
    pub forward: DVec3,
    /// An `Rg32Uint` texture drawn with this frame's camera, as [`GpuJudge::judge`](super::GpuJudge::judge)
    /// takes it. Its second channel has the bits of the factor that the previous frame's maps give to this
    /// frame's point. The first channel is ignored.
    pub seen: &'a wgpu::TextureView,
}

impl GpuJudgeInput<'_> {
    /// Creates the uniform of the picture, for triangles that are stored relative to `origin`.
    pub(crate) fn uniform(&self, origin: DVec3, triangles: u32) -> Result<JudgeUniform, GpuTruthError> {
        let Self { camera, settings, maps, before, timestamp_writes: _ } = self;
        let to_light = match settings.light {
            TruthLight::Sun { radius, .. } if radius > 0.0 => return Err(GpuTruthError::SoftSun),
            TruthLight::Sun { to_light, .. } => to_light,
            TruthLight::Spot { .. } => return Err(GpuTruthError::PositionalLight),
        };
        let read = ReadMaps::new(maps, camera.eye)?;
        Ok(JudgeUniform {
            eye: (camera.eye - origin).as_vec3().into(),
            near: finite(camera.near),
            right: camera.right.as_vec3().into(),
            far: finite(camera.far),
            up: camera.up.as_vec3().into(),
            ray_offset: finite(settings.ray_offset),
            forward: camera.forward.as_vec3().into(),
            max_distance: finite(settings.max_distance),
            to_light: to_light.as_vec3().into(),
            edge_width: maps.edge_width(None),
            half_size: camera.half_size.as_vec2().into(),
            size: camera.size,
            map_count: read.count,
            depth_clamp: maps.depth_clamp.into(),
            triangles,
            by_coverage: read.blend.is_some().into(),
            reach: maps.filter_radius,
            blend: read.blend.unwrap_or(0.0),
            is_orthographic: camera.is_orthographic.into(),
            padding: 0,
            maps: read.uniforms,
            before: before.map_or(Ok(BeforeUniform::default()), |before| before.uniform(camera.eye))?,
        })
    }
}

impl GpuBefore<'_> {
    /// Creates the uniform for points relative to this frame's `eye`.
    fn uniform(&self, eye: DVec3) -> Result<BeforeUniform, GpuTruthError> {
        let read = ReadMaps::new(self.maps, eye)?;
        Ok(BeforeUniform {
            forward: self.forward.as_vec3().into(),
            eye_depth: finite((eye - self.eye).dot(self.forward)),
            map_count: read.count,
            by_coverage: read.blend.is_some().into(),
            padding_0: 0,
            padding_1: 0,
            maps: read.uniforms,
        })
    }
}

/// Maps in the order of selection.
struct ReadMaps {
    uniforms: [MapUniform; MAX_MAPS],
    count: u32,
    /// Texels over which a map is blended into the next one, if selected by coverage; `None` if selected by
    /// view depth.
    blend: Option<f32>,
}

impl ReadMaps {
    /// Sorts the maps and makes their rows relative to `eye`.
    fn new(maps: &PictureMaps, eye: DVec3) -> Result<Self, GpuTruthError> {
        if maps.maps.len() > MAX_MAPS {
            return Err(GpuTruthError::TooManyMaps(maps.maps.len()));
        }
        let (order, blend) = match maps.reading {
            MapReading::ViewDepth => (MapOrder::by_area(maps.maps.iter().map(|_| Some(1.0))), None),
            MapReading::Coverage { order, blend } => (order, Some(blend)),
        };
        let mut uniforms = [MapUniform::default(); MAX_MAPS];
        let mut count = 0;
        let read = order.iter().filter_map(|index| Some((index, maps.maps.get(index)?)));
        for (uniform, (index, map)) in uniforms.iter_mut().zip(read) {
            let edge_width = maps.edge_width(Some(index));
            *uniform = MapUniform { index: index as u32, edge_width, ..map_uniform(map, eye) };
            count += 1;
        }
        Ok(Self { uniforms, count, blend })
    }
}

fn map_uniform(map: &MeasuredMap, eye: DVec3) -> MapUniform {
    let [row_x, row_y, row_z, row_w] = map.rows_from(eye).map(|row| row.as_vec4().into());
    MapUniform {
        row_x,
        row_y,
        row_z,
        row_w,
        size: map.size.as_vec2().into(),
        split_far: finite(map.split_far),
        is_reversed: map.is_reversed.into(),
        blend_near: finite(map.blend_near),
        ..MapUniform::default()
    }
}

/// Clamps a length to finite values, because WGSL has no infinity.
fn finite(value: f64) -> f32 {
    (value as f32).clamp(f32::MIN, f32::MAX)
}
