//! Proofs that a map has no holes: it holds every receiver and loses no caster.
//!
//! [`prove`] reads only a fit's matrices, not their history, so it works for fits that were held, moved to
//! another origin, stored or changed. Its result holds for **all** points of the receivers. It tests the
//! corners of each box clipped to the view. The rounding of f32 positions, matrices and shader arithmetic is
//! bounded and must be left as free space.
//!
//! ```text
//!     toward the light
//!   ┌────────▲─────────┐ near plane: no part of a caster over the receivers' outline,
//!   │     ┌──┴──┐      │ widened by the filter's reach, may lie before it
//!   │     │     │      │
//!   │ r ┌─┴─────┴─┐ r  │ receivers' boxes ∩ view, the filter's reach r from the sides
//!   │   └─────────┘    │
//!   └──────────────────┘ far plane
//! ```

mod half_space;

use glam::{DVec2, DVec3};

use crate::base::checks::UNIT;
use crate::base::{FitError, box_corners, checks};
use crate::bias::{Bias, FilterRadius, HARDWARE_SNAP};
use crate::content::{Bounds, Content, Found, Query, Visit, VisitCorners};
use crate::diagnostics::{DepthRounding, DepthStorage, depth_rounding};
use crate::fits::Covers;
use crate::fits::covered::{Detail, LightHull};
use crate::input::{FitInput, Scratch};
use crate::light::{LightAxes, Outline, OutlineScratch};
use crate::map::FittedMap;
use crate::projection::LightProjection;
use crate::selection::DepthRange;
use crate::technique::Technique;
use crate::technique::settings::{CasterPolicy, FitSettings};
use crate::view::Range;
use half_space::HalfSpaces;

/// Result of [`prove`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use = "a proof says whether the map has holes"]
pub enum CoverageProof {
    /// There are no holes: the map holds all receivers with everything that the filter reads, and all given
    /// casters.
    Proven(Margins),
    /// A receiver is outside the map, or cannot be proven to be inside.
    Uncovered {
        /// The plane of the map that the receiver lies beyond.
        plane: MapPlane,
        /// The farthest point beyond it, in world space.
        point: DVec3,
        /// Missing space: texels for the planes across the light, metres for near and far. It includes the
        /// filter radius and the bound of the rounding.
        by: f32,
    },
    /// A receiver is in view although the fit is marked as [empty](LightProjection::is_empty), which allows
    /// skipping its shadow pass.
    MarkedEmpty {
        /// A point of the receiver, in world space.
        point: DVec3,
    },
    /// A part of a caster that can cast a shadow into view lies in front of the near plane, or cannot be
    /// proven to lie behind it.
    CasterLost {
        /// The part farthest toward the light, in world space.
        point: DVec3,
        /// Its distance in front of the near plane, in metres, with the bound of the rounding.
        by: f32,
    },
    /// There are no holes, but the rounding of the map's depths exceeds its constant bias, so surfaces that
    /// face the light shadow themselves.
    DepthTooCoarse(DepthRounding),
}

impl CoverageProof {
    /// Returns whether the map has no holes and its bias covers the rounding of its depths.
    pub const fn is_proven(&self) -> bool {
        matches!(self, Self::Proven(_))
    }
}

/// The free space beyond the required space. Infinite if no space was required.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Margins {
    /// Free space at each of [`MapPlane::ALL`]: texels for the planes across the light, metres for far and
    /// near.
    pub planes: [f32; 6],
    /// Distance between the near plane and the first caster over the receivers, in metres. Infinite with
    /// depth clamp, which has no requirement.
    pub casters: f32,
}

