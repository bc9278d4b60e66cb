//! The least rectangle around the camera frustum as seen from the light, turned about the light. It is least
//! by area, or made square. No fit without knowledge of the scene is tighter.
//!
//! The frustum's outline has four to eight corners. The rectangle is searched along their edges. It turns and
//! changes size with every movement of the camera, so shadow edges crawl unless the fit is
//! [held](crate::settings::Stabilise::Hysteresis).

use super::Form;

pub(super) const FORM: Form = Form { may_turn: true, ..Form::OF_VIEWS };
