//! The rows for stabilisation.

use shadowfit::settings::{Hysteresis, Stabilise};
use shadowfit::{Cascades, Maps, SingleMap, Windows};

use crate::field::{Field, code, field};
use crate::tool::Settings;
use crate::{ChoiceOption, Group, Kind, Number, Parameter, Value};

/// A number of held cascades or of one held map.
macro_rules! held {
    ($part:ident) => {
        field!(technique.maps, Maps::Cascades(Cascades { stabilise: Stabilise::Hysteresis(hold), .. })
            | Maps::Single(SingleMap { stabilise: Stabilise::Hysteresis(hold), .. }) => hold.$part)
    };
}

/// Rows in display order.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "stabilise.mode",
        group: Group::Stabilise,
        label: "Stabilise",
        unit: "",
        help: "Whether maps keep their place while the camera moves. Maps that are fitted in each frame have the \
           finest texels, but their shadow edges crawl.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "hysteresis",
                label: "Hold",
                help: "Keeps a map, moved only by whole texels, until it no longer covers the visible area.",
            },
            ChoiceOption {
                id: "snap",
                label: "Snap to texels",
                help: "Maps move by whole texels of a grid that is fixed to the world. Edges still crawl when the \
                       camera turns, except with the stable sphere.",
            },
            ChoiceOption { id: "off", label: "Off", help: "Maps are fitted again in each frame." },
        ]),
        field: Field {
            get: |s| {
                Some(Value::Option(match stabilise(s)? {
                    Stabilise::Hysteresis(_) => 0,
                    Stabilise::Snap { .. } => 1,
                    Stabilise::Off => 2,
                }))
            },
            set: |s, value| {
                let Some(now) = stabilise(s) else { return };
                let max_oversize = now.max_oversize();
                s.technique.maps = s.technique.maps.with_stabilise(match (value, now) {
                    (Value::Option(0), Stabilise::Hysteresis(_)) => now,
                    (Value::Option(0), _) => {
                        Stabilise::Hysteresis(Hysteresis::default().with_max_oversize(max_oversize))
                    }
                    (Value::Option(1), _) => Stabilise::Snap { max_oversize },
                    _ => Stabilise::Off,
                });
            },
            code: code!(maps),
            is_of_variant: true,
        },
        inert: windows_are_still,
    },
    Parameter {
        id: "stabilise.margin",
        group: Group::Stabilise,
        label: "Margin",
        unit: "",
        help: "Free space around the area that a new map must cover, as a share of its width, so that the map can be \
           held longer. More space makes texels coarser.",
        kind: Kind::Number(Number { min: 0.0, max: 10.0, step: 0.01, logarithmic: true, decimals: 2, unset: None }),
        field: held!(margin),
        inert: only_held,
    },
    Parameter {
        id: "stabilise.growth",
        group: Group::Stabilise,
        label: "Growth",
        unit: "×",
        help: "Limit on the enlargement of a new map that looks ahead: the map also covers the area that the camera \
           will see if its motion continues. A larger map is held longer, but has coarser texels.",
        kind: Kind::Number(Number { min: 1.0, max: 100.0, step: 0.05, logarithmic: true, decimals: 2, unset: None }),
        field: held!(max_growth),
        inert: only_held,
    },
    Parameter {
        id: "stabilise.max_oversize",
        group: Group::Stabilise,
        label: "Oversize",
        unit: "×",
        help: "A held map is fitted again once its texels are larger than necessary by this factor. This limit also \
           applies to held splits and to the depth ranges of windows. Lower is sharper, higher is more stable.",
        kind: Kind::Number(Number { min: 1.0, max: 100.0, step: 0.05, logarithmic: true, decimals: 2, unset: None }),
        field: field!(technique.maps, Maps::Windows(Windows { max_depth_oversize: max_oversize, .. })
            | Maps::Cascades(Cascades {
                stabilise: Stabilise::Snap { max_oversize } | Stabilise::Hysteresis(Hysteresis { max_oversize, .. }), ..
            })
            | Maps::Single(SingleMap {
                stabilise: Stabilise::Snap { max_oversize } | Stabilise::Hysteresis(Hysteresis { max_oversize, .. }), ..
            }) => max_oversize),
        inert: |s| {
            (stabilise(s) == Some(Stabilise::Off)).then_some("Nothing is held between frames; turn on Stabilise.")
        },
    },
    Parameter {
        id: "stabilise.horizon",
        group: Group::Stabilise,
        label: "Horizon",
        unit: "frames",
        help: "Greatest number of frames that a new map looks ahead along the camera's motion.",
        kind: Kind::Number(Number { min: 0.0, max: 1_000.0, step: 1.0, logarithmic: true, decimals: 0, unset: None }),
        field: held!(look_ahead),
        inert: only_held,
    },
];

/// Returns the stabilisation of cascades or of a single map; `None` for windows.
fn stabilise(s: &Settings) -> Option<Stabilise> {
    match s.technique.maps {
        Maps::Windows(_) => None,
        Maps::Cascades(Cascades { stabilise, .. }) | Maps::Single(SingleMap { stabilise, .. }) => Some(stabilise),
    }
}

fn only_held(s: &Settings) -> Option<&'static str> {
    let is_held = matches!(stabilise(s), Some(Stabilise::Hysteresis(_)));
    windows_are_still(s).or_else(|| (!is_held).then_some("Only held maps use this; set Stabilise to Hold."))
}

fn windows_are_still(s: &Settings) -> Option<&'static str> {
    matches!(s.technique.maps, Maps::Windows(_))
        .then_some("Windows are stable without this setting; choose another fit.")
}
