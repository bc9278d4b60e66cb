//! What a frame hands to a shadow map: the fitted maps with their biases and casters, and the view that reads them.

use shadowfit::bias::Bias;
use shadowfit::glam::{DVec3, UVec2, Vec3};
use shadowfit::scroll::{GridAnchor, Scroll};
use shadowfit::settings::MapChoice;
use shadowfit::{CasterVolume, DepthConvention, FittedMap, LightFit};

use crate::{ShadowMapDescriptor, ShadowMapError};

/// A fitted map: its matrices, which points read it, with which bias, and which casters are drawn
/// into it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapFit {
    /// The map's matrices and box.
    pub fit: LightFit,
    /// View depth at which it ends, in metres: by view depth a point reads the first map that ends beyond it and covers
    /// it. `f32::MAX` for no end, `f32::MIN` for a map in front of all others that no point reads. By coverage it is
    /// ignored.
    pub far: f32,
    /// View depth, in metres, from which on points are blended into this map, up to the end of the map in front of it;
    /// at that end or beyond, such as `f32::MAX`, for no blend. By coverage it is ignored.
    pub blend_near: f32,
    /// Biases of the look-up, for [`Self::fit`].
    pub bias: Bias,
    /// Casters that are drawn into it; `None` for all that the map can store, which is what maps need that are kept
    /// for later frames. [`Self::sweep`] leaves only those that can cast a shadow into view.
    pub volume: Option<CasterVolume>,
    /// Where the map lies on the world's grid, if it does: what can be kept of it follows from that.
    pub anchor: Option<GridAnchor>,
    /// Where the map's first texel is stored in its layer, in texels: texel t at (t + wrap) mod size, so that a map that
    /// moves keeps what it still covers where it is. Only for fits with as many texels as a layer. Zero for maps
    /// that lie as they are.
    pub wrap: UVec2,
}

impl MapFit {
    /// A single map for all view depths, into which every caster that it can store is drawn.
    pub fn new(fit: LightFit, bias: Bias) -> Self {
        Self { fit, far: f32::MAX, blend_near: f32::MAX, bias, volume: None, anchor: None, wrap: UVec2::ZERO }
    }
}

impl MapFit {
    /// How this map follows from an earlier one of the same number.
    pub fn scroll_from(&self, before: &Self) -> Scroll {
        let [before, now] =
            [before, self].map(|map| FittedMap { fit: map.fit, anchor: map.anchor, ..FittedMap::default() });
        Scroll::between(&before, &now)
    }
}

impl From<&FittedMap> for MapFit {
    /// One of several maps with the biases of its technique, into which every caster that it can
    /// store is drawn:
    ///
    /// ```
    /// # let fitted = shadowfit::FittedMaps::default();
    /// use shadowfit_wgpu::MapFit;
    ///
    /// let maps: Vec<MapFit> = fitted.iter().map(MapFit::from).collect();
    /// ```
    ///
    /// For another [`Bias`], such as [`Bias::automatic`] or [`Bias::fixed`], set [`MapFit::bias`].
    fn from(map: &FittedMap) -> Self {
        let range = map.depth_range();
        let (far, blend_near) = (range.far as f32, range.blend_near as f32);
        Self { far, blend_near, anchor: map.anchor, ..Self::new(map.fit, map.bias) }
    }
}

/// From where the maps are looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapView {
    /// World position that all positions in the shaders are relative to, in metres.
    pub origin: DVec3,
    /// World position of the eye that view depths are counted from, in metres.
    pub eye: DVec3,
    /// Unit direction in which that eye looks, world axes.
    pub forward: Vec3,
    /// Number of the frame, by which the pattern of [soft filters](shadowfit::settings::FilterKind::is_soft) moves, for
    /// temporal antialiasing that averages over frames; 0 in each frame for a pattern that stays.
    pub frame: u32,
}

/// How far the length of [`MapView::forward`] may be from 1: the rounding of a direction that was normalised in f32 and
/// turned by a few matrices.
const UNIT_TOLERANCE: f32 = 1e-3;

impl MapView {
    /// Positions and view depths relative to an eye that looks along `forward` (unit, world axes).
    pub fn from_eye(eye: DVec3, forward: Vec3) -> Self {
        Self { origin: eye, eye, forward, frame: 0 }
    }
}

/// Refuses maps that a shadow map cannot hold or that a shader would read wrongly.
pub(crate) fn check(descriptor: &ShadowMapDescriptor, view: &MapView, maps: &[MapFit]) -> Result<(), ShadowMapError> {
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
        check_layer(descriptor, index, &map.fit)?;
        check_wrap(descriptor, index, map)?;
        map.bias.checked().map_err(|error| ShadowMapError::Bias { index, error })?;
        // NaN has no order.
        let is_in_order = map.far >= previous || descriptor.choice == MapChoice::Coverage;
        if !is_in_order {
            return Err(ShadowMapError::Order { index, far: map.far, previous });
        }
        previous = map.far;
    }
    Ok(())
}

/// Refuses a fit that a layer cannot hold.
fn check_layer(descriptor: &ShadowMapDescriptor, index: usize, fit: &LightFit) -> Result<(), ShadowMapError> {
    let map: ([u32; 2], DepthConvention) = (descriptor.resolution, descriptor.depth);
    let fit = (fit.resolution.to_array(), fit.depth);
    let suits = fit.1 == map.1 && fit.0.iter().zip(&map.0).all(|(fit, layer)| (1..=*layer).contains(fit));
    if suits { Ok(()) } else { Err(ShadowMapError::Fit { index, fit, map }) }
}

/// Refuses a map that cannot wrap around in its layer.
fn check_wrap(descriptor: &ShadowMapDescriptor, index: usize, map: &MapFit) -> Result<(), ShadowMapError> {
    let (wrap, fit) = (map.wrap, map.fit.resolution);
    let is_whole = fit.to_array() == descriptor.resolution && wrap.cmplt(fit).all();
    if wrap == UVec2::ZERO || is_whole {
        return Ok(());
    }
    Err(ShadowMapError::Wrap { index, wrap: wrap.to_array(), fit: fit.to_array(), map: descriptor.resolution })
}
