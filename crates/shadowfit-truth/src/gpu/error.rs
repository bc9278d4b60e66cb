//! Reasons why a picture cannot be judged on the GPU, and what to do about them.

use shadowfit_rays::RayError;
use thiserror::Error;

/// Reason why a picture cannot be judged on the GPU.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum GpuTruthError {
    /// The tracer's alpha test is a function that only the CPU can run.
    #[error(
        "the tracer has an alpha test, a function that only the CPU can run: pass its holes as plain data, \
         with `Tracer::with_cut_outs`"
    )]
    AlphaTest,
    /// A buffer would be larger than the device allows.
    #[error(
        "{what} need {bytes} bytes in one buffer, but the device allows {limit}: use fewer of them, or request a \
         device with higher `max_storage_buffer_binding_size` and `max_buffer_size`"
    )]
    TooLarge {
        /// Content of the buffer.
        what: &'static str,
        /// Bytes that are needed.
        bytes: u64,
        /// Greatest size of one buffer on this device, in bytes.
        limit: u64,
    },
    /// The triangles cannot be traced on the device: it is too small for them, or too old.
    #[error(transparent)]
    Rays(#[from] RayError),
    /// The picture has more maps than the uniform can hold.
    #[error("the picture has {0} shadow maps, but the shader reads at most 8: judge it on the CPU")]
    TooManyMaps(usize),
    /// The sun has a radius and therefore needs many rays.
    #[error("the sun has a radius, but the GPU traces hard shadows only: set the radius of `TruthLight::Sun` to 0")]
    SoftSun,
    /// The light has a position. The shader traces rays to suns only.
    #[error(
        "the light has a position, but the GPU traces rays to suns only: judge the picture on the CPU, with `judge`"
    )]
    PositionalLight,
    /// The texture of seen triangles and the camera have different sizes.
    #[error(
        "the texture of seen triangles has {}×{} pixels, but the camera {}×{}: pass the camera of that picture",
        seen[0], seen[1], camera[0], camera[1]
    )]
    Size {
        /// Size of the texture, in pixels.
        seen: [u32; 2],
        /// Size of the camera's picture, in pixels.
        camera: [u32; 2],
    },
    /// The texture of the previous frame's factors and the camera have different sizes.
    #[error(
        "the texture of the previous frame's factors has {}×{} pixels, but the camera {}×{}: draw it with the camera \
         of this frame",
        before[0], before[1], camera[0], camera[1]
    )]
    BeforeSize {
        /// Size of the texture, in pixels.
        before: [u32; 2],
        /// Size of the camera's picture, in pixels.
        camera: [u32; 2],
    },
    /// The classes were read before any picture was judged.
    #[error("no picture was judged yet: call `GpuJudge::judge` and submit its encoder before reading")]
    NotJudged,
    /// The classes or their tally cannot be read back.
    #[error("the judged picture cannot be read back, because the device was lost or ran out of memory: open it again")]
    Read,
}
