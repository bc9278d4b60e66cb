//! Constant blocks of the shaders that draw and read the maps, in any graphics API: the shaders of
//! `shadowfit-wgpu` in WGSL, and their translations to GLSL, HLSL and MSL.
//!
//! All blocks are plain data in the layout of std140, which is also the layout of WGSL's uniform address space and
//! of HLSL's constant buffers for these structs. Copy their bytes to a buffer.
//!
//! ```
//! # use shadowfit::glam::{DVec2, DVec3, Vec3};
//! # use shadowfit::*;
//! use shadowfit::culling::Reader;
//! use shadowfit::uniform::{CasterUniform, ReceiverUniform};
//! # let camera = PerspectiveCamera {
//! #     eye: DVec3::new(0.0, 1.7, 5.0),
//! #     forward: Vec3::NEG_Z,
//! #     up: Vec3::Y,
//! #     fov_y: 0.8,
//! #     aspect: 16.0 / 9.0,
//! #     near: 0.1,
//! #     far: 200.0,
//! # };
//! # let views = [camera.frustum()?];
//! # let input = FitInput::new(&views, Vec3::new(0.3, -0.8, 0.2));
//! # let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
//! let technique = Technique::default();
//! let maps = FitState::new().fit(&input, &technique, &mut Scratch::new(&mut storage))?;
//! let caster = CasterUniform::new(&maps[0].projection, camera.eye); // one for each map
//! let reader = Reader::from_eye(camera.eye, camera.forward);
//! let receiver = ReceiverUniform::new(&maps, &reader, &technique.reading()).with_fade(technique.fade_depths());
//! assert_eq!((receiver.map_count, size_of_val(&caster), size_of_val(&receiver)), (4, 80, 1344));
//! # Ok::<(), FitError>(())
//! ```

use glam::{DMat4, DVec3, DVec4, Mat4, Vec2, Vec3};

use crate::base::{DepthConvention, FitError};
use crate::culling::Reader;
use crate::demand::{DEPTHS, DepthPicture, PIXELS, VisibleDemandSpace};
use crate::map::FittedMap;
use crate::projection::LightProjection;
use crate::selection::{MapOrder, MapReading};
use crate::technique::Technique;
use crate::technique::settings::{MAX_MAPS, Softness};
use crate::view::ViewFrustum;

/// Shift of the rotation pattern of discs from frame to frame, in pixels, and period of the pattern, in
/// frames (J. Jimenez, "Next generation post processing in Call of Duty: Advanced Warfare", 2014).
const FRAME_SHIFT: f32 = 5.588_238;
const FRAMES: u32 = 64;

/// Depths of a fade that never begins.
const NO_FADE: [f32; 2] = [f32::MAX; 2];

/// Uniform of the shadow pass's vertex shader: `shadowfit_Caster` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub struct CasterUniform {
    /// Matrix from world positions relative to the origin to the map's clip space.
    pub clip_from_world: [[f32; 4]; 4],
    /// 1 if fragment shaders clamp depth because the device cannot.
    pub clamps_in_fragment: u32,
    /// Keeps the struct a multiple of 16 bytes.
    pub padding_0: u32,
    /// As above.
    pub padding_1: u32,
    /// As above.
    pub padding_2: u32,
}

/// One map in the uniform of the look-up: `shadowfit_Map` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub struct MapUniform {
    /// Matrix from world positions relative to the origin to texture coordinates (x right, y down, z the
    /// stored depth).
    pub uv_from_world: [[f32; 4]; 4],
    /// Vector whose dot product with a plane's unit normal, divided by cos θ, is the change of the plane's
    /// depth over one texel along u. θ is the angle between the normal and the direction to the light. Zero
    /// without receiver-plane bias.
    pub depth_per_texel_u: [f32; 3],
    /// Depth bias that does not depend on the slope, in units of the stored depth. Its sign moves the
    /// receiver toward the light when it is added.
    pub constant_depth: f32,
    /// As `depth_per_texel_u`, along v.
    pub depth_per_texel_v: [f32; 3],
    /// Depth bias to be multiplied by tan θ, with the same sign convention.
    pub slope_depth: f32,
    /// Width and height of the used corner of the layer, in texels.
    pub size: [f32; 2],
    /// Offset along the normal to be multiplied by sin θ, in metres.
    pub normal_offset: f32,
    /// Receiver-plane bias in texels, with the same sign convention. It is multiplied by the plane's depth
    /// change over a texel.
    pub receiver_plane: f32,
    /// View depth at which the map ends, in metres. With selection by view depth, points from there on do not
    /// read it.
    pub far: f32,
    /// View depth where the blend from the previous map into this one begins, in metres. Used with selection
    /// by view depth.
    pub blend_near: f32,
    /// Index of the layer that contains the map.
    pub layer: u32,
    /// Aligns the next field to 8 bytes.
    pub padding_0: u32,
    /// Position of the map's first texel in its layer, in texels. The map wraps around from there.
    pub texel_offset: [f32; 2],
    /// Radii along u and v of the disc of look-ups, in texels. If the disc depends on the caster's distance,
    /// these are the greatest radii.
    pub disc: [f32; 2],
    /// Radii of the penumbra, in texels per unit of stored depth between the caster and its shadow. Negative
    /// with reversed depth.
    pub penumbra: [f32; 2],
    /// Keeps the struct a multiple of 16 bytes.
    pub padding_1: u32,
    /// As above.
    pub padding_2: u32,
}

