//! The fitter of one sun and one camera as a WebAssembly module with plain exports over one memory.
//!
//! The npm package `shadowfit` in the folder `npm` wraps it. An instance of the module is a fitter: a page
//! creates one for each sun and camera, and the garbage collector frees it. It has neither
//! handles nor text: errors are numbers, and `npm/src/fitter.js` has their sentences.
//!
//! The caller writes numbers into the memory, calls a function, and reads numbers. All numbers are
//! `f64` except boxes and depths, which are `f32`.
#![cfg_attr(target_arch = "wasm32", no_std)]
#![cfg_attr(not(target_arch = "wasm32"), allow(dead_code, reason = "the exports exist only in the module"))]

extern crate alloc;

mod error;
#[cfg(target_arch = "wasm32")]
mod exports;
mod fitter;
mod input;
mod output;
mod settings;

/// Allocator of the module: small, since the module allocates only while the scene grows.
#[cfg(target_arch = "wasm32")]
#[global_allocator]
static ALLOCATOR: lol_alloc::LockedAllocator<lol_alloc::FreeListAllocator> =
    lol_alloc::LockedAllocator::new(lol_alloc::FreeListAllocator::new());

/// Stops the module. The core never panics, so this only happens if memory runs out. A message would add the
/// standard library's formatting to the module.
#[cfg(target_arch = "wasm32")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    core::arch::wasm32::unreachable()
}
