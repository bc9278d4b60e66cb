//! The classic techniques, each with the numbers of its source: what draws their maps and shades their scenes.
//!
//! A [`SampleFrame`] says what is drawn, a [`SampleRenderer`] draws it, by one shadow test and one shading of
//! [`ShadowTest`] and [`Shading`]; [`formula`] has the same formulas in Rust. They compute in display values, as their
//! sources did, unless [`Shading::Modern`] is asked for. [`OcclusionPasses`] draw ambient occlusion, [`SkyBox`] a sky box. Right-handed, y up, the sources' own units; depth 0 to 1.

pub mod formula;

mod format;
mod frame;
mod kind;
mod light_image;
mod map;
mod occlusion;
mod pipelines;
mod renderer;
mod sky_box;

pub use format::SampleFormat;
pub use frame::{
    CasterFaces, LightImage, LightPlace, SampleFrame, SampleLight, SampleMapSettings, SampleUniform, Shading,
    ShadowTest, StoredDepth,
};
pub use kind::{ShadingKind, TestKind};
pub use occlusion::formula as occlusion_formula;
pub use occlusion::{
    OcclusionFrame, OcclusionLight, OcclusionMethod, OcclusionPasses, OcclusionSettings, OcclusionUniform,
    OcclusionView,
};
pub use renderer::{SampleError, SampleRenderer};
pub use sky_box::{SkyBox, SkyBoxUniform, SkyPicture, direction_of, face_of};