/// Uniform of the look-up: `shadowfit_Receiver` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub struct ReceiverUniform {
    /// Unit direction toward the light.
    pub to_light: [f32; 3],
    /// Number of used `maps`.
    pub map_count: u32,
    /// Coefficients of the view depth: for a position relative to the origin it is `dot(xyz, position) + w`,
    /// in metres.
    pub view: [f32; 4],
    /// View depth where shadows begin to fade, in metres.
    pub fade_near: f32,
    /// Width of the fade, in metres.
    pub fade_width: f32,
    /// Least radius of discs, in texels.
    pub least_disc: f32,
    /// Greatest radius of discs, in texels.
    pub greatest_disc: f32,
    /// Shift of the rotation pattern of discs in this frame, in pixels.
    pub frame_shift: f32,
    /// 1 if the light is off: all factors are 0.
    pub is_off: u32,
    /// Aligns the maps to 16 bytes.
    pub padding_0: u32,
    /// As above.
    pub padding_1: u32,
    /// Maps in selection order; see [`MapOrder`].
    pub maps: [MapUniform; MAX_MAPS],
}

/// Uniform of the demand pass, a compute shader that counts the points of a depth buffer as
/// [`VisibleDemandSpace::count_picture`](crate::demand::VisibleDemandSpace::count_picture): `Demand` in WGSL,
/// where the fields are explained.
#[allow(missing_docs)]
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
pub struct DemandUniform {
    pub world_from_pixel: [[f32; 4]; 4],
    pub view: [f32; 4],
    pub direction: [f32; 3],
    pub far_depth: f32,
    pub x: [f32; 3],
    pub cell: f32,
    pub y: [f32; 3],
    pub shape: f32,
    pub corner: [u32; 2],
    pub size: [u32; 2],
    pub step: u32,
    pub pixels: f32,
    pub exponent: i32,
    pub near: f32,
    pub far: f32,
    pub bins_per_octave: f32,
    pub pixel_width: [f32; 2],
}

impl CasterUniform {
    /// Returns the uniform for a fit, with positions relative to `origin` (world space, metres).
    pub fn new(fit: &LightProjection, origin: DVec3) -> Self {
        Self { clip_from_world: fit.relative_to(origin).clip_from_world.to_cols_array_2d(), ..Self::default() }
    }
}

impl MapUniform {
    /// Returns the uniform for a map in layer 0, with positions relative to `origin` (world space, metres)
    /// and read as `reading` says.
    pub fn new(map: &FittedMap, origin: DVec3, reading: &MapReading) -> Self {
        let made = Self::on_plane(map, origin, reading);
        if map.bias.receiver_plane == 0.0 {
            Self { depth_per_texel_u: [0.0; 3], depth_per_texel_v: [0.0; 3], ..made }
        } else {
            made
        }
    }

