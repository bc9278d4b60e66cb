//! Fits a directional light's shadow maps to what a camera sees, and gives spot lights theirs.
//!
//! Camera, sun and boxes of the scene in, maps and the casters of each out, frame by frame; this is the
//! example `fit_once`:
//!
//! ```
//! use shadowfit::glam::{DVec3, Vec3};
//! use shadowfit::{Aabb, Boxes, FitError, FitInput, PerspectiveCamera, ShadowFitter, Technique};
//!
//! fn main() -> Result<(), FitError> {
//!     let ground = Aabb::new(Vec3::new(-80.0, -0.1, -80.0), Vec3::new(80.0, 0.0, 80.0));
//!     let house = Aabb::new(Vec3::new(-4.0, 0.0, -12.0), Vec3::new(4.0, 6.0, -6.0));
//!     let objects = [ground, house];
//!     let boxes = Boxes::world(&objects);
//!     let sun = Vec3::new(0.3, -0.8, 0.2); // the way its light travels
//!     let technique = Technique::default(); // 4 maps of 2048 × 2048 texels
//!     let mut fitter = ShadowFitter::new(&technique); // remembers the last frame's maps, to keep them still
//!
//!     for frame in 0..3 {
//!         let eye = DVec3::new(0.0, 1.7, 20.0 - 0.1 * f64::from(frame));
//!         let (forward, up) = (Vec3::NEG_Z, Vec3::Y);
//!         let camera = PerspectiveCamera { eye, forward, up, fov_y: 0.8, aspect: 16.0 / 9.0, near: 0.1, far: 200.0 };
//!         let views = [camera.frustum()?];
//!         let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, sun) };
//!         let maps = fitter.fit(&input)?;
//!         for (map, casters) in maps.iter().zip(maps.caster_volumes(&views, &technique)?) {
//!             let drawn: Vec<usize> = casters.casters_in(&boxes).collect();
//!             println!("draw objects {drawn:?} with {}", map.projection.clip_from_world);
//!             println!("look the map up with {}, biased by {}", map.projection.uv_from_world, map.bias.constant_depth);
//!         }
//!     }
//!     Ok(())
//! }
//! ```
//!
//! A map is drawn with `clip_from_world` and looked up with `uv_from_world`. A point reads the finest
//! map that holds it ([`FittedMaps::read`]), compares its depth moved by the
//! [`bias`](FittedMap::bias), and takes positions relative to [`LightProjection::origin`], which is the
//! eye. Boxes need not be exact: one for each object is enough, and without any the maps cover the
//! whole view.
//!
//! [`Technique::default`] is the one to begin with: [`Windows`], which are sharp and hardly
//! ever make an edge crawl. Tell the fitter what the last frame showed ([`ShadowFitter::set_visible_demand`]);
//! `shadowfit-wgpu` counts it in the depth buffer by a compute pass. Without it the fit looks through the
//! boxes in each frame: texels are a third wider, and with a thousand boxes a fit takes three times as long
//! or more. [`PRESETS`] has other techniques by name, each with a line that says when to take it. The
//! repository's `docs/MATHS.md` derives every fit, with pictures.
//!
//! # Without an allocator
//!
//! [`ShadowFitter`] owns the memory that fits work in, and needs the feature `alloc`. [`FitState`] makes the same maps
//! in memory that the caller owns:
//!
//! ```
//! use shadowfit::glam::{DVec2, DVec3, Vec3};
//! use shadowfit::{FitInput, FitState, PerspectiveCamera, Technique, Scratch};
//!
//! let eye = DVec3::new(0.0, 1.7, 20.0);
//! let (forward, up) = (Vec3::NEG_Z, Vec3::Y);
//! let camera = PerspectiveCamera { eye, forward, up, fov_y: 0.8, aspect: 1.6, near: 0.1, far: 200.0 };
//! let mut fitter = FitState::new();
//! let mut storage = [DVec2::ZERO; Scratch::required(0, 1)]; // no boxes, one view
//!
//! let views = [camera.frustum()?];
//! let input = FitInput::new(&views, Vec3::new(0.3, -0.8, 0.2));
//! let maps = fitter.fit(&input, &Technique::default(), &mut Scratch::new(&mut storage))?;
//! assert_eq!(maps.len(), 4);
//! # Ok::<(), shadowfit::FitError>(())
//! ```
//!
//! [`Scratch::required`] says how much storage the fits of a frame need, from the number of boxes and of views. Maps
//! that are [held](settings::Stabilise::Hysteresis) are fitted to the views of two frames ahead as well: count two views
//! more for them. What the last frame showed goes into [`FitInput::demand`] and [`FitInput::histogram`].
//!
//! # A single map
//!
//! Where only the camera is known, [`fit`] is a function without state:
//!
//! ```
//! use shadowfit::glam::{DVec3, Vec3};
//! use shadowfit::settings::{BiasSettings, FilterKind, FitSettings, MapFormat};
//! use shadowfit::{Bias, PerspectiveCamera, fit};
//!
//! let camera = PerspectiveCamera {
//!     eye: DVec3::new(0.0, 1.7, 20.0),
//!     forward: Vec3::NEG_Z,
//!     up: Vec3::Y,
//!     fov_y: 0.8,
//!     aspect: 16.0 / 9.0,
//!     near: 0.1,
//!     far: 200.0,
//! };
//! let settings = FitSettings::default().with_max_distance(30.0);
//! let map = fit(&camera.frustum()?, Vec3::new(0.3, -0.8, 0.2), &settings)?;
//! let bias = Bias::from_texels(&BiasSettings::automatic(FilterKind::Pcf5x5), MapFormat::Depth32Float, &map);
//! println!("{} {} {}", map.clip_from_world, map.uv_from_world, bias.constant_depth);
//! # Ok::<(), shadowfit::FitError>(())
//! ```
//!
//! # What is where
//!
//! | what you need | where it is |
//! |---|---|
//! | other filters, biases, splits, resolutions, the shadow distance | [`Technique`] and [`settings`] |
//! | techniques by name | [`PRESETS`], [`Technique::preset`] |
//! | a view from a matrix, with its depth convention; both eyes of a headset | [`ViewFrustum`], [`FitInput::views`] |
//! | one map, from the camera alone or with boxes | [`fit`], [`fit_scene`] |
//! | which map a point reads, by coverage or by view depth | [`selection`], [`FittedMaps::read`] |
//! | which casters to draw into a map | [`CasterVolume`], [`culling`] for spheres, oriented boxes, whole lists and tighter volumes |
//! | splits chosen by what the last frame showed | [`demand`], [`FitInput::histogram`], [`FitInput::depth_bounds`] |
//! | windows placed by what the last frame showed | [`Windows`], [`demand`], [`ShadowFitter::set_visible_demand`], [`FitInput::demand`] |
//! | how many maps are enough | [`fewest_maps`] |
//! | boxes that hug large meshes | [`Clusters`], feature `alloc`, and [`NormalCone`] |
//! | thousands of static boxes, given once | [`StaticBoxes`], [`FitInput::static_boxes`], feature `alloc` |
//! | static casters drawn only where the map is new: the passes of each frame as data, for any graphics API | [`cache`], feature `alloc` |
//! | the texels of a map that can be kept, for a cache of your own | [`scroll`] |
//! | a moving sun without crawling shadow edges | [`light_steps`] |
//! | a lamp or headlight: its perspective map, casters and biases | [`SpotLight`](spot::SpotLight), [`spot`] |
//! | a proof that no map has a hole | [`proof`] |
//! | biases in metres and depth for a filter of your own | [`Bias`], [`bias`] |
//! | pixels per texel, depth steps, margin against acne | [`diagnostics`] |
//! | f32 matrices for world positions, a fit from a matrix of other code | [`LightProjection::world_matrices`], [`LightProjection::from_clip_from_world`] |
//! | all parameters with unit, range and help, for panels and files; a technique as Rust code | the crate `shadowfit-params` |
//!
//! # Conventions
//!
//! - Right-handed world, y up, metres, radians, column vectors; clip space x right, y up, with the
//!   depth range that a [`DepthConvention`] names; texture space u right, v down.
//! - Matrices are named `dst_from_src`. Their world inputs are **relative to an origin** in f64,
//!   the eye unless moved: [`LightProjection::relative_to`] and [`LightProjection::world_matrices`] convert.
//! - A light is its **direction of travel**, of a [`SpotLight`](spot::SpotLight) along its axis. Where a source speaks
//!   of the direction toward the light, `to_light = -direction`.
//! - Nothing panics; every bad input is a [`FitError`] with its value. Nothing allocates, except what needs the
//!   feature `alloc`; a [`ShadowFitter`] and a [`MapCache`](cache::MapCache) allocate while their scene grows, and not in
//!   steady frames.
//! - Transcendental functions come from `libm`, everything else is `+ - × ÷ √` on scalars, so the
//!   same input gives the same bits on every target.
//!
//! # Features
//!
//! | feature | adds |
//! |---|---|
//! | `std` (default) | `alloc`, and glam with the standard library |
//! | `alloc` | [`ShadowFitter`], [`VisibleDemand`], [`StaticBoxes`], `Clusters` and [`cache`], for which an allocator is enough |
//! | `serde` | `Serialize` and `Deserialize` for all settings, inputs and outputs that own their data, and for the state between frames; `Clusters` have theirs in [`Aabb`] and [`NormalCone`] |
//! | `bytemuck` | `Pod` and `Zeroable` for [`Aabb`], [`Sphere`](culling::Sphere), [`OrientedBox`](culling::OrientedBox), [`NormalCone`], [`Bias`], [`SpotBias`](spot::SpotBias) and [`CasterPlanes`](culling::CasterPlanes) |
//! | `mint` | the module `mint`: conversions from and to the types of other maths crates |
//!
//! This crate's vectors are those of the [`glam`] that it re-exports, 0.33 (from 0.33.2) or 0.34.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(feature = "alloc")]
extern crate alloc;