/// Proves that a map has no holes, or finds one. Also checks that its bias covers the rounding of its depths.
///
/// - **Receivers** are `input.receivers`, clipped to the views' slices between `query.near` and `query.far`.
///   If the boxes are unknown, the slices themselves are the receivers. Boxes whose
///   [cone](FitInput::receiver_cones) faces away from the light are ignored, as in the fits. A frustum ends
///   at its corners. A camera matrix with other rounding may show a sliver beyond them.
/// - **Casters** are `input.casters`, for any caster policy of the fit: their parts over the receivers'
///   outline, widened by the filter radius, the rasteriser's snap and the normal offset. For maps that are
///   [read by coverage](CoverageQuery::is_shared) they are the parts over the whole map. The proof does not
///   include casters that are not in the input.
/// - **Depth**: if the query has the map's bias, the bias must cover the rounding of depths.
/// - **Rounding**: positions are f32 relative to [`LightProjection::origin`], multiplied by `uv_from_world`
///   and `clip_from_world` in f32 in any order of operations. For positions relative to another origin, call
///   [`LightProjection::relative_to`] first and prove the result.
///
/// World positions are f64, in metres. The fit of the XNA sample has no caster policy, so the proof reports
/// any caster in front of the frustum.
///
/// ```
/// use shadowfit::bias::FilterRadius;
/// use shadowfit::glam::{DVec2, DVec3, Vec3};
/// use shadowfit::proof::{CoverageProof, CoverageQuery, MapPlane, prove};
/// use shadowfit::settings::FitSettings;
/// use shadowfit::{FitInput, PerspectiveCamera, Scratch};
///
/// let camera = PerspectiveCamera {
///     eye: DVec3::new(0.0, 1.7, 5.0),
///     forward: Vec3::NEG_Z,
///     up: Vec3::Y,
///     fov_y: 0.8,
///     aspect: 16.0 / 9.0,
///     near: 0.1,
///     far: 200.0,
/// };
/// let views = [camera.frustum()?];
/// let input = FitInput::new(&views, Vec3::new(0.3, -0.8, 0.2));
/// let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
/// let mut scratch = Scratch::new(&mut storage);
///
/// // Hardware 2×2 samples read texels up to one away: half a texel must be left free for them.
/// let settings = FitSettings::default().with_border(0.5);
/// let query = CoverageQuery::of_fit(&settings, FilterRadius::HARDWARE_2X2);
/// let map = shadowfit::fit_scene(&input, &settings, &mut scratch)?;
/// assert!(prove(&input, &map, &query, &mut scratch)?.is_proven());
///
/// // Without them there is a hole, and the proof says where.
/// let map = shadowfit::fit_scene(&input, &settings.with_border(0.0), &mut scratch)?;
/// let CoverageProof::Uncovered { plane, by, .. } = prove(&input, &map, &query, &mut scratch)? else { panic!() };
/// assert!(plane != MapPlane::Near && by > 0.49 && by < 0.51);
/// # Ok::<(), shadowfit::FitError>(())
/// ```
///
/// A debug build can prove every map of every frame:
///
/// ```
/// # use shadowfit::glam::{DVec2, DVec3, Vec3};
/// # use shadowfit::proof::{CoverageQuery, prove};
/// # use shadowfit::*;
/// # let mut camera = PerspectiveCamera {
/// #     eye: DVec3::new(0.0, 1.7, 5.0),
/// #     forward: Vec3::NEG_Z,
/// #     up: Vec3::Y,
/// #     fov_y: 0.8,
/// #     aspect: 16.0 / 9.0,
/// #     near: 0.1,
/// #     far: 200.0,
/// # };
/// # let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
/// # let mut scratch = Scratch::new(&mut storage);
/// let (mut fitter, technique) = (FitState::new(), Technique::default());
/// for _ in 0..10 {
///     camera.eye.x += 0.3;
///     let views = [camera.frustum()?];
///     let input = FitInput::new(&views, Vec3::new(0.3, -0.8, 0.2));
///     let maps = fitter.fit(&input, &technique, &mut scratch)?;
///     if cfg!(debug_assertions) {
///         for map in maps.iter() {
///             let query = CoverageQuery::of_map(map, &technique, technique.filter.into())
///                 .with_normal_offset(map.bias.normal_offset);
///             let proof = prove(&input, &map.projection, &query, &mut scratch)?;
///             assert!(proof.is_proven(), "{proof:?}");
///         }
///     }
/// }
/// # Ok::<(), FitError>(())
/// ```
///
/// # Errors
///
/// Returns the errors of [`fit_scene`](crate::fit_scene) for the views, the light's direction and the boxes.
/// Returns [`FitError::NotFinite`] and [`FitError::OutOfRange`] for the query and for a fit whose matrices
/// are not a light's. Returns [`FitError::ZeroResolution`], [`FitError::ScratchTooSmall`], and
/// [`FitError::NearNotBelowFar`] for a query whose near is above its far (equal ones require nothing).
pub fn prove(
    input: &FitInput,
    fit: &LightProjection,
    query: &CoverageQuery,
    scratch: &mut Scratch,
) -> Result<CoverageProof, FitError> {
    let range = query.checked()?;
    check(input, fit)?;
    let half_spaces = HalfSpaces::new(fit, query)?;
    let axes = LightAxes::of_matrix(&fit.light_from_world)?;
    let (content, points) = Content::new(input.scene(), scratch.storage)?;
    let offset = content.origin - fit.origin;
    let receivers = Worst::of(&content, range, &half_spaces, offset);
    if let Some(proof) = receivers.failure(fit) {
        return Ok(proof);
    }
    let is_read = if query.is_shared { !fit.is_empty } else { receivers.any.is_some() };
    let mut margins = Margins { planes: receivers.least.map(|(margin, _)| margin as f32), casters: f32::INFINITY };
    if is_read && content.has_casters() && query.casters != CasterPolicy::DepthClamp {
        let map = whole_map(fit, &axes, offset);
        let over = if query.is_shared {
            Outline::new(&axes, &map.corners, raster_reach(fit, map.farthest))
        } else {
            let hull = LightHull::of(Covers::Receivers, Detail::Outline, &content, axes, range, points)?;
            Outline::new(&axes, hull.outline, caster_reach(fit, query, hull.farthest))
        };
        let NearestCaster { margin, point, .. } = NearestCaster::find(&content, over, &half_spaces, offset);
        if margin < 0.0 {
            return Ok(CoverageProof::CasterLost { point: fit.origin + point, by: -margin as f32 });
        }
        margins.casters = margin as f32;
    }
    if let Some((bias, storage)) = query.bias {
        let rounding = depth_rounding(fit, &Bias { constant_depth: bias, ..Bias::default() }, storage);
        if is_read && !rounding.is_covered() {
            return Ok(CoverageProof::DepthTooCoarse(rounding));
        }
    }
    Ok(CoverageProof::Proven(margins))
}

