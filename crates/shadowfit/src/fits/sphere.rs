//! The stable fit: the minimal enclosing sphere of the view, as seen from the light.
//!
//! A sphere looks the same from every side, so turning the camera does not change the map's extent. The map's
//! texels lie on a fixed world grid, so moving the camera shifts the map by whole texels. Shadow edges do not
//! move at all, but most of the map lies outside the view.
//!
//! For a symmetric frustum the sphere's centre lies on the axis. Let r₀ be the half diagonal of the near
//! rectangle and r₁ of the far rectangle, L their distance, and x the distance of the centre from the near
//! one:
//!
//! ```text
//!          ____
//!        ╱   ╱│╲         x² + r₀² = (L - x)² + r₁²
//!       │  ╱  │ │        x = (L² + r₁² - r₀²) / 2L, at most L
//!      ┌│╱    │r₁        r = √((L - x)² + r₁²)
//!    r₀├┼──●──┤ │
//!       ╲  x  │╱
//! ```
//!
//! Any other view, or several views together, get the sphere by incremental construction from at most four
//! points of support (E. Welzl, "Smallest enclosing disks (balls and ellipsoids)", 1991). The stable map with
//! a bounding sphere and whole texels is from M. Valient ("Stable rendering of cascaded shadow maps",
//! `ShaderX6`, 2008). Here the extent is rounded up to eighths of an octave instead of a world unit, and the
//! grid is kept in f64.

use glam::{DVec3, Vec3};

use super::{Alignment, Covers, Form};
use crate::base::FitError;
use crate::base::enclosing::{SymmetricFrustum, minimal};
use crate::view::ViewFrustum;

pub(super) const FORM: Form = Form { covers: Covers::Sphere, alignment: Alignment::OnGrid, ..Form::OF_VIEWS };

impl ViewFrustum {
    /// Returns the centre and radius, in metres, of the minimal sphere around the corners. The centre is in
    /// world axes relative to [`Self::origin`]. The result is exact to 1e-9 of the radius for the given f32
    /// corners.
    ///
    /// # Errors
    ///
    /// As [`Self::slice`] for frusta that no fit can use.
    pub fn enclosing_sphere(&self) -> Result<(DVec3, f64), FitError> {
        let corners = self.checked()?.corners.map(Vec3::as_dvec3);
        let symmetric = SymmetricFrustum::new(&corners);
        let sphere = symmetric.map_or_else(|| minimal(&corners), |symmetric| symmetric.sphere(0.0, 1.0));
        Ok((sphere.centre, sphere.radius))
    }
}
