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
