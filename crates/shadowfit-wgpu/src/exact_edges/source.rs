//! Inputs of the passes: the maps as the look-up reads them, and the regions where maps or rays are
//! unreliable.

use shadowfit::glam::{DMat4, DVec3, DVec4, Vec3};
use shadowfit::uniform::world_from_pixel;
use shadowfit::{Aabb, DepthConvention, FittedMap};

use super::error::EdgeError;
use super::uniform::{EdgeUniform, MAX_UNKNOWN, UnknownUniform, points};
use super::view::EdgeView;
use crate::pixels::DepthBufferError;
use crate::{MapView, SunShadows};

/// Margin of the boxes of unknown casters in addition to the filter's footprint, in texels. The rasteriser's
/// rounding is less.
const AROUND: f32 = 2.0;

/// Uniforms of a frame.
pub(super) struct Source {
    pub(super) edges: EdgeUniform,
    /// Uniform of the look-up, for positions relative to the eye.
    pub(super) receiver: Vec<u8>,
}

impl Source {
    /// Computes the uniforms for maps that are read from a view.
    pub(super) fn new(
        sun: &SunShadows,
        map_view: &MapView,
        view: &EdgeView<'_>,
        rays_origin: DVec3,
    ) -> Result<Self, EdgeError> {
        let descriptor = sun.map().descriptor();
        let part @ [left, top, width, height] = view.part();
        let texture = view.depth.texture();
        let to_world = checked_matrix(view, part)?;
        let (points, point_reach) =
            points(descriptor.edges.samples(), texture.sample_count(), descriptor.filter.is_soft());
        let mut unknown = Unknown::default();
        unknown.add_stale(sun, view.eye);
        unknown.add_missing(sun, view);
        let forward = MiddleRay::new(&to_world, [width, height], view.convention).forward();
        let edges = EdgeUniform {
            world_from_pixel: to_world.as_mat4().to_cols_array_2d(),
            eye: (view.eye - rays_origin).as_vec3().to_array(),
            far_depth: view.convention.far(),
            forward: forward.to_array(),
            ray_offset: view.ray_offset,
            corner: [left, top],
            size: [width, height],
            depth_rounding: rounding(texture.format()),
            point_reach,
            unsure_maps: unknown.maps,
            sun_tangent: if descriptor.filter.is_soft() { descriptor.softness.tangent() } else { 0.0 },
            vertex_rounding: VERTEX_ROUNDING * farthest_vertex(sun),
            padding_1: 0,
            padding_2: 0,
            points,
            unknown: unknown.boxes,
        };
        let from_eye = MapView { origin: view.eye, ..*map_view };
        Ok(Self { edges, receiver: sun.map().receiver_bytes(&from_eye, sun.maps()) })
    }
}

/// Rounding of a point on a drawn triangle as a share of the distance of its farthest vertex: ten roundings
/// of 2⁻²⁴, as for the bias of maps.
const VERTEX_ROUNDING: f32 = 10.0 / 16_777_216.0;

/// Returns the distance of the farthest vertex of receivers, in metres.
fn farthest_vertex(sun: &SunShadows) -> f32 {
    sun.maps().iter().map(|map| map.projection.vertex_distance).fold(0.0, f32::max)
}

/// Returns the matrix from pixels to positions relative to the eye, or an error if it is invalid.
fn checked_matrix(view: &EdgeView<'_>, [_, _, width, height]: [u32; 4]) -> Result<DMat4, EdgeError> {
    if view.convention == DepthConvention::NegativeOneToOne {
        return Err(DepthBufferError::Depth(view.convention).into());
    }
    if !view.eye.is_finite() {
        return Err(EdgeError::Eye(view.eye));
    }
    if !(view.ray_offset >= 0.0 && view.ray_offset.is_finite()) {
        return Err(EdgeError::RayOffset(view.ray_offset));
    }
    let to_world = world_from_pixel(&view.clip_from_eye, [width, height], view.convention)
        .ok_or(DepthBufferError::SingularMatrix)?;
    let ray = MiddleRay::new(&to_world, [width, height], view.convention);
    let is_reversed = view.convention == DepthConvention::Reversed;
    if ray.depth_grows() == is_reversed {
        return Err(DepthBufferError::OtherDepth(view.convention).into());
    }
    Ok(to_world)
}

/// Ray through the centre of the view, homogeneous. If the near plane is tilted, the far plane and with it a
/// part of the ray may lie behind the eye.
struct MiddleRay {
    at_near: DVec4,
    at_far: DVec4,
    is_reversed: bool,
}

impl MiddleRay {
    fn new(to_world: &DMat4, size: [u32; 2], convention: DepthConvention) -> Self {
        let [x, y] = size.map(|side| f64::from(side) * 0.5 - 0.5);
        let at = |depth: f32| *to_world * DVec4::new(x, y, f64::from(depth - convention.far()), 1.0);
        let (at_near, at_far) = (at(convention.near()), at(convention.far()));
        Self { at_near, at_far, is_reversed: convention == DepthConvention::Reversed }
    }

