//! The picture whose edges are traced: its depth buffer, its camera, and what the engine says about it.

use shadowfit::glam::{DVec3, Mat4};
use shadowfit::{Boxes, DepthConvention};

/// A picture whose depth buffer is complete.
#[derive(Clone, Copy, Debug)]
pub struct EdgeView<'a> {
    /// A view of the depth aspect of the whole texture, with usage `TEXTURE_BINDING` and 1 or 4 samples, that the
    /// pre-pass has stored. Any depth format is exact. The coarser its steps, the more pixels are traced.
    pub depth: &'a wgpu::TextureView,
    /// The matrix that it was drawn with: from world positions relative to the eye, in metres, to clip space.
    /// Perspective or orthographic, with a finite far plane or an infinite one; jitter is welcome.
    pub clip_from_eye: Mat4,
    /// Its depth convention: 0..1, plain or reversed. Pixels at the far plane's depth show nothing.
    pub convention: DepthConvention,
    /// World position of the eye, in metres.
    pub eye: DVec3,
    /// Normals of the picture's triangles, where the engine has them; else they follow from the depths of neighbours.
    pub normals: Option<Normals<'a>>,
    /// The picture's part of the textures, in pixels: left, top, width, height; `None` for all.
    pub rectangle: Option<[u32; 4]>,
    /// Boxes around casters that the maps have and the rays have not, such as grass that a vertex shader bends: the
    /// filter decides what lies under them. Where there are many, boxes around several.
    pub missing_from_rays: Option<Boxes<'a>>,
    /// Pixels whose rays a frame may trace, on average over frames of the same picture; `None` for all. Which of them are
    /// traced follows from pixel and frame number ([`SunFrame::number`](crate::SunFrame::number)); the others keep the
    /// filter's factor.
    pub budget: Option<u32>,
    /// The bind group of the pass's [`AnyHit`](super::AnyHit), if that has a layout.
    pub any_hit: Option<&'a wgpu::BindGroup>,
    /// Rays start at least this far above the surface, in metres. Where maps or boxes of receivers reach kilometres away,
    /// triangles in the plane of the surface are ignored near the start, because positions in large triangles are rounded by
    /// more than this. Default: 0.001.
    pub ray_offset: f32,
}

/// The normals of a picture's triangles: of unit length, in world axes, and not those of a normal map.
#[derive(Clone, Copy, Debug)]
pub struct Normals<'a> {
    /// A view of a float texture of one sample, as large as the depth texture.
    pub view: &'a wgpu::TextureView,
    /// How its first three channels have them.
    pub encoding: NormalEncoding,
}

/// How channels have the coordinates of a normal. Zero in all of them stands for no normal: it follows from the depths of
/// neighbours there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalEncoding {
    /// As they are, -1..1.
    Signed,
    /// As (1 + coordinate) / 2, 0..1.
    Unsigned,
}

impl<'a> EdgeView<'a> {
    /// The picture that fills a depth texture, without normals. `clip_from_eye` takes positions relative to `eye`, a
    /// world position in metres.
    pub const fn new(
        depth: &'a wgpu::TextureView,
        clip_from_eye: Mat4,
        convention: DepthConvention,
        eye: DVec3,
    ) -> Self {
        Self {
            depth,
            clip_from_eye,
            convention,
            eye,
            normals: None,
            rectangle: None,
            missing_from_rays: None,
            budget: None,
            any_hit: None,
            ray_offset: 1e-3,
        }
    }

    /// This picture with normals.
    #[must_use]
    pub const fn with_normals(mut self, view: &'a wgpu::TextureView, encoding: NormalEncoding) -> Self {
        self.normals = Some(Normals { view, encoding });
        self
    }

    /// The picture's part of the textures, in pixels.
    pub(super) fn part(&self) -> [u32; 4] {
        let texture = self.depth.texture();
        self.rectangle.unwrap_or([0, 0, texture.width(), texture.height()])
    }
}
