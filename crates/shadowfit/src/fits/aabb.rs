//! The axis-aligned box of the camera frustum in the light's axes, which most engines use. Depth is tight to
//! the frustum. The near plane is moved toward the light by a caster extension, since objects between the
//! light and the frustum cast shadows into it.
//!
//! ```text
//!   toward the light
//!          ▲ z
//!          ┌────●────┐  near plane with the light in its middle
//!          │ casters │  caster_extension
//!    max.z ┼─────────┤
//!          │ frustum │
//!    min.z └─────────┘  far plane
//! ```
//!
//! The roll about the light comes from the shortest arc from straight down, so the map turns continuously
//! with the sun.

use super::Form;

pub(super) const FORM: Form = Form::OF_VIEWS;
