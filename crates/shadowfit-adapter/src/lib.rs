#![doc = include_str!("../README.md")]

mod choice;
mod error;
#[cfg(feature = "clap")]
mod options;

pub use choice::{ADAPTER_VARIABLE, AdapterChoice, EmptyName, adapters, instance};
pub use error::{AdapterError, label};
#[cfg(feature = "clap")]
pub use options::AdapterOptions;
