//! Fits from matrices of other code, so that they can be drawn, culled and evaluated like those of this crate.

use glam::{DMat4, DVec3, UVec2, Vec3};

use crate::base::{DepthConvention, FitError, checks};
use crate::fits::{Constraint, LightFit, Volume};
use crate::light::LightAxes;

/// How far axes may be from being perpendicular, and from the light's direction, as a cosine: matrices that were
/// written with seven digits and multiplied in f32.
const SKEW: f64 = 1e-4;

impl LightFit {
    /// The fit that equals a light's orthographic view-projection: clip space (x right, y up, depth 0..1, plain or
    /// reversed) from world space in metres. `direction` is the light's direction of travel in world axes, of any
    /// length; `origin` is the world position, in metres, that the fit's own matrices are relative to; choose one near
    /// what is seen.
    ///
    /// Whether depth is reversed is read from the matrix. A mirrored matrix gives a mirrored light
    /// space.
    ///
    /// # Errors
    ///
    /// [`FitError::NotOrthographic`] for a perspective, a sheared box, or one along another direction, and what a fit
    /// returns for inputs that are not finite or out of range.
    pub fn from_clip_from_world(
        clip_from_world: &DMat4,
        direction: Vec3,
        resolution: UVec2,
        origin: DVec3,
    ) -> Result<Self, FitError> {
        let direction = checks::unit("the light's direction", direction)?;
        if resolution.x == 0 || resolution.y == 0 {
            return Err(FitError::ZeroResolution { resolution });
        }
        for value in clip_from_world.to_cols_array().into_iter().chain(origin.to_array()) {
            checks::finite("an element of the matrix or the origin", value)?;
        }
        let rows = Rows::of(clip_from_world, origin)?;
        let axes = rows.axes.map(|row| row / checks::length(row));
        let along = axes[2].dot(direction);
        check_axes(axes, along)?;
        let depth = if along > 0.0 { DepthConvention::ZeroToOne } else { DepthConvention::Reversed };
        // Light space looks along -z, whichever way the depth runs.
        Self::from_volume(origin, &rows.volume(axes, along.signum()), resolution, depth)
    }
}

/// Rows of the matrix, and their offsets at the origin.
struct Rows {
    axes: [DVec3; 3],
    offsets: DVec3,
}

impl Rows {
    fn of(matrix: &DMat4, origin: DVec3) -> Result<Self, FitError> {
        let row = |index: usize| {
            let column = |column: usize| matrix.to_cols_array()[column * 4 + index];
            (DVec3::new(column(0), column(1), column(2)), column(3))
        };
        let ((x, x0), (y, y0), (z, z0), (w, w0)) = (row(0), row(1), row(2), row(3));
        if w != DVec3::ZERO || w0 <= 0.0 {
            return Err(FitError::NotOrthographic { why: "it is a perspective" });
        }
        let offset = |row: DVec3, at_zero: f64| (row.dot(origin) + at_zero) / w0;
        let rows =
            Self { axes: [x / w0, y / w0, z / w0], offsets: DVec3::new(offset(x, x0), offset(y, y0), offset(z, z0)) };
        if rows.axes.iter().any(|row| checks::length(*row) == 0.0) {
            return Err(FitError::NotOrthographic { why: "it is flat" });
        }
        Ok(rows)
    }

    /// The box that the matrix maps to the clip cube. `travel` is 1 where depth grows along the light's direction,
    /// else -1.
    fn volume(&self, axes: [DVec3; 3], travel: f64) -> Volume {
        let scale = self.axes.map(checks::length);
        let half = DVec3::new(1.0 / scale[0], 1.0 / scale[1], 0.5 / scale[2]);
        // Along z toward the light: depth 1/2 lies in the middle.
        let middle = DVec3::new(
            -self.offsets.x / scale[0],
            -self.offsets.y / scale[1],
            -travel * (0.5 - self.offsets.z) / scale[2],
        );
        let (min, max) = (middle - half, middle + half);
        let axes = LightAxes { x: axes[0].as_vec3(), y: axes[1].as_vec3(), z: (axes[2] * -travel).as_vec3() };
        let volume = Volume::covering(axes, (min, max), [Constraint::default(); 6], false);
        Volume { light_z: max.z, depth_range: half.z * 2.0, ..volume }
    }
}

fn check_axes([x, y, z]: [DVec3; 3], along: f64) -> Result<(), FitError> {
    let skew = x.dot(y).abs().max(x.dot(z).abs()).max(y.dot(z).abs());
    if skew > SKEW {
        return Err(FitError::NotOrthographic { why: "its axes are not perpendicular" });
    }
    if along.abs() < 1.0 - SKEW {
        return Err(FitError::NotOrthographic { why: "its depth does not run along the light's direction" });
    }
    Ok(())
}
