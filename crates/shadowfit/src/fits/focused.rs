//! The least rectangle around the visible parts of the receivers' boxes.
//!
//! Most of a frustum is empty air. Each receiver's box is clipped to the frustum and projected along the
//! light. The rectangle encloses the outlines of all boxes, and depth ends at the lowest one. No pixel of a
//! receiver lies outside its box, so none is missed. Tighter boxes give finer texels, so it pays to cut a
//! large mesh into clusters (`Clusters`, with the feature `cache`).

use super::{Covers, Form};

pub(super) const FORM: Form =
    Form { covers: Covers::Receivers, may_turn: true, whole_distance: true, ..Form::OF_VIEWS };
