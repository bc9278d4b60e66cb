//! Tests of helpers that need a device.

mod at_once_gpu;
mod read_back_gpu;
