//! Input of the edge pass for one view: its depth buffer, its camera, and the casters that the rays lack.

use shadowfit::glam::{DVec3, Mat4};
use shadowfit::{Boxes, DepthConvention};

/// A view whose edges are traced, for [`EdgePass::record`](super::EdgePass::record). Its depth buffer must be
/// complete.
#[derive(Clone, Copy, Debug)]
pub struct EdgeView<'a> {
    /// View of the depth aspect of the whole texture, with usage `TEXTURE_BINDING` and 1 or 4 samples. The
    /// pre-pass must store its depths. Results are exact with any depth format, but coarser depths lead to
    /// more traced pixels.
    pub depth: &'a wgpu::TextureView,
    /// Matrix that the depth buffer was drawn with, from world positions relative to the eye, in metres, to
    /// clip space. It can be perspective or orthographic, with a finite or infinite far plane, and may
    /// contain jitter.
    pub clip_from_eye: Mat4,
    /// Depth convention of the depth buffer: 0..1, plain or reversed. Pixels at the far plane's depth have no
    /// surface.
    pub convention: DepthConvention,
    /// World position of the eye, in metres.
    pub eye: DVec3,
    /// Normals of the visible triangles. If `None`, they are computed from the depths of neighbouring pixels.
    pub normals: Option<Normals<'a>>,
    /// Part of the textures that the view fills, in pixels: left, top, width, height; `None` for all.
    pub rectangle: Option<[u32; 4]>,
    /// Boxes around casters that are in the maps but not in the rays, such as grass that a vertex shader
    /// bends. The filter decides pixels that their shadows may reach. If there are many casters, merge their
    /// boxes.
    pub missing_from_rays: Option<Boxes<'a>>,
    /// Average number of pixels to trace per frame, for a constant view; `None` for all. Pixel position and
    /// frame number ([`SunFrame::number`](crate::SunFrame::number)) decide which pixels are traced. The
    /// others keep the filter's factor.
    pub budget: Option<u32>,
    /// Bind group of the pass's [`AnyHit`](super::AnyHit), if it has a layout.
    pub any_hit: Option<&'a wgpu::BindGroup>,
    /// Least distance between the surface and the start of rays, in metres. If maps or receiver boxes extend
    /// over kilometres, triangles in the plane of the surface are ignored near the start, because positions
    /// in large triangles are rounded by more than this. Default: 0.001.
    pub ray_offset: f32,
}

/// Normals of the visible triangles: of unit length, in world axes, without a normal map.
#[derive(Clone, Copy, Debug)]
pub struct Normals<'a> {
    /// View of a float texture with one sample and the size of the depth texture.
    pub view: &'a wgpu::TextureView,
    /// Encoding of the normals in the first three channels.
    pub encoding: NormalEncoding,
}

/// Encoding of a normal's coordinates. If all are zero, the normal is computed from the depths of
/// neighbouring pixels instead.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalEncoding {
    /// The coordinate itself, -1..1.
    Signed,
    /// (1 + coordinate) / 2, 0..1.
    Unsigned,
}

impl<'a> EdgeView<'a> {
    /// Returns the view that fills a depth texture, without normals. `clip_from_eye` takes positions relative
    /// to `eye`, a world position in metres.
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

    /// Returns this view with normals.
    #[must_use]
    pub const fn with_normals(mut self, view: &'a wgpu::TextureView, encoding: NormalEncoding) -> Self {
        self.normals = Some(Normals { view, encoding });
        self
    }

    /// Returns the part of the textures that the view fills, in pixels.
    pub(super) fn part(&self) -> [u32; 4] {
        let texture = self.depth.texture();
        self.rectangle.unwrap_or([0, 0, texture.width(), texture.height()])
    }
}
