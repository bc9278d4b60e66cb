//! The records that the shaders read, field by field as in WGSL; tests compare sizes and offsets with naga's
//! reflection.

/// Greatest number of shadow maps that a picture may have.
pub const MAX_MAPS: usize = 8;

/// A shadow map.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct MapUniform {
    /// First row of clip from positions relative to the eye.
    pub row_x: [f32; 4],
    /// Second row.
    pub row_y: [f32; 4],
    /// Third row.
    pub row_z: [f32; 4],
    /// Fourth row.
    pub row_w: [f32; 4],
    /// Texels across and down.
    pub size: [f32; 2],
    /// View depth below which the map is the first to be read, in metres; by view depth.
    pub split_far: f32,
    /// 1 where depth 1 is nearest to the light.
    pub is_reversed: u32,
    /// View depth from which the map in front is blended into this one, in metres; by view depth.
    pub blend_near: f32,
    /// Its index.
    pub index: u32,
    /// Width of the edge zone where it is read: in pixels, or in texels where those are wider than pixels on screen.
    pub edge_width: f32,
    /// Unused.
    pub padding: u32,
}

/// The maps of the frame before.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct BeforeUniform {
    /// Its unit direction of view.
    pub forward: [f32; 3],
    /// View depth of this frame's eye in it, in metres.
    pub eye_depth: f32,
    /// Number of maps that points try; 0 where no frame before is compared.
    pub map_count: u32,
    /// 1 where maps are read by coverage.
    pub by_coverage: u32,
    /// Unused.
    pub padding_0: u32,
    /// Unused.
    pub padding_1: u32,
    /// The maps, in the order in which points try them. Their rows are of positions relative to this frame's eye.
    pub maps: [MapUniform; MAX_MAPS],
}

/// A picture's camera, light and maps.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct JudgeUniform {
    /// Eye, relative to the origin of the triangles, in metres.
    pub eye: [f32; 3],
    /// View depth of the near plane, in metres.
    pub near: f32,
    /// Unit direction to the right.
    pub right: [f32; 3],
    /// View depth of the far plane, in metres.
    pub far: f32,
    /// Unit direction upward.
    pub up: [f32; 3],
    /// Start of the shadow rays above the surface, in metres.
    pub ray_offset: f32,
    /// Unit direction of view.
    pub forward: [f32; 3],
    /// Greatest view depth that is judged, in metres.
    pub max_distance: f32,
    /// Unit direction toward the light.
    pub to_light: [f32; 3],
    /// Width of the edge zone where no map is read, in pixels.
    pub edge_width: f32,
    /// Half of the picture's width and height, in metres: at a view depth of 1 m, or at any of an orthographic lens.
    pub half_size: [f32; 2],
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Number of maps that points try.
    pub map_count: u32,
    /// 1 where the maps were drawn with depth clamp.
    pub depth_clamp: u32,
    /// Number of triangles.
    pub triangles: u32,
    /// 1 where maps are read by coverage.
    pub by_coverage: u32,
    /// Texels that the filter reads around a point.
    pub reach: f32,
    /// Texels over which a map is blended into the next one, by coverage.
    pub blend: f32,
    /// 1 where all lines of sight are parallel.
    pub is_orthographic: u32,
    /// Unused.
    pub padding: u32,
    /// The maps, in the order in which points try them.
    pub maps: [MapUniform; MAX_MAPS],
    /// The maps of the frame before.
    pub before: BeforeUniform,
}

/// Sums over a judged picture.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TallyRecord {
    /// Pixels by [`crate::Class`] as a number.
    pub all: [u32; 6],
    /// The grazing ones of them.
    pub grazing: [u32; 6],
    /// Pixels that the light reaches in truth.
    pub lit: u32,
    /// Pixels in the edge zone.
    pub edge_zone: u32,
    /// Pixels that no map covers.
    pub uncovered: u32,
    /// Pixels in `bins` with more than one pixel per texel.
    pub undersampled: u32,
    /// Pixels that are compared with the frame before.
    pub crawl_compared: u32,
    /// Those of them whose verdict differs.
    pub crawl_different: u32,
    /// Low word of the sum of errors, in steps of [`Self::ERROR_ONE`].
    pub error_low: u32,
    /// High word of it.
    pub error_high: u32,
    /// Pixels by pixels per texel, in [bins](super::GpuTally::pixels_per_texel).
    pub bins: [u32; TallyRecord::BINS],
}

impl TallyRecord {
    /// Bins of pixels per texel.
    pub const BINS: usize = 1024;
    /// Steps of an error of 1: 2^20, so that the 1024 pixels of a workgroup's square fit in a word.
    pub const ERROR_ONE: u32 = 1 << 20;
}
