//! One hash over all output of fits.

use std::fmt::{Debug, Write};

/// FNV-1a over the `Debug` texts of values (G. Fowler, L. C. Noll, K.-P. Vo: "The FNV non-cryptographic hash
/// algorithm").
///
/// Rust prints the shortest decimal that reads back as the same float, and the sign of zero, so two texts are
/// equal only if all bits are. It prints every field, including private and future ones.
pub(crate) struct Hash(u64);

impl Hash {
    pub(crate) fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    pub(crate) fn add(&mut self, value: &impl Debug) {
        // Writing to a number cannot fail.
        let _ = write!(self, "{value:?};");
    }

    pub(crate) fn value(&self) -> u64 {
        self.0
    }
}

impl Write for Hash {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        for byte in text.bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
        Ok(())
    }
}
