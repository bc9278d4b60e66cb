//! 10,000 fits of every kind, and one hash over every number that they and what follows from them say: biases, culling,
//! diagnostics.
//!
//! The hash is the same on every target: x86-64 with SIMD, glam's scalar maths, a browser. `cargo xtask ci` runs it on
//! these three.

mod hash;
mod inputs;
mod numbers;
mod random;
mod run;
mod windows;

/// Number of fits.
pub const FITS: u32 = 10_000;

/// The hash of all fits. A change of what a fit computes changes it on purpose, and on all targets alike:
/// `cargo test -p shadowfit-determinism` prints the new one.
pub const HASH: u64 = 0x0990_58be_8624_1cf1;

/// The hash over the numbers alone that as many fits give, every setting written out: it does not know what anything is
/// called or what is kept between frames, and only changes if engines get other numbers.
pub const NUMBERS: u64 = 0xc357_2f28_d9c9_f7a5;

/// The hash over the numbers of as many fits that are read by coverage, windows among them.
pub const WINDOWS: u64 = 0x275c_3df4_bb67_af26;

/// What 10,000 fits came to.
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

/// The hash over the numbers that fits give.
pub fn numbers() -> u64 {
    numbers::hash(FITS)
}

/// The hash over the numbers of fits that are read by coverage.
pub fn windows() -> u64 {
    windows::hash(FITS)
}

/// The hash of all fits, for a host without Rust: WebAssembly is given no name but a fixed one.
#[expect(unsafe_code, reason = "a fixed name is all that it says; no other function of this program has it")]
#[unsafe(no_mangle)]
pub extern "C" fn shadowfit_hash() -> u64 {
    outcome().hash
}

/// The hash that [`shadowfit_hash`] should have.
#[expect(unsafe_code, reason = "as above")]
#[unsafe(no_mangle)]
pub extern "C" fn shadowfit_expected_hash() -> u64 {
    HASH
}

/// The hash over the numbers, likewise.
#[expect(unsafe_code, reason = "as above")]
#[unsafe(no_mangle)]
pub extern "C" fn shadowfit_numbers() -> u64 {
    numbers()
}

/// The hash that [`shadowfit_numbers`] should have.
#[expect(unsafe_code, reason = "as above")]
#[unsafe(no_mangle)]
pub extern "C" fn shadowfit_expected_numbers() -> u64 {
    NUMBERS
}

/// The hash over the numbers of fits that are read by coverage, likewise.
#[expect(unsafe_code, reason = "as above")]
#[unsafe(no_mangle)]
pub extern "C" fn shadowfit_windows() -> u64 {
    windows()
}

/// The hash that [`shadowfit_windows`] should have.
#[expect(unsafe_code, reason = "as above")]
#[unsafe(no_mangle)]
pub extern "C" fn shadowfit_expected_windows() -> u64 {
    WINDOWS
}
