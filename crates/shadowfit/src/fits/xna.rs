//! The fit of the XNA "Shadow Mapping" sample (Microsoft, XNA Creators Club, 2008):
//! `CreateLightViewProjectionMatrix`, kept exactly so that its pictures and flaws can be reproduced. It is
//! tight across the light, has twice the necessary depth, and ignores casters outside the frustum.
//!
//! The light is at the centre of the box's x and y and at its *minimum* z. This is the face **away** from the
//! incoming light, since view space looks along -z. The projection then runs from -depth to +depth:
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
//! The deviations from the source change no number of its own scene:
//!
//! - Corners are relative to the eye, and the box is measured in f64. The source rounds world coordinates to
//!   f32.
//! - A vertical light uses another up axis. The source divides by zero.
//! - Reversed and -1..1 depth are available.
//! - `margin` is the remedy that the source's text suggests.

use super::{Alignment, Covers, Form};
use crate::light::Roll;

pub(super) const FORM: Form = Form {
    covers: Covers::Corners,
    roll: Roll::LookAt,
    alignment: Alignment::Exact,
    whole_distance: true,
    ..Form::OF_VIEWS
};
