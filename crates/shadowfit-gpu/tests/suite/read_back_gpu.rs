//! Tests of numbers that are read back from a device.

use shadowfit_gpu::ReadBackRing;
use shadowfit_testing::{TestGpu, test_gpu};

/// Number of buffers in the ring.
const BUFFERS: usize = 2;

/// Records the read-back of a number, with twice the number as its value.
fn record(TestGpu { device, queue, .. }: &TestGpu, ring: &mut ReadBackRing<u32>, number: u32) -> bool {
    let source = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 4,
        usage: wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    queue.write_buffer(&source, 0, &number.to_ne_bytes());
    let mut encoder = device.create_command_encoder(&Default::default());
    let is_recorded = ring.record(&mut encoder, &source, number * 2);
    queue.submit([encoder.finish()]);
    is_recorded
}

fn take(gpu: &TestGpu, ring: &mut ReadBackRing<u32>) -> Option<(u32, Vec<u8>)> {
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device works");
    ring.take(<[u8]>::to_vec).expect("the device works")
}

#[test]
fn gpu_the_newest_result_comes_back_once_and_frees_all_buffers() {
    let gpu = test_gpu();
    let mut ring = ReadBackRing::new(&gpu.device, "numbers", 4, BUFFERS);
    assert_eq!(take(&gpu, &mut ring), None);
    assert!(record(&gpu, &mut ring, 1) && record(&gpu, &mut ring, 2) && !record(&gpu, &mut ring, 3));
    assert_eq!(take(&gpu, &mut ring), Some((4, 2u32.to_ne_bytes().to_vec())));
    assert_eq!(take(&gpu, &mut ring), None);
    assert!(record(&gpu, &mut ring, 4) && record(&gpu, &mut ring, 5));
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the device works");
    assert_eq!(ring.free(), None);
    ring.free_overtaken();
    assert!(ring.free().is_some());
}

#[test]
fn gpu_forgotten_results_never_come_back_and_an_encoder_that_is_dropped_frees_its_buffer() {
    let gpu = test_gpu();
    let mut ring = ReadBackRing::new(&gpu.device, "numbers", 4, 1);
    assert!(record(&gpu, &mut ring, 1));
    ring.forget();
    assert_eq!(take(&gpu, &mut ring), None);
    let source = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 4,
        usage: wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    assert!(ring.record(&mut encoder, &source, 7) && ring.free().is_none());
    drop(encoder);
    assert!(record(&gpu, &mut ring, 3));
    assert_eq!(take(&gpu, &mut ring), Some((6, 3u32.to_ne_bytes().to_vec())));
}
