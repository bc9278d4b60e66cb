//! Spot lights (perspective): a map's matrices, frustum, biases and figures.
//!
//! Unlike the sun, a spot light has a position and a lens, so its map is not fitted to a camera: it shows
//! everything in the light's frustum. It needs no stabilising, caching or proofs, since the map is constant
//! while light and lens do not change.
//!
//! ```
//! use shadowfit::glam::{DVec3, UVec2, Vec3};
//! use shadowfit::settings::{FilterKind, MapFormat};
//! use shadowfit::spot::{SpotBias, SpotLight};
//! use shadowfit::DepthConvention;
//!
//! let eye = DVec3::new(3.0, 1.7, 8.0);
//! let lamp = SpotLight::toward(DVec3::new(0.0, 4.0, 0.0), DVec3::new(0.5, 0.0, -2.0), 0.9, 1.0, 0.1, 30.0);
//! let map = lamp.fit(UVec2::splat(1024), DepthConvention::ZeroToOne)?.relative_to(eye);
//! let bias = SpotBias::automatic(FilterKind::Pcf3x3, MapFormat::Depth32Float, &map)?;
//!
//! let (min, max) = (Vec3::new(-1.0, -1.7, -10.0), Vec3::new(1.0, 0.3, -8.0)); // relative to the eye
//! if map.caster_volume().intersects_aabb(min, max) {
//!     println!("draw the box with {}", map.clip_from_world);
//! }
//! println!("look the map up with {} and {bias:?}", map.uv_from_world);
//! # Ok::<(), shadowfit::FitError>(())
//! ```
//!
//! # In a shader
//!
//! The matrices are perspectives: **divide by w**. w is the distance d along the light's axis, in metres. A
//! point with w <= 0 is beside or behind the light. The division would mirror it into the map, so check w
//! *before* dividing. The shader decides whether points outside the map are lit.
//!
//! ```wgsl
//! let lifted = position + normal * offset;           // see `SpotBias` for the offset and for the depth bias
//! let at = uv_from_world * vec4f(lifted, 1.0);
//! let uv = at.xy / at.w;
//! let is_inside = at.w > 0.0 && all(uv >= vec2f(0.0)) && all(uv <= vec2f(1.0)) && at.z >= 0.0 && at.z <= at.w;
//! let compared = at.z / at.w - depth_bias;           // + depth_bias with reversed depth
//! ```

mod bias;

pub use self::bias::{SpotBias, depth_gradient, normal_offset, on_hardware, receiver_plane_depth};

use glam::{DMat4, DVec3, DVec4, Mat4, UVec2, Vec2, Vec3, Vec4};

use crate::base::checks::{MAX_LENGTH, MIN_LENGTH};
use crate::base::{DepthConvention, FitError, checks};
use crate::culling::CasterVolume;
use crate::light::{LightAxes, is_vertical};
use crate::projection::{COVER_TOLERANCE, WorldMatrices};
use crate::view::{PerspectiveCamera, ViewFrustum};

/// A light at a point that shines into a rectangular frustum: a lamp, a headlight, a projector.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpotLight {
    /// Position of the light in world space, in metres.
    pub position: DVec3,
    /// Direction of the light's axis in world space, away from the light, of any length that is not extreme.
    /// It is normalised.
    pub direction: Vec3,
    /// Up direction of the map in world space. It need not be perpendicular to `direction`. For a light
    /// within 1e-6 radians of this direction or its opposite, the top of the map is -z for +y up, as for a
    /// map seen from straight above and for the XNA sample's sun.
    pub up: Vec3,
    /// Vertical angle of the frustum, in radians, between 0 and π.
    pub fov_y: f32,
    /// Width of the frustum divided by its height.
    pub aspect: f32,
    /// Distance of the near plane along the axis, in metres. Casters nearer to the light are not stored.
    pub near: f32,
    /// Distance of the far plane along the axis, in metres.
    pub far: f32,
}

impl SpotLight {
    /// Returns a light at a position (world space, metres) that points at a target, with +y up.
    ///
    /// `fov_y` is the vertical angle in radians and `aspect` is width by height. `near` and `far` are
    /// distances along the axis in metres. [`Self::fit`] rejects a target at the position itself.
    pub fn toward(position: DVec3, target: DVec3, fov_y: f32, aspect: f32, near: f32, far: f32) -> Self {
        Self { position, direction: (target - position).as_vec3(), up: Vec3::Y, fov_y, aspect, near, far }
    }

