//! The plain data that callers pass and receive.
#![allow(missing_docs, reason = "members whose names say all have no comment in the header")]

use core::ffi::c_char;

/// Version of this interface, greatest numbers of maps, views and rectangles, and length of the demand counts.
pub const SHADOWFIT_VERSION: u32 = 1;
pub const SHADOWFIT_MAX_MAPS: usize = 8;
pub const SHADOWFIT_MAX_VIEWS: usize = 4;
pub const SHADOWFIT_MAX_RECTS: usize = 24;
pub const SHADOWFIT_COUNTS: usize = 17_152;

/// Depth in clip space, from the near plane to the far plane: 0 to 1 (Direct3D, Vulkan, Metal), -1 to 1 (OpenGL,
/// whose depth buffers store it as 0 to 1), or 1 to 0.
pub const SHADOWFIT_DEPTH_ZERO_TO_ONE: u32 = 0;
pub const SHADOWFIT_DEPTH_NEGATIVE_ONE_TO_ONE: u32 = 1;
pub const SHADOWFIT_DEPTH_REVERSED: u32 = 2;

/// Casters that can shadow something in view, for maps that are redrawn in each frame, or all casters over the map,
/// for maps that are kept.
pub const SHADOWFIT_CASTERS_VISIBLE: u32 = 0;
pub const SHADOWFIT_CASTERS_ALL: u32 = 1;

/// Update of a kept map: draw nothing, clear and draw the rectangles, or the whole map, as the only rectangle.
pub const SHADOWFIT_UPDATE_NOTHING: u32 = 0;
pub const SHADOWFIT_UPDATE_RECTS: u32 = 1;
pub const SHADOWFIT_UPDATE_WHOLE: u32 = 2;

/// Bias that a shader can apply: each comparison uses the depth of the receiver's plane at its own texel, the receiver
/// moves along its normal, or one constant is added, for shaders that know no normal.
pub const SHADOWFIT_BIAS_RECEIVER_PLANE: u32 = 0;
pub const SHADOWFIT_BIAS_NORMAL_OFFSET: u32 = 1;
pub const SHADOWFIT_BIAS_CONSTANT: u32 = 2;

/// Depths in maps: 32-bit floats, or numbers of 24 or 16 bits.
pub const SHADOWFIT_FORMAT_FLOAT32: u32 = 0;
pub const SHADOWFIT_FORMAT_UNORM24: u32 = 1;
pub const SHADOWFIT_FORMAT_UNORM16: u32 = 2;

/// Result of a proof: no holes, a receiver outside the map, a caster in front of the near plane, or a rounding of
/// depths that exceeds the bias.
pub const SHADOWFIT_PROVEN: u32 = 0;
pub const SHADOWFIT_UNCOVERED: u32 = 1;
pub const SHADOWFIT_CASTER_LOST: u32 = 2;
pub const SHADOWFIT_DEPTH_TOO_COARSE: u32 = 3;

/// A camera, with SHADOWFIT_DEPTH_... of its depth buffer. Planes are view depths; aspect is width divided by height.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitCamera {
    pub size: u32,
    pub depth: u32,
    pub eye: [f64; 3],
    pub forward: [f32; 3],
    pub up: [f32; 3],
    /// Vertical field of view; 0 for an orthographic camera, whose picture is 2 half_height metres high.
    pub fov_y: f32,
    pub half_height: f32,
    pub aspect: f32,
    pub near_plane: f32,
    pub far_plane: f32,
}

/// The view of a camera, filled by shadowfit_view_from_camera or shadowfit_view_from_matrix. Corners and matrix are
/// relative to the eye.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitView {
    pub size: u32,
    pub depth: u32,
    pub eye: [f64; 3],
    pub forward: [f32; 3],
    pub near_plane: f32,
    pub far_plane: f32,
    /// Corners of the near plane, then of the far plane.
    pub corners: [[f32; 3]; 8],
    pub clip_from_eye: [f32; 16],
}

/// Axis-aligned boxes in world axes, in metres.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitBoxes {
    /// First box: least x, y, z, greatest x, y, z. Null if the boxes are unknown.
    pub min_max: *const f32,
    /// Number of boxes. 0 with a pointer means that no object exists.
    pub count: usize,
    /// Bytes from one box to the next; 0 for boxes without gaps.
    pub stride: usize,
    /// World position that the boxes are relative to.
    pub origin: [f64; 3],
}

/// Input of a fit.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitFrame {
    pub size: u32,
    /// Number of views, 1 to 4: more than one for headsets and split screens.
    pub view_count: u32,
    /// The views that share the maps. View depths count from the first one.
    pub views: *const ShadowfitView,
    /// Direction of the light's travel, from the sun to the scene.
    pub light_direction: [f32; 3],
    /// Number of the frame, which moves the pattern of soft filters; 0 for a fixed pattern.
    pub number: u32,
    /// World position that the positions of your shaders are relative to. 0 for plain world positions. Far from
    /// the world's origin, use the eye.
    pub origin: [f64; 3],
    /// Boxes around the objects that receive shadows. If they are unknown, maps cover the whole view.
    pub receivers: ShadowfitBoxes,
    pub casters: ShadowfitBoxes,
}