    /// Returns whether depth increases along the ray away from the eye, as plain depth does.
    fn depth_grows(&self) -> bool {
        let (near, far) = (self.at_near, self.at_far);
        let is_perspective = (near.w - far.w).abs() > PERSPECTIVE * near.w.abs().max(far.w.abs());
        // In a perspective, w is one over the view depth.
        let is_farther = if is_perspective {
            far.w < near.w
        } else {
            (far / far.w).truncate().length() > (near / near.w).truncate().length()
        };
        is_farther != self.is_reversed
    }

    /// Returns the unit direction away from the eye.
    fn forward(&self) -> Vec3 {
        let (near, far) = (self.at_near, self.at_far);
        (far.truncate() * near.w - near.truncate() * far.w).normalize_or_zero().as_vec3()
    }
}

/// Least relative change of w along a ray of a perspective. A smaller change is rounding in an orthographic
/// view.
const PERSPECTIVE: f64 = 1e-4;

/// Returns a relative and an absolute bound of a depth's rounding. A float is rounded when it is stored, and
/// more when it is interpolated. Rasterisers interpolate small depths with the same absolute precision as
/// large ones, so that a reversed depth far away is less precise than its format. Without the absolute bound
/// of 2⁻³⁰, rays on NVIDIA start below the surface of distant mountains. `Depth24Plus` may have 24 bits or be
/// a float.
fn rounding(format: wgpu::TextureFormat) -> [f32; 2] {
    const BITS_17: f32 = 1.0 / 131_072.0;
    const BITS_23: f32 = 1.0 / 8_388_608.0;
    const BITS_24: f32 = 1.0 / 16_777_216.0;
    const BITS_30: f32 = 1.0 / 1_073_741_824.0;
    match format {
        wgpu::TextureFormat::Depth32Float | wgpu::TextureFormat::Depth32FloatStencil8 => [BITS_23, BITS_30],
        wgpu::TextureFormat::Depth16Unorm => [BITS_23, BITS_17],
        _ => [BITS_23, BITS_24],
    }
}

/// Regions where maps or rays are unreliable.
struct Unknown {
    boxes: [UnknownUniform; MAX_UNKNOWN],
    count: usize,
    /// Bits of the layers of maps that are unreliable everywhere.
    maps: u32,
}

impl Default for Unknown {
    fn default() -> Self {
        Self { boxes: [UnknownUniform::default(); MAX_UNKNOWN], count: 0, maps: 0 }
    }
}

impl Unknown {
    /// Adds casters that moved over maps that wait for a redraw.
    fn add_stale(&mut self, sun: &SunShadows, eye: DVec3) {
        for stale in sun.cached().stale() {
            let Some(map) = sun.maps().get(stale.map) else { continue };
            let bit = 1 << (sun.map().first_layer() as usize + stale.map);
            match &stale.boxes {
                Some(boxes) if self.count + boxes.len() <= MAX_UNKNOWN / 2 => {
                    let around = reach(map, sun);
                    for aabb in boxes {
                        let Aabb { min, max } = aabb.relative_to(eye);
                        self.push(UnknownUniform { maps: bit, ..unknown(min, max, around) });
                    }
                }
                _ => self.maps |= bit,
            }
        }
    }

    /// Adds casters that the rays lack. If there are too many, the last box encloses the rest.
    fn add_missing(&mut self, sun: &SunShadows, view: &EdgeView<'_>) {
        let Some(missing) = view.missing_from_rays else { return };
        let offset = (missing.origin - view.eye).as_vec3();
        // The footprint of the coarsest map is the widest.
        let around = sun.maps().iter().map(|map| reach(map, sun)).fold(0.0, f32::max);
        let first = self.count;
        for aabb in missing.boxes.iter().filter(|aabb| !aabb.is_empty()) {
            let aabb = Aabb::new(aabb.min + offset, aabb.max + offset);
            if self.count < MAX_UNKNOWN {
                self.push(UnknownUniform { is_filtered: 1, ..unknown(aabb.min, aabb.max, around) });
            } else if let Some(last) = self.boxes[first..].last_mut() {
                let [least, most] = [Vec3::from(last.least), Vec3::from(last.most)];
                last.least = least.min(aabb.min - around).to_array();
                last.most = most.max(aabb.max + around).to_array();
            }
        }
    }

    fn push(&mut self, aabb: UnknownUniform) {
        self.boxes[self.count] = aabb;
        self.count += 1;
    }
}

/// Returns a box of unknown casters, widened by a distance.
fn unknown(min: Vec3, max: Vec3, around: f32) -> UnknownUniform {
    let [least, most] = [min - around, max + around].map(|corner| corner.to_array());
    UnknownUniform { least, most, ..UnknownUniform::default() }
}

/// Returns the radius of the filter's footprint in a map, in metres, including the normal offset.
fn reach(map: &FittedMap, sun: &SunShadows) -> f32 {
    let descriptor = sun.map().descriptor();
    let texels = descriptor.softness.filter_radius(descriptor.filter) + AROUND;
    map.projection.texel_size.max_element() * texels + map.bias.normal_offset
}
