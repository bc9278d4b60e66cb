//! The views of a frame: their slices, enclosing spheres, and the parts for box queries.

use glam::{DVec3, Vec3};

use super::Content;
use super::boxes::Bounds;
use crate::base::FitError;
use crate::base::enclosing::{EnclosingSphere, SymmetricFrustum, minimal};
use crate::view::{Depths, Range, Slice, View, slice_corners};

/// Greatest number of views that share a stable map.
pub(crate) const MAX_SPHERE_VIEWS: usize = 8;

/// The part of a view between two view depths.
pub(crate) struct ViewPart {
    /// Index of the view.
    pub(crate) index: usize,
    pub(crate) view: View,
    /// Least and greatest view depth of the part, in metres. They lie within the view.
    pub(crate) near: f64,
    pub(crate) far: f64,
}

impl ViewPart {
    /// Returns the part as a convex body.
    pub(crate) fn slice(&self) -> Slice {
        self.view.slice(self.near, self.far)
    }

    /// Returns whether a box with these view depths may reach into the part.
    #[inline]
    pub(super) fn reaches(&self, depths: Depths) -> bool {
        depths.near <= self.far && depths.far >= self.near
    }

    /// Returns the bounds of a box that may reach into the part.
    #[inline]
    pub(super) fn bounds(&self, min: DVec3, max: DVec3) -> Option<Bounds> {
        let depths = self.view.depths(min, max).filter(|depths| self.reaches(*depths))?;
        Some(Bounds { min, max, depths })
    }
}

impl Content<'_> {
    /// Returns the minimal sphere around all views' slices, relative to the origin.
    #[inline(always)]
    pub(crate) fn enclosing_sphere(&self, range: Range) -> Result<EnclosingSphere, FitError> {
        if let ([view], Some(symmetric)) = (self.views, self.symmetric()) {
            let (near, far) = (range.near.max(view.near), range.far.min(view.far));
            if near >= far {
                return Err(FitError::NearNotBelowFar { near, far });
            }
            let per_metre = 1.0 / (f64::from(view.far) - f64::from(view.near));
            let share = |depth: f32| (f64::from(depth) - f64::from(view.near)) * per_metre;
            return Ok(symmetric.sphere(share(near), share(far)));
        }
        self.enclosing_sphere_of_any(range)
    }

    /// Returns the sphere for several views, or for one that is not symmetric.
    #[inline(never)]
    fn enclosing_sphere_of_any(&self, range: Range) -> Result<EnclosingSphere, FitError> {
        let mut corners = [DVec3::ZERO; 8 * MAX_SPHERE_VIEWS];
        let mut count = 0;
        for slice in self.slices(range) {
            let Some(free) = corners.get_mut(8 * count..8 * count + 8) else {
                let (value, max) = (self.views.len() as f64, MAX_SPHERE_VIEWS as f64);
                return Err(FitError::OutOfRange {
                    input: "the number of views of a stable fit",
                    value,
                    min: 1.0,
                    max,
                });
            };
            free.copy_from_slice(&slice);
            count += 1;
        }
        if count == 0 {
            return Err(FitError::NearNotBelowFar { near: range.near, far: range.far });
        }
        Ok(minimal(&corners[..8 * count]))
    }

    /// Returns the first view, if it is a symmetric frustum.
    fn symmetric(&self) -> Option<&SymmetricFrustum> {
        self.symmetric.get_or_init(|| SymmetricFrustum::new(&self.views[0].corners.map(Vec3::as_dvec3))).as_ref()
    }

    /// Returns the views in the form that fits use.
    pub(crate) fn views(&self) -> impl Iterator<Item = View> {
        self.views.iter().map(|view| View::new(view, self.origin))
    }

    /// Returns the whole of each view.
    pub(crate) fn whole_views(&self) -> impl Iterator<Item = ViewPart> {
        self.views().enumerate().map(|(index, view)| {
            let (near, far) = (view.near, view.far);
            ViewPart { index, view, near, far }
        })
    }

    /// Returns the part of each view between two view depths, unless it is empty.
    pub(crate) fn parts(&self, range: Range) -> impl Iterator<Item = ViewPart> {
        let parts = self.whole_views().map(move |part| ViewPart {
            near: f64::from(range.near).max(part.near).min(part.far),
            far: f64::from(range.far).min(part.far).max(part.near),
            ..part
        });
        parts.filter(|part| part.near < part.far)
    }

    /// Returns the corners of the views' slices.
    pub(crate) fn corners(&self, range: Range) -> impl Iterator<Item = DVec3> {
        self.slices(range).flatten()
    }

    /// Returns the corners of each view's slice. Skips empty slices.
    pub(crate) fn slices(&self, range: Range) -> impl Iterator<Item = [DVec3; 8]> {
        self.views.iter().filter_map(move |view| slice_corners(view, self.origin, range.near, range.far))
    }
}
