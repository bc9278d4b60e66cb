//! Pictures whose truth and whose errors are known in closed form, and the GPU's twin beside them.

#[cfg(feature = "gpu")]
mod agreement_gpu;
mod classes;
mod metamorphic;
mod scenes;
#[cfg(feature = "gpu")]
mod shaders;
mod shadows;
