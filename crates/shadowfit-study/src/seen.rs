//! What the frame before showed, in the form that a technique is told of it.

use glam::DVec3;
use shadowfit::histogram::DepthHistogram;
use shadowfit::need::NeedGrid;
use shadowfit::settings::{FitKind, NeedSource, SplitScheme};
use shadowfit::{FitError, PerspectiveCamera, Technique};
use shadowfit_truth::Tracer;
use shadowfit_wgpu::need;

use crate::{SeenDepths, SeenNeed};

/// What a camera saw, for the maps of the next frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Seen {
    /// For splits.
    Depths(SeenDepths),
    /// For windows.
    Need(SeenNeed),
    /// For both, from the depth buffer of a picture.
    Picture(need::SeenNeed),
}

impl Seen {
    /// Whether a technique is told what the frame before showed.
    pub fn is_used_by(technique: &Technique) -> bool {
        match technique.fit.kind {
            FitKind::Windows => technique.need == NeedSource::LastFrame,
            _ => technique.splits == SplitScheme::FromHistogram,
        }
    }

    /// What a technique is told, counted by rays; `None` where it is told nothing. Camera and rays are relative to the
    /// world position `origin`; `direction` is the light's direction of travel in world axes.
    ///
    /// # Errors
    ///
    /// As [`SeenNeed::trace`].
    pub fn trace(
        technique: &Technique,
        (tracer, origin): (&Tracer, DVec3),
        camera: &PerspectiveCamera,
        direction: glam::Vec3,
    ) -> Result<Option<Self>, FitError> {
        if !Self::is_used_by(technique) {
            return Ok(None);
        }
        Ok(Some(if technique.fit.kind == FitKind::Windows {
            Self::Need(SeenNeed::trace(tracer, camera, direction, &technique.fit)?.moved(origin))
        } else {
            Self::Depths(SeenDepths::trace(tracer, camera, direction))
        }))
    }

    /// The histogram of visible depths, as fits take it.
    pub fn histogram(&self) -> Option<DepthHistogram<'_>> {
        match self {
            Self::Depths(depths) => Some(depths.histogram()),
            Self::Picture(seen) => Some(seen.histogram()),
            Self::Need(_) => None,
        }
    }

    /// The grid of needs, as fits take it.
    pub fn need(&self) -> Option<NeedGrid<'_>> {
        match self {
            Self::Need(need) => Some(need.grid()),
            Self::Picture(seen) => Some(seen.grid()),
            Self::Depths(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn each_technique_is_told_what_it_uses_in_world_positions() {
        let corner = |x: f32, z: f32| Vec3::new(x, 0.0, z);
        let ground = [corner(-50.0, 50.0), corner(50.0, 50.0), corner(0.0, -50.0)];
        let tracer = Tracer::new([ground]);
        let camera = PerspectiveCamera {
            eye: DVec3::new(0.0, 2.0, 5.0),
            forward: Vec3::NEG_Z,
            up: Vec3::Y,
            fov_y: 0.8,
            aspect: 1.6,
            near: 0.1,
            far: 150.0,
        };
        let origin = DVec3::new(1e5, 0.0, -2e5);
        let seen = |name: &str| {
            let technique = Technique::preset(name).expect("a preset");
            Seen::trace(&technique, (&tracer, origin), &camera, Vec3::NEG_Y).expect("a camera that makes sense")
        };
        assert_eq!(["clusters-4", "stable-4", "windows-boxes-4"].map(seen), [None, None, None]);
        let [histogram, windows] = ["histogram-4", "windows-4"].map(|name| seen(name).expect("it is told"));
        assert!(histogram.histogram().expect("for splits").bins.iter().sum::<u32>() > 100);
        assert_eq!(histogram.need(), None);
        let need = windows.need().expect("for windows");
        assert_eq!((need.space.origin, windows.histogram()), (origin + camera.eye, None));
        assert!(need.counts.iter().sum::<u32>() > 100);
    }
}
