//! The volume that holds the casters of a map, its planes for shaders, and tests of single shapes.

use glam::{DVec3, Vec3, Vec4};

use super::shapes::{Bounds, OrientedBox, Sphere, TEST_ROUNDING};
use crate::base::checks::UNIT;
use crate::base::{Aabb, Boxes};
use crate::keep::texels::TexelRect;
use crate::projection::LightProjection;
use crate::technique::settings::CasterPolicy;

/// A convex volume that holds casters of one map, given by planes. It is plain data for the CPU and for
/// shaders.
///
/// | made by | holds |
/// |---|---|
/// | [`LightProjection::caster_volume`] | every caster that the map can store |
/// | [`CasterVolume::of_map`] | the same, without a near plane where the pipeline clamps depth |
/// | [`SpotFit::caster_volume`](crate::spot::SpotFit::caster_volume) | every caster that the map of a spot light can store |
/// | [`CasterVolume::swept`] | every caster that can cast a shadow into a slice of the view |
///
/// A shape is culled if it lies completely behind one of the planes. The test is conservative: a shape
/// outside the volume near an edge or a corner, but behind none of the planes, is kept. Larger shapes are
/// kept more often. For each 100 boxes that cast a shadow into the view of the tests' camera, a swept volume
/// keeps at most 7 other boxes if their half extents are up to a tenth of the view's, and at most 25 if they
/// are up to half of it. The map's own box keeps more than three times as many.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CasterVolume {
    /// World position that the planes and single test shapes are relative to, in metres.
    pub origin: DVec3,
    /// Planes (n, d) with unit normals that point inward. A point p in world axes, in metres relative to
    /// [`Self::origin`], is inside if n·p + d >= 0 for all planes. Planes past [`Self::count`] are (0, 0, 0,
    /// 1), and every point is inside them.
    pub planes: [Vec4; Self::MAX_PLANES],
    /// Number of planes in use.
    pub count: u32,
}

/// A plane with every point inside.
const EVERYWHERE: Vec4 = Vec4::new(0.0, 0.0, 0.0, 1.0);

/// A plane with every point outside.
const NOWHERE: Vec4 = Vec4::new(0.0, 0.0, 0.0, f32::MIN);

impl CasterVolume {
    /// Greatest number of planes: four sides and the far plane of the map, and for the view five planes that
    /// face away from the light and six silhouette edges.
    pub const MAX_PLANES: usize = 16;

    /// Returns the volume that holds everything.
    pub const fn everywhere(origin: DVec3) -> Self {
        Self { origin, planes: [EVERYWHERE; Self::MAX_PLANES], count: 0 }
    }

    /// Returns the empty volume.
    pub const fn nowhere(origin: DVec3) -> Self {
        let mut planes = [EVERYWHERE; Self::MAX_PLANES];
        planes[0] = NOWHERE;
        Self { origin, planes, count: 1 }
    }

    /// Returns the volume of up to [`Self::MAX_PLANES`] planes with unit normals that point inward.
    pub(crate) fn of_planes(origin: DVec3, planes: impl IntoIterator<Item = Vec4>) -> Self {
        let mut volume = Self::everywhere(origin);
        for plane in planes {
            volume.push(plane);
        }
        volume
    }

    /// Returns the volume of all casters that a map can store, relative to the fit's origin. Its planes are
    /// -x, +x, -y, +y, far and near in the light's axes. The near plane is left out for
    /// [`CasterPolicy::DepthClamp`], because a map with depth clamp stores casters in front of its near plane
    /// too.
    pub fn of_map(fit: &LightProjection, casters: CasterPolicy) -> Self {
        let (sides, [far, near]) = map_planes(fit);
        let near = (casters != CasterPolicy::DepthClamp).then_some(near);
        Self::of_planes(fit.origin, sides.into_iter().chain([far]).chain(near))
    }

    /// Returns the volume of the casters that can be drawn into a part of the map, as [`Self::of_map`]. It
    /// includes one texel around the part for the rasteriser's rounding.
    pub fn of_part(fit: &LightProjection, casters: CasterPolicy, part: TexelRect) -> Self {
        let (mut sides, [far, near]) = map_planes(fit);
        let end = (part.min + part.size).as_dvec2() + 1.0;
        let (first, size) = (part.min.as_dvec2() - 1.0, fit.resolution.as_dvec2());
        // Texels that each side moves inward: left, right, bottom, top. Rows count downward.
        let inward = [first.x, size.x - end.x, size.y - end.y, first.y];
        let texel = fit.texel_size.as_dvec2();
        for ((side, texels), texel) in sides.iter_mut().zip(inward).zip([texel.x, texel.x, texel.y, texel.y]) {
            side.w = (f64::from(side.w) - texels * texel) as f32;
        }
        let near = (casters != CasterPolicy::DepthClamp).then_some(near);
        Self::of_planes(fit.origin, sides.into_iter().chain([far]).chain(near))
    }

    /// Returns this volume, cut at the near plane of a map, for passes without depth clamp. They clip casters
    /// in front of that plane, so drawing these casters is wasted.
    #[must_use]
    pub fn cut_at_near_plane(&self, fit: &LightProjection) -> Self {
        let (_, [_, near]) = map_planes(&fit.relative_to(self.origin));
        let mut volume = *self;
        volume.push(near);
        volume
    }

    /// Returns the planes in use.
    pub fn active_planes(&self) -> &[Vec4] {
        &self.planes[..(self.count as usize).min(Self::MAX_PLANES)]
    }

