//! Pseudo-random numbers that are the same everywhere.
//!
//! G. Steele, D. Lea, C. Flood: "Fast splittable pseudorandom number generators", 2014 (`SplitMix64`). It
//! uses only integers. Floats are made from them by operations that are exact or rounded once.

use shadowfit::glam::{DVec3, Vec3};

/// A stream of numbers.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Creates an independent stream for each index.
    pub(crate) fn stream(seed: u64, index: u64) -> Self {
        Self(Self(Self(seed).next() ^ index).next())
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number in 0..count.
    pub(crate) fn below(&mut self, count: u32) -> u32 {
        ((self.next() >> 32) % u64::from(count)) as u32
    }

    /// Returns one of several values.
    pub(crate) fn pick<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len() as u32) as usize]
    }

    /// Returns true once in `count` calls.
    pub(crate) fn once_in(&mut self, count: u32) -> bool {
        self.below(count) == 0
    }

    /// Returns a number between two bounds, in steps of 2⁻²⁴ of their distance.
    pub(crate) fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * (self.below(1 << 24) as f32 / 16_777_216.0)
    }

    /// Returns a number from 2^low to 2^(high + 1).
    pub(crate) fn scale(&mut self, low: i32, high: i32) -> f32 {
        let exponent = low + self.below((high - low + 1) as u32).cast_signed();
        f32::from_bits(((exponent + 127) as u32) << 23) * self.between(1.0, 2.0)
    }

    /// Returns a vector with coordinates in -1..1.
    pub(crate) fn vector(&mut self) -> Vec3 {
        let [x, y, z] = [0; 3].map(|_| self.between(-1.0, 1.0));
        Vec3::new(x, y, z)
    }

    /// Returns a position with coordinates in -limit..limit.
    pub(crate) fn place(&mut self, limit: f64) -> DVec3 {
        let [x, y, z] = [0; 3].map(|_| (f64::from(self.below(u32::MAX)) / 2_147_483_648.0 - 1.0) * limit);
        DVec3::new(x, y, z)
    }
}
