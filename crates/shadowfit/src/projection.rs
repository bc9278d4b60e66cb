//! The result of every fit: the light's matrices and the box that the map stores.
//!
//! All maps take positions relative to an origin in f64, so that they stay exact far from the world's origin.
//! [`LightProjection::relative_to`] moves that origin.
//!
//! [`LightProjection::from_clip_from_world`] converts another engine's matrix, so that it can be drawn,
//! culled and evaluated like the projections of this crate.

use glam::{DMat4, DVec3, Mat4, UVec2, Vec2, Vec3, Vec4};

use crate::base::checks::{MAX_LENGTH, MIN_LENGTH};
use crate::base::{DepthConvention, FitError, checks};
use crate::light::{BoundSource, LightAxes, Volume};

/// An orthographic view-projection of a directional light.
///
/// *Light space* is right-handed, in metres, with x right and y up in the map. The light is at its origin and
/// looks along -z. Clip space has x right, y up and the depth range [`Self::depth`]. Texture space has u
/// right and v **down**, both 0..1 over the map. Row 0 is on top, as in wgpu, Direct3D, Vulkan and Metal;
/// OpenGL users flip v.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LightProjection {
    /// World position that all inputs of the matrices are relative to, in metres. It is the eye of the
    /// frustum until [`Self::relative_to`] moves it.
    pub origin: DVec3,
    /// Unit direction of travel of the light in world axes.
    pub direction: Vec3,
    /// Transform to light space from world positions relative to [`Self::origin`], in metres.
    pub light_from_world: Mat4,
    /// Transform to clip space from light space.
    pub clip_from_light: Mat4,
    /// Transform to clip space from world positions relative to [`Self::origin`], in metres.
    pub clip_from_world: Mat4,
    /// Transform to texture space (u, v) and stored depth from world positions relative to [`Self::origin`].
    /// The stored depth is the clip depth as a depth attachment holds it. For -1..1 it is half the clip depth
    /// plus one half.
    pub uv_from_world: Mat4,
    /// Least corner of the fitted box in light space, in metres.
    pub box_min: Vec3,
    /// Greatest corner of the fitted box in light space, in metres. Its z is the near plane of the
    /// map. The box fills the map, except in the XNA fit, whose far plane lies one more box depth
    /// beyond `box_min`.
    pub box_max: Vec3,
    /// Size of one texel across the light, along u and v, in metres.
    pub texel_size: Vec2,
    /// Distance between the near and the far plane, in metres.
    pub depth_range: f32,
    /// Upper bound of the distance from [`Self::origin`] to the corners of the receivers' boxes of this map,
    /// in metres; 0 if it is not known. Cascades of a view share one bound, which includes the corners of
    /// their maps. A shader rounds a vertex by a share of its distance from the origin, and a large triangle
    /// that reaches into the map inherits the rounding of its vertices. [Biases](crate::bias) cover that.
    #[cfg_attr(feature = "serde", serde(default))]
    pub vertex_distance: f32,
    /// Width and height of the map, in texels.
    pub resolution: UVec2,
    /// Depth range of the clip space.
    pub depth: DepthConvention,
    /// Sources of the planes -x, +x, -y, +y, far and near of the box, in the map's axes.
    pub bounds_from: [BoundSource; 6],
    /// Whether no receiver is in view. The map is then fitted to the view itself, and its shadow pass may be
    /// skipped. If the receivers are unknown, a map is empty only if its range has no part of the view.
    pub is_empty: bool,
}

/// Matrices for plain f32 world positions, for engines without a camera-relative path.
///
/// World coordinates rounded to f32 cost about 6e-8 of their distance from the world's origin:
/// a centimetre at 100 km.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WorldMatrices {
    /// Transform to light space from world space, in metres.
    pub light_from_world: Mat4,
    /// Transform to clip space from light space.
    pub clip_from_light: Mat4,
    /// Transform to clip space from world space.
    pub clip_from_world: Mat4,
}

/// Tolerance of coverage at a map's sides, for suns and spot lights, as a share of the map's extent. It
/// covers the rounding of f32 texture coordinates, so that the frustum's own corners count as covered.
pub(crate) const COVER_TOLERANCE: f64 = 1e-6;

