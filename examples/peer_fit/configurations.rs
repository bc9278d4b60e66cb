//! The fits that can be asked for by name.

use glam::UVec2;
use shadowfit::{CascadeSettings, CasterPolicy, FitKind, FitSettings, HoldSettings, SplitScheme, Stabilise};

/// What a fit is told of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Knowledge {
    /// The boxes of its objects.
    Objects,
    /// The boxes of clusters of its triangles.
    Clusters,
}

/// A named fit.
pub(crate) struct Configuration {
    pub(crate) name: &'static str,
    pub(crate) what: &'static str,
    pub(crate) receivers: Knowledge,
    settings: fn() -> CascadeSettings,
}

impl Configuration {
    pub(crate) fn needs_triangles(&self) -> bool {
        self.receivers == Knowledge::Clusters || self.uses_histogram()
    }

    pub(crate) fn uses_histogram(&self) -> bool {
        (self.settings)().splits == SplitScheme::FromHistogram
    }

    pub(crate) fn settings(&self, resolution: u32) -> CascadeSettings {
        let settings = (self.settings)();
        CascadeSettings { fit: settings.fit.with_resolution(UVec2::splat(resolution)), ..settings }
    }
}

pub(crate) const CONFIGURATIONS: [Configuration; 10] = [
    Configuration {
        name: "xna-1",
        what: "one map by the XNA sample's rule",
        receivers: Knowledge::Objects,
        settings: || single(FitKind::XnaSample),
    },
    Configuration {
        name: "aabb-1",
        what: "one map, box of the frustum in the light's axes",
        receivers: Knowledge::Objects,
        settings: || single(FitKind::FrustumAabb),
    },
    Configuration {
        name: "oriented-1",
        what: "one map, least rectangle around the frustum",
        receivers: Knowledge::Objects,
        settings: || single(FitKind::Oriented),
    },
    Configuration {
        name: "focused-1",
        what: "one map, least rectangle around the objects' boxes in view",
        receivers: Knowledge::Objects,
        settings: || single(FitKind::Focused),
    },
    Configuration {
        name: "clusters-1",
        what: "one map, least rectangle around the triangle clusters' boxes in view",
        receivers: Knowledge::Clusters,
        settings: || single(FitKind::Focused),
    },
    Configuration {
        name: "stable-4",
        what: "4 maps around spheres on a fixed grid of texels, cuts from the clusters' boxes and held",
        receivers: Knowledge::Clusters,
        settings: || {
            let settings = several(FitKind::Sphere, SplitScheme::FromBoxes, Stabilise::Snap);
            settings.with_hold(HoldSettings::default().with_waste(4.0))
        },
    },
    Configuration {
        name: "focused-4",
        what: "4 maps, least rectangles around the objects' boxes in view, cuts from the boxes",
        receivers: Knowledge::Objects,
        settings: || several(FitKind::Focused, SplitScheme::FromBoxes, Stabilise::Off),
    },
    Configuration {
        name: "clusters-4",
        what: "the same with the boxes of triangle clusters",
        receivers: Knowledge::Clusters,
        settings: || several(FitKind::Focused, SplitScheme::FromBoxes, Stabilise::Off),
    },
    Configuration {
        name: "histogram-4",
        what: "the same, cuts from a histogram of the visible depth of the frame before",
        receivers: Knowledge::Clusters,
        settings: || several(FitKind::Focused, SplitScheme::FromHistogram, Stabilise::Off),
    },
    Configuration {
        name: "calm-4",
        what: "the same, maps held while they serve and moved by whole texels",
        receivers: Knowledge::Clusters,
        settings: || several(FitKind::Focused, SplitScheme::FromHistogram, Stabilise::Hysteresis),
    },
];

fn single(kind: FitKind) -> CascadeSettings {
    CascadeSettings { count: 1, ..several(kind, SplitScheme::Logarithmic, Stabilise::Off) }
}

fn several(kind: FitKind, splits: SplitScheme, stabilise: Stabilise) -> CascadeSettings {
    let fit = FitSettings { kind, casters: CasterPolicy::List, max_distance: f32::MAX, ..FitSettings::default() };
    CascadeSettings { fit, splits, stabilise, ..CascadeSettings::default() }
}
