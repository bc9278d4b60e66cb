//! The facts of one pixel on their way from the GPU, without waiting.

use shadowfit_gpu::{MapState, Mapping};

use crate::Gpu;
use crate::probe::ProbePixel;
use crate::read_back::ReadError;

/// Which pixel is asked about, and which texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelQuery {
    /// Width and height of the picture, in pixels.
    pub size: [u32; 2],
    /// Column and row of the pixel, from the left top; the nearest one for what lies beside the picture.
    pub pixel: [u32; 2],
    /// Texels of a map to be read too.
    pub texels: Option<TexelBlock>,
}

/// A square of texels of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexelBlock {
    /// Index of the map.
    pub map: usize,
    /// Column and row of the texel in the middle, from the left top of the map as it is looked up, wherever it is
    /// stored.
    pub texel: [i32; 2],
    /// Texels on each side of it, at most [`Self::MAX_RADIUS`].
    pub radius: u32,
}

impl TexelBlock {
    /// Greatest radius, in texels.
    pub const MAX_RADIUS: u32 = 31;

    /// Width and height, in texels.
    pub fn side(&self) -> u32 {
        self.radius.min(Self::MAX_RADIUS) * 2 + 1
    }
}

/// What is known of one pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelFacts {
    /// The pixel, and the texels that were read.
    pub query: PixelQuery,
    /// The triangle that it shows and the light that reaches it through the maps, as a
    /// [probe](crate::Renderer::probe) of the whole picture has it; `None` for the sky.
    pub seen: Option<ProbePixel>,
    /// Depths that the map holds, rows from the top: those of [`PixelQuery::texels`], beyond a border the texel at it.
    /// Empty where no texels were asked for, or the map does not exist.
    pub depths: Vec<f32>,
}

/// Facts of a pixel that the GPU is still finding.
#[derive(Debug)]
pub struct PixelRead {
    query: PixelQuery,
    /// Whether texels were found to be read.
    has_depths: bool,
    buffer: wgpu::Buffer,
    mapping: Mapping,
    is_taken: bool,
}

/// Format of the depths of a block of texels: the bits of floats, which not all devices can draw to.
pub(crate) const BLOCK_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// Bytes between rows of depths in the buffer, and before the first: the least that textures can be copied with.
pub(crate) const ROW: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT;

impl PixelRead {
    /// A buffer for the facts: the probed pixel at its start, rows of depths from [`ROW`] on.
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

    /// Has the buffer mapped, once what fills it is submitted.
    pub(crate) fn map(&self) {
        self.mapping.map(&self.buffer);
    }

    /// The facts, once the GPU has found them: `None` before that, and after they were taken. Does not wait.
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
