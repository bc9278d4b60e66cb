//! CPU scenes for the shadowfit viewer: glTF import, built-in scenes, animation and bounds.
//!
//! A [`Scene`] is the data. A [`Pose`] holds the transforms at a time of an animation. Renderers draw both,
//! ray tracers take [`Pose::triangles`]. This crate needs no GPU. Spaces are right-handed with y up, in
//! metres and radians.

mod bounds;
pub mod builtin;
mod deform;
mod error;
mod import;
mod limits;
pub mod parts;
mod plain;
mod pose;
mod sample;
mod scene;
mod view;

pub use deform::Deformed;
pub use error::SceneError;
pub use import::{DecodeImage, DecodedImage, LoadStep, SceneSize, gltf_images, load_gltf_from_memory};
#[cfg(not(target_family = "wasm"))]
pub use import::{decode_image, load_gltf, load_gltf_scene, load_gltf_with_progress};
pub use pose::{Instance, Pose, Triangle};
pub use scene::*;
pub use view::Placement;

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadMe;
