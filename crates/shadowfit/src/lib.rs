//! Fits a directional light's orthographic view-projection to a camera frustum.
//!
//! Camera and light in, matrices out; this is the example `fit_once`:
//!
//! ```
//! use shadowfit::glam::{DVec3, Vec3};
//! use shadowfit::{Bias, BiasSettings, FilterKind, FitError, FitSettings, PerspectiveCamera, fit};
//!
//! fn main() -> Result<(), FitError> {
//!     let camera = PerspectiveCamera {
//!         eye: DVec3::new(0.0, 1.7, 5.0),
//!         forward: Vec3::NEG_Z,
//!         up: Vec3::Y,
//!         fov_y: 0.8,
//!         aspect: 16.0 / 9.0,
//!         near: 0.1,
//!         far: 200.0,
//!     };
//!     let direction = Vec3::new(0.3, -0.8, 0.2); // the way the light travels
//!     let settings = FitSettings::default().with_max_distance(30.0);
//!     let light = fit(&camera.frustum()?, direction, &settings)?;
//!     let bias = Bias::from_texels(&BiasSettings::automatic_normal_offset(FilterKind::Hardware2x2), &light);
//!
//!     println!("positions are relative to the eye at {}", light.origin);
//!     println!("draw the map with clip_from_world {}", light.clip_from_world);
//!     println!("look it up with uv_from_world {}", light.uv_from_world);
//!     println!("offset the looked-up point along its normal by {} m times sin θ", bias.normal_offset);
//!     println!("a texel is {} m, the depth range {} m", light.texel_size, light.depth_range);
//!     Ok(())
//! }
//! ```
//!
//! The repository's `docs/MATHS.md` derives every fit, with pictures, and says when to use which.
//!
//! # Conventions
//!
//! - Right-handed world, y up, metres, radians, column vectors; clip space x right, y up, with the
//!   depth range that a [`DepthConvention`] names; texture space u right, v down.
//! - Matrices are named `dst_from_src`. Their world inputs are **relative to an origin** in f64,
//!   the eye unless moved: [`LightFit::relative_to`] and [`LightFit::world_matrices`] convert.
//! - A light is its **direction of travel**. Where a source speaks of the direction toward the
//!   light, `to_light = -direction`.
//! - Nothing panics; every bad input is a [`FitError`] with its value. Nothing allocates, except
//!   `Clusters`, which needs the feature `alloc`.
//! - Transcendental functions come from `libm`, everything else is `+ - × ÷ √` on scalars, so the
//!   same input gives the same bits on every target.
//!
//! # Features
//!
//! | feature | adds |
//! |---|---|
//! | `std` (default) | `alloc`, and glam with the standard library |
//! | `alloc` | `Clusters`, for which an allocator is enough |
//! | `serde` | `Serialize` and `Deserialize` for all settings, inputs and outputs that own their data, and for the state between frames; `Clusters` have theirs in [`Aabb`] and [`NormalCone`] |
//! | `bytemuck` | `Pod` and `Zeroable` for [`Aabb`], [`Sphere`], [`OrientedBox`], [`NormalCone`], [`Bias`] and [`CasterPlanes`] |
//! | `mint` | the module `mint`: conversions from and to the types of other maths crates |
//!
//! This crate's vectors are those of the [`glam`] that it re-exports, 0.33 (from 0.33.2) or 0.34.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "alloc")]
extern crate alloc;

pub mod bias;
pub mod diagnostics;
pub mod figures;
pub mod fits;
pub mod light_steps;
#[cfg(feature = "mint")]
pub mod mint;
pub mod params;
pub mod scroll;
pub mod settings;
pub mod tool;
pub mod verify;

mod axes;
mod bounds;
mod camera;
mod caster;
mod checks;
#[cfg(feature = "alloc")]
mod clusters;
mod content;
mod covered;
mod depth;
mod depth_storage;
mod enclosing_sphere;
mod error;
mod frustum;
mod grid;
mod histogram;
mod hull;
mod input;
mod light_fit;
mod light_hull;
mod map_fitter;
mod maps;
mod motion;
mod near_plane;
mod normal_cone;
mod number;
mod outline;
mod presets;
mod rectangle;
mod rule;
mod splits;
mod technique;
mod view;
mod volume;

pub use bias::Bias;
pub use bounds::{Aabb, Boxes};
pub use camera::PerspectiveCamera;
pub use caster::{Bounds, CasterPlanes, CasterVolume, OrientedBox, Sphere, Sweep, cull};
#[cfg(feature = "alloc")]
pub use clusters::Clusters;
pub use depth::DepthConvention;
pub use error::FitError;
pub use fits::{fit, fit_scene};
pub use frustum::ViewFrustum;
pub use glam;
pub use grid::GridAnchor;
pub use histogram::{DepthHistogram, needed_texel};
pub use input::{DepthBounds, FitInput, Workspace};
pub use light_fit::{LightFit, WorldMatrices};
pub use light_steps::{LightStep, LightStepSettings, LightSteps};
pub use map_fitter::{MapFitter, fewest_maps};
pub use maps::{FittedMap, FittedMaps};
pub use normal_cone::NormalCone;
pub use presets::{PRESETS, Preset, RECOMMENDED};
pub use scroll::Scroll;
pub use settings::{
    BiasSettings, CasterPolicy, FilterKind, FitKind, FitSettings, HoldSettings, MAX_MAPS, MapFormat, MapOverride,
    ReceiverSource, RectangleKind, SplitScheme, Stabilise,
};
pub use technique::Technique;
pub use volume::Constraint;

/// Runs the example of the README as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