/// What everything else stands on: errors, checks of numbers, boxes, depth conventions, hulls and spheres.
mod base {
    pub(crate) mod checks;
    pub(crate) mod enclosing;
    mod error;
    mod space;

    pub use error::FitError;
    pub use space::{Aabb, Boxes, DepthConvention};
    pub(crate) use space::{box_corners, moved};
}

mod technique;

/// What a camera sees: frusta from cameras and matrices, cut by view depth and clipped against boxes.
mod view {
    mod camera;
    mod frustum;
    mod lens;
    mod oblique;
    mod slice;

    pub use camera::PerspectiveCamera;
    pub use frustum::ViewFrustum;
    pub use lens::{Camera, Lens};
    pub(crate) use slice::{
        Depths, EDGES, Picture, Plane, Range, RayCount, Slice, View, at, clip_to_box, covered, crossing, inner_part,
        slice_corners,
    };
}

/// The light: its axes, boxes along them, the texel lines across it, and parts of boxes over an outline toward it.
mod light {
    mod axes;
    mod column;
    pub(crate) mod grid;
    mod outline;
    mod volume;

    pub(crate) use axes::{Light, LightAxes, Roll, is_same_direction, is_vertical};
    pub(crate) use column::Column;
    pub(crate) use outline::{Outline, OutlineScratch};
    pub use volume::BoundSource;
    pub(crate) use volume::Volume;
}

