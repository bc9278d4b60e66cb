//! Tests of parallel creation.

use core::future::Future;
use core::pin::pin;
use core::task::{Context, Poll, Waker};

use shadowfit_gpu::make_at_once;
use shadowfit_testing::test_gpu;

/// Enough for several rounds of threads on most machines.
const COUNT: u64 = 65;

fn buffer(device: &wgpu::Device, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
}

#[test]
fn gpu_what_is_made_at_once_comes_in_the_order_of_its_kinds() {
    let device = test_gpu().device;
    let sizes: Vec<u64> = (1..=COUNT).map(|size| size * 4).collect();
    let made = make_at_once(&device, &sizes, |size| buffer(&device, *size, wgpu::BufferUsages::STORAGE));
    assert_eq!(made.iter().map(wgpu::Buffer::size).collect::<Vec<_>>(), sizes);
    assert!(make_at_once(&device, &[], |size: &u64| *size).is_empty());
}

#[test]
fn gpu_an_error_of_one_kind_reaches_the_scope_of_the_thread_that_asks() {
    let device = test_gpu().device;
    let usages = [wgpu::BufferUsages::STORAGE, wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::STORAGE];
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let made = make_at_once(&device, &usages, |usage| buffer(&device, 4, *usage));
    let error = pin!(scope.pop()).poll(&mut Context::from_waker(Waker::noop()));
    assert!(matches!(error, Poll::Ready(Some(wgpu::Error::Validation { .. }))), "{error:?}");
    assert_eq!(made.len(), 2);
}
