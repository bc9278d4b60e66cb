//! The rows of the biases.

use super::always_active;
use crate::params::{Group, Kind, Number, Parameter};

pub(super) const CONSTANT: Parameter = Parameter {
    id: "bias.constant",
    group: Group::Bias,
    label: "Constant",
    unit: "texels",
    help: "Moves the compared depth toward the light by the same amount everywhere. A little hides the \
           rounding of stored depths; raise it against acne on surfaces that face the light.",
    kind: Kind::Number(Number {
        min: 0.0,
        max: 64.0,
        step: 0.05,
        logarithmic: true,
        decimals: 2,
        read: |s| f64::from(s.technique.bias.constant),
        write: |s, value| s.technique.bias.constant = value as f32,
    }),
    inert: always_active,
};

pub(super) const SLOPE: Parameter = Parameter {
    id: "bias.slope",
    group: Group::Bias,
    label: "Slope-scaled",
    unit: "texels",
    help: "Depth bias that grows with the tangent of the angle between surface and light. Raise it against \
           acne on slopes; too much lets light leak under casters (peter-panning).",
    kind: Kind::Number(Number {
        min: 0.0,
        max: 16.0,
        step: 0.05,
        logarithmic: true,
        decimals: 2,
        read: |s| f64::from(s.technique.bias.slope),
        write: |s, value| s.technique.bias.slope = value as f32,
    }),
    inert: always_active,
};

pub(super) const NORMAL_OFFSET: Parameter = Parameter {
    id: "bias.normal_offset",
    group: Group::Bias,
    label: "Normal offset",
    unit: "texels",
    help: "Looks the shadow up a little above the surface, along its normal and more at grazing light. The cure for \
           acne where shaders know no receiver plane: 0.71 texels clear the point filter, 1.42 the 2×2 one, 2.83 and \
           4.24 those of 3×3 and 5×5, on any slope.",
    kind: Kind::Number(Number {
        min: 0.0,
        max: 16.0,
        step: 0.05,
        logarithmic: true,
        decimals: 2,
        read: |s| f64::from(s.technique.bias.normal_offset),
        write: |s, value| s.technique.bias.normal_offset = value as f32,
    }),
    inert: always_active,
};

pub(super) const RECEIVER_PLANE: Parameter = Parameter {
    id: "bias.receiver_plane",
    group: Group::Bias,
    label: "Receiver plane",
    unit: "texels",
    help: "Compares each texel with the depth of the lit surface's own plane there, and moves that toward the light by \
           the plane's rise over so many texels. Clears any slope with far less leaking than the others: 0.5 is enough \
           for the point filter and 1 for the rest. 0 turns it off.",
    kind: Kind::Number(Number {
        min: 0.0,
        max: 16.0,
        step: 0.05,
        logarithmic: true,
        decimals: 2,
        read: |s| f64::from(s.technique.bias.receiver_plane),
        write: |s, value| s.technique.bias.receiver_plane = value as f32,
    }),
    inert: always_active,
};