/// Returns an error for an input or a fit that a proof cannot use.
fn check(input: &FitInput, fit: &LightProjection) -> Result<(), FitError> {
    if input.views.is_empty() {
        return Err(FitError::NoView);
    }
    for view in input.views {
        view.checked()?;
    }
    checks::unit("the light's direction", input.direction)?;
    checks::point("the fit's origin", fit.origin)?;
    Ok(())
}

/// The extent of a map.
struct WholeMap {
    /// Its outline along its axes, relative to the content's origin.
    corners: [DVec2; 4],
    /// Greatest distance of the map from the fit's origin, in metres.
    farthest: f64,
}

/// Returns the extent of a map. `offset` is the vector from the fit's origin to the content's origin.
fn whole_map(fit: &LightProjection, axes: &LightAxes, offset: DVec3) -> WholeMap {
    let (min, max) = fit.clip_box();
    let moved = fit.light_from_world.w_axis.truncate().as_dvec3();
    let from = (moved + axes.project(offset)).truncate();
    let (low, high) = (min.truncate() - from, max.truncate() - from);
    let corners = [(low.x, low.y), (high.x, low.y), (high.x, high.y), (low.x, high.y)];
    WholeMap { corners: corners.map(|(x, y)| DVec2::new(x, y)), farthest: fit.farthest_corner() }
}

/// Returns the distance around the outline in which casters are read, in metres: the filter radius with the
/// rasteriser's snap, the normal offset, and the rounding of receivers and casters.
fn caster_reach(fit: &LightProjection, query: &CoverageQuery, distance: f64) -> f64 {
    let reach = query.filter_radius.disc.as_dvec2() + f64::from(query.filter_radius.taps);
    texels(fit, reach) + f64::from(query.normal_offset) + raster_reach(fit, distance)
}

/// Returns the distance around a map in which casters are drawn into it, in metres: the rasteriser's snap,
/// and the rounding of receivers and casters.
fn raster_reach(fit: &LightProjection, distance: f64) -> f64 {
    let size = (fit.box_max - fit.box_min).as_dvec3().truncate();
    let rounding = SHIFT_ROUNDINGS * UNIT * (distance + size.max_element());
    texels(fit, DVec2::splat(f64::from(HARDWARE_SNAP))) + rounding
}

/// Returns a number of texels along both axes as a distance in metres.
fn texels(fit: &LightProjection, count: DVec2) -> f64 {
    let size = (fit.box_max - fit.box_min).as_dvec3().truncate();
    let texels = count * size / fit.resolution.as_dvec2();
    libm::sqrt(texels.dot(texels))
}

/// Number of roundings that shift a receiver and a caster against each other across the light, as multiples
/// of 2⁻²⁴ of the distance and the map's extent: ten in each term of both.
const SHIFT_ROUNDINGS: f64 = 32.0;

