//! A fit's decision, before it becomes matrices: a box along the light's axes, and where it lies on
//! the world's texel grid.

use glam::{DVec2, DVec3};

use crate::light::LightAxes;

/// What set a plane of a fitted box: what to change for a tighter fit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Constraint {
    /// The view frustum, cut at the shadow distance or by the splits.
    #[default]
    View,
    /// The box of a receiver.
    Receivers,
    /// The box of a caster that lies before the covered region.
    Casters,
    /// [`FitSettings::caster_extension`](crate::settings::FitSettings::caster_extension).
    CasterExtension,
    /// The enclosing sphere of the [stable fit](crate::fits::sphere).
    Sphere,
    /// Where a [window](crate::settings::FitKind::Windows) stands, and how wide its texels are.
    Window,
    /// A fit that is held from an earlier frame.
    Held,
}

/// A box along the light's axes and how it is stored.
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
    /// What set the planes -x, +x, -y, +y, far, near.
    pub(crate) set_by: [Constraint; 6],
    pub(crate) is_empty: bool,
    /// Where it lies on the world's grid, if it does.
    pub(crate) grid: Option<Grid>,
}

/// Where a map lies on the world's grid. Lines are counted from the world's origin along the map's
/// axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Grid {
    /// Grid line of the map's least corner.
    pub(crate) first: DVec2,
    /// Size of a texel, in metres.
    pub(crate) texel: DVec2,
    /// Far and near plane along the light's z from the world's origin, in metres; in steps once
    /// they have been [stabilised](crate::light::grid::stabilise_depth).
    pub(crate) z: (f64, f64),
}

/// What a box is enlarged by on each side, as a share of the greatest distance from the origin and
/// the box's own extent together.
///
/// A shader's f32 matrix times an f32 position is off by ten times 2⁻²⁴ of the sum of its terms, as
/// [`verify`](crate::verify) counts, the matrix's elements by two and the frustum's corners by two
/// more. The terms of the position sum to no more than its distance d, the translation is no more
/// than d and half the extent e, and an offset of the texture or clip coordinates adds another
/// half: 14 d + 12 (d + e), which is less than 28 (d + e).
pub(crate) const ROUNDING: f64 = 28.0 / 16_777_216.0;

impl Volume {
    /// Puts the light in the near plane, with the depth range from there to the far plane.
    pub(crate) fn light_at_near_plane(&mut self) {
        self.light_z = self.max.z;
        self.depth_range = self.max.z - self.min.z;
    }
}
