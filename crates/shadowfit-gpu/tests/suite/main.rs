//! Helpers that need a device.

mod at_once_gpu;
mod read_back_gpu;
