//! The rows of the biases.

use shadowfit::settings::BiasSettings;

use super::always_active;
use crate::field::field;
use crate::{Group, Kind, Number, Parameter};

/// Rows in display order.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "bias.constant",
        group: Group::Bias,
        label: "Constant",
        unit: "texels",
        help: "Moves the compared depth toward the light by this many texel widths. A small value hides the rounding \
           of stored depths. If Receiver plane leaves acne in creases or on tightly curved parts, raise it to about 1.",
        kind: Kind::Number(Number { min: 0.0, max: 64.0, step: 0.05, logarithmic: true, decimals: 2, unset: None }),
        field: field!(technique.bias.constant),
        inert: always_active,
    },
    Parameter {
        id: "bias.slope",
        group: Group::Bias,
        label: "Slope-scaled",
        unit: "texels",
        help: "Moves the compared depth toward the light by this many texel widths times the tangent of the angle \
           between surface normal and light. Reduces acne on slopes in shaders without a receiver-plane bias. Too much \
           lets light leak under casters (peter-panning).",
        kind: Kind::Number(Number { min: 0.0, max: 16.0, step: 0.05, logarithmic: true, decimals: 2, unset: None }),
        field: field!(technique.bias.slope),
        inert: always_active,
    },
    Parameter {
        id: "bias.normal_offset",
        group: Group::Bias,
        label: "Normal offset",
        unit: "texels",
        help: "Offsets the look-up position along the surface normal, farther at grazing light. Cures acne in shaders \
           without a receiver-plane bias: 0.71 texels are enough for the point filter, 1.42 for 2×2, 2.83 for 3×3, \
           4.25 for 5×5 and 5.66 for 7×7, on any slope.",
        kind: Kind::Number(Number { min: 0.0, max: 16.0, step: 0.05, logarithmic: true, decimals: 2, unset: None }),
        field: field!(technique.bias.normal_offset),
        inert: always_active,
    },
    Parameter {
        id: "bias.receiver_plane",
        group: Group::Bias,
        label: "Receiver plane",
        unit: "texels",
        help: "Compares each texel with the depth of the receiver's own plane at that texel, moved toward the light by \
           the plane's height change over this many texels. Removes acne on any slope and leaks far less light than \
           the other biases: 0.51 is enough for the point filter and 1.01 for all others. 0 turns it off.",
        kind: Kind::Number(Number { min: 0.0, max: 16.0, step: 0.05, logarithmic: true, decimals: 2, unset: None }),
        field: field!(technique.bias.receiver_plane),
        inert: always_active,
    },
    Parameter {
        id: "bias.depth_steps",
        group: Group::Bias,
        label: "Depth steps",
        unit: "steps",
        help: "Minimum bias, in multiples of the rounding error: a step of the map's format, plus the rounding of \
           positions in deep maps and large triangles. 1 removes the bands that rounding causes; more only helps if \
           the hardware rounds badly.",
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