mod content;

/// What was visible, and how fine a texel it asks for.
pub mod demand {
    pub(crate) mod from_boxes;
    pub(crate) mod grid;
    pub(crate) mod histogram;
    #[cfg(feature = "alloc")]
    mod rows;
    #[cfg(feature = "alloc")]
    mod visible_demand;

    pub use grid::{CELLS, DemandGrid, DemandSpace, LEVELS, MIN_FACING, PIXELS, SIDE};
    pub use histogram::{DepthBounds, DepthHistogram, needed_texel};
    #[cfg(feature = "alloc")]
    pub use rows::DepthRows;
    #[cfg(feature = "alloc")]
    pub use visible_demand::{CLASSES, COUNTS, DEPTHS, VisibleDemand, VisibleDemandSpace};
}

mod input;

mod projection;

mod fits;

mod cascades;

mod windows;

pub mod bias;
pub mod culling;
pub mod selection;

mod map;

/// How [`StaticBoxes`] changed between frames.
#[cfg(feature = "alloc")]
pub mod static_boxes {
    pub use crate::content::tree::{BoxChange, BoxRevision};
}

/// What can be kept of the maps of the last frame: the texels of a map that moved, and the direction of the light.
mod keep {
    pub mod light_steps;
    pub mod scroll;
    pub(crate) mod texels;
}

#[cfg(feature = "alloc")]
pub mod cache;
pub mod diagnostics;
pub mod proof;
pub mod spot;

mod fitter;
#[cfg(feature = "alloc")]
mod shadow_fitter;

#[cfg(feature = "mint")]
pub mod mint;

pub use base::{Aabb, Boxes, DepthConvention, FitError};
pub use bias::Bias;
#[cfg(feature = "alloc")]
pub use content::clusters::Clusters;
pub use content::normal_cone::NormalCone;
#[cfg(feature = "alloc")]
pub use content::tree::StaticBoxes;
pub use culling::CasterVolume;
#[cfg(feature = "alloc")]
pub use demand::VisibleDemand;
pub use fits::{fit, fit_scene};
pub use fitter::{FitState, fewest_maps};
pub use glam;
pub use input::{FitInput, Scratch};
pub use keep::{light_steps, scroll};
pub use light::BoundSource;
pub use map::{FittedMap, FittedMaps, PlacementSource};
pub use projection::{LightProjection, WorldMatrices};
#[cfg(feature = "alloc")]
pub use shadow_fitter::ShadowFitter;
pub use technique::{Cascades, Maps, PRESETS, Preset, SingleMap, Technique, Windows, settings};
pub use view::{Camera, Lens, PerspectiveCamera, ViewFrustum};

/// Runs the example of the README as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
