//! Known content of the maps, so that maps that would not change are not drawn again.
//!
//! It compares all inputs of drawing a map: the maps, the light, the pose of the scene, the view that casters
//! are culled by, and the layers themselves.

use glam::{DVec3, Vec3};
use shadowfit::{Camera, FittedMap};
use shadowfit_wgpu::{Culling, MAX_MAPS};

use super::Renderer;
use crate::frame::Frame;
use crate::scene::GpuScene;
use crate::statistics::MapStatistics;

/// Inputs of the last drawing into the maps.
#[derive(Debug)]
pub(super) struct KnownMaps {
    maps: Vec<FittedMap>,
    direction: Vec3,
    camera: Camera,
    reader: (DVec3, Vec3),
    culling: Culling,
    pose: u64,
    /// Bind group of the layers that were drawn into.
    layers: wgpu::BindGroup,
    drawn: [MapStatistics; MAX_MAPS],
}

impl KnownMaps {
    fn is_of(&self, scene: &GpuScene, frame: &Frame<'_>) -> bool {
        let Self { maps, direction, camera, reader, culling, pose, .. } = self;
        maps == frame.maps
            && (*direction, *camera, *reader) == (frame.direction, frame.camera, frame.reader())
            && (*culling, *pose) == (frame.culling, scene.pose())
    }
}

impl Renderer {
    /// Returns the frame. If its maps may [stay](Frame::maps_stay) and would not change, they stay.
    pub(super) fn with_known_maps<'a>(&mut self, scene: &GpuScene, frame: &Frame<'a>) -> Frame<'a> {
        let layers = self.sun.receiver_group();
        let known = self.known.as_ref().filter(|known| known.layers == *layers && known.is_of(scene, frame));
        let Some(known) = known.filter(|_| frame.maps_may_stay && !frame.maps_stay) else { return *frame };
        self.drawn = known.drawn;
        Frame { maps_stay: true, ..*frame }
    }

    /// Records what the passes of a frame draw. Cached maps are left to their cache, because they cost
    /// nothing if unchanged.
    pub(super) fn note_maps(&mut self, scene: &GpuScene, frame: &Frame<'_>) {
        let is_kept = (0..frame.maps.len()).any(|map| self.sun.is_cached(map));
        self.known = (!is_kept).then(|| KnownMaps {
            maps: frame.maps.to_vec(),
            direction: frame.direction,
            camera: frame.camera,
            reader: frame.reader(),
            culling: frame.culling,
            pose: scene.pose(),
            layers: self.sun.receiver_group().clone(),
            drawn: self.drawn,
        });
    }
}
