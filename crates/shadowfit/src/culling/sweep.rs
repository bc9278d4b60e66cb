//! The volume that can cast shadows into a slice of the view: the slice swept toward the light.
//!
//! Its planes are the slice's planes that face away from the light, and one plane along the light through
//! each silhouette edge of the slice as seen from the light. It is unbounded toward the light.
//!
//! ```text
//!      │ toward the light │
//!      │        ▲         │
//!      ●───────────●      │   ● silhouette edges, each with a plane along the light
//!       ╲  facing   ╲     │
//!        ╲ the light ╲    │
//!         ╲           ╲   │
//!          ●───────────────●
//!            facing away: these planes bound the volume below
//! ```
//!
//! The choice of normals affects only how tight the volume is. Every plane is moved outward until all corners
//! of the slices are inside, and further by the filter radius.

use glam::{DVec2, DVec3, Vec3};

use super::volume::{CasterVolume, map_planes};
use crate::base::checks::{MAX_LENGTH, ROUNDING};
use crate::base::enclosing::HullBuilder;
use crate::base::{FitError, checks};
use crate::bias::FilterRadius;
use crate::projection::LightProjection;
use crate::view::{Slice, View, ViewFrustum};

/// The receivers that read a map, and the radius of the filter around them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweep<'a> {
    /// The views that read the map.
    pub views: &'a [ViewFrustum],
    /// Least view depth of the receivers, in metres. Default: `f32::MIN`, no limit.
    pub near: f32,
    /// Greatest view depth of the receivers, in metres. Default: `f32::MAX`, no limit.
    pub far: f32,
    /// Radius of the filter. A penumbra search counts as a disc, see [`FilterRadius::over_disc`]. The sweep
    /// adds one texel, because the edge of a caster is rasterised to whole texels. Default:
    /// [`FilterRadius::HARDWARE_2X2`].
    pub filter_radius: FilterRadius,
    /// Greatest distance between receiver and look-up point, in any direction, in metres:
    /// [`Bias::normal_offset`](crate::Bias::normal_offset) plus any other offset of the shader. Default: 0.
    pub normal_offset: f32,
}

impl<'a> Sweep<'a> {
    /// Returns a sweep for views that read the map at every depth, with the hardware's 2×2 filter and no
    /// normal offset.
    pub const fn new(views: &'a [ViewFrustum]) -> Self {
        Self { views, near: f32::MIN, far: f32::MAX, filter_radius: FilterRadius::HARDWARE_2X2, normal_offset: 0.0 }
    }

    /// Returns an error for values that are not finite or out of range.
    fn checked(&self) -> Result<(), FitError> {
        let Self { near, far, .. } = *self;
        checks::finite("the sweep's near distance", f64::from(near))?;
        checks::finite("the sweep's far distance", f64::from(far))?;
        if near >= far {
            return Err(FitError::NearNotBelowFar { near, far });
        }
        self.filter_radius.checked()?;
        checks::within("the sweep's normal offset", f64::from(self.normal_offset), 0.0, MAX_LENGTH)?;
        if self.views.is_empty() {
            return Err(FitError::NoView);
        }
        self.views.iter().try_for_each(|view| view.checked().map(|_| ()))
    }
}

/// Texel that a caster's edge is rasterised to. It adds to the filter radius, in texels.
const RASTER_TEXELS: f32 = 1.0;

/// Greatest number of outline edges for several views. The outline of one view never has more.
const MAX_OUTLINE: usize = 6;

/// Storage elements for the outline of several views: enough for any 15 views.
const OUTLINE_STORAGE: usize = 256;

