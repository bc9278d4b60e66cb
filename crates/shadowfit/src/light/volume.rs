//! The result of a fit before it becomes matrices: a box along the light's axes, and its position on the
//! world's texel grid.

use glam::{DVec2, DVec3};

use super::axes::LightAxes;
use super::grid::{Grid, anchor, stabilised_depth};
use crate::base::checks;

/// Input that sets a plane of a fitted box. Change this input for a tighter fit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum BoundSource {
    /// The view frustum, cut at the shadow distance or by the splits.
    #[default]
    View,
    /// The box of a receiver.
    Receivers,
    /// The box of a caster in front of the covered region, on the light's side.
    Casters,
    /// [`MapSettings::caster_extension`](crate::settings::MapSettings::caster_extension).
    CasterExtension,
    /// The enclosing sphere of the [stable fit](crate::settings::FitKind::Sphere).
    Sphere,
    /// The position and texel width of a [window](crate::Windows).
    Window,
    /// A fit that is held from an earlier frame.
    Held,
}

/// A box along the light's axes, with its depth range and grid position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Volume {
    pub(crate) axes: LightAxes,
    /// Corner of the fitted box with the least coordinates, along the light's axes and relative
    /// to the fit's origin, in metres.
    pub(crate) min: DVec3,
    /// The opposite corner; its z is the map's near plane.
    pub(crate) max: DVec3,
    /// Coordinate of the light along its z axis.
    pub(crate) light_z: f64,
    /// Distance between near and far plane, in metres.
    pub(crate) depth_range: f64,
    /// [`LightProjection::vertex_distance`](crate::LightProjection::vertex_distance).
    pub(crate) vertex_distance: f64,
    /// Sources of the planes -x, +x, -y, +y, far, near.
    pub(crate) bounds_from: [BoundSource; 6],
    pub(crate) is_empty: bool,
    /// Position on the world's grid, if the box lies on it.
    pub(crate) grid: Option<Grid>,
}

impl Volume {
    /// Creates a box whose near plane and light position are set later.
    #[inline(always)]
    pub(crate) fn covering(
        axes: LightAxes,
        min: DVec3,
        max: DVec3,
        bounds_from: [BoundSource; 6],
        is_empty: bool,
    ) -> Self {
        Self { axes, min, max, light_z: 0.0, depth_range: 0.0, vertex_distance: 0.0, bounds_from, is_empty, grid: None }
    }

    /// Returns a box around the origin, for a map that no point reads.
    pub(crate) fn nowhere(axes: LightAxes) -> Self {
        let mut volume = Self::covering(axes, DVec3::NEG_ONE, DVec3::ONE, [BoundSource::View; 6], true);
        volume.light_at_near_plane();
        volume
    }

    /// Creates the box of a map on the world's grid, relative to an origin.
    pub(crate) fn on_grid(
        axes: LightAxes,
        grid: Grid,
        resolution: DVec2,
        origin: DVec3,
        bounds_from: [BoundSource; 6],
        is_empty: bool,
    ) -> Self {
        let anchor = anchor(&axes, origin);
        let (min, max) = grid.across(anchor, resolution);
        let (min, max) = (min.extend(grid.z.0 - anchor.z), max.extend(grid.z.1 - anchor.z));
        let mut volume = Self { grid: Some(grid), ..Self::covering(axes, min, max, bounds_from, is_empty) };
        volume.light_at_near_plane();
        volume
    }

    /// Moves the near and far plane of a box on the grid to a range that holds them. The range held from an
    /// earlier frame is used if it still holds them and is at most `max_oversize` times longer than a new
    /// one.
    #[inline(always)]
    pub(crate) fn stabilise_depth(&mut self, origin: DVec3, held: Option<(f64, f64)>, max_oversize: f64) {
        let anchor = anchor(&self.axes, origin).z;
        if let Some(grid) = &mut self.grid {
            grid.z = stabilised_depth(held, self.min.z + anchor, self.max.z + anchor, max_oversize);
            (self.min.z, self.max.z) = (grid.z.0 - anchor, grid.z.1 - anchor);
            self.light_at_near_plane();
        }
    }

    /// Returns the distance of the farthest corner of the box from the fit's origin, in metres.
    pub(crate) fn farthest_corner(&self) -> f64 {
        checks::length(self.min.abs().max(self.max.abs()))
    }

    /// Places the light in the near plane, and sets the depth range from there to the far plane.
    pub(crate) fn light_at_near_plane(&mut self) {
        self.light_z = self.max.z;
        self.depth_range = self.max.z - self.min.z;
    }
}