/// The caster over an outline that is nearest to the near plane.
struct NearestCaster<'a> {
    over: Outline<'a>,
    scratch: OutlineScratch,
    half_spaces: &'a HalfSpaces,
    /// Vector from the fit's origin to the content's origin.
    offset: DVec3,
    /// Least distance of a part of a caster behind the near plane, in metres. Negative in front of the plane.
    margin: f64,
    /// The part with this distance, relative to the fit's origin.
    point: DVec3,
}

impl<'a> NearestCaster<'a> {
    /// Finds the nearest of a frame's casters.
    fn find(content: &Content, over: Outline<'a>, half_spaces: &'a HalfSpaces, offset: DVec3) -> Self {
        let (scratch, margin, point) = (OutlineScratch::new(), f64::INFINITY, DVec3::ZERO);
        let mut nearest = Self { over, scratch, half_spaces, offset, margin, point };
        content.visit(Query::Casters, &mut nearest);
        nearest
    }
}

impl Visit for NearestCaster<'_> {
    fn wants(&self, bounds: &Bounds) -> bool {
        self.over.may_hold(bounds.min, bounds.max, f64::MIN)
    }

    fn take(&mut self, Found { bounds, .. }: &Found) {
        let Self { over, scratch, half_spaces, offset, margin, point } = self;
        over.parts_over(bounds.min, bounds.max, f64::MIN, scratch, |corner| {
            let p = over.axes.unproject(corner) + *offset;
            let its = half_spaces.near().into_iter().map(|near| near.margin(p)).fold(f64::INFINITY, f64::min);
            if its < *margin {
                (*margin, *point) = (its, p);
            }
        });
    }
}

/// The points with the least margins.
struct Worst<'a> {
    half_spaces: &'a HalfSpaces,
    /// Vector from the fit's origin to the content's origin.
    offset: DVec3,
    /// Least margin at each plane and its point, relative to the fit's origin.
    least: [(f64, DVec3); 6],
    any: Option<DVec3>,
}

impl<'a> Worst<'a> {
    /// Finds the points in the views between two depths.
    fn of(content: &Content, range: Range, half_spaces: &'a HalfSpaces, offset: DVec3) -> Self {
        let mut worst = Self { half_spaces, offset, least: [(f64::INFINITY, DVec3::ZERO); 6], any: None };
        if content.knows_receivers() {
            content.visit_corners(range, &mut worst);
        } else {
            content.corners(range).for_each(|corner| worst.take(corner));
        }
        worst
    }

    /// Returns whether a point has less margin at some plane than all points before it.
    fn is_worse(&self, p: DVec3) -> bool {
        let p = p + self.offset;
        self.half_spaces.all.iter().any(|half_space| half_space.margin(p) < self.least[half_space.plane as usize].0)
    }

    /// Returns the failure, if there is one, at the plane that lacks the largest part of the map's extent.
    fn failure(&self, fit: &LightProjection) -> Option<CoverageProof> {
        let point = self.any?;
        if fit.is_empty {
            return Some(CoverageProof::MarkedEmpty { point: fit.origin + point });
        }
        let (across, along) = (fit.resolution.as_dvec2(), f64::from(fit.depth_range));
        let extents = [across.x, across.x, across.y, across.y, along, along];
        let mut worst = (0.0, None);
        for ((plane, (margin, p)), extent) in MapPlane::ALL.into_iter().zip(self.least).zip(extents) {
            if margin / extent < worst.0 {
                let by = -margin as f32;
                worst = (margin / extent, Some(CoverageProof::Uncovered { plane, point: fit.origin + p, by }));
            }
        }
        worst.1
    }
}

impl VisitCorners for Worst<'_> {
    /// Returns whether a point of a box may have less margin at some plane than all points before it. The
    /// least margin of a box is at one of its corners.
    fn wants(&self, bounds: &Bounds) -> bool {
        self.any.is_none() || box_corners(bounds.min, bounds.max).into_iter().any(|corner| self.is_worse(corner))
    }

    fn take(&mut self, corner: DVec3) {
        let p = corner + self.offset;
        self.any = Some(p);
        for half_space in &self.half_spaces.all {
            let (margin, least) = (half_space.margin(p), &mut self.least[half_space.plane as usize]);
            if margin < least.0 {
                *least = (margin, p);
            }
        }
    }
}

