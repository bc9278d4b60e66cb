//! A perspective (spot) light: its map's matrices, frustum, biases and figures.
//!
//! Unlike the sun, a spot light has a position and a lens of its own, so nothing has to be fitted to the camera: the
//! map shows what the light sees. Nothing is stabilised, kept or proven either: where light and lens stand still, so
//! does the map.
//!
//! ```
//! use shadowfit::glam::{DVec3, UVec2, Vec3};
//! use shadowfit::settings::{FilterKind, MapFormat};
//! use shadowfit::{DepthConvention, SpotBias, SpotLight};
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
//! The matrices are perspectives: **divide by w**. w is the distance d along the light's axis, in metres. A point with
//! w <= 0 is beside or behind the light; after the division it would land in the map again, mirrored, so it must be
//! told apart *before* dividing. Lit or not is then up to the shader: nothing outside the map has been stored.
//!
//! ```wgsl
//! let lifted = position + normal * offset;           // see `SpotBias` for the offset and for the depth bias
//! let at = uv_from_world * vec4f(lifted, 1.0);
//! let uv = at.xy / at.w;
//! let is_inside = at.w > 0.0 && all(uv >= vec2f(0.0)) && all(uv <= vec2f(1.0)) && at.z >= 0.0 && at.z <= at.w;
//! let compared = at.z / at.w - depth_bias;           // + depth_bias with reversed depth
//! ```

pub mod bias;

mod casters;
mod matrix;
mod plane;

use glam::{DVec3, UVec2, Vec3};

pub use self::bias::SpotBias;
pub use self::matrix::SpotFit;
use crate::base::checks::{MAX_LENGTH, MIN_LENGTH};
use crate::base::{DepthConvention, FitError, checks};
use crate::light::{LightAxes, is_vertical};
use crate::view::{PerspectiveCamera, ViewFrustum};

/// A light at a point that shines through a rectangular window: a lamp, a headlight, a projector.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SpotLight {
    /// Position of the light in world space, in metres.
    pub position: DVec3,
    /// Direction of travel along the light's axis in world space; any length that is not extreme; it is normalised.
    pub direction: Vec3,
    /// Direction in world space that is upward in the map; need not be perpendicular to `direction`. Of a light that
    /// shines within 1e-6 radians of straight along it, the map's top is where that of a map seen from straight above
    /// is (-z for +y up), as for the XNA sample's sun.
    pub up: Vec3,
    /// Vertical angle of the window, in radians, between 0 and π.
    pub fov_y: f32,
    /// Width of the window divided by its height.
    pub aspect: f32,
    /// Distance of the near plane along the axis, in metres. Casters nearer to the light are not stored.
    pub near: f32,
    /// Distance of the far plane along the axis, in metres.
    pub far: f32,
}

impl SpotLight {
    /// A light at a position (world space, metres) that shines toward a target, with +y up.
    ///
    /// `fov_y` is the vertical angle in radians, `aspect` width by height, `near` and `far` are distances along the
    /// axis in metres. [`Self::fit`] refuses a target at the position itself.
    pub fn toward(position: DVec3, target: DVec3, fov_y: f32, aspect: f32, near: f32, far: f32) -> Self {
        Self { position, direction: (target - position).as_vec3(), up: Vec3::Y, fov_y, aspect, near, far }
    }

    /// The light's map: its matrices relative to the light's position, which [`SpotFit::relative_to`] moves.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`], [`FitError::OutOfRange`] and [`FitError::BadDirection`] for what cannot be such a light
    /// or is too small or large for f32 arithmetic, [`FitError::NearNotBelowFar`], [`FitError::ZeroResolution`].
    pub fn fit(&self, resolution: UVec2, depth: DepthConvention) -> Result<SpotFit, FitError> {
        let lens = self.lens()?;
        if resolution.x == 0 || resolution.y == 0 {
            return Err(FitError::ZeroResolution { resolution });
        }
        Ok(SpotFit::of_lens(self.position, &lens, resolution, depth))
    }

    /// A camera that sees what the light shines on, with the same matrices. One of a light that [`Self::fit`] refuses
    /// is refused by [`PerspectiveCamera::frustum`].
    pub fn camera(&self) -> PerspectiveCamera {
        let Self { position, direction, up, fov_y, aspect, near, far } = *self;
        let axes = self.axes().ok().filter(|(_, is_vertical)| *is_vertical);
        let up = axes.map_or(up, |(axes, _)| axes.y);
        PerspectiveCamera { eye: position, forward: direction, up, fov_y, aspect, near, far }
    }

    /// The light's frustum as a view, for whatever takes one: to draw it, or to list what it sees.
    ///
    /// # Errors
    ///
    /// As [`Self::fit`].
    pub fn frustum(&self) -> Result<ViewFrustum, FitError> {
        self.lens()?;
        self.camera().frustum()
    }

    /// The light's axes, and whether it shines straight along `up`.
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
            checks::within("half an extent of the spot light's window at 1 m", tangent, MIN_LENGTH, MAX_LENGTH)?;
        }
        Ok(Lens { axes, tangents: [tangent_x, tangent_y], near: self.near, far: self.far })
    }
}

/// What a light sees through, checked.
struct Lens {
    axes: LightAxes,
    /// Tangents of half the horizontal and half the vertical angle.
    tangents: [f64; 2],
    near: f32,
    far: f32,
}
