//! The renderer on devices that can do less. Tests that need a graphics device have `gpu` in their path, by which
//! `cargo xtask test` leaves them out where there is none.

mod devices;
mod limits_gpu;
mod pictures;
mod probe_gpu;
mod sheets;
#[cfg(feature = "gles")]
mod webgl2_gpu;
