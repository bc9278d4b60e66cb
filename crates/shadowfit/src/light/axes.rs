//! The light's own axes: where its roll comes from.
//!
//! A direction does not fix the rotation about itself (the roll). Which roll a fit picks decides
//! whether the map turns smoothly with the sun and where it flips.

use glam::{DVec2, DVec3, Mat4, Vec3};

use crate::base::{FitError, checks};

/// Right-handed orthonormal axes of a light in world space. The light looks along -z, so `z` is
/// the direction *toward* the light.
///
/// The axes are rounded to f32 here, once, so that boxes are measured along exactly the axes that
/// the matrices hold.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct LightAxes {
    pub(crate) x: Vec3,
    pub(crate) y: Vec3,
    pub(crate) z: Vec3,
}

/// Length of the difference of two unit directions up to which they count as the same direction,
/// rounded differently: a few steps of f32.
const SAME_DIRECTION: f64 = 8.0 * checks::UNIT;

/// Whether two unit directions differ by rounding alone.
pub(crate) fn is_same_direction(a: DVec3, b: DVec3) -> bool {
    (a - b).dot(a - b) <= SAME_DIRECTION * SAME_DIRECTION
}

/// Whether a light travels straight along `up`, so that its roll is taken from a fixed axis; both are unit vectors.
pub(crate) fn is_vertical(direction: DVec3, up: DVec3) -> bool {
    checks::length(direction.cross(up)) < VERTICAL_SINE
}

/// Where a light's rotation about itself comes from.
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
    /// Unit direction that is up.
    up: DVec3,
    /// Roll that `axes` were made with.
    roll: Roll,
    axes: LightAxes,
}

impl Light {
    /// A light, with its axes precomputed for the roll that most of its maps use.
    #[inline(always)]
    pub(crate) fn new(direction: DVec3, up: DVec3, roll: Roll) -> Self {
        let axes = match roll {
            Roll::LookAt => LightAxes::look_at(direction, up),
            Roll::ShortestArc => LightAxes::shortest_arc(direction, up),
        };
        Self { direction, up, roll, axes }
    }

    /// This light along the direction that was held from an earlier frame, if the two differ by no
    /// more than rounding.
    #[inline(always)]
    pub(crate) fn held(self, direction: Option<DVec3>) -> Self {
        match direction {
            Some(held) if held != self.direction && is_same_direction(held, self.direction) => {
                Self::new(held, self.up, self.roll)
            }
            _ => self,
        }
    }

    /// Unit direction that is up.
    pub(crate) fn up(&self) -> DVec3 {
        self.up
    }

    /// Unit direction of travel.
    pub(crate) fn direction(&self) -> DVec3 {
        self.direction
    }

    /// The light's axes for a roll.
    #[inline(always)]
    pub(crate) fn axes(&self, roll: Roll) -> LightAxes {
        if roll == self.roll { self.axes } else { self.other_axes(roll) }
    }

    #[inline(never)]
    fn other_axes(&self, roll: Roll) -> LightAxes {
        Self::new(self.direction, self.up, roll).axes
    }
}

/// Sine of the angle to the vertical below which the look-at roll is taken from a fixed axis: an
/// f32 unit vector's own rounding is 1e-7, so its azimuth is noise there.
const VERTICAL_SINE: f64 = 1e-6;

/// How far the determinant of a light's axes may be from 1: far more than f32 rounding.
const ORTHONORMAL: f64 = 1e-3;

impl LightAxes {
    /// Look-at axes as the XNA sample computes them: `x = direction × up`; `up` is a unit vector
    /// (the sample's is +y).
    ///
    /// Within 1e-6 radians of the vertical, where the sample divides by zero, the map's top is
    /// where that of a map seen from straight above is (-z for +y up). The roll flips there: it follows the azimuth on
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

    /// The axes of a light straight down (for +y up: x = +x, y = -z, so that -z is at the map's
    /// top), turned by the shortest arc from straight down to `direction`.
    ///
    /// Continuous everywhere but for light straight up, where the arc's axis is the x of light
    /// straight down.
    #[inline(always)]
    pub(crate) fn shortest_arc(direction: DVec3, up: DVec3) -> Self {
        let (x, y) = top_down_axes(up);
        match arc(-up, direction) {
            Some(turn) => Self::from_f64(turn(x), turn(y), -direction),
            None => Self::from_f64(x, -y, -direction),
        }
    }

    /// These axes turned about the light so that x points along a unit direction of its plane.
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

    /// World axes to light axes, both from the same origin.
    #[inline]
    pub(crate) fn project(&self, v: DVec3) -> DVec3 {
        let (x, y, z) = (self.x.as_dvec3(), self.y.as_dvec3(), self.z.as_dvec3());
        DVec3::new(x.dot(v), y.dot(v), z.dot(v))
    }

    /// Middle and half the size of a world-space box as it extends along light axes.
    #[inline]
    pub(crate) fn project_box(&self, min: DVec3, max: DVec3) -> (DVec3, DVec3) {
        let (centre, half) = ((min + max) * 0.5, (max - min) * 0.5);
        let reach = |axis: glam::Vec3| axis.as_dvec3().abs().dot(half);
        (self.project(centre), DVec3::new(reach(self.x), reach(self.y), reach(self.z)))
    }

    /// The axes of a `light_from_world` matrix; refuses a matrix that is not a rotation.
    pub(crate) fn of_matrix(light_from_world: &Mat4) -> Result<Self, FitError> {
        let rows = light_from_world.transpose();
        let axes = Self { x: rows.x_axis.truncate(), y: rows.y_axis.truncate(), z: rows.z_axis.truncate() };
        let (least, most) = (1.0 - ORTHONORMAL, 1.0 + ORTHONORMAL);
        checks::within("the determinant of light_from_world", axes.determinant(), least, most)?;
        Ok(axes)
    }

    /// Determinant of the matrix with these rows: 1 up to rounding.
    pub(crate) fn determinant(&self) -> f64 {
        self.x.as_dvec3().dot(self.y.as_dvec3().cross(self.z.as_dvec3()))
    }

    /// World axes from light axes, the inverse of [`Self::project`] to f64 rounding: the rounded
    /// axes are not quite orthonormal, so their transpose would be off by 1e-7 of the distance.
    pub(crate) fn unproject(&self, v: DVec3) -> DVec3 {
        let (x, y, z) = (self.x.as_dvec3(), self.y.as_dvec3(), self.z.as_dvec3());
        (y.cross(z) * v.x + z.cross(x) * v.y + x.cross(y) * v.z) / self.determinant()
    }
}

/// Axes x and y of light straight down: +x and -z, turned by the shortest arc from +y to `up`.
#[inline(always)]
fn top_down_axes(up: DVec3) -> (DVec3, DVec3) {
    if up == DVec3::Y { (DVec3::X, DVec3::NEG_Z) } else { tilted_top_down_axes(up) }
}

/// The axes of light straight down, for any up direction.
fn tilted_top_down_axes(up: DVec3) -> (DVec3, DVec3) {
    match arc(DVec3::Y, up) {
        Some(turn) => (turn(DVec3::X), turn(DVec3::NEG_Z)),
        None => (DVec3::X, DVec3::Z),
    }
}

/// The rotation that takes one unit vector to another along the shortest arc; `None` where they
/// are opposite and no arc is the shortest.
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
