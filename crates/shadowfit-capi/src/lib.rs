//! The C interface of shadowfit. `include/shadowfit.h` is generated from this crate and documents it.
//!
//! The caller owns all memory. A state is one buffer, made of a `state::State` and the working memory of fits
//! behind it. No function allocates: the library is built with an allocator that always fails.
//!
//! All pointers of callers are read and written in `pointer`, and all functions that C calls are in
//! `exports`. The modules between them are safe Rust.
#![cfg_attr(not(test), no_std)]
#![allow(unsafe_code, reason = "C passes pointers")]
#![allow(
    clippy::missing_safety_doc,
    clippy::doc_markdown,
    reason = "the header, in plain text, says what pointers point to"
)]
#![allow(clippy::result_large_err, reason = "without an allocator, an error holds its text")]

mod bias;
mod cache;
mod casters;
mod constants;
mod demand;
mod error;
mod exports;
mod fit;
#[cfg(c_library)]
mod library;
mod pointer;
mod proof;
mod state;
mod technique;
mod types;
mod view;

pub use constants::{
    ShadowfitCasterConstants, ShadowfitDemandConstants, ShadowfitMapConstants, ShadowfitReceiverConstants,
};
pub use error::ShadowfitResult;
pub use exports::*;
pub use state::ShadowfitState;
pub use types::*;
