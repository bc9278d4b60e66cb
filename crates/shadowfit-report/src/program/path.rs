//! Camera paths: the frames on which techniques are compared.
//!
//! A path is read from a file ([`file`]) or found in the scene ([`find`]), so that a report needs no
//! preparation. A found path can be written, edited and read again.

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

/// Cameras in rendering order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CameraPath {
    /// Frames, at least one.
    pub(crate) frames: Vec<PathFrame>,
    /// The sun, if the path defines one.
    pub(crate) light: Option<LightSettings>,
}

/// A camera, and the part of the path that it belongs to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PathFrame {
    /// Camera. World space is right-handed, in metres, y up unless the path defines another direction.
    pub(crate) camera: Camera,
    /// Group, such as `orbit`. The frames of a group are consecutive, and the camera jumps between groups.
    pub(crate) group: String,
}

impl CameraPath {
    /// Returns the path moved by an offset, in metres.
    pub(crate) fn moved(mut self, offset: DVec3) -> Self {
        self.frames.iter_mut().for_each(|frame| frame.camera.eye += offset);
        self
    }

    /// Returns the names of the frames: the group and the index in it, such as `orbit/3`.
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