    /// Returns the same uniform, with `depth_per_texel_u` and `depth_per_texel_v` even without receiver-plane
    /// bias.
    fn on_plane(map: &FittedMap, origin: DVec3, reading: &MapReading) -> Self {
        let MapReading { filter, softness, .. } = reading;
        let FittedMap { projection: fit, bias, .. } = map.relative_to(origin);
        let toward_light = if fit.depth == DepthConvention::Reversed { 1.0 } else { -1.0 };
        let [u, v] = depth_per_texel(&fit);
        Self {
            uv_from_world: fit.uv_from_world.to_cols_array_2d(),
            depth_per_texel_u: u.to_array(),
            constant_depth: toward_light * bias.constant_depth,
            depth_per_texel_v: v.to_array(),
            slope_depth: toward_light * bias.slope_depth,
            size: fit.resolution.as_vec2().to_array(),
            normal_offset: bias.normal_offset,
            receiver_plane: toward_light * bias.receiver_plane,
            far: map.shader_end(),
            blend_near: map.shader_blend_start(),
            texel_offset: map.texel_offset.as_vec2().to_array(),
            disc: softness.texels(*filter, &fit).to_array(),
            penumbra: (Vec2::splat(-toward_light * softness.tangent() * fit.depth_range) / fit.texel_size).to_array(),
            ..Self::default()
        }
    }
}

/// Returns vectors whose dot product with a plane's unit normal n, divided by n·z, is the change of the
/// plane's depth over one texel along u and v. The plane's height falls by n·x / n·z along the map's x, and v
/// runs against its y. This is [`crate::bias::depth_gradient`] without the division by n·z, the cosine.
fn depth_per_texel(fit: &LightProjection) -> [Vec3; 2] {
    let away_from_light = if fit.depth == DepthConvention::Reversed { -1.0 } else { 1.0 };
    let scale = fit.texel_size * (away_from_light / fit.depth_range);
    let row = |index: usize| fit.light_from_world.row(index).truncate();
    [row(0) * scale.x, row(1) * -scale.y]
}

impl ReceiverUniform {
    /// Returns the uniform for a light that is off.
    pub fn off() -> Self {
        Self { is_off: 1, ..Self::default() }
    }

    /// Returns this uniform for maps that are stored from layer `first` on.
    #[must_use]
    pub fn in_layers(mut self, first: u32) -> Self {
        self.maps.iter_mut().for_each(|map| map.layer += first);
        self
    }

    /// Returns the uniform of [`Self::new`], with the depth change per texel in each map even without
    /// receiver-plane bias.
    pub fn on_planes(maps: &[FittedMap], reader: &Reader, reading: &MapReading) -> Self {
        let mut uniform = Self::new(maps, reader, reading);
        for slot in uniform.maps.iter_mut().take(uniform.map_count as usize) {
            let on_plane = MapUniform::on_plane(&maps[slot.layer as usize], reader.origin, reading);
            *slot = MapUniform { layer: slot.layer, ..on_plane };
        }
        uniform
    }

    /// Returns the uniform for maps of one light that are stored in the layers of a texture, in their order.
    /// Positions are relative to the reader's origin. Maps that no point selects ([`MapOrder`]) and maps past
    /// [`MAX_MAPS`] are left out. Without any map, all points are lit. Shadows end with their maps, unless they
    /// [fade](Self::with_fade).
    pub fn new(maps: &[FittedMap], reader: &Reader, reading: &MapReading) -> Self {
        let Softness { floor, ceiling, .. } = reading.softness;
        let mut uniform = Self { least_disc: floor, greatest_disc: ceiling, ..Self::default() }.with_fade(NO_FADE);
        let order = MapOrder::new(reading.selection, maps.iter().map(|map| &map.projection));
        for (slot, index) in uniform.maps.iter_mut().zip(order.iter()) {
            *slot = MapUniform { layer: index as u32, ..MapUniform::new(&maps[index], reader.origin, reading) };
            uniform.map_count += 1;
        }
        uniform.to_light = maps.first().map_or([0.0, 1.0, 0.0], |map| (-map.projection.direction).to_array());
        let at_origin = reader.forward.as_dvec3().dot(reader.origin - reader.eye) as f32;
        uniform.view = reader.forward.extend(at_origin).to_array();
        uniform
    }

    /// Returns this uniform with shadows that fade between two view depths, in metres
    /// ([`Technique::fade_depths`]).
    #[must_use]
    pub fn with_fade(mut self, [near, far]: [f32; 2]) -> Self {
        (self.fade_near, self.fade_width) = (near, far - near);
        self
    }

    /// Returns this uniform for the frame with a number. The number moves the pattern of soft filters, for
    /// temporal anti-aliasing that averages over frames.
    #[must_use]
    pub fn with_frame(mut self, frame: u32) -> Self {
        self.frame_shift = (frame % FRAMES) as f32 * FRAME_SHIFT;
        self
    }
}

