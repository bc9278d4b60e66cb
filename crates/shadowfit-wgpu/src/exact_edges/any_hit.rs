//! An engine's own alpha test.

/// An engine's own alpha test of hits, which ray tracing pipelines call an any-hit shader: for textures of its own, or
/// instances that cast for some views only. The passes that draw casters into the maps must discard the same, and the
/// depth pre-pass what the picture discards: where maps are sure they decide, and an edge between both would be a seam.
#[derive(Clone, Debug)]
pub struct AnyHit {
    /// WGSL that defines `fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool`, as
    /// [`RayWgslOptions::counts`](shadowfit_rays::RayWgslOptions::counts) says: whether a hit blocks its ray. The ray from the
    /// eye that finds a pixel's triangle asks it, too, and prefers hits that count. Hits come in no order. What it binds is in group [`Self::GROUP`], 3. It is part of a compute shader, so textures are sampled
    /// with `textureSampleLevel`. Names of its own need a prefix, since the pass has many.
    pub wgsl: String,
    /// Layout of the bind group that the WGSL reads, visible to compute shaders; `None` where it binds nothing. The pass
    /// itself binds 6 storage buffers, which the device's limit counts together with those of the layout.
    pub layout: Option<wgpu::BindGroupLayout>,
}

impl AnyHit {
    /// The bind group that [`Self::wgsl`] may read; it is given for each picture
    /// ([`EdgeView::any_hit`](super::EdgeView::any_hit)).
    pub const GROUP: u32 = 3;
}
