//! Texels of a texture in a buffer that the CPU reads, without the padding between rows.

/// A copy of a texture's texels. Each row begins at a multiple of 256 bytes, as WebGPU requires.
#[derive(Debug)]
pub struct TexelCopy {
    buffer: wgpu::Buffer,
    /// Bytes per row.
    row: usize,
    /// Bytes per row with padding.
    padded: usize,
}

impl TexelCopy {
    /// Records a copy from the top left of a texture with one aspect, usage `COPY_SRC`, and this number of
    /// bytes per texel.
    pub fn record(
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        texture: &wgpu::Texture,
        size: wgpu::Extent3d,
        bytes_per_texel: u32,
    ) -> Self {
        let row = size.width * bytes_per_texel;
        let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("texels"),
            size: u64::from(padded) * u64::from(size.height) * u64::from(size.depth_or_array_layers),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: Some(size.height) };
        let destination = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, size);
        Self { buffer, row: row as usize, padded: padded as usize }
    }

    /// Returns the buffer that the texels are copied to, for mapping.
    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Returns the texels of the mapped buffer in rows from the top without padding, one layer after the other.
    ///
    /// # Errors
    ///
    /// If the buffer is not mapped.
    pub fn texels(&self) -> Result<Vec<u8>, wgpu::MapRangeError> {
        let mapped = self.buffer.get_mapped_range(..)?;
        // Copies whole rows: byte by byte, tests that read many maps would take seconds.
        let rows: Vec<&[u8]> = mapped.chunks(self.padded).map(|row| &row[..self.row]).collect();
        Ok(rows.concat())
    }
}
