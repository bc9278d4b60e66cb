//! The parts that Rust requires of a library without its standard library.

use core::alloc::{GlobalAlloc, Layout};

/// Allocator that always fails, because no function of this library allocates. A crate that this one uses has
/// other functions that do.
struct NoAllocator;

#[global_allocator]
static ALLOCATOR: NoAllocator = NoAllocator;

// SAFETY: a null pointer means that no memory is left, and nothing was allocated that could be freed.
unsafe impl GlobalAlloc for NoAllocator {
    unsafe fn alloc(&self, _: Layout) -> *mut u8 {
        core::ptr::null_mut()
    }

    unsafe fn dealloc(&self, _: *mut u8, _: Layout) {}
}

unsafe extern "C" {
    fn abort() -> !;
}

/// Ends the program. No function of this library panics on any input, so this is a fault of the library.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    // SAFETY: C's `abort` may be called at any time.
    unsafe { abort() }
}

// Symbol that Rust's own precompiled functions refer to. It is never called, because nothing unwinds. It is weak, so
// that a program may also link a library with Rust's standard library, which defines it.
#[cfg(all(unix, not(target_vendor = "apple")))]
core::arch::global_asm!(
    ".pushsection .rodata",
    ".weak rust_eh_personality",
    ".hidden rust_eh_personality",
    "rust_eh_personality:",
    ".byte 0",
    ".popsection"
);

#[cfg(not(all(unix, not(target_vendor = "apple"))))]
#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}
