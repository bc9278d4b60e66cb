//! The planes of a volume with one layout for all targets, as shaders read them.

use super::volume::CasterVolume;

/// The planes of a [`CasterVolume`] for a shader, with the layout of this WGSL in uniform and in
/// storage buffers, 272 bytes:
///
/// ```wgsl
/// struct CasterPlanes {
///     planes: array<vec4f, 16>, // n·p + d >= 0 inside, p relative to the volume's origin
///     count: u32,
/// }
/// ```
///
/// The volume itself has an origin in f64, which no shader can read: move it to the origin that
/// the shader's positions have first, with [`CasterVolume::relative_to`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct CasterPlanes {
    /// [`CasterVolume::planes`]. All of them may be tested: everything is inside the unused ones.
    pub planes: [[f32; 4]; CasterVolume::MAX_PLANES],
    /// Number of planes in use.
    pub count: u32,
    /// Padding at the end of the struct, as in WGSL; zero.
    pub padding: [u32; 3],
}

impl From<&CasterVolume> for CasterPlanes {
    fn from(volume: &CasterVolume) -> Self {
        Self {
            planes: volume.planes.map(|plane| plane.to_array()),
            count: volume.active_planes().len() as u32,
            padding: [0; 3],
        }
    }
}
