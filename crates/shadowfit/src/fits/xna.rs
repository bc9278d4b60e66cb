//! The fit of the XNA "Shadow Mapping" sample (Microsoft, XNA Creators Club, 2008):
//! `CreateLightViewProjectionMatrix`, kept exactly so that its pictures and flaws can be
//! reproduced. Tight across the light, twice the depth it needs, and blind to casters outside the
//! frustum.
//!
//! The light stands at the centre of the box's x and y at its *minimum* z, which is the face
//! **away** from where the light comes from, since view space looks along -z; the projection then
//! runs from -depth to +depth:
//!
//! ```text
//!   toward the light
//!         ▲ z
//!   max.z ┼───────┐  near plane, depth 0
//!         │frustum│
//!   min.z ┼───●───┤  the light, depth 0.5
//!         │ empty │
//!         └───────┘  far plane, depth 1
//! ```
//!
//! Deviations from the source, none of which changes a number of its own scene: corners are
//! relative to the eye and the box is measured in f64 (the source rounds world coordinates to f32),
//! a vertical light takes another up axis (the source divides by zero), reversed and -1..1 depth
//! are offered, and `margin` is the remedy that the source's text suggests.

use super::{Alignment, Covers, Form};
use crate::light::Roll;

pub(super) const FORM: Form = Form {
    covers: Covers::Corners,
    roll: Roll::LookAt,
    alignment: Alignment::Exact,
    whole_distance: true,
    ..Form::OF_VIEWS
};
