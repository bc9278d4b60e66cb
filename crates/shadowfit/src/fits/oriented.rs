//! The least rectangle around the camera frustum as seen from the light, turned about it: by area,
//! or made square. It is the tightest a fit can be without knowing the scene.
//!
//! The frustum's outline has four to eight corners, along whose edges the rectangle is sought. It
//! turns and changes its size with every movement of the camera, so shadow edges crawl unless the
//! fit is [held](crate::settings::Stabilise::Hysteresis).

use super::Form;

pub(super) const FORM: Form = Form { may_turn: true, ..Form::OF_VIEWS };