impl LightProjection {
    /// Converts a fitted box into matrices. Fails if f32 matrices cannot hold the box.
    #[inline(always)]
    pub(crate) fn from_volume(
        origin: DVec3,
        volume: &Volume,
        resolution: UVec2,
        depth: DepthConvention,
    ) -> Result<Self, FitError> {
        let size = volume.max - volume.min;
        for extent in [size.x, size.y, volume.depth_range] {
            checks::within("an extent of the light's box", extent, MIN_LENGTH, MAX_LENGTH)?;
        }
        let centre = (volume.min + volume.max) * 0.5;
        let light = DVec3::new(centre.x, centre.y, volume.light_z);
        let light_from_world = light_from_world(&volume.axes, light);
        let clip_from_light = clip_from_light(size, volume, depth);
        let box_max = DVec3::new(size.x * 0.5, size.y * 0.5, volume.max.z - volume.light_z);
        let (clip_from_world, uv_from_world) = products(&light_from_world, &clip_from_light, depth);
        Ok(Self {
            origin,
            direction: -volume.axes.z,
            light_from_world,
            clip_from_light,
            clip_from_world,
            uv_from_world,
            box_min: (box_max - size).as_vec3(),
            box_max: box_max.as_vec3(),
            texel_size: (size.truncate() / resolution.as_dvec2()).as_vec2(),
            depth_range: volume.depth_range as f32,
            vertex_distance: volume.vertex_distance as f32,
            resolution,
            depth,
            bounds_from: volume.bounds_from,
            is_empty: volume.is_empty,
        })
    }

    /// Returns this map with inputs relative to another world position, in metres. The translation is
    /// computed in f64 and rounded once. An origin that is not finite gives matrices that are not finite.
    #[must_use]
    pub fn relative_to(&self, new_origin: DVec3) -> Self {
        let moved = self.project(new_origin).as_vec3();
        let mut fit = *self;
        fit.origin = new_origin;
        if fit.vertex_distance > 0.0 {
            fit.vertex_distance += checks::length(new_origin - self.origin) as f32;
        }
        fit.light_from_world.w_axis = moved.extend(1.0);
        (fit.clip_from_world, fit.uv_from_world) = products(&fit.light_from_world, &fit.clip_from_light, fit.depth);
        fit
    }

    /// Returns the world position of the light space's origin, in metres. A directional light has no
    /// position; this is the position of its view matrix. It is the middle of the near plane, or in the XNA
    /// fit the middle of the box's face away from the light.
    pub fn light_position(&self) -> DVec3 {
        self.origin + self.unproject(DVec3::ZERO)
    }

    /// Returns the matrices for plain f32 world positions.
    pub fn world_matrices(&self) -> WorldMatrices {
        let Self { light_from_world, clip_from_light, clip_from_world, .. } = self.relative_to(DVec3::ZERO);
        WorldMatrices { light_from_world, clip_from_light, clip_from_world }
    }

    /// Returns whether the map covers a world position, in metres, to 1e-6 of the map's extent. In the XNA
    /// fit the map includes its empty farther half.
    pub fn covers(&self, point: DVec3) -> bool {
        let p = self.project(point);
        let (min, max) = self.clip_box();
        let tolerance = (max - min) * COVER_TOLERANCE;
        p.cmpge(min - tolerance).all() && p.cmple(max + tolerance).all()
    }

    /// Returns the number of texels between a world position, in metres, and the nearest of the map's sides,
    /// or `None` if the map does not [cover](Self::covers) the position. Rounding may make it slightly
    /// negative.
    pub fn texels_to_edge(&self, point: DVec3) -> Option<f64> {
        let p = self.project(point);
        let (min, max) = (self.box_min.as_dvec3(), self.box_max.as_dvec3());
        let free = (p - min).min(max - p).truncate() / self.texel_size.as_dvec2();
        self.covers(point).then_some(free.x.min(free.y))
    }

    /// Returns the corners of the box that the map stores, in world axes relative to [`Self::origin`], in
    /// metres. The near face comes first, then the far face. Each is ordered left-top, right-top,
    /// right-bottom, left-bottom in the map.
    pub fn corners(&self) -> [Vec3; 8] {
        let (min, max) = self.clip_box();
        [
            (min.x, max.y, max.z),
            (max.x, max.y, max.z),
            (max.x, min.y, max.z),
            (min.x, min.y, max.z),
            (min.x, max.y, min.z),
            (max.x, max.y, min.z),
            (max.x, min.y, min.z),
            (min.x, min.y, min.z),
        ]
        .map(|(x, y, z)| self.unproject(DVec3::new(x, y, z)).as_vec3())
    }

    /// Returns the box between the near and the far plane, in light space.
    pub(crate) fn clip_box(&self) -> (DVec3, DVec3) {
        let (mut min, max) = (self.box_min.as_dvec3(), self.box_max.as_dvec3());
        min.z = max.z - f64::from(self.depth_range);
        (min, max)
    }

    /// Returns the distance from [`Self::origin`] to the farthest corner of the box between the near and the
    /// far plane, in metres.
    pub(crate) fn farthest_corner(&self) -> f64 {
        let ((min, max), origin) = (self.clip_box(), self.light_from_world.w_axis.truncate().as_dvec3());
        checks::length((min - origin).abs().max((max - origin).abs()))
    }

