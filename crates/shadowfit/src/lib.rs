//! Fits the shadow maps of a directional light to the camera's view, and builds perspective maps for spot
//! lights.
//!
//! Pass in the camera, the sun and your objects' bounds. You get four shadow maps, placed where they improve
//! the most visible pixels, and the casters to draw into each. This is the example `fit_once` of the
//! repository:
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
//! Draw a map with `clip_from_world` and look it up with `uv_from_world`. Both matrices take positions
//! relative to [`LightProjection::origin`], which is the eye. [`FittedMaps::read`] selects the map for a
//! point: the finest map that covers it. Move the point's depth toward the light by the
//! [`bias`](FittedMap::bias) before you compare it with the map. One box per object is enough, and boxes need
//! not be tight. Without boxes, the maps cover the whole view.
//!
//! Start with [`Technique::default`]. It uses [`Windows`]: shadows are sharp, and their edges hardly ever
//! crawl while the camera moves. Windows follow the *visible demand* of the last frame: its visible surface
//! points, with the texel size that each needs. Pass it to [`ShadowFitter::set_visible_demand`]; a compute
//! pass of `shadowfit-wgpu` counts it in the depth buffer. Without it, every fit estimates it by rays through
//! the boxes. Texels are then a third wider, and with a thousand boxes a fit takes at least three times as
//! long. [`PRESETS`] lists other techniques by name and says when to use each. In the repository,
//! `docs/MATHS.md` derives every fit, with pictures, and `docs/GLOSSARY.md` explains the terms.
//!
//! # Without an allocator
//!
//! [`ShadowFitter`] owns its scratch memory and needs the feature `alloc`. [`FitState`] computes the same
//! maps in memory that the caller owns:
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
//! [`Scratch::required`] returns the storage that the fits of a frame need, from the number of boxes and
//! views. Maps that are [held](settings::Stabilise::Hysteresis) are also fitted to the predicted views of two
//! later frames, so count two more views for them. Pass the visible demand of the last frame in
//! [`FitInput::demand`] and [`FitInput::histogram`].
//!
//! # A single map
//!
//! If only the camera is known, call [`fit`], a function without state:
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
//! # Where to find things
//!
//! | you need | see |
//! |---|---|
//! | other filters, biases, splits, resolutions, the shadow distance | [`Technique`] and [`settings`] |
//! | techniques by name | [`PRESETS`], [`Technique::preset`] |
//! | a view from a matrix, with its depth convention; both eyes of a headset | [`ViewFrustum`], [`FitInput::views`] |
//! | one map, from the camera alone or with boxes | [`fit`], [`fit_scene`] |
//! | the map that a point reads, by coverage or by view depth | [`selection`], [`FittedMaps::read`] |
//! | the casters to draw into a map | [`CasterVolume`], [`culling`] for spheres, oriented boxes, whole lists and tighter volumes |
//! | splits chosen from the visible depths of the last frame | [`demand`], [`FitInput::histogram`], [`FitInput::depth_bounds`] |
//! | windows placed by the visible demand of the last frame | [`Windows`], [`demand`], [`ShadowFitter::set_visible_demand`], [`FitInput::demand`] |
//! | the smallest useful number of maps | [`fewest_maps`] |
//! | tight boxes around large meshes | [`Clusters`], feature `cache`, and [`NormalCone`] |
//! | thousands of static boxes, passed once | [`StaticBoxes`], [`FitInput::static_boxes`], feature `cache` |
//! | cached maps, with static casters drawn only into new parts: the passes of each frame as data, for any graphics API | [`cache`], feature `cache` |
//! | the texels of a map that stay valid, for your own cache | [`scroll`] |
//! | a moving sun without crawling shadow edges | [`light_steps`] |
//! | a lamp or headlight: its perspective map, casters and biases | [`SpotLight`](spot::SpotLight), [`spot`] |
//! | a proof that no map has a hole | [`proof`] |
//! | biases in metres and depth for your own filter | [`Bias`], [`bias`] |
//! | pixels per texel, depth steps, margin against acne | [`diagnostics`] |
//! | f32 matrices for world positions, a projection from another engine's matrix | [`LightProjection::world_matrices`], [`LightProjection::from_clip_from_world`] |
//! | all parameters with unit, range and help, for panels and files; a technique as Rust code | the crate `shadowfit-params` |
//!
//! # Conventions
//!
//! - The world is right-handed with y up, in metres and radians. Vectors are columns. Clip space has x right
//!   and y up, and a [`DepthConvention`] names its depth range. Texture space has u right and v down.
//! - *Along the light* means along the direction of its rays, *across the light* perpendicular to it. *View
//!   depth* is the distance from the eye along the camera's forward direction.
//! - Matrices are named `dst_from_src`. Their world inputs are **relative to an origin** in f64, by default
//!   the eye. [`LightProjection::relative_to`] moves the origin. [`LightProjection::world_matrices`] takes
//!   plain world positions.
//! - A light is given by its **direction of travel**. For a [`SpotLight`](spot::SpotLight) this is the
//!   direction along its axis. If you have the direction toward the light, pass `-to_light`.
//! - No function panics. Invalid input returns a [`FitError`] with the offending value. No function
//!   allocates, except those behind the features `alloc` and `cache`. [`ShadowFitter`] and [`MapCache`](cache::MapCache)
//!   allocate while their scene grows, but not in steady frames.
//! - Transcendental functions come from `libm`, and all other arithmetic is `+ - × ÷ √` on scalars. The same
//!   input gives the same bits on every target.
//!
//! # Features
//!
//! | feature | adds |
//! |---|---|
//! | `std` (default) | `alloc`, and glam with the standard library |
//! | `cache` (default) | [`cache`], [`StaticBoxes`] and [`Clusters`]; needs `alloc` |
//! | `cascades` (default) | techniques with [`Cascades`] and [`SingleMap`]; without it their fits fail with [`FitError::MissingFeature`] |
//! | `windows` (default) | techniques with [`Windows`], such as [`Technique::default`]; without it their fits fail in the same way |
//! | `alloc` | [`ShadowFitter`] and [`VisibleDemand`]; needs an allocator but not the standard library |
//! | `serde` | `Serialize` and `Deserialize` for all settings, for inputs and outputs that own their data, and for the state between frames; to store `Clusters`, store their [`Aabb`]s and [`NormalCone`]s |
//! | `bytemuck` | `Pod` and `Zeroable` for [`Aabb`], [`Sphere`](culling::Sphere), [`OrientedBox`](culling::OrientedBox), [`NormalCone`], [`Bias`], [`SpotBias`](spot::SpotBias) and [`CasterPlanes`](culling::CasterPlanes) |
//! | `mint` | the module `mint`: conversions from and to the types of other maths crates |
//!
//! The vector and matrix types are from the re-exported [`glam`], version 0.33 (from 0.33.2) or 0.34.
#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(
    not(all(feature = "cascades", feature = "windows")),
    allow(
        dead_code,
        unused_imports,
        reason = "a build with one kind of maps does not use the parts that only the other kind needs"
    )
)]

