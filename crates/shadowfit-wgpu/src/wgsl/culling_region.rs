//! Culling records for shaders: one for each region of a frame's passes, for engines that keep their casters
//! on the GPU.

use bytemuck::{Pod, Zeroable};
use shadowfit::CasterVolume;
use shadowfit::glam::{DVec3, Vec4};

/// A region of a pass, for shaders that cull casters: `shadowfit_CullingRegion` of
/// [`culling_wgsl`](crate::culling_wgsl), an element of its storage buffer.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct CullingRegion {
    /// Planes (n, d) with unit normals that point inward: a point p, in metres relative to the origin of the
    /// frame, is inside if n·p + d >= 0. Every point is inside an unused plane.
    pub planes: [[f32; 4]; CullingRegion::MAX_PLANES],
    /// [`DrawRegion::viewport`](crate::DrawRegion::viewport).
    pub viewport: [f32; 4],
    /// [`DrawRegion::scissor`](crate::DrawRegion::scissor).
    pub scissor: [u32; 4],
    /// Index of the map.
    pub map: u32,
    /// 1 if static casters belong in the region, 0 otherwise.
    pub fixed: u32,
    /// 1 if moving casters belong in the region, 0 otherwise.
    pub moving: u32,
    /// Number of leading planes that static casters are culled by. A caster that lies wholly behind one of
    /// them is not drawn.
    pub fixed_planes: u32,
    /// Number of leading planes that moving casters are culled by.
    pub moving_planes: u32,
    /// Keeps the struct a multiple of 16 bytes.
    pub padding_0: u32,
    /// As above.
    pub padding_1: u32,
    /// As above.
    pub padding_2: u32,
}

impl CullingRegion {
    /// Maximum number of planes per region: the caster volume's planes, and six for the region's rectangle.
    pub const MAX_PLANES: usize = CasterVolume::MAX_PLANES + 6;

    /// Returns a region that draws all casters in the intersection of some volumes, for maps that are drawn
    /// without [`SunShadows`](crate::SunShadows). Shapes are relative to `origin` (world space, metres). The
    /// map is 0, and the viewport is empty. Planes past [`Self::MAX_PLANES`] are left out, which only keeps
    /// more casters.
    pub fn new(volumes: impl IntoIterator<Item = CasterVolume>, origin: DVec3) -> Self {
        let mut region = Self { planes: [Vec4::W.to_array(); Self::MAX_PLANES], fixed: 1, moving: 1, ..Self::zeroed() };
        let mut count = 0;
        for volume in volumes {
            for (slot, plane) in region.planes[count..].iter_mut().zip(volume.relative_to(origin).active_planes()) {
                *slot = plane.to_array();
                count += 1;
            }
        }
        (region.fixed_planes, region.moving_planes) = (count as u32, count as u32);
        region
    }
}
