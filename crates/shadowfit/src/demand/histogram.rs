//! Visible depths: a histogram that the engine computes from its last depth buffer.

use glam::Vec3;

/// Counts of visible points that face the light, in bins of equal width in log view depth. Optionally,
/// classes sort them by how much finer their texels must be than their depth alone requires.
///
/// Fill it from the depth buffer of the last frame, without the sky. Coarse sampling is enough, such as 64 ×
/// 36 samples. [`Self::bin`] returns the bin of a point. The histogram only decides where the maps are split,
/// so a late or wrong histogram costs sharpness, never coverage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthHistogram<'a> {
    /// View depth at which the first bin begins, in metres; positive.
    pub near: f32,
    /// View depth at which the last bin ends, in metres.
    pub far: f32,
    /// Counts: all depths of the first class, then all depths of the second, and so on.
    pub bins: &'a [u32],
    /// Number of classes of foreshortening, each a factor of two wide; 1 for depths alone.
    pub classes: usize,
}

/// View depths of the nearest and the farthest visible point, from a reduction of a depth buffer (A.
/// Lauritzen, M. Salvi, A. Lefohn, "Sample distribution shadow maps", 2011).
///
/// ```
/// # use shadowfit::glam::{DVec2, DVec3, Vec3};
/// use shadowfit::demand::DepthBounds;
/// use shadowfit::settings::SplitScheme;
/// # use shadowfit::*;
/// # let camera = PerspectiveCamera {
/// #     eye: DVec3::new(0.0, 1.7, 5.0),
/// #     forward: Vec3::NEG_Z,
/// #     up: Vec3::Y,
/// #     fov_y: 0.8,
/// #     aspect: 16.0 / 9.0,
/// #     near: 0.1,
/// #     far: 200.0,
/// # };
/// let cascades = Cascades::default().with_splits(SplitScheme::Logarithmic);
/// let technique = Technique::default().with_maps(cascades);
/// let views = [camera.frustum()?];
/// let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
/// let mut split = |depth_bounds| {
///     let input = FitInput { depth_bounds, ..FitInput::new(&views, Vec3::new(0.3, -0.8, 0.2)) };
///     let maps = FitState::new().fit(&input, &technique, &mut Scratch::new(&mut storage))?;
///     Ok::<_, FitError>(maps[0].depths.and_then(|range| range.far).expect("only the last map has no end"))
/// };
/// assert!(split(None)? < 1.0); // the whole view, from its near plane on
/// assert!(split(Some(DepthBounds { near: 4.0, far: 50.0 }))? > 4.0); // the visible depths of the last frame
/// # Ok::<(), FitError>(())
/// ```
///
/// They only decide where the maps are split. The first map still begins where shadows begin, and the last
/// one ends where they end, so late or wrong bounds cost sharpness, never coverage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthBounds {
    /// Least view depth, in metres.
    pub near: f32,
    /// Greatest view depth, in metres; not below the least.
    pub far: f32,
}

/// Returns the width of the widest texel, in metres across the light, at which a point shows at most one
/// pixel per texel. One pixel covers a parallelogram of the surface, spanned by `right` and `down`. The
/// result is the least singular value of the matrix of these two vectors, projected across the light.
///
/// `right` and `down` are the movements of the visible point on its surface, in metres in world axes, from
/// this pixel to the next one on the right and below. `direction` is the light's direction of travel, of unit
/// length. The foreshortening class of a point is `log2(depth · pixel / texel)`, where `depth` is its view
/// depth and `pixel` the width of one pixel at a view depth of one metre.
pub fn needed_texel(right: Vec3, down: Vec3, direction: Vec3) -> f32 {
    let along = direction.as_dvec3();
    let seen = |v: Vec3| v.as_dvec3() - along * v.as_dvec3().dot(along);
    let (a, b) = (seen(right), seen(down));
    // σ² of the 3 × 2 matrix (a b) are the eigenvalues of its 2 × 2 Gram matrix.
    let (aa, bb, ab) = (a.dot(a), b.dot(b), a.dot(b));
    let (half, det) = ((aa + bb) * 0.5, aa * bb - ab * ab);
    let greatest = half + libm::sqrt((half * half - det).max(0.0));
    if greatest > 0.0 { libm::sqrt((det / greatest).max(0.0)) as f32 } else { 0.0 }
}

impl DepthHistogram<'_> {
    /// Returns the index into [`Self::bins`] for a visible point, or `None` if it lies before the first bin
    /// or behind the last. `depth` is its view depth in metres. `class` is `log2(depth · pixel /
    /// needed_texel)`, as for [`needed_texel`], or 0 if unknown.
    pub fn bin(near: f32, far: f32, depth_bins: usize, classes: usize, depth: f32, class: f32) -> Option<usize> {
        if !(depth >= near && depth < far && near > 0.0) || depth_bins == 0 || classes == 0 {
            return None;
        }
        let share = libm::log2(f64::from(depth / near)) / libm::log2(f64::from(far / near));
        let depth_bin = ((share * depth_bins as f64) as usize).min(depth_bins - 1);
        // NaN and negative numbers count as the first class.
        let class = (libm::round(f64::from(class.max(0.0))) as usize).min(classes - 1);
        Some(class * depth_bins + depth_bin)
    }

    /// Returns whether the histogram has no counts or invalid depths. Splits then come from the boxes.
    pub fn is_empty(&self) -> bool {
        let is_valid = self.near > 0.0 && self.near < self.far && self.far.is_finite();
        let is_whole = self.classes > 0 && self.bins.len().is_multiple_of(self.classes);
        !is_valid || !is_whole || self.bins.iter().all(|count| *count == 0)
    }
}