/// Requirements on a map: the receivers that read it, the filter radius around them, and the clipping of
/// casters in front of the near plane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CoverageQuery {
    /// Least view depth of the receivers that read the map, in metres.
    pub near: f32,
    /// Greatest view depth of the receivers that read the map, in metres.
    pub far: f32,
    /// Radius of the filter. The centres of all texels that it reads must lie in the map. A sampler's
    /// rounding of texture coordinates only shifts the weights by an equal amount, so it counts only if
    /// [`FilterRadius::on_hardware`] has included it.
    pub filter_radius: FilterRadius,
    /// Greatest distance across the light between the looked-up point and the receiver, in metres:
    /// [`Bias::normal_offset`](crate::Bias::normal_offset). It needs no room along the light: points in front
    /// of the near plane are lit, which is correct if no caster is lost.
    pub normal_offset: f32,
    /// Whether every point in the map may read it, at any depth and in later frames, as for maps that are
    /// read by [coverage](crate::settings::MapSelection::Coverage). Casters over any part of the map must
    /// then not lie in front of the near plane. Otherwise only the receivers between the view depths read it.
    pub is_shared: bool,
    /// Treatment of casters in front of the near plane. [`CasterPolicy::DepthClamp`] loses none. The other
    /// policies make no difference here.
    pub casters: CasterPolicy,
    /// [`Bias::constant_depth`] of the map and its depth storage: the bias must cover the
    /// [rounding](depth_rounding) of depths. `None` requires nothing.
    pub bias: Option<(f32, DepthStorage)>,
}

impl CoverageQuery {
    /// Returns the requirements on a single map of [`fit_scene`](crate::fit_scene): all receivers up to the
    /// shadow distance.
    pub const fn of_fit(settings: &FitSettings, reach: FilterRadius) -> Self {
        let (near, far) = (f32::MIN, settings.map.max_distance);
        let casters = settings.map.casters;
        Self { near, far, filter_radius: reach, normal_offset: 0.0, is_shared: false, casters, bias: None }
    }

    /// Returns the requirements on one of several maps: the receivers from [`DepthRange::covered_from`] to
    /// [`DepthRange::far`] or the shadow distance. If maps are read by coverage, proofs for each map of a
    /// frame prove the whole frame: every receiver lies in the map of its view depth, and any finer map that
    /// it reads has all of its casters.
    pub const fn of_map(map: &FittedMap, settings: &Technique, reach: FilterRadius) -> Self {
        let shadow_distance = settings.fit.max_distance;
        let (near, far) = match map.depths {
            Some(DepthRange { far, covered_from: Some(near), .. }) => {
                let far = if let Some(far) = far { (far as f32).min(shadow_distance) } else { shadow_distance };
                ((near as f32).min(far), far)
            }
            _ => (shadow_distance, shadow_distance),
        };
        let is_shared = settings.shares_maps();
        let bias = Some((map.bias.constant_depth, DepthStorage::of(settings.format)));
        Self { near, far, filter_radius: reach, normal_offset: 0.0, is_shared, casters: settings.fit.casters, bias }
    }

    /// Returns this query with another [`normal_offset`](Self::normal_offset).
    #[must_use]
    pub const fn with_normal_offset(mut self, normal_offset: f32) -> Self {
        self.normal_offset = normal_offset;
        self
    }

    pub(super) fn checked(&self) -> Result<Range, FitError> {
        checks::finite("the query's near distance", f64::from(self.near))?;
        checks::finite("the query's far distance", f64::from(self.far))?;
        if let Some((bias, _)) = self.bias {
            checks::finite("the query's constant bias", f64::from(bias))?;
        }
        checks::within("the query's normal offset", f64::from(self.normal_offset), 0.0, checks::MAX_LENGTH)?;
        self.filter_radius.checked()?;
        if self.near > self.far {
            return Err(FitError::NearNotBelowFar { near: self.near, far: self.far });
        }
        Ok(Range { near: self.near, far: self.far })
    }
}

/// A side of the box that a map stores, in light space: -x, +x, -y, +y, far, near.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum MapPlane {
    /// Texture coordinate u = 0.
    Left,
    /// Texture coordinate u = 1.
    Right,
    /// Texture coordinate v = 1.
    Bottom,
    /// Texture coordinate v = 0.
    Top,
    /// Away from the light.
    Far,
    /// Toward the light.
    Near,
}

impl MapPlane {
    /// All planes, in the order of [`LightProjection::bounds_from`](crate::LightProjection::bounds_from).
    pub const ALL: [Self; 6] = [Self::Left, Self::Right, Self::Bottom, Self::Top, Self::Far, Self::Near];
}