    /// Converts the centre and half extents of a box relative to [`Self::origin`] to light space, in f64.
    pub(crate) fn project_box(&self, centre: DVec3, half: DVec3) -> (DVec3, DVec3) {
        let m = &self.light_from_world;
        let columns = [m.x_axis, m.y_axis, m.z_axis].map(|column| column.truncate().as_dvec3().abs());
        (self.project(self.origin + centre), columns[0] * half.x + columns[1] * half.y + columns[2] * half.z)
    }

    /// Converts an absolute world position to light space, in f64.
    fn project(&self, point: DVec3) -> DVec3 {
        let m = &self.light_from_world;
        let p = point - self.origin;
        m.x_axis.truncate().as_dvec3() * p.x
            + m.y_axis.truncate().as_dvec3() * p.y
            + m.z_axis.truncate().as_dvec3() * p.z
            + m.w_axis.truncate().as_dvec3()
    }

    /// Converts light space to world axes relative to the origin, in f64. The rotation's transpose is its
    /// inverse, up to f32 rounding.
    fn unproject(&self, point: DVec3) -> DVec3 {
        let m = &self.light_from_world;
        let p = point - m.w_axis.truncate().as_dvec3();
        DVec3::new(
            m.x_axis.truncate().as_dvec3().dot(p),
            m.y_axis.truncate().as_dvec3().dot(p),
            m.z_axis.truncate().as_dvec3().dot(p),
        )
    }
}

/// Returns the matrix from the world to light space, for a light at a position along its axes.
#[inline(always)]
fn light_from_world(&LightAxes { x, y, z }: &LightAxes, light: DVec3) -> Mat4 {
    let t = (-light).as_vec3();
    Mat4::from_cols(
        Vec4::new(x.x, y.x, z.x, 0.0),
        Vec4::new(x.y, y.y, z.y, 0.0),
        Vec4::new(x.z, y.z, z.z, 0.0),
        Vec4::new(t.x, t.y, t.z, 1.0),
    )
}

/// Returns the matrix from light space to clip space.
#[inline(always)]
fn clip_from_light(size: DVec3, volume: &Volume, depth: DepthConvention) -> Mat4 {
    let near = (volume.max.z - volume.light_z) / volume.depth_range;
    let per_metre = 1.0 / volume.depth_range;
    // Distance behind the near plane, as a share of the range, is near - per_metre z.
    let (scale, offset) = match depth {
        DepthConvention::ZeroToOne => (-per_metre, near),
        DepthConvention::Reversed => (per_metre, 1.0 - near),
        DepthConvention::NegativeOneToOne => (-2.0 * per_metre, 2.0 * near - 1.0),
    };
    Mat4::from_cols(
        Vec4::new((2.0 / size.x) as f32, 0.0, 0.0, 0.0),
        Vec4::new(0.0, (2.0 / size.y) as f32, 0.0, 0.0),
        Vec4::new(0.0, 0.0, scale as f32, 0.0),
        Vec4::new(0.0, 0.0, offset as f32, 1.0),
    )
}

/// Computes `clip_from_world` and `uv_from_world` in f64.
#[inline(always)]
fn products(light_from_world: &Mat4, clip_from_light: &Mat4, depth: DepthConvention) -> (Mat4, Mat4) {
    let clip = clip_from_light;
    let scale = DVec3::new(f64::from(clip.x_axis.x), f64::from(clip.y_axis.y), f64::from(clip.z_axis.z));
    let offset = clip.w_axis.truncate().as_dvec3();
    let (mut uv_scale, mut uv_offset) = (DVec3::new(0.5, -0.5, 1.0), DVec3::new(0.5, 0.5, 0.0));
    if depth == DepthConvention::NegativeOneToOne {
        (uv_scale.z, uv_offset.z) = (0.5, 0.5);
    }
    let uv_from_world = scaled(light_from_world, scale * uv_scale, offset * uv_scale + uv_offset);
    (scaled(light_from_world, scale, offset), uv_from_world)
}

/// Returns `scale · (matrix p) + offset` as one affine matrix, computed in f64.
#[inline(always)]
fn scaled(matrix: &Mat4, scale: DVec3, offset: DVec3) -> Mat4 {
    let column = |c: Vec4| c.truncate().as_dvec3() * scale;
    Mat4::from_cols(
        column(matrix.x_axis).as_vec3().extend(0.0),
        column(matrix.y_axis).as_vec3().extend(0.0),
        column(matrix.z_axis).as_vec3().extend(0.0),
        (column(matrix.w_axis) + offset).as_vec3().extend(1.0),
    )
}

