//! Scenes lit by one map, with the numbers of a classic technique: draws the map and shades the scene.
//!
//! A [`SampleFrame`] describes the picture, a [`SampleRenderer`] draws it. Its [`ShadowTest`] and [`Shading`]
//! have their own WGSL. They compute in display values, as their sources did, except [`Shading::modern`].
//! Right-handed, y up, the sources' own units. Depth is 0 to 1.

pub mod point;
pub mod shaders;

mod format;
mod frame;
mod light_image;
mod map;
mod pipelines;
mod renderer;

pub use format::SampleFormat;
pub use frame::{
    CORNFLOWER, CasterFaces, FrameExtras, LightImage, LightPlace, MapRead, SampleFrame, SampleLight, SampleMapSettings,
    SampleUniform, Shading, ShadowTest, StoredDepth,
};
pub use renderer::{SampleError, SampleRenderer};