    /// Returns the light's map. Its matrices are relative to the light's position. [`SpotFit::relative_to`]
    /// changes this.
    ///
    /// # Errors
    ///
    /// Returns [`FitError::NotFinite`], [`FitError::OutOfRange`] and [`FitError::BadDirection`] for invalid
    /// parameters and for values too small or large for f32 arithmetic. Returns [`FitError::NearNotBelowFar`]
    /// and [`FitError::ZeroResolution`].
    pub fn fit(&self, resolution: UVec2, depth: DepthConvention) -> Result<SpotFit, FitError> {
        let lens = self.lens()?;
        if resolution.x == 0 || resolution.y == 0 {
            return Err(FitError::ZeroResolution { resolution });
        }
        Ok(SpotFit::of_lens(self.position, &lens, resolution, depth))
    }

    /// Returns a camera with the light's matrices, whose picture is the lit part of the world. If
    /// [`Self::fit`] rejects the light, [`PerspectiveCamera::frustum`] rejects the camera.
    pub fn camera(&self) -> PerspectiveCamera {
        let Self { position, direction, up, fov_y, aspect, near, far } = *self;
        let axes = self.axes().ok().filter(|(_, is_vertical)| *is_vertical);
        let up = axes.map_or(up, |(axes, _)| axes.y);
        PerspectiveCamera { eye: position, forward: direction, up, fov_y, aspect, near, far }
    }

    /// Returns the light's frustum as a view, for example to draw it or to cull with it.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Self::fit`].
    pub fn frustum(&self) -> Result<ViewFrustum, FitError> {
        self.lens()?;
        self.camera().frustum()
    }

    /// Returns the light's axes, and whether its axis is parallel to `up`.
    fn axes(&self) -> Result<(LightAxes, bool), FitError> {
        let direction = checks::unit("the spot light's direction", self.direction)?;
        let up = checks::unit("the spot light's up direction", self.up)?;
        Ok((LightAxes::look_at(direction, up), is_vertical(direction, up)))
    }

    fn lens(&self) -> Result<Lens, FitError> {
        checks::point("the spot light's position", self.position)?;
        let (axes, _) = self.axes()?;
        let within = |input, value: f32, max| checks::within(input, f64::from(value), MIN_LENGTH, max);
        let fov_y = within("the spot light's fov_y", self.fov_y, core::f64::consts::PI)?;
        let aspect = within("the spot light's aspect", self.aspect, MAX_LENGTH)?;
        within("the spot light's near distance", self.near, MAX_LENGTH)?;
        within("the spot light's far distance", self.far, MAX_LENGTH)?;
        if self.near >= self.far {
            return Err(FitError::NearNotBelowFar { near: self.near, far: self.far });
        }
        let tangent_y = libm::tan(fov_y * 0.5);
        let tangent_x = tangent_y * aspect;
        for tangent in [tangent_x, tangent_y] {
            checks::within("half an extent of the spot light's frustum at 1 m", tangent, MIN_LENGTH, MAX_LENGTH)?;
        }
        Ok(Lens { axes, tangents: [tangent_x, tangent_y], near: self.near, far: self.far })
    }
}

/// Checked lens of a light.
struct Lens {
    axes: LightAxes,
    /// Tangents of half the horizontal and half the vertical angle.
    tangents: [f64; 2],
    near: f32,
    far: f32,
}

/// A perspective view-projection of a spot light.
///
/// *Light space* is right-handed with x right and y up in the map, in metres. The light is at its origin and
/// points along -z. Clip space has x right, y up and the depth range [`Self::depth`]. Its w is the distance
/// along the light's axis, in metres. Texture space has u right, v **down** (row 0 on top, as in wgpu,
/// Direct3D, Vulkan and Metal; OpenGL users flip v), both 0..1 over the map. Clip and texture coordinates
/// must be divided by w, and points behind the light have w <= 0. See the [module](super) for the shader
/// code.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpotFit {
    /// World position that all inputs of the matrices are relative to, in metres. It is the light's position
    /// until [`Self::relative_to`] changes it.
    pub origin: DVec3,
    /// Position of the light in world space, in metres.
    pub position: DVec3,
    /// Unit direction of the light's axis, away from the light, in world axes.
    pub direction: Vec3,
    /// Transform to light space from world positions relative to [`Self::origin`], in metres.
    pub light_from_world: Mat4,
    /// Transform to clip space from light space.
    pub clip_from_light: Mat4,
    /// Transform to clip space from world positions relative to [`Self::origin`], in metres.
    pub clip_from_world: Mat4,
    /// Transform to texture space (u, v) and stored depth, all times w, from world positions relative to
    /// [`Self::origin`]. The stored depth is the clip depth. For -1..1 it is half the clip depth plus one
    /// half, as in a depth attachment.
    pub uv_from_world: Mat4,
    /// Size of one texel along u and v at 1 m from the light along its axis, in metres. It grows in
    /// proportion to this distance, so the unit is metres per metre.
    pub texel_size: Vec2,
    /// Width and height of the map, in texels.
    pub resolution: UVec2,
    /// Distance of the near plane along the axis, in metres.
    pub near: f32,
    /// Distance of the far plane along the axis, in metres.
    pub far: f32,
    /// Depth range of the clip space.
    pub depth: DepthConvention,
}

