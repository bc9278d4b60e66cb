//! Building blocks for techniques that draw a [`GpuScene`](crate::GpuScene) with their own passes.
//!
//! A frame begins with [`begin_frame`](crate::GpuScene::begin_frame) and collects the draws of its passes
//! ([`seen`](crate::GpuScene::seen), [`drawn_of`](crate::GpuScene::drawn_of)). After
//! [`end_frame`](crate::GpuScene::end_frame) each pass sets a pipeline by a draw's [`PartKey`] and
//! [draws](crate::GpuScene::draw) it. [`Maker`] creates pipelines whose vertex stage reads [`part_buffers`].
//! The modules [`bindings`](crate::bindings) and [`attachment`](crate::attachment) contain helpers, and
//! [`shaders`](crate::shaders) contains the shared WGSL.

pub use crate::formats::{DEPTH_FORMAT, ENCODED_FORMAT};
pub use crate::maker::{InstanceNumber, Maker, Shape, Streams, culled, depth, part_buffers};
pub use crate::material::material_layout;
pub use crate::part::PartKey;
pub use crate::probe::PROBE_FORMAT;
pub use crate::scene::Draw;
pub use crate::unrolled::Numbering;
