//! Camera paths: the frames that techniques are compared on.
//!
//! A path comes from a file ([`file`]), or is found in the scene itself ([`find`]) so that a report
//! needs no preparation; a found one can be written, edited and read again.

mod file;
mod find;
mod follow;
mod probe;
mod route;
#[cfg(test)]
mod scenes;

use glam::DVec3;
use shadowfit::Camera;
use shadowfit_params::tool::LightSettings;

pub(crate) use find::find;
pub(crate) use follow::follow;

/// Cameras in the order in which they are rendered.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CameraPath {
    /// At least one.
    pub(crate) frames: Vec<PathFrame>,
    /// The sun, where the path asks for one.
    pub(crate) light: Option<LightSettings>,
}

/// A camera, and the part of the path that it belongs to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PathFrame {
    /// Right-handed world, y up unless the path says otherwise, metres.
    pub(crate) camera: Camera,
    /// Such as `orbit`; frames of a group follow each other, and the camera jumps between groups.
    pub(crate) group: String,
}

impl CameraPath {
    /// Returns the path moved by an offset, in metres.
    pub(crate) fn moved(mut self, offset: DVec3) -> Self {
        self.frames.iter_mut().for_each(|frame| frame.camera.eye += offset);
        self
    }

    /// Names of the frames: the group and the place in it, such as `orbit/3`.
    pub(crate) fn names(&self) -> Vec<String> {
        let mut place = 0;
        let mut names = Vec::with_capacity(self.frames.len());
        for (index, frame) in self.frames.iter().enumerate() {
            place = if index > 0 && self.frames[index - 1].group == frame.group { place + 1 } else { 0 };
            names.push(format!("{}/{place}", frame.group));
        }
        names
    }
}
