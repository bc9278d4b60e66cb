//! The records that the shaders read, with the same fields as in WGSL. Tests compare sizes and offsets with
//! naga's reflection.

/// Greatest number of shadow maps of a picture.
pub const MAX_MAPS: usize = 8;

/// A shadow map.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct MapUniform {
    /// First row of the matrix clip from eye-relative position.
    pub row_x: [f32; 4],
    /// Second row.
    pub row_y: [f32; 4],
    /// Third row.
    pub row_z: [f32; 4],
    /// Fourth row.
    pub row_w: [f32; 4],
    /// Texels across and down.
    pub size: [f32; 2],
    /// View depth below which the map is read first, in metres. For selection by view depth.
    pub split_far: f32,
    /// 1 if depth 1 is nearest to the light.
    pub is_reversed: u32,
    /// View depth from which the map in front is blended into this one, in metres. For selection by view
    /// depth.
    pub blend_near: f32,
    /// Index of the map in the picture.
    pub index: u32,
    /// Width of the edge zone if this map is read: in pixels, or in texels if these are wider than pixels on
    /// screen.
    pub edge_width: f32,
    /// Unused.
    pub padding: u32,
}

/// The maps of the previous frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
pub struct BeforeUniform {
    /// The previous frame's unit view direction.
    pub forward: [f32; 3],
    /// View depth of this frame's eye in the previous frame, in metres.
    pub eye_depth: f32,
    /// Number of maps that a point tries; 0 if no previous frame is compared.
    pub map_count: u32,
    /// 1 if maps are selected by coverage.
    pub by_coverage: u32,
    /// Unused.
    pub padding_0: u32,
    /// Unused.
    pub padding_1: u32,
    /// The maps, in the order of selection. Their rows apply to positions relative to this
    /// frame's eye.
    pub maps: [MapUniform; MAX_MAPS],
}

/// A picture's camera, light and maps.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct JudgeUniform {
    /// Eye position relative to the origin of the triangles, in metres.
    pub eye: [f32; 3],
    /// View depth of the near plane, in metres.
    pub near: f32,
    /// Unit direction to the right.
    pub right: [f32; 3],
    /// View depth of the far plane, in metres.
    pub far: f32,
    /// Unit direction upward.
    pub up: [f32; 3],
    /// Offset of the shadow rays' start above the surface, in metres.
    pub ray_offset: f32,
    /// Unit view direction.
    pub forward: [f32; 3],
    /// Greatest view depth that is judged, in metres.
    pub max_distance: f32,
    /// Unit direction toward the light.
    pub to_light: [f32; 3],
    /// Width of the edge zone if no map is read, in pixels.
    pub edge_width: f32,
    /// Half of the picture's width and height, in metres: at a view depth of 1 m, or at any view depth if the
    /// lens is orthographic.
    pub half_size: [f32; 2],
    /// Pixels across and down.
    pub size: [u32; 2],
    /// Number of maps that a point tries.
    pub map_count: u32,
    /// 1 if the maps were drawn with depth clamp.
    pub depth_clamp: u32,
    /// Number of triangles.
    pub triangles: u32,
    /// 1 if maps are selected by coverage.
    pub by_coverage: u32,
    /// Reach of the filter's footprint around a point, in texels.
    pub reach: f32,
    /// Texels over which a map is blended into the next one. For selection by coverage.
    pub blend: f32,
    /// 1 if all lines of sight are parallel.
    pub is_orthographic: u32,
    /// Unused.
    pub padding: u32,
    /// The maps, in the order of selection.
    pub maps: [MapUniform; MAX_MAPS],
    /// The maps of the previous frame.
    pub before: BeforeUniform,
}

/// Sums over a judged picture.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TallyRecord {
    /// Counted pixels by [`crate::Class`] as a number.
    pub all: [u32; 6],
    /// Grazing pixels among them, by class.
    pub grazing: [u32; 6],
    /// Pixels that the light reaches in truth.
    pub lit: u32,
    /// Pixels in the edge zone.
    pub edge_zone: u32,
    /// Pixels that no map covers.
    pub uncovered: u32,
    /// Pixels in `bins` with more than one pixel per texel.
    pub undersampled: u32,
    /// Pixels that are compared with the previous frame.
    pub crawl_compared: u32,
    /// Compared pixels whose verdict differs.
    pub crawl_different: u32,
    /// Low word of the sum of errors, in steps of 1 / [`Self::ERROR_ONE`].
    pub error_low: u32,
    /// High word of the sum of errors.
    pub error_high: u32,
    /// Low word of the sum of the cosines toward the light, in steps of 1 / [`Self::ERROR_ONE`].
    pub light_low: u32,
    /// High word of the sum of the cosines.
    pub light_high: u32,
    /// Low word of the sum of errors times cosines, in steps of 1 / [`Self::ERROR_ONE`].
    pub light_error_low: u32,
    /// High word of the sum of errors times cosines.
    pub light_error_high: u32,
    /// Histogram of pixels per texel, in [bins](super::GpuTally::pixels_per_texel).
    pub bins: [u32; TallyRecord::BINS],
}

impl TallyRecord {
    /// Number of bins of pixels per texel.
    pub const BINS: usize = 1024;
    /// Number of steps of an error of 1: 2^20, so that the sum over the 1024 pixels of a workgroup's square
    /// fits into a word.
    pub const ERROR_ONE: u32 = 1 << 20;
}
