//! Textures read back as values.

use bytemuck::Pod;

/// Waits for the bytes of all layers of a texture, row by row, without the padding that copies need.
///
/// # Panics
///
/// If the texture has several aspects, or the device is lost.
pub fn bytes(device: &wgpu::Device, queue: &wgpu::Queue, texture: &wgpu::Texture) -> Vec<u8> {
    let size = texture.size();
    let used = size.width * texture.format().block_copy_size(None).expect("one aspect");
    let row = used.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("texels"),
        size: u64::from(row * size.height * size.depth_or_array_layers),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: Some(size.height) };
    let destination = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, size);
    queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(wgpu::MapMode::Read, |result| result.expect("texels can be read"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
    let mapped = buffer.slice(..).get_mapped_range().expect("texels are mapped");
    // Whole rows at once: one byte after the other takes seconds where tests read many maps.
    let rows: Vec<&[u8]> = mapped.chunks(row as usize).map(|row| &row[..used as usize]).collect();
    rows.concat()
}

/// Waits for the texels of all layers of a texture, row by row, as values of the size of a texel.
///
/// # Panics
///
/// If a texel has another size than `T`, and as [`bytes`].
pub fn texels<T: Pod>(device: &wgpu::Device, queue: &wgpu::Queue, texture: &wgpu::Texture) -> Vec<T> {
    assert_eq!(texture.format().block_copy_size(None), u32::try_from(size_of::<T>()).ok(), "{:?}", texture.format());
    bytemuck::pod_collect_to_vec(&bytes(device, queue, texture))
}