impl Technique {
    /// Returns the view depths between which shadows fade, in metres. Both are `f32::MAX` if shadows end with
    /// their maps.
    pub fn fade_depths(&self) -> [f32; 2] {
        let (end, share) = (self.fit.max_distance, self.fade);
        if end < f32::MAX { [end * (1.0 - share.clamp(0.0, 1.0)), end] } else { NO_FADE }
    }
}

impl DemandUniform {
    /// Returns the uniform for a depth buffer, and for points that are counted in a space. One point is counted
    /// per `step` pixels across and down. The view begins at the pixel `corner` of its texture.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] for a matrix without an inverse.
    pub fn new(
        picture: &DepthPicture,
        space: &VisibleDemandSpace,
        step: u32,
        corner: [u32; 2],
    ) -> Result<Self, FitError> {
        let DepthPicture { size, clip_from_world, depth, view } = *picture;
        let VisibleDemandSpace { demand: space, near, far } = *space;
        // The histogram has no bins for negative or zero depths, which orthographic views may have.
        let octaves = libm::log2(f64::from(far) / f64::from(near));
        let (first, bins_per_octave) = if near > 0.0 { (near, DEPTHS as f64 / octaves) } else { (f32::MAX, 0.0) };
        let world_from_pixel = world_from_pixel(&clip_from_world, size, depth)
            .ok_or(FitError::NotFinite { input: "the inverse of a depth buffer's matrix", value: f64::NAN })?;
        Ok(Self {
            world_from_pixel: world_from_pixel.as_mat4().to_cols_array_2d(),
            view: view_depth(view),
            direction: space.direction.to_array(),
            far_depth: if depth == DepthConvention::Reversed { 0.0 } else { 1.0 },
            x: space.x.to_array(),
            cell: space.cell,
            y: space.y.to_array(),
            shape: 1.0 / space.y.length(),
            corner,
            size,
            step,
            pixels: size[1] as f32 / PIXELS * view.height_in_picture(&clip_from_world),
            exponent: ((space.texel.to_bits() >> 23) & 0xff).cast_signed(),
            near: first,
            far,
            bins_per_octave: bins_per_octave as f32,
            pixel_width: pixel_width(view),
        })
    }
}

/// Returns the matrix from a pixel's column and row (at its centre), and its stored depth minus the far plane's, to
/// homogeneous positions in the source space of `clip_from_world`. Returns `None` if the matrix has no inverse.
/// `size` is the size of the picture, in pixels. If depth is not reversed, most of the view lies near depth 1.
/// Differences from 1 are exact in f32, and small enough for an f32 matrix.
pub fn world_from_pixel(clip_from_world: &Mat4, size: [u32; 2], depth: DepthConvention) -> Option<DMat4> {
    let [width, height] = size.map(f64::from);
    let (scale, far) = match depth {
        DepthConvention::ZeroToOne => (1.0, 1.0),
        DepthConvention::Reversed => (1.0, 0.0),
        DepthConvention::NegativeOneToOne => (2.0, 1.0),
    };
    let clip_from_pixel = DMat4::from_cols(
        DVec4::X * (2.0 / width),
        DVec4::Y * (-2.0 / height),
        DVec4::Z * scale,
        DVec4::new(1.0 / width - 1.0, 1.0 - 1.0 / height, far, 1.0),
    );
    let clip_from_world = clip_from_world.as_dmat4();
    let world_from_pixel = clip_from_world.inverse() * clip_from_pixel;
    (clip_from_world.determinant() != 0.0 && world_from_pixel.as_mat4().is_finite()).then_some(world_from_pixel)
}

/// Returns the plane whose distance from a position relative to the eye is its view depth, in metres.
fn view_depth(view: &ViewFrustum) -> [f32; 4] {
    // The centre of the near rectangle is the most precise point.
    let middle = (view.corners[0] + view.corners[2]) * 0.5;
    view.forward.extend(view.near - view.forward.dot(middle)).to_array()
}

/// Returns the width of a pixel on a surface that faces the eye, in metres: at view depth 0, and its growth per
/// metre of view depth. The pixel has the size that it would have if the frustum were [`PIXELS`] high.
fn pixel_width(view: &ViewFrustum) -> [f32; 2] {
    let height = |top: usize, bottom: usize| (view.corners[top].as_dvec3() - view.corners[bottom].as_dvec3()).length();
    let (at_near, at_far) = (height(0, 3), height(4, 7));
    let growth = (at_far - at_near) / (f64::from(view.far) - f64::from(view.near));
    [at_near - growth * f64::from(view.near), growth].map(|width| (width / f64::from(PIXELS)) as f32)
}
