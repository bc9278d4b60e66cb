//! What a camera sees: frusta from cameras and matrices, cut by view depth and clipped against boxes.

mod camera;
mod frustum;
mod slice;

pub use camera::PerspectiveCamera;
pub use frustum::ViewFrustum;
pub(crate) use slice::{EDGES, Picture, Plane, Range, Slice, View, at, clip_to_box, inner_part, slice_corners};
