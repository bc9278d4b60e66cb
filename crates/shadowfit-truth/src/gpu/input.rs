//! A picture to judge on the GPU, and the uniform that is made of it for the shaders.

use glam::DVec3;
use shadowfit::choice::MapOrder;

use super::error::GpuTruthError;
use super::uniform::{JudgeUniform, MAX_MAPS, MapUniform};
use crate::camera::PixelCamera;
use crate::maps::{MapReading, MeasuredMap, PictureMaps};
use crate::truth::TruthSettings;

/// A picture to judge.
#[derive(Clone, Copy, Debug)]
pub struct GpuJudgeInput<'a> {
    /// Camera of the picture.
    pub camera: &'a PixelCamera,
    /// How truth is traced; the sun must be hard.
    pub settings: &'a TruthSettings,
    /// The maps, at most [`MAX_MAPS`].
    pub maps: &'a PictureMaps<'a>,
}

impl GpuJudgeInput<'_> {
    /// The uniform of the picture, for triangles that are stored relative to `origin`.
    pub(crate) fn uniform(&self, origin: DVec3, triangles: u32) -> Result<JudgeUniform, GpuTruthError> {
        let Self { camera, settings, maps } = self;
        if maps.maps.len() > MAX_MAPS {
            return Err(GpuTruthError::TooManyMaps(maps.maps.len()));
        }
        if settings.sun_radius > 0.0 {
            return Err(GpuTruthError::SoftSun);
        }
        let (order, blend) = match maps.reading {
            MapReading::ViewDepth => (MapOrder::by_area(maps.maps.iter().map(|_| Some(1.0))), None),
            MapReading::Coverage { order, blend } => (order, Some(blend)),
        };
        let mut uniforms = [MapUniform::default(); MAX_MAPS];
        let mut map_count = 0;
        let read = order.iter().filter_map(|index| Some((index, maps.maps.get(index)?)));
        for (uniform, (index, map)) in uniforms.iter_mut().zip(read) {
            let edge_width = maps.edge_width(Some(index));
            *uniform = MapUniform { index: index as u32, edge_width, ..map_uniform(map, camera.eye) };
            map_count += 1;
        }
        Ok(JudgeUniform {
            eye: (camera.eye - origin).as_vec3().into(),
            near: finite(camera.near),
            right: camera.right.as_vec3().into(),
            far: finite(camera.far),
            up: camera.up.as_vec3().into(),
            ray_offset: finite(settings.ray_offset),
            forward: camera.forward.as_vec3().into(),
            max_distance: finite(settings.max_distance),
            to_light: settings.to_light.as_vec3().into(),
            edge_width: maps.edge_width(None),
            tan_half_fov: camera.tan_half_fov.as_vec2().into(),
            size: camera.size,
            map_count,
            depth_clamp: maps.depth_clamp.into(),
            triangles,
            by_coverage: blend.is_some().into(),
            reach: maps.reach,
            blend: blend.unwrap_or(0.0),
            padding_0: 0,
            padding_1: 0,
            maps: uniforms,
        })
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

/// A length that shaders can compare: WGSL has no infinity.
fn finite(value: f64) -> f32 {
    (value as f32).clamp(f32::MIN, f32::MAX)
}