impl SpotFit {
    fn of_lens(position: DVec3, lens: &Lens, resolution: UVec2, depth: DepthConvention) -> Self {
        let LightAxes { x, y, z } = lens.axes;
        let [tangent_x, tangent_y] = lens.tangents;
        let light_from_world = Mat4::from_cols(
            Vec4::new(x.x, y.x, z.x, 0.0),
            Vec4::new(x.y, y.y, z.y, 0.0),
            Vec4::new(x.z, y.z, z.z, 0.0),
            Vec4::W,
        );
        let (scale, offset) = depth_row(f64::from(lens.near), f64::from(lens.far), depth);
        let clip_from_light = Mat4::from_cols(
            Vec4::new((1.0 / tangent_x) as f32, 0.0, 0.0, 0.0),
            Vec4::new(0.0, (1.0 / tangent_y) as f32, 0.0, 0.0),
            Vec4::new(0.0, 0.0, scale as f32, -1.0),
            Vec4::new(0.0, 0.0, offset as f32, 0.0),
        );
        let size = resolution.as_dvec2();
        let mut fit = Self {
            origin: position,
            position,
            direction: -z,
            light_from_world,
            clip_from_light,
            clip_from_world: Mat4::IDENTITY,
            uv_from_world: Mat4::IDENTITY,
            texel_size: Vec2::new((2.0 * tangent_x / size.x) as f32, (2.0 * tangent_y / size.y) as f32),
            resolution,
            near: lens.near,
            far: lens.far,
            depth,
        };
        fit.multiply();
        fit
    }

    /// Returns the same map with its inputs relative to another world position, in metres, usually the
    /// camera's eye. The translation is computed in f64 and rounded once. An origin that is not finite gives
    /// matrices that are not finite.
    #[must_use]
    pub fn relative_to(&self, new_origin: DVec3) -> Self {
        let mut fit = Self { origin: new_origin, ..*self };
        fit.light_from_world.w_axis = self.project(new_origin).as_vec3().extend(1.0);
        fit.multiply();
        fit
    }

    /// Returns the matrices for plain f32 world positions.
    pub fn world_matrices(&self) -> WorldMatrices {
        let Self { light_from_world, clip_from_light, clip_from_world, .. } = self.relative_to(DVec3::ZERO);
        WorldMatrices { light_from_world, clip_from_light, clip_from_world }
    }

    /// Returns whether a world position, in metres, lies inside the light's frustum, to 1e-6 of its extent
    /// there.
    pub fn covers(&self, point: DVec3) -> bool {
        let p = self.project(point);
        let distance = -p.z;
        let window = self.tangents().map(|tangent| tangent * distance * (1.0 + 2.0 * COVER_TOLERANCE));
        let slack = (f64::from(self.far) - f64::from(self.near)) * COVER_TOLERANCE;
        // At the light itself the frustum has no extent and holds no points.
        distance > 0.0
            && (p.x.abs() <= window[0])
            && (p.y.abs() <= window[1])
            && (distance >= f64::from(self.near) - slack)
            && (distance <= f64::from(self.far) + slack)
    }

    /// Returns the stored depth at a distance along the light's axis, in metres. It is in 0..1 between the
    /// planes and outside this range elsewhere. Not finite at the light itself.
    pub fn depth_at(&self, distance: f64) -> f64 {
        let (near, far) = (f64::from(self.near), f64::from(self.far));
        let plain = far * (distance - near) / (distance * (far - near));
        if self.depth == DepthConvention::Reversed {
            near * (far - distance) / (distance * (far - near))
        } else {
            plain
        }
    }