impl CasterVolume {
    /// Returns the volume of all casters that can cast a shadow, through a map, on a visible point. It is
    /// relative to the fit's origin.
    ///
    /// [`FittedMaps::caster_volumes`](crate::FittedMaps::caster_volumes) computes the volumes of all maps.
    /// The depths must include the view depths of all points that read this map. If the shader selects maps
    /// by view depth, this is the map's own range. If it reads the first map that covers a point, use all
    /// depths at which it may read this map, or the whole range if in doubt.
    ///
    /// The planes are the planes of the view's slice that face away from the light, its silhouette edges
    /// swept along the light, the map's far plane and its four sides. For one view this is the exact sweep,
    /// widened by the filter radius. Several views share an outline of at most six edges around them all. The
    /// volume is unbounded toward the light, so that it serves maps with depth clamp too.
    /// [`Self::cut_at_near_plane`] adds the map's near plane.
    ///
    /// If no view has a part in the range of depths, the volume is empty.
    ///
    /// # Errors
    ///
    /// Returns [`FitError::NoView`] without a view, [`FitError::NotFinite`] and [`FitError::OutOfRange`] for
    /// the depths, the filter radius and the offset, [`FitError::NearNotBelowFar`] for an empty range, and
    /// the errors of an invalid frustum.
    pub fn swept(fit: &LightProjection, sweep: &Sweep) -> Result<Self, FitError> {
        sweep.checked()?;
        Ok(Planes { fit, sweep }.volume())
    }
}

/// Finds the planes of a sweep.
struct Planes<'a> {
    fit: &'a LightProjection,
    sweep: &'a Sweep<'a>,
}

impl Planes<'_> {
    fn volume(&self) -> CasterVolume {
        let mut volume = CasterVolume::everywhere(self.fit.origin);
        let Some(first) = self.slices().next() else {
            return CasterVolume::nowhere(self.fit.origin);
        };
        let (sides, [far, _]) = map_planes(self.fit);
        let to_light = -self.fit.direction.as_dvec3();
        if self.sweep.views.len() == 1 {
            // The whole view has exactly the same normals as its slices. Maps then share these normals, and
            // `cull` computes their supports once.
            let whole = self.view(&self.sweep.views[0]).slice(f64::MIN, f64::MAX);
            silhouette(&whole, to_light, |normal| self.push(&mut volume, normal));
        } else {
            self.outline(|normal| self.push(&mut volume, normal));
        }
        for plane in first.planes {
            if plane.normal.dot(to_light) > 0.0 {
                self.push(&mut volume, plane.normal);
            }
        }
        volume.push(far);
        for plane in sides {
            volume.push(plane);
        }
        volume
    }

    fn view(&self, frustum: &ViewFrustum) -> View {
        View::new(frustum, self.fit.origin)
    }

    /// Returns the parts of the views in the range.
    fn slices(&self) -> impl Iterator<Item = Slice> {
        let (near, far) = (f64::from(self.sweep.near), f64::from(self.sweep.far));
        let slices = self.sweep.views.iter().map(move |view| self.view(view).slice(near, far));
        slices.filter(|slice| slice.near < slice.far)
    }

    /// Adds the plane with an inward normal that holds all slices and the filter radius around them.
    fn push(&self, volume: &mut CasterVolume, normal: DVec3) {
        // The plane uses the rounded normal, so the corners are measured with it too.
        let rounded = normal.as_vec3();
        let normal = rounded.as_dvec3();
        let (mut least, mut farthest) = (f64::MAX, 0.0_f64);
        for corner in self.slices().flat_map(|slice| slice.corners) {
            least = least.min(normal.dot(corner));
            farthest = farthest.max(corner.dot(corner));
        }
        let pad = libm::sqrt(farthest) * ROUNDING;
        volume.push(rounded.extend((self.reach_along(rounded) + pad - least) as f32));
    }

    /// Returns the distance that the filter reads along a direction, in metres.
    fn reach_along(&self, normal: Vec3) -> f64 {
        let reach = FilterRadius { taps: self.sweep.filter_radius.taps + RASTER_TEXELS, ..self.sweep.filter_radius };
        let texel = self.fit.texel_size.as_dvec2();
        let [x, y] = self.map_axes();
        let normal = normal.as_dvec3();
        reach.rise(normal.dot(x) * texel.x, normal.dot(y) * texel.y) + f64::from(self.sweep.normal_offset)
    }

    /// Returns the map's axes in world space.
    fn map_axes(&self) -> [DVec3; 2] {
        let rows = self.fit.light_from_world.transpose();
        [rows.x_axis, rows.y_axis].map(|row| row.truncate().as_dvec3())
    }

    /// Emits the normals of a simplified outline of all slices in the light's plane.
    fn outline(&self, mut emit: impl FnMut(DVec3)) {
        let [x, y] = self.map_axes();
        let mut storage = [DVec2::ZERO; OUTLINE_STORAGE];
        let mut hull = HullBuilder::new(&mut storage);
        for corner in self.slices().flat_map(|slice| slice.corners) {
            if hull.push(DVec2::new(x.dot(corner), y.dot(corner))).is_err() {
                // There are more corners than the storage holds. The map's own sides bound the volume
                // instead.
                return;
            }
        }
        let corners = hull.finish();
        let count = simplify(corners, MAX_OUTLINE);
        for i in 0..count {
            let edge = corners[(i + 1) % count] - corners[i];
            let inward = x * -edge.y + y * edge.x;
            if let Some(normal) = unit(inward) {
                emit(normal);
            }
        }
    }
}

