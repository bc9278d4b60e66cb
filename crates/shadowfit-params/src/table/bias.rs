//! The rows of the biases.

use shadowfit::settings::BiasSettings;

use super::always_active;
use crate::field::field;
use crate::{Group, Kind, Number, Parameter};

/// In the order that they are shown.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "bias.constant",
        group: Group::Bias,
        label: "Constant",
        unit: "texels",
        help: "Moves the compared depth toward the light by the same amount everywhere. A little hides the \
           rounding of stored depths; raise it against acne on surfaces that face the light.",
        kind: Kind::Number(Number { min: 0.0, max: 64.0, step: 0.05, logarithmic: true, decimals: 2, unset: None }),
        field: field!(technique.bias.constant),
        inert: always_active,
    },
    Parameter {
        id: "bias.slope",
        group: Group::Bias,
        label: "Slope-scaled",
        unit: "texels",
        help: "Depth bias that grows with the tangent of the angle between surface and light. Raise it against \
           acne on slopes; too much lets light leak under casters (peter-panning).",
        kind: Kind::Number(Number { min: 0.0, max: 16.0, step: 0.05, logarithmic: true, decimals: 2, unset: None }),
        field: field!(technique.bias.slope),
        inert: always_active,
    },
    Parameter {
        id: "bias.normal_offset",
        group: Group::Bias,
        label: "Normal offset",
        unit: "texels",
        help: "Looks the shadow up a little above the surface, along its normal, and higher where the light grazes. The \
           cure for acne in shaders that have no receiver plane: 0.71 texels are enough for the point filter, 1.42 for \
           2×2, 2.83 for 3×3, 4.24 for 5×5 and 5.66 for 7×7, on any slope.",
        kind: Kind::Number(Number { min: 0.0, max: 16.0, step: 0.05, logarithmic: true, decimals: 2, unset: None }),
        field: field!(technique.bias.normal_offset),
        inert: always_active,
    },
    Parameter {
        id: "bias.receiver_plane",
        group: Group::Bias,
        label: "Receiver plane",
        unit: "texels",
        help: "Compares each texel with the depth that the lit surface's own plane has there, moved toward the light by \
           what the plane rises over this many texels. Clears any slope and leaks far less light than the other biases: \
           0.5 is enough for the point filter and 1 for the rest. 0 turns it off.",
        kind: Kind::Number(Number { min: 0.0, max: 16.0, step: 0.05, logarithmic: true, decimals: 2, unset: None }),
        field: field!(technique.bias.receiver_plane),
        inert: always_active,
    },
    Parameter {
        id: "bias.depth_steps",
        group: Group::Bias,
        label: "Depth steps",
        unit: "steps",
        help: "Adds as much bias as rounding needs, this many times: a step of the map's format, and the rounding of \
           positions where maps are deep or triangles large. 1 clears the bands that rounding leaves; more only helps \
           where hardware rounds badly.",
        kind: Kind::Number(Number {
            min: 0.0,
            max: BiasSettings::MAX_DEPTH_STEPS as f64,
            step: 0.1,
            logarithmic: false,
            decimals: 2,
            unset: None,
        }),
        field: field!(technique.bias.depth_steps),
        inert: always_active,
    },
];
