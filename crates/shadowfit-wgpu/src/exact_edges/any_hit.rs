//! The engine's own alpha test.

/// The engine's own alpha test of ray hits, like an any-hit shader of a ray tracing pipeline. Use it for the
/// engine's own textures, or for instances that cast shadows only in some views. The passes that draw casters
/// into the maps must discard the same fragments, and the depth pre-pass must discard the same fragments as
/// the main pass. Otherwise seams appear between pixels that the maps decide and pixels that rays decide.
#[derive(Clone, Debug)]
pub struct AnyHit {
    /// WGSL that defines `fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool`, which returns whether a
    /// hit blocks its ray; see [`RayWgslOptions::counts`](shadowfit_rays::RayWgslOptions::counts). The pass
    /// calls it for shadow rays, and for the ray from the eye that finds a pixel's triangle and prefers hits
    /// that block. Hits come in no particular order. The WGSL's resources are bound at group 3
    /// ([`Self::GROUP`]). It runs in a compute shader, so textures must be sampled with
    /// `textureSampleLevel`. Its names need a prefix to avoid conflicts with the names of the pass.
    pub wgsl: String,
    /// Layout of the bind group that the WGSL reads, visible to compute shaders; `None` if the WGSL has no
    /// bindings. The pass itself binds 6 storage buffers, which count toward the device's limit together with
    /// the layout's own.
    pub layout: Option<wgpu::BindGroupLayout>,
}

impl AnyHit {
    /// Index of the bind group that [`Self::wgsl`] may read. The bind group is set per view
    /// ([`EdgeView::any_hit`](super::EdgeView::any_hit)).
    pub const GROUP: u32 = 3;
}
