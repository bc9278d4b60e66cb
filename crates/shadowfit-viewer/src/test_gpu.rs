//! The devices that unit tests draw with.

use std::sync::LazyLock;

use shadowfit_render::{AdapterChoice, Gpu};

/// The software adapter's device, which all tests of the process share.
pub(crate) fn shared_gpu() -> Gpu {
    static GPU: LazyLock<Gpu> = LazyLock::new(fresh_gpu);
    GPU.clone()
}

/// The software adapter, opened again for a test that loses the device or replaces its error handler.
pub(crate) fn fresh_gpu() -> Gpu {
    pollster::block_on(Gpu::headless(AdapterChoice::Software)).expect("the software adapter")
}
