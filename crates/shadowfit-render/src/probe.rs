//! The renderer's own results for each pixel: the visible triangle and the shadow factor. Measurements use
//! these instead of colours. The pixel's exact position follows from the triangle.

use core::fmt;

use shadowfit_wgpu::ShadowMapError;

use crate::formats::DEPTH_FORMAT;
use crate::read_back::{ReadBack, ReadError};
use crate::{Gpu, bindings};

/// Format of the probe's target: the triangle's number plus one (0 is the sky), and the bits of the factor.
pub const PROBE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rg32Uint;

/// One pixel of a [`Probe`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProbePixel {
    /// The visible triangle: its number in the scene's [`triangles`](shadowfit_scene::Pose::triangles),
    /// without blended surfaces.
    pub triangle: u32,
    /// Filtered share of the light, 0..=1, as shaded.
    pub factor: f32,
}

impl ProbePixel {
    /// Decodes a pixel of the target; `None` for the sky.
    pub(crate) fn of([triangle, factor]: [u32; 2]) -> Option<Self> {
        Some(Self { triangle: triangle.checked_sub(1)?, factor: f32::from_bits(factor) })
    }
}

/// All pixels of a picture, rows from the top; `None` for the sky. Blended surfaces are left out, so that the
/// surfaces behind them are recorded.
#[derive(Clone, Debug)]
pub struct Probe {
    /// Width and height, in pixels.
    pub size: [u32; 2],
    /// `size[0] * size[1]` pixels.
    pub pixels: Vec<Option<ProbePixel>>,
}

/// Reason why a frame could not be probed.
#[derive(Clone, Debug, PartialEq)]
pub enum ProbeError {
    /// A map does not match the shadow map.
    ShadowMap(ShadowMapError),
    /// The probe could not be read back.
    Read(ReadError),
}

impl From<ReadError> for ProbeError {
    fn from(error: ReadError) -> Self {
        Self::Read(error)
    }
}

impl From<ShadowMapError> for ProbeError {
    fn from(error: ShadowMapError) -> Self {
        Self::ShadowMap(error)
    }
}

impl fmt::Display for ProbeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ShadowMap(error) => error.fmt(f),
            Self::Read(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for ProbeError {}

/// Textures that a probe is drawn into.
#[derive(Debug)]
pub struct ProbeTargets {
    /// Width and height, in pixels.
    pub size: [u32; 2],
    pub(crate) texture: wgpu::Texture,
    /// The pixels: x is the triangle's number plus one (0 is the sky), y the bits of the f32 factor.
    pub view: wgpu::TextureView,
    pub(crate) depth: wgpu::TextureView,
}

impl ProbeTargets {
    /// Creates targets of at least 1×1 pixels.
    pub fn new(device: &wgpu::Device, size: [u32; 2]) -> Self {
        let limit = device.limits().max_texture_dimension_2d;
        let size = size.map(|side| side.clamp(1, limit));
        let texture = |format, usage| {
            let usage = usage | wgpu::TextureUsages::RENDER_ATTACHMENT;
            bindings::plain_texture(device, "probe", size, format, usage)
        };
        let readable = wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::TEXTURE_BINDING;
        let pixels = texture(PROBE_FORMAT, readable);
        let view = pixels.create_view(&Default::default());
        let depth = texture(DEPTH_FORMAT, wgpu::TextureUsages::TEXTURE_BINDING).create_view(&Default::default());
        Self { size, texture: pixels, view, depth }
    }

    /// Returns the depth buffer of the last probe: reversed, 0 for the sky. Shaders can load it.
    pub fn depth_view(&self) -> &wgpu::TextureView {
        &self.depth
    }

    /// Waits for the probe and reads it.
    ///
    /// # Errors
    ///
    /// [`ReadError`] if the device was lost or does not answer.
    pub fn read(&self, gpu: &Gpu) -> Result<Probe, ReadError> {
        Ok(self.probe(&ReadBack::new(gpu, &self.texture, self.size, 8).wait(gpu)?))
    }

    /// Reads the probe like [`Self::read`]. A browser can do other work meanwhile.
    ///
    /// # Errors
    ///
    /// As for [`Self::read`].
    pub async fn arrive(&self, gpu: &Gpu) -> Result<Probe, ReadError> {
        Ok(self.probe(&ReadBack::new(gpu, &self.texture, self.size, 8).arrive(gpu).await?))
    }

    fn probe(&self, bytes: &[u8]) -> Probe {
        let pixels = bytemuck::pod_collect_to_vec::<u8, [u32; 2]>(bytes).into_iter().map(ProbePixel::of);
        Probe { size: self.size, pixels: pixels.collect() }
    }
}
