//! For techniques that draw a [`GpuScene`](crate::GpuScene) by their own passes.
//!
//! A frame begins with [`begin_frame`](crate::GpuScene::begin_frame) and lists what its passes draw
//! ([`seen`](crate::GpuScene::seen), [`drawn_of`](crate::GpuScene::drawn_of)); after
//! [`end_frame`](crate::GpuScene::end_frame) each pass sets a pipeline by a draw's [`PartKey`] and
//! [draws](crate::GpuScene::draw) it. [`Maker`] makes pipelines whose vertex stage reads [`part_buffers`];
//! [`bindings`](crate::bindings) and [`attachment`](crate::attachment) have the rest, [`shaders`](crate::shaders) the WGSL
//! that pictures share.

pub use crate::formats::{DEPTH_FORMAT, ENCODED_FORMAT};
pub use crate::maker::{InstanceNumber, Maker, Shape, Streams, culled, depth, part_buffers};
pub use crate::material::material_layout;
pub use crate::part::PartKey;
pub use crate::probe::PROBE_FORMAT;
pub use crate::scene::Draw;
pub use crate::unrolled::Numbering;
