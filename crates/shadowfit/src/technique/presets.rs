//! Techniques by name, each with a line that says when to take it.

use crate::technique::settings::{Edges, FitKind, Shape, SplitScheme, Stabilise};
use crate::technique::{Cascades, SingleMap, Technique, Windows};

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
    /// Name of the preset that is [`Technique::default`].
    pub const RECOMMENDED: &str = "windows-4";

    /// The technique.
    pub fn technique(&self) -> Technique {
        (self.make)()
    }
}

/// All presets, from the plainest fit to the recommended one.
pub static PRESETS: [Preset; 10] = [
    Preset {
        name: "xna-1",
        summary: "one map by the XNA sample's rule",
        advice: "Only to compare with the sample: it loses casters outside the view.",
        make: || single(FitKind::XnaSample),
    },
    Preset {
        name: "aabb-1",
        summary: "one map, box of the frustum in the light's axes",
        advice: "For a small view of which nothing is known, where the map must not turn with the camera.",
        make: || single(FitKind::FrustumAabb),
    },
    Preset {
        name: "oriented-1",
        summary: "one map, least rectangle around the frustum",
        advice: "For a small view of which nothing is known: the finest texels that one map can have there.",
        make: || single(FitKind::Oriented),
    },
    Preset {
        name: "focused-1",
        summary: "one map, least rectangle around the boxes in view",
        advice: "For a turntable, a board, a room: one map, and boxes of the objects at hand, or of clusters of their \
                 triangles where they are large.",
        make: || single(FitKind::Focused),
    },
    Preset {
        name: "stable-4",
        summary: "4 maps around spheres on a fixed grid of texels, splits from the boxes and held",
        advice: "Where edges must stand still, and coarser shadows are a fair price: they move only in the frame in which \
                 the splits are chosen again, once in a while on a way through very different views.",
        make: || several(FitKind::Sphere, SplitScheme::FromBoxes, Stabilise::Snap { max_oversize: 4.0 }),
    },
    Preset {
        name: "focused-4",
        summary: "4 maps, least rectangles around the boxes in view, splits from what the frame before showed",
        advice: "For pictures that stand alone, and the fewest wrong pixels that four maps have in each frame; edges crawl \
                 when the camera moves. Splits come from the boxes where no frame before is known.",
        make: || several(FitKind::Focused, SplitScheme::FromHistogram, Stabilise::Off),
    },
    Preset {
        name: "calm-4",
        summary: "as focused-4, maps held while they serve and moved by whole texels",
        advice: "Where maps must be cascades: nearly as still as stable-4, and sharper. An engine that reads maps by \
                 view depth sets Selection to By view depth.",
        make: || several(FitKind::Focused, SplitScheme::FromHistogram, Stabilise::default()),
    },
    Preset {
        name: "windows-8",
        summary: "8 windows, placed by what the frame before showed",
        advice: "The sharpest, for twice the passes and the memory of windows-4.",
        make: || Technique::default().with_maps(Windows::default().with_count(8)),
    },
    Preset {
        name: "exact-4",
        summary: "4 windows, edges traced where the maps are not sure",
        advice: "For exact, smooth edges at about the cost of two more look-ups and some rays. It needs the engine's \
                 triangles (shadowfit-rays) and a depth pre-pass; without them it is windows-4.",
        make: || Technique::default().with_edges(Edges::Traced { samples: Edges::USUAL_SAMPLES }),
    },
    Preset {
        name: Preset::RECOMMENDED,
        summary: "4 windows, placed by what the frame before showed",
        advice: "The one to begin with: as sharp as the sharpest of the others, edges hardly ever crawl, and maps can be \
                 kept from frame to frame instead of drawn anew. Give it the depth buffer of the frame before \
                 (shadowfit-wgpu has a pass for that).",
        make: Technique::default,
    },
];

impl Technique {
    /// The technique of the preset with this name, or `None` where [`PRESETS`] has no such name.
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