    /// Adds a plane if there is room for it. Without it the volume is only larger.
    pub(super) fn push(&mut self, plane: Vec4) {
        if let Some(free) = self.planes.get_mut(self.count as usize) {
            *free = plane;
            self.count += 1;
        }
    }

    /// Returns the same volume with its planes relative to another world position, in metres. The planes are
    /// moved in f64, then outward by the rounding of their normals over the distance, 1e-7 of it.
    #[must_use]
    pub fn relative_to(&self, origin: DVec3) -> Self {
        let offset = origin - self.origin;
        let slack = (offset.x.abs() + offset.y.abs() + offset.z.abs()) * NORMAL_ROUNDING;
        let mut volume = Self { origin, ..*self };
        for plane in &mut volume.planes {
            // Planes without a normal hold all points or none, at any origin.
            if plane.truncate() != Vec3::ZERO {
                let moved = f64::from(plane.w) + plane.truncate().as_dvec3().dot(offset) + slack;
                plane.w = moved as f32;
            }
        }
        volume
    }

    /// Returns the indices of the boxes that may touch the volume.
    pub fn casters_in<'a>(&self, boxes: &Boxes<'a>) -> impl Iterator<Item = usize> + use<'a> {
        let volume = self.relative_to(boxes.origin);
        let touches = move |(index, aabb): (usize, &Aabb)| volume.intersects(aabb).then_some(index);
        boxes.boxes.iter().enumerate().filter_map(touches)
    }

    /// Returns whether an axis-aligned box may touch the volume. `min` and `max` are its corners in world
    /// axes **relative to [`Self::origin`]**, in metres. A box with a `min` above its `max` is empty and does
    /// not touch. A box with NaN counts as touching.
    ///
    /// Known false positives: boxes outside the volume near an edge or corner that are not completely behind
    /// one of its planes.
    pub fn intersects_aabb(&self, min: Vec3, max: Vec3) -> bool {
        self.intersects(&Aabb { min, max })
    }

    /// Returns whether a sphere may touch the volume. The centre is in world axes relative to
    /// [`Self::origin`], centre and radius are in metres. A sphere with a negative radius does not touch. A
    /// sphere with NaN counts as touching.
    ///
    /// It has the known false positives of [`Self::intersects_aabb`]. The test against a single plane is
    /// exact.
    pub fn intersects_sphere(&self, centre: Vec3, radius: f32) -> bool {
        self.intersects(&Sphere { centre, radius })
    }

    /// Returns whether an oriented box, relative to [`Self::origin`], may touch the volume. A box with NaN
    /// counts as touching. It has the known false positives of [`Self::intersects_aabb`].
    pub fn intersects_obb(&self, oriented: &OrientedBox) -> bool {
        self.intersects(oriented)
    }

    pub(super) fn intersects<S: Bounds>(&self, shape: &S) -> bool {
        let slack = shape.slack();
        let is_behind = |plane: &Vec4| shape.support(plane.truncate()) + widened(plane.w) < -slack;
        slack != f32::NEG_INFINITY && !self.active_planes().iter().any(is_behind)
    }
}

impl LightProjection {
    /// Returns the volume of all casters that the map can store: the map's own box, relative to
    /// [`Self::origin`]. It excludes casters in front of the map's near plane. For maps with depth clamp see
    /// [`CasterVolume::of_map`]. [`CasterVolume::swept`] holds only the casters that can cast a shadow into
    /// view.
    pub fn caster_volume(&self) -> CasterVolume {
        CasterVolume::of_map(self, CasterPolicy::None)
    }
}

/// Rounding of a unit normal's direction, in f64.
const NORMAL_ROUNDING: f64 = 2.0 * UNIT;

/// Returns a plane's d, enlarged by its rounding in the test.
pub(super) fn widened(d: f32) -> f32 {
    d + d.abs() * TEST_ROUNDING
}

/// Returns the planes -x, +x, -y, +y of a map, and the far and near planes, relative to the fit's origin.
pub(super) fn map_planes(fit: &LightProjection) -> ([Vec4; 4], [Vec4; 2]) {
    let (min, max) = fit.clip_box();
    let rows = fit.light_from_world.transpose();
    let t = fit.light_from_world.w_axis.truncate().as_dvec3();
    let axes = [rows.x_axis, rows.y_axis, rows.z_axis].map(Vec4::truncate);
    let low = |i: usize| axes[i].extend((t[i] - min[i]) as f32);
    let high = |i: usize| (-axes[i]).extend((max[i] - t[i]) as f32);
    ([low(0), high(0), low(1), high(1)], [low(2), high(2)])
}

/// The planes of a [`CasterVolume`] for a shader. The layout equals this WGSL struct in uniform and storage
/// buffers, 272 bytes:
///
/// ```wgsl
/// struct CasterPlanes {
///     planes: array<vec4f, 16>, // n·p + d >= 0 inside, p relative to the volume's origin
///     count: u32,
/// }
/// ```
///
/// A volume's origin is in f64, which shaders cannot read. Move it to the origin of the shader's positions
/// first, with [`CasterVolume::relative_to`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct CasterPlanes {
    /// [`CasterVolume::planes`]. Shaders may test all of them, because every point is inside the unused ones.
    pub planes: [[f32; 4]; CasterVolume::MAX_PLANES],
    /// Number of planes in use.
    pub count: u32,
    /// Padding at the end of the struct, as in WGSL. Zero.
    pub padding: [u32; 3],
}

impl From<&CasterVolume> for CasterPlanes {
    fn from(volume: &CasterVolume) -> Self {
        Self {
            planes: volume.planes.map(|plane| plane.to_array()),
            count: volume.active_planes().len() as u32,
            padding: [0; 3],
        }
    }
}
