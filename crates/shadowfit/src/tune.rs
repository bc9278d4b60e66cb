//! Temporary.
#![allow(missing_docs)]
use core::sync::atomic::{AtomicU32, Ordering};
pub static T: [AtomicU32; 16] = [const { AtomicU32::new(0) }; 16];
pub fn set(i: usize, v: f32) { T[i].store(v.to_bits(), Ordering::Relaxed); }
pub fn get(i: usize, default: f32) -> f32 { let b = T[i].load(Ordering::Relaxed); if b == 0 { default } else { f32::from_bits(b) } }