/// Biases of a look-up. With the angle t between the normal and the light, move the position by normal_offset * sin t
/// metres along the normal, and its stored depth toward the light by constant_depth + slope_depth * tan t +
/// receiver_plane * (|dz/du| + |dz/dv|), with the plane's changes of depth per texel.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitBias {
    pub constant_depth: f32,
    pub slope_depth: f32,
    pub normal_offset: f32,
    pub receiver_plane: f32,
}

/// A fitted map, for positions relative to the frame's origin.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitMap {
    /// Draws casters: from world positions to clip space, x right, y up.
    pub clip_from_world: [f32; 16],
    /// Reads the map: from world positions to u (right), v (down) and the stored depth.
    pub uv_from_world: [f32; 16],
    /// From world positions to the light's axes, in metres. The light looks along -z.
    pub light_from_world: [f32; 16],
    pub bias: ShadowfitBias,
    pub texel_size: [f32; 2],
    /// Distance from the near plane to the far plane, in metres along the light.
    pub depth_range: f32,
    /// View depth at which the map ends, in metres, if maps are selected by view depth.
    pub end_depth: f32,
    pub resolution: [u32; 2],
    /// 1 if nothing in view receives shadows, so that the map need not be drawn.
    pub is_empty: u32,
}

/// The maps of a frame: windows from fine to coarse, cascades from near to far.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitMaps {
    pub size: u32,
    /// Number of maps; 0 if the frame has no shadows.
    pub count: u32,
    /// 1 if visible depths placed the maps, 0 if boxes did.
    pub from_visible_depths: u32,
    pub maps: [ShadowfitMap; SHADOWFIT_MAX_MAPS],
}

/// The parts of a technique that create textures and choose shaders.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitTechnique {
    pub size: u32,
    pub map_count: u32,
    pub resolution: [u32; 2],
    pub depth: u32,
    /// 1 if the pass must clamp depth instead of clipping it.
    pub clamps_depth: u32,
    /// 1 if points select maps by view depth, 0 by coverage.
    pub by_view_depth: u32,
    /// Width of the blend between two maps: texels by coverage, a share of the range by view depth.
    pub blend: f32,
    /// Greatest distance of a texel that the filter reads, in texels.
    pub filter_radius: f32,
    /// Names as in technique files, such as "pcf_5x5" and "depth32float".
    pub filter: [c_char; 24],
    pub format: [c_char; 24],
}

/// A depth buffer that was read back, of at least 3 x 3 pixels, and the view and light that it was drawn with.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitDepths {
    pub size: u32,
    pub width: u32,
    pub height: u32,
    /// Pixels per counted point, across and down. A few hundred points are enough.
    pub step: u32,
    /// First depth of the top row, as stored, in 0 to 1.
    pub depths: *const f32,
    /// Bytes from one row to the next lower one; 0 for rows without gaps. Negative for OpenGL, whose rows begin
    /// at the bottom: depths then points to the last row in memory.
    pub row_stride: isize,
    pub view: *const ShadowfitView,
    pub light_direction: [f32; 3],
}

/// A rectangle of texels in the texture: left column, top row, and size.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct ShadowfitRect {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
    /// Corner of the viewport that draws the rectangle. It has the map's size, and may begin outside the texture.
    pub viewport_x: i32,
    pub viewport_y: i32,
}

/// The parts of a kept map to clear and draw again. A map that moves keeps its texels where they are: texel t of
/// the map is stored at (t + texel_offset) modulo its size, so the sampler must repeat.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitUpdate {
    pub size: u32,
    pub kind: u32,
    pub texel_offset: [u32; 2],
    pub rect_count: u32,
    /// Scissor rectangles with their viewports.
    pub rects: [ShadowfitRect; SHADOWFIT_MAX_RECTS],
    /// Corners (x, y) of the viewports that draw the whole map, such as for moving casters: up to four if it wraps.
    pub viewport_count: u32,
    pub viewports: [[i32; 2]; 4],
}

/// A filter of your own shader: SHADOWFIT_BIAS_... that it can apply, and SHADOWFIT_FORMAT_... of the map.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitFilter {
    pub size: u32,
    pub bias: u32,
    pub format: u32,
    /// Radius of a comparison, in texels: 0.5 for one texel, 1 for bilinear ones, 3 for a tent of 5 x 5.
    pub taps: f32,
    /// Radius of a disc over which the comparisons are spread, in texels.
    pub disc: f32,
}

/// Result of a proof, SHADOWFIT_PROVEN or a kind of hole, and the world position of the hole.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ShadowfitProof {
    pub size: u32,
    pub result: u32,
    pub point: [f64; 3],
    /// Missing space: texels across the light, metres along it.
    pub missing: f32,
}
