//! Numbers from the bytes of a fuzzer.

use shadowfit::glam::{DVec3, Vec3};

/// Bytes that are read from the front, followed by zeros.
pub(crate) struct Bytes<'a>(pub(crate) &'a [u8]);

impl Bytes<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (taken, rest) = self.0.split_at(self.0.len().min(N));
        self.0 = rest;
        let mut bytes = [0; N];
        bytes[..taken.len()].copy_from_slice(taken);
        bytes
    }

    pub(crate) fn byte(&mut self) -> u8 {
        let [byte] = self.take();
        byte
    }

    /// Returns a number in 0..count.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count
    }

    /// Returns one of several values.
    pub(crate) fn pick<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }

    /// Returns a number between two bounds. One in 32 calls returns a float of raw bits.
    pub(crate) fn f32(&mut self, low: f32, high: f32) -> f32 {
        if self.byte() >= 248 {
            return f32::from_le_bytes(self.take());
        }
        let share = f32::from(u16::from_le_bytes(self.take())) / f32::from(u16::MAX);
        low + (high - low) * share
    }

    /// Returns an f64 in the same way.
    pub(crate) fn f64(&mut self, low: f64, high: f64) -> f64 {
        if self.byte() >= 248 {
            return f64::from_le_bytes(self.take());
        }
        let share = f64::from(u32::from_le_bytes(self.take())) / f64::from(u32::MAX);
        low + (high - low) * share
    }

    pub(crate) fn vec3(&mut self, limit: f32) -> Vec3 {
        let [x, y, z] = [0; 3].map(|_| self.f32(-limit, limit));
        Vec3::new(x, y, z)
    }

    pub(crate) fn dvec3(&mut self, limit: f64) -> DVec3 {
        let [x, y, z] = [0; 3].map(|_| self.f64(-limit, limit));
        DVec3::new(x, y, z)
    }

    pub(crate) fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }
}
