//! Why a picture cannot be judged on the GPU, with what to do about it.

use shadowfit_rays::RayError;
use thiserror::Error;

/// Why a picture cannot be judged on the GPU.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum GpuTruthError {
    /// The tracer's alpha test is a function that only the CPU can run.
    #[error(
        "the tracer has an alpha test, a function that only the CPU can run: give its holes as plain data, \
         with `Tracer::with_cut_outs`"
    )]
    AlphaTest,
    /// A buffer would be larger than the device allows.
    #[error(
        "{what} demand {bytes} bytes in one buffer, and the device allows {limit}: use fewer of them, or ask the \
         adapter for a device with higher `max_storage_buffer_binding_size` and `max_buffer_size`"
    )]
    TooLarge {
        /// What would be in the buffer.
        what: &'static str,
        /// Bytes that it needs.
        bytes: u64,
        /// Bytes that one buffer may have.
        limit: u64,
    },
    /// The triangles cannot be traced on the device: it is too small for them, or too old.
    #[error(transparent)]
    Rays(#[from] RayError),
    /// More maps than the uniform holds.
    #[error("the picture has {0} shadow maps, and the shader reads at most 8: judge it on the CPU")]
    TooManyMaps(usize),
    /// A sun with a radius needs many rays.
    #[error("the sun has a radius, and the GPU traces hard shadows only: give `TruthLight::Sun` the radius 0")]
    SoftSun,
    /// A light with a position, to which the shader has no rays.
    #[error(
        "the light has a position, and the GPU traces rays to suns only: judge the picture on the CPU, with `judge`"
    )]
    PositionalLight,
    /// The picture of triangles and the camera have different sizes.
    #[error(
        "the texture of seen triangles has {}×{} pixels and the camera {}×{}: give the camera of that picture",
        seen[0], seen[1], camera[0], camera[1]
    )]
    Size {
        /// Size of the texture, in pixels.
        seen: [u32; 2],
        /// Size of the camera's picture, in pixels.
        camera: [u32; 2],
    },
    /// The picture of the frame before's factors and the camera have different sizes.
    #[error(
        "the texture of the factors of the frame before has {}×{} pixels and the camera {}×{}: draw it with the camera \
         of this frame",
        before[0], before[1], camera[0], camera[1]
    )]
    BeforeSize {
        /// Size of the texture, in pixels.
        before: [u32; 2],
        /// Size of the camera's picture, in pixels.
        camera: [u32; 2],
    },
    /// No picture was judged before its classes were read.
    #[error("no picture was judged yet: call `GpuJudge::judge` and submit its encoder before reading")]
    NotJudged,
    /// The classes or their tally cannot be read back.
    #[error("what was judged cannot be read back from the device, which was lost or ran out of memory: open it again")]
    Read,
}
