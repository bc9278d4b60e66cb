//! Techniques by name, each with advice on when to use it.

use crate::technique::settings::{Edges, FitKind, Shape, SplitScheme, Stabilise};
use crate::technique::{Cascades, SingleMap, Technique, Windows};

/// A technique by name.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// Permanent name for files and command lines: the kind of fit and the number of maps.
    pub name: &'static str,
    /// Summary in a few words.
    pub summary: &'static str,
    /// Advice on when to use it, in a sentence or two.
    pub advice: &'static str,
    make: fn() -> Technique,
}

impl Preset {
    /// Name of the preset that equals [`Technique::default`].
    pub const RECOMMENDED: &str = "windows-4";

    /// Returns the technique.
    pub fn technique(&self) -> Technique {
        (self.make)()
    }
}

/// All presets, from the plainest fit to the recommended one.
pub static PRESETS: [Preset; 10] = [
    Preset {
        name: "xna-1",
        summary: "one map by the XNA sample's rule",
        advice: "Only for comparison with the sample: it loses casters outside the view.",
        make: || single(FitKind::XnaSample),
    },
    Preset {
        name: "aabb-1",
        summary: "one map, box of the frustum in the light's axes",
        advice: "For a small view without known boxes, if the map must not turn with the camera.",
        make: || single(FitKind::FrustumAabb),
    },
    Preset {
        name: "oriented-1",
        summary: "one map, smallest rectangle around the frustum",
        advice: "For a small view without known boxes: the finest texels that one map can have there.",
        make: || single(FitKind::Oriented),
    },
    Preset {
        name: "focused-1",
        summary: "one map, smallest rectangle around the boxes in view",
        advice: "For a turntable, a board or a room. Pass a box for each object, and boxes of triangle clusters for \
                 large objects.",
        make: || single(FitKind::Focused),
    },
    Preset {
        name: "stable-4",
        summary: "4 maps around spheres on a fixed texel grid, splits from the boxes and held",
        advice: "If edges must not move and coarser shadows are acceptable. Edges move only in frames that choose \
                 new splits, which is rare and happens when the view changes a lot.",
        make: || several(FitKind::Sphere, SplitScheme::FromBoxes, Stabilise::Snap { max_oversize: 4.0 }),
    },
    Preset {
        name: "focused-4",
        summary: "4 maps, smallest rectangles around the boxes in view, splits from the last frame's depths",
        advice: "For single pictures, and for the fewest wrong pixels per frame with four maps. Edges crawl when the \
                 camera moves. Splits come from the boxes if no earlier frame is known.",
        make: || several(FitKind::Focused, SplitScheme::FromHistogram, Stabilise::Off),
    },
    Preset {
        name: "calm-4",
        summary: "like focused-4, with maps held and moved by whole texels",
        advice: "If maps must be cascades: nearly as still as stable-4, and sharper. An engine that reads maps by \
                 view depth sets Selection to By view depth.",
        make: || several(FitKind::Focused, SplitScheme::FromHistogram, Stabilise::default()),
    },
    Preset {
        name: "windows-8",
        summary: "8 windows, placed by the last frame's visible demand",
        advice: "The sharpest shadows, for twice the passes and memory of windows-4.",
        make: || Technique::default().with_maps(Windows::default().with_count(8)),
    },
    Preset {
        name: "exact-4",
        summary: "4 windows, exact edges by rays",
        advice: "For exact, smooth edges at about the cost of two more look-ups and some rays. It needs the engine's \
                 triangles (shadowfit-rays) and a depth pre-pass; without them it equals windows-4.",
        make: || Technique::default().with_edges(Edges::Traced { samples: Edges::USUAL_SAMPLES }),
    },
    Preset {
        name: Preset::RECOMMENDED,
        summary: "4 windows, placed by the last frame's visible demand",
        advice: "The one to start with: as sharp as any other four maps, edges hardly ever crawl, and maps can be \
                 cached from frame to frame. Pass it the depth buffer of the last frame (shadowfit-wgpu has a pass \
                 for that).",
        make: Technique::default,
    },
];

impl Technique {
    /// Returns the technique of the preset with this name, or `None` if [`PRESETS`] has no such name.
    pub fn preset(name: &str) -> Option<Self> {
        PRESETS.iter().find(|preset| preset.name == name).map(Preset::technique)
    }
}

fn single(kind: FitKind) -> Technique {
    Technique::default().with_maps(SingleMap { shape: Shape::new(kind), stabilise: Stabilise::Off })
}

fn several(kind: FitKind, splits: SplitScheme, stabilise: Stabilise) -> Technique {
    Technique::default().with_maps(Cascades { shape: Shape::new(kind), splits, stabilise, ..Cascades::default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_say_the_number_of_maps() {
        for (index, preset) in PRESETS.iter().enumerate() {
            assert!(PRESETS[..index].iter().all(|other| other.name != preset.name), "{}", preset.name);
            let count = preset.name.rsplit('-').next().and_then(|count| count.parse().ok());
            assert_eq!(count, Some(preset.technique().maps.count()), "{}", preset.name);
        }
        assert_eq!(Technique::preset(Preset::RECOMMENDED), Some(Technique::default()));
        assert_eq!(Technique::preset("calm"), None);
    }
}
