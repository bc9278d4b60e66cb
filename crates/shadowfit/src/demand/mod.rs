//! What was visible, and how fine a texel it asks for: what the last frame showed, and what boxes let expect.

pub mod histogram;
pub mod need;
#[cfg(feature = "alloc")]
pub mod seen;
