//! Read-back of a texture's pixels from the GPU.

use core::fmt;

use shadowfit_gpu::{MapState, Mapping, TexelCopy};

use crate::Gpu;
use crate::wait::waiting;

/// Pixels that the GPU is still copying.
#[derive(Debug)]
pub struct ReadBack {
    copy: TexelCopy,
    mapping: Mapping,
}

/// Reason why pixels could not be read back. No pixels are returned then, not even black ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadError {
    /// The device was lost or destroyed, or is out of memory for the copy.
    Lost,
    /// The device did not finish its work. In browsers it never does while a program waits; use
    /// [`ReadBack::arrive`] there.
    Unfinished,
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reason = match self {
            Self::Lost => "it was lost, or is out of memory",
            Self::Unfinished => "it did not finish its work",
        };
        write!(
            f,
            "pixels could not be read back from the graphics device: {reason}; start again, with smaller pictures \
                   if it is out of memory"
        )
    }
}

impl core::error::Error for ReadError {}

impl ReadBack {
    /// Starts to copy a texture of a `size` in pixels.
    pub fn new(gpu: &Gpu, texture: &wgpu::Texture, size: [u32; 2], bytes_per_pixel: u32) -> Self {
        let _unreported = gpu.without_reports();
        let size = wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let copy = TexelCopy::record(&gpu.device, &mut encoder, texture, size, bytes_per_pixel);
        gpu.submit([encoder.finish()]);
        let mapping = Mapping::new();
        mapping.map(copy.buffer());
        Self { copy, mapping }
    }

    /// Returns the pixels, rows from the top without padding, once they have arrived; `None` before that.
    /// Does not wait.
    ///
    /// # Errors
    ///
    /// [`ReadError`] if the device was lost.
    pub fn take(&self, gpu: &Gpu) -> Option<Result<Vec<u8>, ReadError>> {
        let polled = gpu.device.poll(wgpu::PollType::Poll);
        match self.mapping.state() {
            MapState::Busy if polled.is_ok() => None,
            MapState::Readable => Some(self.pixels()),
            _ => Some(Err(ReadError::Lost)),
        }
    }

    /// Waits for the GPU and returns the pixels, as for [`Self::take`].
    ///
    /// # Errors
    ///
    /// [`ReadError`] if the device was lost or does not answer.
    pub fn wait(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadError> {
        waiting(|| gpu.device.poll(wgpu::PollType::wait_indefinitely())).map_err(|_| ReadError::Unfinished)?;
        match self.mapping.state() {
            MapState::Busy => Err(ReadError::Unfinished),
            MapState::Readable => self.pixels(),
            _ => Err(ReadError::Lost),
        }
    }

    /// Returns the pixels like [`Self::wait`]. A browser can do other work meanwhile.
    ///
    /// # Errors
    ///
    /// [`ReadError`] if the device was lost or does not answer.
    #[cfg_attr(not(target_family = "wasm"), expect(clippy::unused_async, reason = "only browsers wait"))]
    pub async fn arrive(&self, gpu: &Gpu) -> Result<Vec<u8>, ReadError> {
        #[cfg(target_family = "wasm")]
        loop {
            if let Some(pixels) = self.take(gpu) {
                return pixels;
            }
            gloo_timers::future::TimeoutFuture::new(POLL_MS).await;
        }
        #[cfg(not(target_family = "wasm"))]
        self.wait(gpu)
    }

    fn pixels(&self) -> Result<Vec<u8>, ReadError> {
        self.copy.texels().map_err(|_| ReadError::Lost)
    }
}

/// Time between two polls for pixels in a browser, in milliseconds.
#[cfg(target_family = "wasm")]
const POLL_MS: u32 = 2;

/// Copies a texture of a `size` in pixels to the CPU, rows from the top without padding. Waits for the GPU.
///
/// # Errors
///
/// [`ReadError`] if the device was lost or does not answer.
pub fn read_texture(
    gpu: &Gpu,
    texture: &wgpu::Texture,
    size: [u32; 2],
    bytes_per_pixel: u32,
) -> Result<Vec<u8>, ReadError> {
    ReadBack::new(gpu, texture, size, bytes_per_pixel).wait(gpu)
}