    /// Returns b = near · far / (far - near), in metres. At the distance d along the axis the stored depth
    /// changes by b / d² per metre, in every depth convention.
    pub fn depth_scale(&self) -> f64 {
        let (near, far) = (f64::from(self.near), f64::from(self.far));
        near * (far / (far - near))
    }

    /// Returns the tangents of half the horizontal and half the vertical angle.
    pub(crate) fn tangents(&self) -> [f64; 2] {
        let half = self.resolution.as_dvec2() * self.texel_size.as_dvec2() * 0.5;
        [half.x, half.y]
    }

    /// Returns the greatest distance from the light per metre along its axis, which is at the frustum's
    /// corners.
    pub(crate) fn stretch(&self) -> f64 {
        let [x, y] = self.tangents();
        libm::sqrt(1.0 + x * x + y * y)
    }

    /// Returns the light-space position of an absolute world position, in f64.
    pub(crate) fn project(&self, point: DVec3) -> DVec3 {
        self.turn(point - self.position)
    }

    /// Returns a vector in light axes from world axes, in f64.
    pub(crate) fn turn(&self, v: DVec3) -> DVec3 {
        let m = &self.light_from_world;
        let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis].map(|column| column.truncate().as_dvec3());
        x * v.x + y * v.y + z * v.z
    }

    /// Returns the light's axes x, y and z in world axes.
    pub(crate) fn axes(&self) -> [DVec3; 3] {
        let rows = self.light_from_world.transpose();
        [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.truncate().as_dvec3())
    }

    /// Returns the distance of the light from the origin, in metres.
    pub(crate) fn away(&self) -> f64 {
        checks::length(self.position - self.origin)
    }

    /// Computes `clip_from_world` and `uv_from_world` from the other two matrices, in f64.
    fn multiply(&mut self) {
        let clip = self.clip_from_light.as_dmat4().mul_mat4(&self.light_from_world.as_dmat4());
        self.clip_from_world = clip.as_mat4();
        let halved = self.depth == DepthConvention::NegativeOneToOne;
        let (scale, offset) = if halved { (0.5, 0.5) } else { (1.0, 0.0) };
        let texture = |c: DVec4| DVec4::new(0.5 * (c.x + c.w), 0.5 * (c.w - c.y), scale * c.z + offset * c.w, c.w);
        let columns = [clip.x_axis, clip.y_axis, clip.z_axis, clip.w_axis].map(texture);
        self.uv_from_world = DMat4::from_cols(columns[0], columns[1], columns[2], columns[3]).as_mat4();
    }
}

/// Returns the scale of z and the offset of a projection's depth, before the division by w = -z.
fn depth_row(near: f64, far: f64, depth: DepthConvention) -> (f64, f64) {
    match depth {
        DepthConvention::ZeroToOne => (far / (near - far), near * far / (near - far)),
        DepthConvention::Reversed => (near / (far - near), near * far / (far - near)),
        DepthConvention::NegativeOneToOne => ((far + near) / (near - far), 2.0 * near * far / (near - far)),
    }
}

impl SpotFit {
    /// Returns the volume of all casters that the map can store: the light's frustum, relative to
    /// [`Self::origin`]. Its planes are -x, +x, -y, +y, far and near in the light's axes. Casters in front of
    /// the near plane are clipped, so they are outside. The light does not reach receivers outside this
    /// volume, so they need no look-up.
    pub fn caster_volume(&self) -> CasterVolume {
        let [x, y, z] = self.axes();
        let [tangent_x, tangent_y] = self.tangents();
        let light = self.position - self.origin;
        // A side plane contains the light, and its normal leans toward the light by the tangent.
        let side = |axis: DVec3, tangent: f64| {
            let inward = axis - z * tangent;
            through(inward / checks::length(inward), light)
        };
        let far = through(z, light - z * f64::from(self.far));
        let near = through(-z, light - z * f64::from(self.near));
        let planes = [side(x, tangent_x), side(-x, tangent_x), side(y, tangent_y), side(-y, tangent_y), far, near];
        CasterVolume::of_planes(self.origin, planes)
    }
}

/// Returns the plane through a point with a unit normal that points inward.
fn through(normal: DVec3, point: DVec3) -> Vec4 {
    normal.as_vec3().extend(-normal.dot(point) as f32)
}
