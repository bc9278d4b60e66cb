//! The rows of the stabilisation.

use shadowfit::settings::{Hysteresis, Stabilise};
use shadowfit::{Cascades, Maps, SingleMap, Windows};

use crate::field::{Field, code, field};
use crate::tool::Settings;
use crate::{ChoiceOption, Group, Kind, Number, Parameter, Value};

/// A number of kept cascades or of one kept map.
macro_rules! held {
    ($part:ident) => {
        field!(technique.maps, Maps::Cascades(Cascades { stabilise: Stabilise::Hysteresis(hold), .. })
            | Maps::Single(SingleMap { stabilise: Stabilise::Hysteresis(hold), .. }) => hold.$part)
    };
}

/// In the order that they are shown.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "stabilise.mode",
        group: Group::Stabilise,
        label: "Stabilise",
        unit: "",
        help: "Whether maps stay where they are while the camera moves. A map that is fitted anew in each frame has the \
           finest texels, but its shadow edges crawl.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "hysteresis",
                label: "Keep while it serves",
                help: "A map is kept, and moved by whole texels, until it no longer covers what it must.",
            },
            ChoiceOption {
                id: "snap",
                label: "Snap to texels",
                help: "Maps move by whole texels of a grid that is fixed to the world. Edges still crawl while the \
                       camera turns, except with the stable sphere.",
            },
            ChoiceOption { id: "off", label: "Off", help: "Maps are fitted anew in each frame." },
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
        help: "Room left around what a new map must cover, as a share of its width, so that it can be kept for longer. \
           More room makes texels coarser.",
        kind: Kind::Number(Number { min: 0.0, max: 10.0, step: 0.01, logarithmic: true, decimals: 2, unset: None }),
        field: held!(margin),
        inert: only_held,
    },
    Parameter {
        id: "stabilise.growth",
        group: Group::Stabilise,
        label: "Growth",
        unit: "×",
        help: "A new map also covers what the camera will see if it goes on moving as it does, as far ahead as makes the \
           map wider by this factor at most.",
        kind: Kind::Number(Number { min: 1.0, max: 100.0, step: 0.05, logarithmic: true, decimals: 2, unset: None }),
        field: held!(max_growth),
        inert: only_held,
    },
    Parameter {
        id: "stabilise.max_oversize",
        group: Group::Stabilise,
        label: "Oversize",
        unit: "×",
        help: "A kept map is made anew once its texels are larger than they have to be by this factor, and kept splits and \
           the depths of windows are likewise. Lower is sharper, higher is calmer.",
        kind: Kind::Number(Number { min: 1.0, max: 100.0, step: 0.05, logarithmic: true, decimals: 2, unset: None }),
        field: field!(technique.maps, Maps::Windows(Windows { max_depth_oversize: max_oversize, .. })
            | Maps::Cascades(Cascades {
                stabilise: Stabilise::Snap { max_oversize } | Stabilise::Hysteresis(Hysteresis { max_oversize, .. }), ..
            })
            | Maps::Single(SingleMap {
                stabilise: Stabilise::Snap { max_oversize } | Stabilise::Hysteresis(Hysteresis { max_oversize, .. }), ..
            }) => max_oversize),
        inert: |s| {
            (stabilise(s) == Some(Stabilise::Off)).then_some("Nothing is kept from frame to frame; turn on Stabilise.")
        },
    },
    Parameter {
        id: "stabilise.horizon",
        group: Group::Stabilise,
        label: "Horizon",
        unit: "frames",
        help: "How many frames of the camera's motion a new map looks ahead at most.",
        kind: Kind::Number(Number { min: 0.0, max: 1_000.0, step: 1.0, logarithmic: true, decimals: 0, unset: None }),
        field: held!(look_ahead),
        inert: only_held,
    },
];

/// What keeps cascades or one map stable; `None` of windows.
fn stabilise(s: &Settings) -> Option<Stabilise> {
    match s.technique.maps {
        Maps::Windows(_) => None,
        Maps::Cascades(Cascades { stabilise, .. }) | Maps::Single(SingleMap { stabilise, .. }) => Some(stabilise),
    }
}

fn only_held(s: &Settings) -> Option<&'static str> {
    let is_held = matches!(stabilise(s), Some(Stabilise::Hysteresis(_)));
    windows_are_still(s)
        .or_else(|| (!is_held).then_some("Only kept maps look ahead; set Stabilise to Keep while it serves."))
}

fn windows_are_still(s: &Settings) -> Option<&'static str> {
    matches!(s.technique.maps, Maps::Windows(_))
        .then_some("Windows stay where they are by a rule of their own; choose another fit.")
}
