//! Fitted maps in the form that `shadowfit-truth` measures.

use glam::{DMat4, DVec3, Vec3};
use shadowfit::FittedMap;
use shadowfit::selection::MapOrder;
use shadowfit::settings::MapSelection;
use shadowfit_truth::{MapReading, MeasuredMap, PictureMaps};
use shadowfit_wgpu::ShadowMapDescriptor;

/// View depth at which maps without an end stop, in metres. Measured maps need finite ends.
pub(crate) const NO_END: f64 = 1e9;

/// Split of maps that no point reads by view depth, in metres of view depth.
const NOWHERE: f64 = -NO_END;

/// Converts maps of a descriptor to measured maps, for positions relative to `origin`. `direction` is the
/// light's direction of travel.
pub(crate) fn measured(
    maps: &[FittedMap],
    descriptor: &ShadowMapDescriptor,
    direction: Vec3,
    origin: DVec3,
) -> Vec<MeasuredMap> {
    let measured = |map: &FittedMap| {
        let reach = descriptor.softness.filter_radius_in(descriptor.filter, &map.projection).per_axis();
        let (size, end) =
            (map.projection.resolution.as_dvec2(), map.depths.map_or(NOWHERE, |range| range.far.unwrap_or(NO_END)));
        let measured = MeasuredMap::new(&clip_from(map, origin), size, end, -direction.as_dvec3());
        let measured = measured.with_filter_radius(reach);
        match map.depths.and_then(|range| range.covered_from) {
            Some(start) => measured.with_blend_near(start),
            None => measured,
        }
    };
    maps.iter().map(measured).collect()
}

/// Returns how the maps of a shadow map are read. `maps` are the measured form of `fits`.
pub(crate) fn picture_maps<'a>(
    maps: &'a [MeasuredMap],
    fits: &[FittedMap],
    descriptor: &ShadowMapDescriptor,
) -> PictureMaps<'a> {
    let reading = match descriptor.selection {
        MapSelection::ViewDepth { .. } => MapReading::ViewDepth,
        choice @ MapSelection::Coverage { blend } => {
            MapReading::Coverage { order: MapOrder::new(choice, fits.iter().map(|map| &map.projection)), blend }
        }
    };
    let reach = descriptor.softness.filter_radius(descriptor.filter);
    PictureMaps { maps, reading, filter_radius: reach, depth_clamp: descriptor.depth_clamp }
}

/// Returns the matrix clip from positions relative to `origin`.
fn clip_from(map: &FittedMap, origin: DVec3) -> DMat4 {
    map.projection.clip_from_world.as_dmat4() * DMat4::from_translation(origin - map.projection.origin)
}
