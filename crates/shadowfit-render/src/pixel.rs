//! The data of one pixel, read back from the GPU without waiting.

use shadowfit_gpu::{MapState, Mapping};

use crate::Gpu;
use crate::probe::ProbePixel;
use crate::read_back::ReadError;

/// The pixel and the texels to read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelQuery {
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    /// Column and row of the pixel, from the left top, clamped to the picture.
    pub pixel: [u32; 2],
    /// Texels of a map to read as well.
    pub texels: Option<TexelBlock>,
}

/// A square of texels of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexelBlock {
    /// Index of the map.
    pub map: usize,
    /// Column and row of the texel in the middle, from the left top of the map as it is looked up, regardless
    /// of where it is stored.
    pub texel: [i32; 2],
    /// Texels on each side of it, at most [`Self::MAX_RADIUS`].
    pub radius: u32,
}

impl TexelBlock {
    /// Greatest radius, in texels.
    pub const MAX_RADIUS: u32 = 31;

    /// Returns width and height, in texels.
    pub fn side(&self) -> u32 {
        self.radius.min(Self::MAX_RADIUS) * 2 + 1
    }
}

/// Data of one pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelFacts {
    /// The pixel, and the texels that were read.
    pub query: PixelQuery,
    /// The visible triangle and the light that reaches it through the maps, as in a
    /// [probe](crate::Renderer::probe) of the whole picture. `None` for the sky.
    pub seen: Option<ProbePixel>,
    /// Depths of [`PixelQuery::texels`], rows from the top. Beyond a border, the border texel repeats. Empty
    /// if no texels were queried, or the map does not exist.
    pub depths: Vec<f32>,
}

/// Data of a pixel that the GPU is still computing.
#[derive(Debug)]
pub struct PixelRead {
    query: PixelQuery,
    /// Whether there are texels to read.
    has_depths: bool,
    buffer: wgpu::Buffer,
    mapping: Mapping,
    is_taken: bool,
}

/// Format of the depths of a block of texels: the bits of floats, because not all devices can draw to float
/// textures.
pub(crate) const BLOCK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// Bytes between rows of depths in the buffer, and before the first row: the smallest pitch for copying
/// textures.
pub(crate) const ROW: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;

impl PixelRead {
    /// Creates a buffer for the data: the probed pixel at its start, rows of depths from [`ROW`] on.
    pub(crate) fn new(device: &wgpu::Device, query: PixelQuery, has_depths: bool) -> Self {
        let rows = if has_depths { query.texels.map_or(0, |block| block.side()) } else { 0 };
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("facts of a pixel"),
            size: u64::from(ROW) * u64::from(1 + rows),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        Self { query, has_depths, buffer, mapping: Mapping::new(), is_taken: false }
    }

    pub(crate) fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Maps the buffer, once the commands that fill it are submitted.
    pub(crate) fn map(&self) {
        self.mapping.map(&self.buffer);
    }

    /// Returns the data, once the GPU has computed them. `None` before that, and after they were taken. Does
    /// not wait.
    ///
    /// # Errors
    ///
    /// [`ReadError`] if the device was lost.
    pub fn take(&mut self, gpu: &Gpu) -> Option<Result<PixelFacts, ReadError>> {
        let _unreported = gpu.without_reports();
        let polled = gpu.device.poll(wgpu::PollType::Poll);
        let state = self.mapping.state();
        if self.is_taken || (state == MapState::Busy && polled.is_ok()) {
            return None;
        }
        self.is_taken = true;
        Some(if state == MapState::Readable { self.facts() } else { Err(ReadError::Lost) })
    }

    fn facts(&self) -> Result<PixelFacts, ReadError> {
        let mapped = self.buffer.slice(..).get_mapped_range().map_err(|_| ReadError::Lost)?;
        let rows: Vec<[u8; ROW as usize]> = mapped.as_chunks().0.to_vec();
        let (pixel, rows) = rows.split_first().ok_or(ReadError::Lost)?;
        let [triangle, factor] =
            [0, 4].map(|at| u32::from_le_bytes([pixel[at], pixel[at + 1], pixel[at + 2], pixel[at + 3]]));
        let side = self.query.texels.map_or(0, |block| block.side()) as usize;
        let depths = rows.iter().flat_map(|row| bytemuck::pod_collect_to_vec::<u8, f32>(row).into_iter().take(side));
        Ok(PixelFacts {
            query: self.query,
            seen: ProbePixel::of([triangle, factor]),
            depths: depths.filter(|_| self.has_depths).collect(),
        })
    }
}
