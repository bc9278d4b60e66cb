//! Statistics of the draws of a frame: plain data.

use shadowfit_wgpu::MAX_MAPS;

/// Draws of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Draw calls of all shadow passes.
    pub shadow_draws: u32,
    /// Triangles of all shadow passes.
    pub shadow_triangles: u64,
    /// Texels of all maps that were drawn or updated.
    pub shadow_texels: u64,
    /// Draw calls of the shaded pass.
    pub scene_draws: u32,
    /// Draws into each map; zeros past the number of maps.
    pub maps: [MapStatistics; MAX_MAPS],
}

/// Draws into one map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MapStatistics {
    /// Casters that were drawn: [clusters](crate::clustered) of the instances' triangles. A caster in several
    /// rectangles counts in each of them.
    pub casters: u32,
    /// Draw calls for the casters.
    pub draws: u32,
    /// Triangles of the casters.
    pub triangles: u64,
    /// Texels of the rectangles that were drawn or updated
    /// ([`SunShadows::updates`](shadowfit_wgpu::SunShadows::updates)). Where rectangles overlap, texels count
    /// in each of them.
    pub texels: u64,
}
