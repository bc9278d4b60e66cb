//! The plan of the gallery: dimensions that its parts share.

use glam::Vec3;

/// Length of a bay, from column to column, in metres.
pub(super) const BAY: f32 = 3.4;
/// Bays of the gallery.
pub(super) const BAYS: usize = 12;
/// Start of the gallery along z, in metres, behind the start view. The gallery extends toward -z.
pub(super) const START: f32 = 10.2;
/// End of the gallery along z, in metres.
pub(super) const END: f32 = START - BAY * BAYS as f32;
/// Half of the gallery's width between its walls, in metres.
pub(super) const HALF: f32 = 2.1;
/// Thickness of the wall above the columns, in metres: too thick for a bias of a decimetre to leak light
/// through.
pub(super) const THICK: f32 = 0.6;
/// Position of the row of columns along x, in metres.
pub(super) const ROW: f32 = HALF + THICK / 2.0;
/// Height at which arches spring from the columns, in metres.
pub(super) const SPRING: f32 = 2.5;
/// Radius of the arches between the columns, in metres: half a bay minus half an abacus.
pub(super) const ARCH: f32 = 1.3;
/// Height of the garden, below the gallery's floor at 0, in metres.
pub(super) const GARDEN: f32 = -0.3;

/// Returns the positions of the columns along z, in metres, from the start, including both ends.
pub(super) fn column_places() -> impl Iterator<Item = f32> {
    (0..=BAYS).map(|index| START - BAY * index as f32)
}

/// Returns the middles of the bays along z, in metres, from the start.
pub(super) fn bay_middles() -> impl Iterator<Item = f32> {
    (0..BAYS).map(|index| START - BAY * (index as f32 + 0.5))
}

/// Returns the points where the lanterns hang: the crowns of every second arch ahead of the start view.
pub(super) fn arch_crowns() -> impl Iterator<Item = Vec3> {
    bay_middles().skip(3).step_by(2).map(|z| Vec3::new(ROW, SPRING + ARCH, z))
}
