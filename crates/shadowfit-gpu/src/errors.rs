//! Device errors as results. Without an error scope wgpu panics.

use core::future::Future;
use core::pin::pin;
use core::task::{Context, Poll, Waker};

/// Runs `work`, which the device may refuse or lack memory for.
///
/// WebGPU in browsers reports errors only after the result is already in use. There every result is `Ok`, and
/// errors go to the device's handler, `wgpu::Device::on_uncaptured_error`.
///
/// # Errors
///
/// The first error. Lack of memory has priority over other errors, which follow from it.
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

/// Returns the result of a future that is ready. Outside browsers, futures of error scopes are always ready.
fn now<T>(future: impl Future<Output = Option<T>>) -> Option<T> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => result,
        Poll::Pending => None,
    }
}
