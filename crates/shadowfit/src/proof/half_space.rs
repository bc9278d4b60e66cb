//! The planes of a map, computed from its matrices, with a bound of the rounding in shader arithmetic.
//!
//! A plane is a linear function of the position that is not negative inside. A bound of the rounding is
//! subtracted from it. The bound is a sum of absolute values, hence convex, so the difference is concave. Its
//! least value over a convex polytope is at a corner, so testing the corners proves it for all points between
//! them.

use glam::{DVec3, Mat4, Vec4};

use super::{CoverageQuery, MapPlane};
use crate::base::checks::UNIT;
use crate::base::{DepthConvention, FitError, checks};
use crate::projection::LightProjection;

/// Number of roundings of 2⁻²⁴ in each term of an affine matrix times an f32 position: one of the position
/// relative to the origin, and four operations. Shaders may round each operation either way, by twice 2⁻²⁴,
/// in any order and with or without fused multiply-add. This gives 9, and the products of these errors are
/// less than one more.
const TERM_ROUNDINGS: f64 = 10.0;

/// Greatest error of the corner of a frustum, or of a box clipped to one, as a share of its distance. It is
/// the rounding of the frustum's corners, once for the corner and once for the plane that it lies in.
const CORNER_ROUNDING: f64 = 2.0 * UNIT;

/// Greatest error by flushing too small f32 results to zero, in all operations.
const FLUSHED: f64 = 16.0 * f32::MIN_POSITIVE as f64;

/// One plane of one of the fit's matrices.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfSpace {
    pub(super) plane: MapPlane,
    /// Row of the function. `row·p + constant` is not negative inside, with p relative to the fit's origin.
    row: DVec3,
    constant: f64,
    /// The matrix's translation, which takes part in the rounding.
    shift: f64,
    /// Texels or metres per unit of the function.
    unit: f64,
    /// Required free space, in texels or metres.
    demand: f64,
}

impl HalfSpace {
    /// Returns a lower bound of a point's distance inside the required plane, in texels across the light or
    /// metres along it.
    pub(super) fn margin(&self, p: DVec3) -> f64 {
        let terms = self.row * p;
        let value = terms.x + terms.y + terms.z + self.constant;
        let sum = terms.x.abs() + terms.y.abs() + terms.z.abs() + self.shift;
        let corner = CORNER_ROUNDING * checks::length(p) * checks::length(self.row);
        (value - TERM_ROUNDINGS * UNIT * sum - FLUSHED - corner) * self.unit - self.demand
    }
}

/// All planes of a fit: the limits of the texture coordinates, of clip space and of the light's box.
pub(super) struct HalfSpaces {
    pub(super) all: [HalfSpace; 18],
}

/// One of the fit's matrices with the ranges of its results: -x, +x, -y, +y, far, near.
struct Matrix {
    name: &'static str,
    elements: Mat4,
    planes: [f64; 6],
}

impl HalfSpaces {
    pub(super) fn new(fit: &LightProjection, query: &CoverageQuery) -> Result<Self, FitError> {
        if fit.resolution.x == 0 || fit.resolution.y == 0 {
            return Err(FitError::ZeroResolution { resolution: fit.resolution });
        }
        let (near, far) = (f64::from(fit.depth.near()), f64::from(fit.depth.far()));
        let stored = if fit.depth == DepthConvention::NegativeOneToOne { [1.0, 0.0] } else { [far, near] };
        let (min, max) = fit.clip_box();
        for coordinate in [min, max].into_iter().flat_map(|corner| corner.to_array()) {
            checks::finite("a corner of the light's box", coordinate)?;
        }
        let matrices = [
            // v points down.
            Matrix {
                name: "uv_from_world",
                elements: fit.uv_from_world,
                planes: [0.0, 1.0, 1.0, 0.0, stored[0], stored[1]],
            },
            Matrix {
                name: "clip_from_world",
                elements: fit.clip_from_world,
                planes: [-1.0, 1.0, -1.0, 1.0, far, near],
            },
            Matrix {
                name: "light_from_world",
                elements: fit.light_from_world,
                planes: [min.x, max.x, min.y, max.y, min.z, max.z],
            },
        ];
        let mut all = [HalfSpace::NONE; 18];
        for (matrix, planes) in matrices.iter().zip(all.chunks_exact_mut(6)) {
            matrix.half_spaces(fit, query, planes)?;
        }
        Ok(Self { all })
    }

    /// Returns the two near planes that casters are drawn with, of clip space and of the light's box.
    pub(super) fn near(&self) -> [&HalfSpace; 2] {
        [&self.all[11], &self.all[17]]
    }
}

impl HalfSpace {
    const NONE: Self =
        Self { plane: MapPlane::Near, row: DVec3::ZERO, constant: 0.0, shift: 0.0, unit: 0.0, demand: 0.0 };
}

impl Matrix {
    fn half_spaces(&self, fit: &LightProjection, query: &CoverageQuery, out: &mut [HalfSpace]) -> Result<(), FitError> {
        for element in self.elements.to_cols_array() {
            checks::finite(self.name, f64::from(element))?;
        }
        let rows = self.elements.transpose();
        if rows.w_axis != Vec4::W {
            let value = f64::from(rows.w_axis.w);
            return Err(FitError::OutOfRange { input: "w of a matrix of the fit", value, min: 1.0, max: 1.0 });
        }
        let rows = [rows.x_axis, rows.y_axis, rows.z_axis].map(Vec4::as_dvec4);
        let resolution = fit.resolution.as_dvec2();
        for (i, half_space) in out.iter_mut().enumerate() {
            let (axis, at) = (i / 2, self.planes[i]);
            let other = self.planes[i ^ 1];
            let row = rows[axis].truncate();
            // Metres per unit of the function.
            let metres = 1.0 / checks::within(self.name, checks::length(row), f64::MIN_POSITIVE, f64::MAX)?;
            let (unit, demand) = if axis < 2 {
                let extent = (other - at).abs();
                let texels = resolution[axis] / checks::within("the light's box", extent, f64::MIN_POSITIVE, f64::MAX)?;
                let disc = f64::from(query.filter_radius.disc[axis]);
                // The centre of the first texel beyond the border lies half a texel outside.
                let read = (f64::from(query.filter_radius.taps) + disc - 0.5).max(0.0);
                (texels, read + f64::from(query.normal_offset) / metres * texels)
            } else {
                (metres, 0.0)
            };
            let sign = if at < other { 1.0 } else { -1.0 };
            *half_space = HalfSpace {
                plane: MapPlane::ALL[i],
                row: row * sign,
                constant: (rows[axis].w - at) * sign,
                shift: rows[axis].w.abs(),
                unit,
                demand,
            };
        }
        Ok(())
    }
}
