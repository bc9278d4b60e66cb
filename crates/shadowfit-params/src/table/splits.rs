//! The rows for the number of maps, the splits between them, and the map that a point reads.

use shadowfit::settings::{MAX_MAPS, MapSelection, SplitScheme};
use shadowfit::{Cascades, Maps, Windows};

use super::always_active;
use crate::field::{Field, Plain as _, code, field};
use crate::tool::Settings;
use crate::{ChoiceOption, Group, Kind, Number, Parameter, Value};

/// Initial λ of the practical splits, common in other engines.
const USUAL_LAMBDA: f32 = 0.5;

/// Initial view depths of manual splits, in metres: each is twice the previous one.
const USUAL_SPLITS: [f32; MAX_MAPS - 1] = [5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 320.0];

/// Rows in display order.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "splits.count",
        group: Group::Splits,
        label: "Maps",
        unit: "",
        help: "Number of shadow maps for the view. Each additional map makes shadows sharper, and costs its memory and \
           draw time.",
        kind: Kind::Number(Number {
            min: 1.0,
            max: MAX_MAPS as f64,
            step: 1.0,
            logarithmic: false,
            decimals: 0,
            unset: None,
        }),
        field: Field {
            get: |s| Some(s.technique.maps.count().value()),
            set: |s, value| {
                let mut count = s.technique.maps.count();
                count.assign(value);
                s.technique.maps = s.technique.maps.with_count(count);
            },
            code: code!(maps),
            is_of_variant: false,
        },
        inert: always_active,
    },
    Parameter {
        id: "splits.scheme",
        group: Group::Splits,
        label: "Splits",
        unit: "",
        help: "Where one map ends and the next begins. The first two options adapt to the scene and make its shadows \
           evenly sharp. The others divide the shadow distance by a formula or by hand.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "from_histogram",
                label: "From visible demand",
                help: "By the view depths of the visible points of a recent frame. If these are unknown, like From \
                       boxes.",
            },
            ChoiceOption { id: "from_boxes", label: "From boxes", help: "By the view depths of the scene's boxes." },
            ChoiceOption {
                id: "practical",
                label: "Practical",
                help: "A mixture of logarithmic and uniform splits, weighted by lambda (parallel-split shadow maps).",
            },
            ChoiceOption {
                id: "logarithmic",
                label: "Logarithmic",
                help: "Each map ends at the same multiple of its start, so that most maps lie close to the camera.",
            },
            ChoiceOption { id: "uniform", label: "Uniform", help: "All maps have equally long ranges." },
            ChoiceOption { id: "manual", label: "Manual", help: "At distances that you set one by one." },
        ]),
        field: Field {
            get: |s| {
                Some(Value::Option(match cascades(s)?.splits {
                    SplitScheme::FromHistogram => 0,
                    SplitScheme::FromBoxes => 1,
                    SplitScheme::Practical(_) => 2,
                    SplitScheme::Logarithmic => 3,
                    SplitScheme::Uniform => 4,
                    SplitScheme::Manual(_) => 5,
                }))
            },
            set: |s, value| {
                let Maps::Cascades(Cascades { splits, .. }) = &mut s.technique.maps else { return };
                *splits = match (value, *splits) {
                    (Value::Option(0), _) => SplitScheme::FromHistogram,
                    (Value::Option(1), _) => SplitScheme::FromBoxes,
                    (Value::Option(2), SplitScheme::Practical(lambda)) => SplitScheme::Practical(lambda),
                    (Value::Option(2), _) => SplitScheme::Practical(USUAL_LAMBDA),
                    (Value::Option(3), _) => SplitScheme::Logarithmic,
                    (Value::Option(4), _) => SplitScheme::Uniform,
                    (_, SplitScheme::Manual(splits)) => SplitScheme::Manual(splits),
                    _ => SplitScheme::Manual(USUAL_SPLITS),
                };
            },
            code: code!(maps),
            is_of_variant: true,
        },
        inert: no_splits,
    },
    Parameter {
        id: "splits.lambda",
        group: Group::Splits,
        label: "Lambda",
        unit: "",
        help: "Weight of the logarithmic splits in the mixture: 1 puts most maps close to the camera, 0 spreads them \
           evenly. 0.5 is a good start.",
        kind: Kind::Number(Number { min: 0.0, max: 1.0, step: 0.05, logarithmic: false, decimals: 2, unset: None }),
        field: field!(technique.maps, Maps::Cascades(Cascades { splits: SplitScheme::Practical(lambda), .. }) => lambda),
        inert: |s| match cascades(s).map(|cascades| cascades.splits) {
            None => no_splits(s),
            Some(SplitScheme::Practical(_)) => None,
            _ => Some("Only practical splits have a lambda; set Splits to Practical (splits.scheme = practical)."),
        },
    },
    manual::<0>("splits.manual_1", "Map 1 ends"),
    manual::<1>("splits.manual_2", "Map 2 ends"),
    manual::<2>("splits.manual_3", "Map 3 ends"),
    manual::<3>("splits.manual_4", "Map 4 ends"),
    manual::<4>("splits.manual_5", "Map 5 ends"),
    manual::<5>("splits.manual_6", "Map 6 ends"),
    manual::<6>("splits.manual_7", "Map 7 ends"),
    Parameter {
        id: "splits.selection",
        group: Group::Splits,
        label: "Selection",
        unit: "",
        help: "The map that a point reads.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "coverage",
                label: "By coverage",
                help: "The finest map that covers the point, at any distance: sharper, at no cost.",
            },
            ChoiceOption {
                id: "view_depth",
                label: "By view depth",
                help: "The map for the point's view depth, as in other engines.",
            },
        ]),
        field: Field {
            get: |s| Some(Value::Option(usize::from(!cascades(s)?.selection.is_by_coverage()))),
            set: |s, value| {
                let Maps::Cascades(Cascades { selection, .. }) = &mut s.technique.maps else { return };
                *selection = match (value, *selection) {
                    (Value::Option(0), MapSelection::ViewDepth { .. }) => MapSelection::default(),
                    (Value::Option(1), MapSelection::Coverage { .. }) => MapSelection::ViewDepth { overlap: 0.0 },
                    (_, selection) => selection,
                };
            },
            code: code!(maps),
            is_of_variant: true,
        },
        inert: |s| match s.technique.maps {
            Maps::Single(_) => Some("A single map leaves nothing to select; raise the number of maps."),
            Maps::Windows(_) => Some("Windows are always read by coverage; choose another fit."),
            Maps::Cascades(_) => None,
        },
    },
    Parameter {
        id: "splits.blend",
        group: Group::Splits,
        label: "Blend",
        unit: "texels",
        help: "Width of the band inside a map's border in which the shader blends into the next coarser map. It hides \
           the line between two maps; 0 turns it off.",
        kind: Kind::Number(Number {
            min: 0.0,
            max: MapSelection::MAX_BLEND as f64,
            step: 1.0,
            logarithmic: false,
            decimals: 1,
            unset: None,
        }),
        field: field!(technique.maps, Maps::Windows(Windows { blend, .. })
            | Maps::Cascades(Cascades { selection: MapSelection::Coverage { blend }, .. }) => blend),
        inert: |s| match s.technique.maps.selection() {
            _ if s.technique.maps.count() < 2 => Some("One map has nothing to blend into; raise the number of maps."),
            MapSelection::Coverage { .. } => None,
            MapSelection::ViewDepth { .. } => Some(
                "Maps read by view depth are blended over the overlap; set Selection to By coverage (splits.selection \
             = coverage).",
            ),
        },
    },
    Parameter {
        id: "splits.overlap",
        group: Group::Splits,
        label: "Overlap",
        unit: "",
        help: "Share of each map's range of view depths that the next map covers too, so that the shader can blend \
           between them. It hides the line between two maps, and costs a little sharpness.",
        kind: Kind::Number(Number { min: 0.0, max: 1.0, step: 0.05, logarithmic: false, decimals: 2, unset: None }),
        field: field!(technique.maps, Maps::Cascades(Cascades { selection: MapSelection::ViewDepth { overlap }, .. }) => overlap),
        inert: |s| match s.technique.maps {
            Maps::Windows(_) => Some("Windows are blended near their borders, by Blend; choose another fit."),
            Maps::Single(_) => Some("A single map has no map to overlap with; raise the number of maps."),
            Maps::Cascades(Cascades { selection: MapSelection::Coverage { .. }, .. }) => Some(
                "Maps read by coverage are blended near their borders; set Selection to By view depth \
             (splits.selection = view_depth).",
            ),
            Maps::Cascades(_) => None,
        },
    },
];

