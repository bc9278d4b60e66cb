//! Techniques by name, each with a line that says when to take it.

use crate::technique::Technique;
use crate::technique::settings::{
    FitKind, FitSettings, HoldSettings, NeedSource, ReceiverSource, SplitScheme, Stabilise,
};

/// A technique by name.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// Stable name, for files and command lines: the fit and the number of maps.
    pub name: &'static str,
    /// What it is, in a few words.
    pub summary: &'static str,
    /// When to take it, in a sentence.
    pub advice: &'static str,
    make: fn() -> Technique,
}

impl Preset {
    /// The technique.
    pub fn technique(&self) -> Technique {
        (self.make)()
    }
}

/// All presets, from the plainest fit to the recommended one.
pub static PRESETS: [Preset; 13] = [
    Preset {
        name: "xna-1",
        summary: "one map by the XNA sample's rule",
        advice: "Only to compare with the sample: it loses casters outside the view.",
        make: || single(FitKind::XnaSample, ReceiverSource::Objects),
    },
    Preset {
        name: "aabb-1",
        summary: "one map, box of the frustum in the light's axes",
        advice: "For a small view of which nothing is known, where the map must not turn with the camera.",
        make: || single(FitKind::FrustumAabb, ReceiverSource::Objects),
    },
    Preset {
        name: "oriented-1",
        summary: "one map, least rectangle around the frustum",
        advice: "For a small view of which nothing is known: the finest texels that one map can have there.",
        make: || single(FitKind::Oriented, ReceiverSource::Objects),
    },
    Preset {
        name: "focused-1",
        summary: "one map, least rectangle around the objects' boxes in view",
        advice: "For a turntable, a board, a room: one map, and boxes of the objects at hand.",
        make: || single(FitKind::Focused, ReceiverSource::Objects),
    },
    Preset {
        name: "clusters-1",
        summary: "one map, least rectangle around the triangle clusters' boxes in view",
        advice: "As focused-1 where objects are large meshes, which clusters hug more closely.",
        make: || single(FitKind::Focused, ReceiverSource::Clusters),
    },
    Preset {
        name: "stable-4",
        summary: "4 maps around spheres on a fixed grid of texels, splits from the clusters' boxes and held",
        advice: "Where no edge may ever crawl, and coarser shadows are a fair price.",
        make: || Technique {
            hold: HoldSettings::default().with_waste(4.0),
            ..several(FitKind::Sphere, ReceiverSource::Clusters, SplitScheme::FromBoxes, Stabilise::Snap)
        },
    },
    Preset {
        name: "focused-4",
        summary: "4 maps, least rectangles around the objects' boxes in view, splits from the boxes",
        advice: "For pictures that stand alone, where only the boxes of objects are known.",
        make: || several(FitKind::Focused, ReceiverSource::Objects, SplitScheme::FromBoxes, Stabilise::Off),
    },
    Preset {
        name: "clusters-4",
        summary: "4 maps, least rectangles around the triangle clusters' boxes in view, splits from the boxes",
        advice: "For pictures that stand alone, where no earlier frame says what is visible.",
        make: || several(FitKind::Focused, ReceiverSource::Clusters, SplitScheme::FromBoxes, Stabilise::Off),
    },
    Preset {
        name: "histogram-4",
        summary: "as clusters-4, splits from a histogram of the visible depth of the frame before",
        advice: "The fewest wrong pixels that four maps have in each frame; edges crawl when the camera moves.",
        make: || several(FitKind::Focused, ReceiverSource::Clusters, SplitScheme::FromHistogram, Stabilise::Off),
    },
    Preset {
        name: "calm-4",
        summary: "as histogram-4, maps held while they serve and moved by whole texels",
        advice: "Where maps must be slices of the view, as for engines that read them by view depth: nearly as still as \
                 stable-4, and sharper.",
        make: || several(FitKind::Focused, ReceiverSource::Clusters, SplitScheme::FromHistogram, Stabilise::Hysteresis),
    },
    Preset {
        name: "windows-boxes-4",
        summary: "4 windows, placed by the triangle clusters' boxes in view",
        advice: "As windows-4 where no depth buffer can be read, as in OpenGL: less sharp, and slower to place.",
        make: || Technique { need: NeedSource::Boxes, ..Technique::default() },
    },
    Preset {
        name: "windows-8",
        summary: "8 windows, placed by what the frame before showed",
        advice: "The sharpest, for twice the passes and the memory of windows-4.",
        make: || Technique { count: 8, ..Technique::default() },
    },
    Preset {
        name: RECOMMENDED,
        summary: "4 windows, placed by what the frame before showed",
        advice: "The one to begin with: as sharp as the sharpest of the others, edges hardly ever crawl, and maps can be \
                 kept from frame to frame instead of drawn anew. Give it the depth buffer of the frame before \
                 (shadowfit-wgpu has a pass for that).",
        make: Technique::default,
    },
];

/// Name of the preset that is [`Technique::default`].
pub const RECOMMENDED: &str = "windows-4";

impl Technique {
    /// The technique of the preset with this name, or `None` where [`PRESETS`] has no such name.
    pub fn preset(name: &str) -> Option<Self> {
        PRESETS.iter().find(|preset| preset.name == name).map(Preset::technique)
    }
}

fn single(kind: FitKind, receivers: ReceiverSource) -> Technique {
    Technique { count: 1, ..several(kind, receivers, SplitScheme::Logarithmic, Stabilise::Off) }
}

fn several(kind: FitKind, receivers: ReceiverSource, splits: SplitScheme, stabilise: Stabilise) -> Technique {
    Technique { fit: FitSettings::default().with_kind(kind), receivers, splits, stabilise, ..Technique::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_say_the_number_of_maps() {
        for (index, preset) in PRESETS.iter().enumerate() {
            assert!(PRESETS[..index].iter().all(|other| other.name != preset.name), "{}", preset.name);
            let count = preset.name.rsplit('-').next().and_then(|count| count.parse().ok());
            assert_eq!(count, Some(preset.technique().count), "{}", preset.name);
        }
        assert_eq!(Technique::preset(RECOMMENDED), Some(Technique::default()));
        assert_eq!(Technique::preset("calm"), None);
    }
}