/// Tolerance for axes that are not perpendicular or not along the light, as a cosine. It accepts matrices
/// that were written with seven digits and multiplied in f32.
const SKEW: f64 = 1e-4;

impl LightProjection {
    /// Creates the projection that equals a light's orthographic view-projection. `clip_from_world` takes
    /// world positions in metres to clip space (x right, y up, with the depth convention `depth`).
    /// `direction` is the light's direction of travel in world axes, of any length. `origin` is the world
    /// position, in metres, that the projection's own matrices are relative to. Choose one near the visible
    /// surfaces.
    ///
    /// A mirrored matrix gives a mirrored light space.
    ///
    /// # Errors
    ///
    /// [`FitError::NotOrthographic`] for a perspective, a sheared box, or a box along another direction. A
    /// matrix with reversed depth also fails this way if `depth` is not [`DepthConvention::Reversed`]. Inputs
    /// that are not finite or out of range fail as in [`fit`](crate::fit).
    pub fn from_clip_from_world(
        clip_from_world: &DMat4,
        depth: DepthConvention,
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
        let rows = Rows::of(clip_from_world, depth, origin)?;
        let axes = rows.axes.map(|row| row / checks::length(row));
        let along = axes[2].dot(direction);
        let [x, y, z] = axes;
        check_axes(x, y, z, along)?;
        if (along > 0.0) == (depth == DepthConvention::Reversed) {
            return Err(FitError::NotOrthographic { why: "its depth runs against the light in this convention" });
        }
        // Light space looks along -z in every depth convention.
        Self::from_volume(origin, &rows.volume(axes, along.signum()), resolution, depth)
    }
}

/// Rows of a matrix, with their offsets at the origin.
struct Rows {
    axes: [DVec3; 3],
    offsets: DVec3,
}

impl Rows {
    /// Extracts the rows of a matrix, with depth in 0..1.
    fn of(matrix: &DMat4, depth: DepthConvention, origin: DVec3) -> Result<Self, FitError> {
        let row = |index: usize| {
            let column = |column: usize| matrix.to_cols_array()[column * 4 + index];
            (DVec3::new(column(0), column(1), column(2)), column(3))
        };
        let ((x, x0), (y, y0), (z, z0), (w, w0)) = (row(0), row(1), row(2), row(3));
        if w != DVec3::ZERO || w0 <= 0.0 {
            return Err(FitError::NotOrthographic { why: "it is a perspective" });
        }
        let offset = |row: DVec3, at_zero: f64| (row.dot(origin) + at_zero) / w0;
        let (scale, shift) = if depth == DepthConvention::NegativeOneToOne { (0.5, 0.5) } else { (1.0, 0.0) };
        let offsets = DVec3::new(offset(x, x0), offset(y, y0), offset(z, z0) * scale + shift);
        let rows = Self { axes: [x / w0, y / w0, z / w0 * scale], offsets };
        if rows.axes.iter().any(|row| checks::length(*row) == 0.0) {
            return Err(FitError::NotOrthographic { why: "it is flat" });
        }
        Ok(rows)
    }

    /// Returns the box that the matrix maps to the clip cube. `travel` is 1 if depth grows along the light's
    /// direction, else -1.
    fn volume(&self, axes: [DVec3; 3], travel: f64) -> Volume {
        let scale = self.axes.map(checks::length);
        let half = DVec3::new(1.0 / scale[0], 1.0 / scale[1], 0.5 / scale[2]);
        // The z axis points toward the light, and depth 1/2 lies in the middle.
        let middle = DVec3::new(
            -self.offsets.x / scale[0],
            -self.offsets.y / scale[1],
            -travel * (0.5 - self.offsets.z) / scale[2],
        );
        let (min, max) = (middle - half, middle + half);
        let axes = LightAxes { x: axes[0].as_vec3(), y: axes[1].as_vec3(), z: (axes[2] * -travel).as_vec3() };
        let volume = Volume::covering(axes, min, max, [BoundSource::default(); 6], false);
        Volume { light_z: max.z, depth_range: half.z * 2.0, ..volume }
    }
}

fn check_axes(x: DVec3, y: DVec3, z: DVec3, along: f64) -> Result<(), FitError> {
    let skew = x.dot(y).abs().max(x.dot(z).abs()).max(y.dot(z).abs());
    if skew > SKEW {
        return Err(FitError::NotOrthographic { why: "its axes are not perpendicular" });
    }
    if along.abs() < 1.0 - SKEW {
        return Err(FitError::NotOrthographic { why: "its depth does not run along the light's direction" });
    }
    Ok(())
}