/// Returns the row for the view depth at which a map ends.
const fn manual<const MAP: usize>(id: &'static str, label: &'static str) -> Parameter {
    Parameter {
        id,
        group: Group::Splits,
        label,
        unit: "m",
        help: "View depth at which this map ends and the next one begins. Each must be greater than the previous one.",
        kind: Kind::Number(Number { min: 0.0, max: 100_000.0, step: 0.1, logarithmic: true, decimals: 2, unset: None }),
        field: field!(technique.maps, Maps::Cascades(Cascades { splits: SplitScheme::Manual(splits), .. }) => splits[MAP]),
        inert: |s| match cascades(s) {
            None => no_splits(s),
            Some(Cascades { splits: SplitScheme::Manual(_), count, .. }) if MAP + 1 < *count as usize => None,
            Some(Cascades { splits: SplitScheme::Manual(_), .. }) => {
                Some("This map does not exist; raise the number of maps.")
            }
            Some(_) => Some("A rule chooses the splits; set Splits to Manual (splits.scheme = manual)."),
        },
    }
}

/// Returns the cascades, or `None` for other maps.
fn cascades(s: &Settings) -> Option<&Cascades> {
    if let Maps::Cascades(cascades) = &s.technique.maps { Some(cascades) } else { None }
}

/// Returns why there are no splits, or `None` if there are some.
fn no_splits(s: &Settings) -> Option<&'static str> {
    match s.technique.maps {
        Maps::Windows(_) => Some("Windows have no splits; choose another fit."),
        Maps::Single(_) => Some("A single map has no splits; raise the number of maps."),
        Maps::Cascades(_) => None,
    }
}
