//! The least rectangle around what the camera can see of the receivers' boxes.
//!
//! Most of a frustum is empty air. Each receiver's box is clipped to the frustum and seen from the
//! light; the rectangle lies around the outlines of all of them, and depth ends at the lowest one.
//! No pixel of a receiver lies outside its box, so none is missed; the more closely the boxes hug
//! the surfaces, the finer the texels, which is why it pays to cut a large mesh into clusters
//! (`Clusters`, with the feature `alloc`).

use super::{Covers, Form};

pub(super) const FORM: Form =
    Form { covers: Covers::Receivers, may_turn: true, whole_distance: true, ..Form::OF_VIEWS };
