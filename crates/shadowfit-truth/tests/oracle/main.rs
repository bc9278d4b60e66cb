//! Pictures with truth and errors in closed form, and the same classes from the GPU.

#[cfg(feature = "gpu")]
mod agreement_gpu;
mod ambient;
mod classes;
mod lamps;
mod metamorphic;
mod scenes;
#[cfg(feature = "gpu")]
mod shaders;
mod shadows;
mod single_pixels;
#[cfg(feature = "gpu")]
mod tally_gpu;
