//! The view of the look-ups, and checks of the maps to draw.

use shadowfit::culling::Reader;
use shadowfit::glam::{DVec3, UVec2, Vec3};
use shadowfit::{DepthConvention, FittedMap, LightProjection};

use crate::{ShadowMapDescriptor, ShadowMapError};

/// The view of the look-ups: the origin of positions, and the eye for view depths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapView {
    /// World position that all positions in the shaders are relative to, in metres.
    pub origin: DVec3,
    /// World position of the eye for view depths, in metres.
    pub eye: DVec3,
    /// Unit viewing direction of this eye, in world axes.
    pub forward: Vec3,
    /// Number of the frame. It moves the pattern of [soft filters](shadowfit::settings::FilterKind::is_soft),
    /// for temporal anti-aliasing that averages over frames. With 0 in every frame the pattern does not
    /// change.
    pub frame: u32,
}

/// Tolerance of the length of [`MapView::forward`]: the rounding of a direction that was normalised in f32
/// and rotated by a few matrices.
const UNIT_TOLERANCE: f32 = 1e-3;

impl MapView {
    /// Returns a view with positions and view depths relative to an eye that looks along `forward` (unit,
    /// world axes).
    pub fn from_eye(eye: DVec3, forward: Vec3) -> Self {
        Self { origin: eye, eye, forward, frame: 0 }
    }

    /// Returns the origin and the eye for the core.
    pub fn reader(&self) -> Reader {
        let Self { origin, eye, forward, .. } = *self;
        Reader { origin, eye, forward }
    }
}

/// Refuses maps that a shadow map cannot hold or that a shader would read wrongly.
pub(crate) fn check(
    descriptor: &ShadowMapDescriptor,
    view: &MapView,
    maps: &[FittedMap],
) -> Result<(), ShadowMapError> {
    let (fits, layers) = (maps.len(), descriptor.maps as usize);
    if fits > layers {
        return Err(ShadowMapError::TooManyFits { fits, layers });
    }
    let length = view.forward.length();
    // NaN is not a unit length either.
    let is_unit = (length - 1.0).abs() <= UNIT_TOLERANCE;
    if fits > 0 && !is_unit {
        return Err(ShadowMapError::Forward { forward: view.forward, length });
    }
    let mut previous = f32::MIN;
    for (index, map) in maps.iter().enumerate() {
        check_layer(descriptor, index, &map.projection)?;
        check_texel_offset(descriptor, index, map)?;
        map.bias.checked().map_err(|error| ShadowMapError::Bias { index, error })?;
        let far = map.shader_end();
        // NaN has no order.
        let is_in_order = far >= previous || descriptor.selection.is_by_coverage();
        if !is_in_order {
            return Err(ShadowMapError::Order { index, far, previous });
        }
        previous = far;
    }
    Ok(())
}

/// Refuses a fit that a layer cannot hold.
fn check_layer(descriptor: &ShadowMapDescriptor, index: usize, fit: &LightProjection) -> Result<(), ShadowMapError> {
    let map: ([u32; 2], DepthConvention) = (descriptor.resolution, descriptor.depth);
    let fit = (fit.resolution.to_array(), fit.depth);
    let suits = fit.1 == map.1 && fit.0.iter().zip(&map.0).all(|(fit, layer)| (1..=*layer).contains(fit));
    if suits { Ok(()) } else { Err(ShadowMapError::Fit { index, fit, map }) }
}

/// Refuses a map that cannot wrap around in its layer.
fn check_texel_offset(descriptor: &ShadowMapDescriptor, index: usize, map: &FittedMap) -> Result<(), ShadowMapError> {
    let (texel_offset, fit) = (map.texel_offset, map.projection.resolution);
    let is_whole = fit.to_array() == descriptor.resolution && texel_offset.cmplt(fit).all();
    if texel_offset == UVec2::ZERO || is_whole {
        return Ok(());
    }
    Err(ShadowMapError::TexelOffset {
        index,
        texel_offset: texel_offset.to_array(),
        fit: fit.to_array(),
        map: descriptor.resolution,
    })
}
