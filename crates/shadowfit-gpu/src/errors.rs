//! Errors of a device as results. Without an error scope wgpu ends the program.

use core::future::Future;
use core::pin::pin;
use core::task::{Context, Poll, Waker};

/// Does work that the device may refuse or lack memory for.
///
/// WebGPU in browsers reports errors when the result is in use already. There every result is `Ok`, and errors go to the
/// device's handler, `wgpu::Device::on_uncaptured_error`.
///
/// # Errors
///
/// The first error. Lack of memory is returned before any other error, which follows from it.
pub fn catch_errors<T>(device: &wgpu::Device, work: impl FnOnce() -> T) -> Result<T, wgpu::Error> {
    if device.adapter_info().backend == wgpu::Backend::BrowserWebGpu {
        return Ok(work());
    }
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let result = work();
    let refused = now(validation.pop());
    match now(memory.pop()).or(refused) {
        Some(error) => Err(error),
        None => Ok(result),
    }
}

/// The result of a future that is ready, as errors are outside browsers.
fn now<T>(future: impl Future<Output = Option<T>>) -> Option<T> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => result,
        Poll::Pending => None,
    }
}
