//! Errors of a device that would otherwise end the program, as results. WebGPU in browsers reports errors later, when the
//! result is in use already: there they go to the device's own handler, `wgpu::Device::on_uncaptured_error`.

use core::future::Future;
use core::pin::pin;
use core::task::{Context, Poll, Waker};

/// Does work that may find the device out of memory, or unable to do it.
pub(crate) fn caught<T>(device: &wgpu::Device, work: impl FnOnce() -> T) -> Result<T, wgpu::Error> {
    if device.adapter_info().backend == wgpu::Backend::BrowserWebGpu {
        return Ok(work());
    }
    let memory = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let validation = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let result = work();
    match now(validation.pop()).or(now(memory.pop())) {
        Some(error) => Err(error),
        None => Ok(result),
    }
}

/// The result of a future that is ready, as those of errors are outside of browsers.
fn now<T>(future: impl Future<Output = Option<T>>) -> Option<T> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => result,
        Poll::Pending => None,
    }
}
