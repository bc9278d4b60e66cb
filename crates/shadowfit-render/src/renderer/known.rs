//! What the maps hold, so that maps that would come out the same are not drawn again.
//!
//! Everything that decides what is drawn into a map is compared: the maps, the light, the pose of the scene, the view
//! that casters are culled by, and the layers themselves.

use glam::{DVec3, Vec3};
use shadowfit::{Camera, FittedMap};
use shadowfit_wgpu::{Culling, MAX_MAPS};

use super::Renderer;
use crate::frame::Frame;
use crate::scene::GpuScene;
use crate::statistics::MapStatistics;

/// What was drawn into the maps last.
#[derive(Debug)]
pub(super) struct KnownMaps {
    maps: Vec<FittedMap>,
    direction: Vec3,
    camera: Camera,
    reader: (DVec3, Vec3),
    culling: Culling,
    pose: u64,
    /// That of the layers which were drawn into.
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
    /// The frame, whose maps [stay](Frame::maps_stay) where they may and nothing in them would change.
    pub(super) fn with_known_maps<'a>(&mut self, scene: &GpuScene, frame: &Frame<'a>) -> Frame<'a> {
        let layers = self.sun.receiver_group();
        let known = self.known.as_ref().filter(|known| known.layers == *layers && known.is_of(scene, frame));
        let Some(known) = known.filter(|_| frame.maps_may_stay && !frame.maps_stay) else { return *frame };
        self.drawn = known.drawn;
        Frame { maps_stay: true, ..*frame }
    }

    /// Notes what the passes of a frame draw. Kept maps are left to their cache: they cost nothing as they are.
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
