//! The texels of a texture in a buffer that the CPU reads, and the padding between their rows.

/// A copy of a texture's texels. Each row begins at a multiple of 256 bytes, which WebGPU requires.
#[derive(Debug)]
pub struct TexelCopy {
    buffer: wgpu::Buffer,
    /// Bytes of a row.
    row: usize,
    /// Bytes of a row with its padding.
    padded: usize,
}

impl TexelCopy {
    /// Records the copy of the left top of a texture with one aspect, usage `COPY_SRC`, and this number of bytes a texel.
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

    /// The buffer that the texels are copied to, for mapping.
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
        // Whole rows at once: one byte after the other takes seconds where tests read many maps.
        let rows: Vec<&[u8]> = mapped.chunks(self.padded).map(|row| &row[..self.row]).collect();
        Ok(rows.concat())
    }
}
