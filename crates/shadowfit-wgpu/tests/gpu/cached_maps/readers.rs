//! Effect of a difference between two maps on the visible points.

use shadowfit::glam::{DMat4, DVec2, DVec3, UVec2};
use shadowfit::selection::{MapOrder, MapReading, by_coverage};
use shadowfit::settings::MapSelection;
use shadowfit::{DepthConvention, FittedMap, PerspectiveCamera};

/// Distance between the tested points of a column, in metres.
const STEP: f64 = 0.5;

/// All points in view, and the maps that they read by coverage.
pub(super) struct Readers<'a> {
    maps: &'a [FittedMap],
    reading: MapReading,
    eye: DVec3,
    clip_from_world: DMat4,
}

impl<'a> Readers<'a> {
    pub(super) fn new(camera: &PerspectiveCamera, maps: &'a [FittedMap], reading: MapReading) -> Self {
        let clip_from_world = camera.clip_from_world(DepthConvention::ZeroToOne).as_dmat4();
        Self { maps, reading, eye: camera.eye, clip_from_world }
    }

    /// Returns whether a point in view could be lit differently if a texel of a map held the other of two
    /// depths. Such a point lies between the depths, within the filter's radius of the texel, and reads this
    /// map. Receivers may lie anywhere in view.
    ///
    /// ```text
    ///        light
    ///     ┌────┬────┐  depth of a caster that one of the maps lacks
    ///     │ no │    │
    ///     ├────╲    │
    ///     │     ╲   │  points in view: their shadow would be lost
    ///     └────┴────┘  depth of what lies behind it
    /// ```
    pub(super) fn tell_apart(&self, index: usize, texel: UVec2, depths: [f32; 2]) -> bool {
        let projection = &self.maps[index].projection;
        let world_from_uv = projection.uv_from_world.as_dmat4().inverse();
        let reach = f64::from(self.reading.softness.filter_radius(self.reading.filter));
        let [from, to] = depths.map(f64::from);
        let steps = ((to - from).abs() * f64::from(projection.depth_range) / STEP).ceil() as u32;
        let around = [-reach, 0.0, reach];
        let columns = around.into_iter().flat_map(|x| around.map(|y| (x, y)));
        let mut points = columns.flat_map(|(x, y)| {
            let uv = (texel.as_dvec2() + 0.5 + DVec2::new(x, y)) / projection.resolution.as_dvec2();
            (0..=steps).map(move |step| uv.extend(from + (to - from) * f64::from(step) / f64::from(steps)))
        });
        points.any(|uv| {
            let point = projection.origin + world_from_uv.transform_point3(uv);
            self.is_in_view(point) && self.reads(point, index)
        })
    }

    fn is_in_view(&self, point: DVec3) -> bool {
        let clip = self.clip_from_world * (point - self.eye).extend(1.0);
        clip.truncate().truncate().abs().max_element() <= clip.w && (0.0..=clip.w).contains(&clip.z)
    }

    /// Returns whether a point reads a map.
    fn reads(&self, point: DVec3, index: usize) -> bool {
        let MapReading { selection, filter, softness } = self.reading;
        let MapSelection::Coverage { blend } = selection else { panic!("maps that are read by coverage") };
        let order = MapOrder::new(selection, self.maps.iter().map(|map| &map.projection));
        let free = |map: usize| self.maps[map].projection.texels_to_edge(point);
        let read = by_coverage(order.iter(), f64::from(softness.filter_radius(filter)), f64::from(blend), free);
        read.is_some_and(|read| read.map == index || read.blend.is_some_and(|blend| blend.map == index))
    }
}
