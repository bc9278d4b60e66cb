//! Tests that a device refuses.

use std::io::Write as _;

/// Says that the running test is skipped, because the adapter lacks something that it needs. Return from the test after it.
/// The line appears even where the output of passing tests is hidden.
pub fn lacking(info: &wgpu::AdapterInfo, what: &str) {
    let thread = std::thread::current();
    let test = thread.name().unwrap_or("a test");
    // The macros that print are captured. A closed output leaves nobody to tell.
    let _ = writeln!(std::io::stderr(), "SKIPPED: {test}: {} lacks {what}", shadowfit_adapter::label(info));
}
