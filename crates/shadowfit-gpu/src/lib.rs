#![doc = include_str!("../README.md")]

mod at_once;
pub mod bindings;
mod compute;
mod errors;
mod mapping;
mod read_back;
mod texels;

pub use at_once::make_at_once;
pub use compute::{compute_pipeline, wgsl_module};
pub use errors::catch_errors;
pub use mapping::{MapState, Mapping};
pub use read_back::{DeviceLost, ReadBackRing};
pub use texels::TexelCopy;
