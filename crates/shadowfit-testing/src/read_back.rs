//! Read-back of textures.

use bytemuck::Pod;
use shadowfit_gpu::TexelCopy;

/// Waits for the bytes of all layers of a texture. Returns them row by row, without the padding of copies.
///
/// # Panics
///
/// If the texture has several aspects, or the device is lost.
pub fn bytes(device: &wgpu::Device, queue: &wgpu::Queue, texture: &wgpu::Texture) -> Vec<u8> {
    let bytes = texture.format().block_copy_size(None).expect("one aspect");
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let copy = TexelCopy::record(device, &mut encoder, texture, texture.size(), bytes);
    queue.submit([encoder.finish()]);
    copy.buffer().slice(..).map_async(wgpu::MapMode::Read, |result| result.expect("texels can be read"));
    device.poll(wgpu::PollType::wait_indefinitely()).expect("the device answers");
    copy.texels().expect("texels are mapped")
}

/// Waits for the texels of all layers of a texture. Returns them row by row, as values of the size of a
/// texel.
///
/// # Panics
///
/// If a texel has another size than `T`, and as [`bytes`].
pub fn texels<T: Pod>(device: &wgpu::Device, queue: &wgpu::Queue, texture: &wgpu::Texture) -> Vec<T> {
    assert_eq!(texture.format().block_copy_size(None), u32::try_from(size_of::<T>()).ok(), "{:?}", texture.format());
    bytemuck::pod_collect_to_vec(&bytes(device, queue, texture))
}