/// Emits the inward normals of planes along the light, one through each edge between a face toward the light
/// and a face away from it.
///
/// ```text
///      0───────1      side i joins the edges from corner i to i + 4 and from i + 1 to i + 5;
///      │       │      faces 4 and 5 are the near and the far rectangle
///      3───────2
/// ```
fn silhouette(view: &Slice, to_light: DVec3, mut emit: impl FnMut(DVec3)) {
    let faces_away = view.planes.map(|plane| plane.normal.dot(to_light) > 0.0);
    let centre = view.corners.iter().copied().sum::<DVec3>() * 0.125;
    let mut edge = |one: usize, other: usize, corner: usize, along: DVec3| {
        if faces_away[one] != faces_away[other]
            && let Some(normal) = unit(along.cross(to_light))
        {
            let is_inward = normal.dot(centre - view.corners[corner]) >= 0.0;
            emit(if is_inward { normal } else { -normal });
        }
    };
    for i in 0..4 {
        // Near and far edges are parallel, and the far one is at least as long.
        let across = view.corners[(i + 1) % 4 + 4] - view.corners[i + 4];
        edge(i, 4, i, across);
        edge(i, 5, i + 4, across);
        edge((i + 3) % 4, i, i, view.corners[i + 4] - view.corners[i]);
    }
}

/// Simplifies a convex polygon (anticlockwise corners) to a number of edges by dropping edges one by one.
/// Extends the neighbours of a dropped edge until they meet. Drops the edge that adds the least area. The
/// result holds the original polygon. Returns the number of corners left.
///
/// ```text
///             X
///            ╱ ╲        edge i from a to b goes, its neighbours meet at X
///           a───b
///          ╱     ╲
/// ```
fn simplify(corners: &mut [DVec2], most: usize) -> usize {
    let mut count = corners.len();
    while count > most.max(4) {
        let mut best = None;
        for i in 0..count {
            let [before, a, b, after] = [i + count - 1, i, i + 1, i + 2].map(|k| corners[k % count]);
            let (first, second) = (a - before, after - b);
            let turn = first.perp_dot(second);
            // Neighbours with a turn of half a circle or more never meet.
            if turn > 0.0 {
                let meeting = a + first * ((b - a).perp_dot(second) / turn);
                let area = (b - a).perp_dot(b - meeting);
                if best.is_none_or(|(_, _, least)| area < least) {
                    best = Some((i, meeting, area));
                }
            }
        }
        let Some((i, meeting, _)) = best else { break };
        corners[i] = meeting;
        let gone = (i + 1) % count;
        corners.copy_within(gone + 1..count, gone);
        count -= 1;
    }
    count
}

/// Returns the direction of a vector, or `None` for zero.
fn unit(v: DVec3) -> Option<DVec3> {
    let length = checks::length(v);
    if length > 0.0 { Some(v / length) } else { None }
}