#[cfg(feature = "alloc")]
extern crate alloc;

/// Basics of all modules: errors, checks of numbers, boxes, depth conventions, hulls and spheres.
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

/// View frusta, made from cameras and matrices, cut by view depth and clipped against boxes.
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

/// The light: its axes, boxes along them, the texel grid across it, and parts of boxes over an outline.
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

/// Visible demand: the surfaces that were visible, and the texel size that they need.
pub mod demand {
    mod counts;
    pub(crate) mod from_boxes;
    pub(crate) mod grid;
    pub(crate) mod histogram;
    mod rows;
    #[cfg(feature = "alloc")]
    mod visible_demand;

    pub use counts::{CLASSES, COUNTS, Counts, DEPTHS, VisibleDemandSpace};
    pub use grid::{CELLS, DemandGrid, DemandSpace, LEVELS, MIN_FACING, PIXELS, SIDE};
    pub use histogram::{DepthBounds, DepthHistogram, needed_texel};
    pub use rows::{DepthPicture, DepthRows};
    #[cfg(feature = "alloc")]
    pub use visible_demand::VisibleDemand;
}

mod input;

mod projection;

mod fits;

#[cfg(feature = "cascades")]
mod cascades;
#[cfg(feature = "windows")]
mod windows;

/// Stand-ins for the kinds of maps that a build leaves out. Their fits fail.
#[cfg(not(all(feature = "cascades", feature = "windows")))]
mod left_out;
#[cfg(not(feature = "cascades"))]
use left_out::cascades;
#[cfg(not(feature = "windows"))]
use left_out::windows;

pub mod bias;
pub mod culling;
pub mod selection;

mod map;

/// Changes of [`StaticBoxes`] between frames.
#[cfg(feature = "cache")]
pub mod static_boxes {
    pub use crate::content::tree::{BoxChange, BoxRevision};
}

/// Reuse of the last frame's maps: the texels that stay valid when a map moves, and a held light direction.
mod keep {
    pub mod light_steps;
    pub mod scroll;
    pub(crate) mod texels;
}

#[cfg(feature = "cache")]
pub mod cache;
pub mod diagnostics;
pub mod proof;
pub mod spot;
pub mod uniform;

mod fitter;
#[cfg(feature = "alloc")]
mod shadow_fitter;

#[cfg(feature = "mint")]
pub mod mint;

pub use base::{Aabb, Boxes, DepthConvention, FitError};
pub use bias::Bias;
#[cfg(feature = "cache")]
pub use content::clusters::Clusters;
pub use content::normal_cone::NormalCone;
#[cfg(feature = "cache")]
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
