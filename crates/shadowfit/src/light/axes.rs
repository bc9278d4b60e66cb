//! The light's own axes, and the roll that they have.
//!
//! A direction does not fix the rotation about itself (the roll). The choice of the roll decides whether the
//! map turns smoothly with the sun, and where it flips.

use glam::{DVec2, DVec3, Mat4, Vec3};

use crate::base::{FitError, checks};

/// Right-handed orthonormal axes of a light in world space. The light looks along -z, so `z` is
/// the direction *toward* the light.
///
/// The axes are rounded to f32 once, here, so that boxes are measured along exactly the axes that the
/// matrices hold.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct LightAxes {
    pub(crate) x: Vec3,
    pub(crate) y: Vec3,
    pub(crate) z: Vec3,
}

/// Greatest difference of two unit directions that count as the same direction with different rounding: a few
/// steps of f32.
const SAME_DIRECTION: f64 = 8.0 * checks::UNIT;

/// Returns whether two unit directions differ only by rounding.
pub(crate) fn is_same_direction(a: DVec3, b: DVec3) -> bool {
    (a - b).dot(a - b) <= SAME_DIRECTION * SAME_DIRECTION
}

/// Returns whether a light travels straight along `up`, so that its roll comes from a fixed axis. Both are
/// unit vectors.
pub(crate) fn is_vertical(direction: DVec3, up: DVec3) -> bool {
    checks::length(direction.cross(up)) < VERTICAL_SINE
}

/// Source of a light's rotation about itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Roll {
    /// [`LightAxes::look_at`].
    LookAt,
    /// [`LightAxes::shortest_arc`].
    ShortestArc,
}

/// The light of one frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Light {
    /// Unit direction of travel.
    direction: DVec3,
    /// Unit up direction.
    up: DVec3,
    /// Roll of `axes`.
    roll: Roll,
    axes: LightAxes,
}

impl Light {
    /// Creates a light, with its axes precomputed for the roll that most of its maps use.
    #[inline(always)]
    pub(crate) fn new(direction: DVec3, up: DVec3, roll: Roll) -> Self {
        let axes = match roll {
            Roll::LookAt => LightAxes::look_at(direction, up),
            Roll::ShortestArc => LightAxes::shortest_arc(direction, up),
        };
        Self { direction, up, roll, axes }
    }

    /// Returns this light along the direction held from an earlier frame, if the two differ by no more than
    /// rounding.
    #[inline(always)]
    pub(crate) fn held(self, direction: Option<DVec3>) -> Self {
        match direction {
            Some(held) if held != self.direction && is_same_direction(held, self.direction) => {
                Self::new(held, self.up, self.roll)
            }
            _ => self,
        }
    }

    /// Returns the unit up direction.
    pub(crate) fn up(&self) -> DVec3 {
        self.up
    }

    /// Returns the unit direction of travel.
    pub(crate) fn direction(&self) -> DVec3 {
        self.direction
    }

    /// Returns the light's axes for a roll.
    #[inline(always)]
    pub(crate) fn axes(&self, roll: Roll) -> LightAxes {
        if roll == self.roll { self.axes } else { self.other_axes(roll) }
    }

    #[inline(never)]
    fn other_axes(&self, roll: Roll) -> LightAxes {
        Self::new(self.direction, self.up, roll).axes
    }
}

/// Sine of the angle to the vertical below which the look-at roll comes from a fixed axis. An f32 unit vector
/// is rounded by 1e-7, so its azimuth is noise there.
const VERTICAL_SINE: f64 = 1e-6;

/// Tolerance of the determinant of a light's axes, which should be 1: far more than f32 rounding.
const ORTHONORMAL: f64 = 1e-3;

impl LightAxes {
    /// Computes look-at axes like the XNA sample: `x = direction × up`. `up` is a unit vector; in the sample
    /// it is +y.
    ///
    /// Within 1e-6 radians of the vertical, where the sample divides by zero, the top of the map points as it
    /// does for light from straight above (-z for +y up). The roll flips there: it follows the azimuth on
    /// every side, so no choice at the pole is continuous.
    #[inline(always)]
    pub(crate) fn look_at(direction: DVec3, up: DVec3) -> Self {
        let mut right = direction.cross(up);
        let mut length = checks::length(right);
        if length < VERTICAL_SINE {
            right = direction.cross(top_down_axes(up).1);
            length = checks::length(right);
        }
        let right = right / length;
        Self::from_f64(right, right.cross(direction), -direction)
    }

