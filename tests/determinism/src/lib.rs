//! 10,000 fits of every kind, and one hash over every number of them and of derived results: biases, culling,
//! diagnostics.
//!
//! The hash is the same on every target: x86-64 with SIMD, glam's scalar maths, a browser. `cargo xtask ci`
//! runs it on these three.

mod hash;
mod inputs;
mod numbers;
mod random;
mod run;
mod windows;

pub mod chunk;

use std::sync::OnceLock;

use numbers::ByKind;
use random::Random;

/// Number of fits.
pub const FITS: u32 = 10_000;

/// The hash of all fits. A deliberate change of the fits changes it, equally on all targets. `cargo test -p
/// shadowfit-determinism` prints the new one.
pub const HASH: u64 = 0x563c_e1c7_70e2_5d38;

/// The hashes over only the numbers of 10,000 other fits, with all settings written out. They do not depend on
/// names or on the state between frames, and change only if engines get other numbers.
pub const NUMBERS: NumbersByKind = NumbersByKind {
    single_map: 0xcbed_08f2_b4b7_6d15,
    cascades: 0x0f44_0507_d30a_bb0d,
    windows: 0x1d4e_5c93_1d61_e34b,
};

/// A hash over numbers for each kind of technique.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NumbersByKind {
    /// Hash of single maps.
    pub single_map: u64,
    /// Hash of cascades, read by coverage and by view depth.
    pub cascades: u64,
    /// Hash of windows.
    pub windows: u64,
}

/// The result of 10,000 fits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// Hash over all output.
    pub hash: u64,
    /// Fits that succeeded.
    pub fits: u32,
    /// Inputs that were refused.
    pub refused: u32,
}

/// Runs all fits.
pub fn outcome() -> Outcome {
    run::run(FITS)
}

/// Computes the hashes over the numbers of fits.
pub fn numbers() -> NumbersByKind {
    let mut numbers = ByKind::new();
    numbers::add(Random::new(2), FITS, &mut numbers);
    windows::add(Random::new(3), FITS, |random| !random.once_in(3), &mut numbers);
    NumbersByKind {
        single_map: numbers.single_map.value(),
        cascades: numbers.cascades.value(),
        windows: numbers.windows.value(),
    }
}

/// Returns the hash of all fits, for a host without Rust. WebAssembly exports need a fixed name.
#[expect(unsafe_code, reason = "a fixed name is all that it says; no other function of this program has it")]
#[unsafe(no_mangle)]
pub extern "C" fn shadowfit_hash() -> u64 {
    outcome().hash
}

/// Returns the expected value of [`shadowfit_hash`].
#[expect(unsafe_code, reason = "as above")]
#[unsafe(no_mangle)]
pub extern "C" fn shadowfit_expected_hash() -> u64 {
    HASH
}

/// Returns the hash over the numbers of a kind, for the same host: 0 for single maps, 1 for cascades, else
/// windows.
#[expect(unsafe_code, reason = "as above")]
#[unsafe(no_mangle)]
pub extern "C" fn shadowfit_numbers(kind: u32) -> u64 {
    static HERE: OnceLock<NumbersByKind> = OnceLock::new();
    HERE.get_or_init(numbers).of(kind)
}

/// Returns the expected value of [`shadowfit_numbers`].
#[expect(unsafe_code, reason = "as above")]
#[unsafe(no_mangle)]
pub extern "C" fn shadowfit_expected_numbers(kind: u32) -> u64 {
    NUMBERS.of(kind)
}

impl NumbersByKind {
    fn of(&self, kind: u32) -> u64 {
        match kind {
            0 => self.single_map,
            1 => self.cascades,
            _ => self.windows,
        }
    }
}
