//! What was drawn for a frame: plain data.

use shadowfit_wgpu::MAX_MAPS;

/// What a frame drew.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Draw calls of all shadow passes.
    pub shadow_draws: u32,
    /// Triangles of all shadow passes.
    pub shadow_triangles: u64,
    /// Texels of all maps that were drawn or mended.
    pub shadow_texels: u64,
    /// Draw calls of the shaded pass.
    pub scene_draws: u32,
    /// What was drawn into each map; zeros past the number of maps.
    pub maps: [MapStatistics; MAX_MAPS],
}

/// What was drawn into one map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MapStatistics {
    /// Casters that were drawn: [clusters](crate::clustered) of the instances' triangles. One that lies in several
    /// rectangles counts in each.
    pub casters: u32,
    /// Draw calls for them.
    pub draws: u32,
    /// Their triangles.
    pub triangles: u64,
    /// Texels of the rectangles that were drawn or mended ([`SunShadows::updates`](shadowfit_wgpu::SunShadows::updates));
    /// where rectangles overlap they count in each.
    pub texels: u64,
}
