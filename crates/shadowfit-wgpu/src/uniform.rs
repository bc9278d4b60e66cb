//! The uniforms that the WGSL reads. Their layout is compared with naga's reflection of the
//! shaders in the tests, so that the two cannot drift apart.

use bytemuck::{Pod, Zeroable};
use shadowfit::glam::DVec3;
use shadowfit::settings::BiasSettings;
use shadowfit::{CasterVolume, DepthConvention, LightFit, bias::Bias};

use crate::MAX_MAPS;

/// What the shadow pass's vertex shader reads: `shadowfit_Caster` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CasterUniform {
    /// Clip space of the map from world positions relative to the origin.
    pub clip_from_world: [[f32; 4]; 4],
}

/// What the look-up reads for one map: `shadowfit_Map` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MapUniform {
    /// Texture coordinates (x right, y down, z the stored depth) from world positions relative to
    /// the origin.
    pub uv_from_world: [[f32; 4]; 4],
    /// Depth bias that does not depend on the slope, signed so that adding it moves the receiver
    /// toward the light.
    pub constant_depth: f32,
    /// Depth bias times tan θ, signed likewise.
    pub slope_depth: f32,
    /// Offset along the normal times sin θ, in metres.
    pub normal_offset: f32,
    /// Keeps the struct a multiple of 16 bytes.
    pub padding: f32,
}

/// What the look-up reads: `shadowfit_Receiver` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ReceiverUniform {
    /// Unit direction toward the light.
    pub to_light: [f32; 3],
    /// How many of `maps` are in use.
    pub map_count: u32,
    /// The maps, nearest first; the first one that covers a point is read.
    pub maps: [MapUniform; MAX_MAPS],
}

/// A caster volume as [`crate::culling_wgsl`] reads it: `shadowfit_CasterVolume` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct VolumeUniform {
    /// Planes (n, d) with unit normals that point inward.
    pub planes: [[f32; 4]; CasterVolume::MAX_PLANES],
    /// Number of planes in use.
    pub count: u32,
    /// Keeps the struct a multiple of 16 bytes.
    pub padding_0: u32,
    /// As above.
    pub padding_1: u32,
    /// As above.
    pub padding_2: u32,
}

/// What [`crate::culling_wgsl`] reads: `shadowfit_Culling` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct CullingUniform {
    /// How many of `volumes` are in use.
    pub volume_count: u32,
    /// Puts the volumes at a multiple of 16 bytes.
    pub padding_0: u32,
    /// As above.
    pub padding_1: u32,
    /// As above.
    pub padding_2: u32,
    /// The volumes of the maps.
    pub volumes: [VolumeUniform; MAX_MAPS],
}

impl CullingUniform {
    /// The uniform for volumes of the maps, with shapes relative to `origin` (world space, metres). Volumes past
    /// [`MAX_MAPS`] are left out.
    pub fn new(volumes: &[CasterVolume], origin: DVec3) -> Self {
        let mut uniform = Self::default();
        for (slot, volume) in uniform.volumes.iter_mut().zip(volumes) {
            let volume = volume.relative_to(origin);
            slot.planes = volume.planes.map(|plane| plane.to_array());
            slot.count = volume.active_planes().len() as u32;
        }
        uniform.volume_count = volumes.len().min(MAX_MAPS) as u32;
        uniform
    }
}

impl CasterUniform {
    /// The uniform for a fit, with positions relative to `origin` (world space, metres).
    pub fn new(fit: &LightFit, origin: DVec3) -> Self {
        Self { clip_from_world: fit.relative_to(origin).clip_from_world.to_cols_array_2d() }
    }
}

impl ReceiverUniform {
    /// The uniform for fits of one light, with positions relative to `origin` (world space,
    /// metres). Fits past [`MAX_MAPS`] are left out; without any, everything is lit.
    pub fn new(fits: &[LightFit], origin: DVec3, bias: &BiasSettings) -> Self {
        let mut uniform = Self::default();
        for (slot, fit) in uniform.maps.iter_mut().zip(fits) {
            let bias = Bias::from_texels(bias, fit);
            let toward_light = if fit.depth == DepthConvention::Reversed { 1.0 } else { -1.0 };
            *slot = MapUniform {
                uv_from_world: fit.relative_to(origin).uv_from_world.to_cols_array_2d(),
                constant_depth: toward_light * bias.constant_depth,
                slope_depth: toward_light * bias.slope_depth,
                normal_offset: bias.normal_offset,
                padding: 0.0,
            };
        }
        uniform.map_count = fits.len().min(MAX_MAPS) as u32;
        uniform.to_light = fits.first().map_or([0.0, 1.0, 0.0], |fit| (-fit.direction).to_array());
        uniform
    }
}