    /// Computes the axes of straight-down light, turned by the shortest arc from straight down to
    /// `direction`. For +y up, straight-down light has x = +x and y = -z, so that -z is at the map's top.
    ///
    /// The axes are continuous everywhere except for light straight up, where the arc's axis is the x of
    /// straight-down light.
    #[inline(always)]
    pub(crate) fn shortest_arc(direction: DVec3, up: DVec3) -> Self {
        let (x, y) = top_down_axes(up);
        match arc(-up, direction) {
            Some(turn) => Self::from_f64(turn(x), turn(y), -direction),
            None => Self::from_f64(x, -y, -direction),
        }
    }

    /// Returns these axes turned about the light so that x points along a unit direction in its plane.
    pub(crate) fn turned(&self, direction: DVec2) -> Self {
        if direction == DVec2::X {
            return *self;
        }
        let (x, y) = (self.x.as_dvec3(), self.y.as_dvec3());
        Self {
            x: (x * direction.x + y * direction.y).as_vec3(),
            y: (y * direction.x - x * direction.y).as_vec3(),
            z: self.z,
        }
    }

    fn from_f64(x: DVec3, y: DVec3, z: DVec3) -> Self {
        Self { x: x.as_vec3(), y: y.as_vec3(), z: z.as_vec3() }
    }

    /// Converts world axes to light axes, both from the same origin.
    #[inline]
    pub(crate) fn project(&self, v: DVec3) -> DVec3 {
        let (x, y, z) = (self.x.as_dvec3(), self.y.as_dvec3(), self.z.as_dvec3());
        DVec3::new(x.dot(v), y.dot(v), z.dot(v))
    }

    /// Returns the middle and half the size of a world-space box's extent along the light's axes.
    #[inline]
    pub(crate) fn project_box(&self, min: DVec3, max: DVec3) -> (DVec3, DVec3) {
        let (centre, half) = ((min + max) * 0.5, (max - min) * 0.5);
        let reach = |axis: glam::Vec3| axis.as_dvec3().abs().dot(half);
        (self.project(centre), DVec3::new(reach(self.x), reach(self.y), reach(self.z)))
    }

    /// Returns the axes of a `light_from_world` matrix. Refuses a matrix that is not a rotation.
    pub(crate) fn of_matrix(light_from_world: &Mat4) -> Result<Self, FitError> {
        let rows = light_from_world.transpose();
        let axes = Self { x: rows.x_axis.truncate(), y: rows.y_axis.truncate(), z: rows.z_axis.truncate() };
        let (least, most) = (1.0 - ORTHONORMAL, 1.0 + ORTHONORMAL);
        checks::within("the determinant of light_from_world", axes.determinant(), least, most)?;
        Ok(axes)
    }

    /// Returns the determinant of the matrix with these rows: 1 up to rounding.
    pub(crate) fn determinant(&self) -> f64 {
        self.x.as_dvec3().dot(self.y.as_dvec3().cross(self.z.as_dvec3()))
    }

    /// Converts light axes to world axes, the inverse of [`Self::project`] to f64 rounding. The rounded axes
    /// are not quite orthonormal, so their transpose would be off by 1e-7 of the distance.
    pub(crate) fn unproject(&self, v: DVec3) -> DVec3 {
        let (x, y, z) = (self.x.as_dvec3(), self.y.as_dvec3(), self.z.as_dvec3());
        (y.cross(z) * v.x + z.cross(x) * v.y + x.cross(y) * v.z) / self.determinant()
    }
}

/// Returns the axes x and y of straight-down light: +x and -z, turned by the shortest arc from +y to `up`.
#[inline(always)]
fn top_down_axes(up: DVec3) -> (DVec3, DVec3) {
    if up == DVec3::Y { (DVec3::X, DVec3::NEG_Z) } else { tilted_top_down_axes(up) }
}

/// Returns the axes of straight-down light for any up direction.
fn tilted_top_down_axes(up: DVec3) -> (DVec3, DVec3) {
    match arc(DVec3::Y, up) {
        Some(turn) => (turn(DVec3::X), turn(DVec3::NEG_Z)),
        None => (DVec3::X, DVec3::Z),
    }
}

/// Returns the rotation of one unit vector to another along the shortest arc, or `None` if they are opposite
/// and no arc is the shortest.
///
/// ```text
///   from ──k = from × to──▶ to       R v = v + k × v + k × (k × v) / (1 + from·to)
/// ```
fn arc(from: DVec3, to: DVec3) -> Option<impl Fn(DVec3) -> DVec3> {
    let k = from.cross(to);
    let cos = from.dot(to);
    // 1 + cos cancels near -1; sin² / (1 - cos) does not.
    let one_plus_cos = if cos < 0.0 { k.dot(k) / (1.0 - cos) } else { 1.0 + cos };
    if one_plus_cos <= 0.0 {
        return None;
    }
    Some(move |v: DVec3| v + k.cross(v) + k.cross(k.cross(v)) / one_plus_cos)
}
