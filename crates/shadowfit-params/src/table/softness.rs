//! The rows for the penumbra width of soft filters.

use shadowfit::settings::{SoftRadius, Softness};

use crate::field::{Field, Plain as _, code, field};
use crate::tool::Settings;
use crate::{ChoiceOption, Group, Kind, Number, Parameter, Value};

/// Greatest radius of a filter that the table allows, in texels. With it the border stays below a quarter of
/// the smallest map, and a look-up does not read too many texels.
const WIDEST: f64 = 32.0;

/// Widest penumbra that the table allows, in metres.
const WIDEST_METRES: f64 = 10.0;

/// Largest sun that the table allows, as an angular radius in degrees.
const LARGEST_SUN: f64 = 30.0;

/// Rows in display order.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "softness.measure",
        group: Group::Softness,
        label: "Width from",
        unit: "",
        help: "How to set the width of soft edges. All maps use the same width in the world, so that edges are equally \
           soft in each of them.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "sun_angle",
                label: "Angle of the sun",
                help: "From the apparent size of the sun, as in nature.",
            },
            ChoiceOption { id: "metres", label: "Metres", help: "A fixed width in metres." },
        ]),
        field: Field {
            get: |s| match s.technique.softness.radius {
                SoftRadius::SunAngle(_) => Some(Value::Option(0)),
                SoftRadius::Metres(_) => Some(Value::Option(1)),
            },
            set: |s, value| {
                let radius = &mut s.technique.softness.radius;
                // The width is kept, unless it exceeds the width for the largest sun.
                *radius = match (value, *radius) {
                    (Value::Option(0), SoftRadius::Metres(metres)) => {
                        let radians = libm::atanf(metres / Softness::USUAL_DISTANCE);
                        SoftRadius::SunAngle(radians.min((LARGEST_SUN as f32).to_radians()))
                    }
                    (Value::Option(1), SoftRadius::SunAngle(radians)) => {
                        SoftRadius::Metres(libm::tanf(radians) * Softness::USUAL_DISTANCE)
                    }
                    (_, same) => same,
                };
            },
            code: code!(softness.radius),
            is_of_variant: false,
        },
        inert: for_soft_filters,
    },
    Parameter {
        id: "softness.angle",
        group: Group::Softness,
        label: "Radius of the sun",
        unit: "deg",
        help: "Half of the angle that the sun takes up in the sky: 0.27 for the real sun, more for a hazy day. PCSS \
           scales the width of edges with the distance to the caster; Vogel discs assume 5 m.",
        kind: Kind::Number(Number {
            min: 0.0,
            max: LARGEST_SUN,
            step: 0.01,
            logarithmic: true,
            decimals: 2,
            unset: None,
        }),
        field: field!(technique.softness.radius, SoftRadius::SunAngle(radians) => radians),
        inert: |s| match s.technique.softness.radius {
            SoftRadius::SunAngle(_) => for_soft_filters(s),
            SoftRadius::Metres(_) => {
                Some("The width is set in metres; set Width from to Angle of the sun (softness.measure = sun_angle).")
            }
        },
    },
    Parameter {
        id: "softness.metres",
        group: Group::Softness,
        label: "Radius",
        unit: "m",
        help: "Distance that soft edges reach to either side, perpendicular to the light. With PCSS this is the \
           distance for a shadow 5 m from its caster, and it grows with the distance to the caster.",
        kind: Kind::Number(Number {
            min: 0.0,
            max: WIDEST_METRES,
            step: 0.01,
            logarithmic: true,
            decimals: 3,
            unset: None,
        }),
        field: field!(technique.softness.radius, SoftRadius::Metres(metres) => metres),
        inert: |s| match s.technique.softness.radius {
            SoftRadius::Metres(_) => for_soft_filters(s),
            SoftRadius::SunAngle(_) => {
                Some("The width comes from the sun; set Width from to Metres (softness.measure = metres).")
            }
        },
    },
    Parameter {
        id: "softness.floor",
        group: Group::Softness,
        label: "Minimum radius",
        unit: "texels",
        help: "Soft edges are at least this wide to either side, which hides the texels of coarse maps. Raising it \
           above the greatest radius raises that too.",
        kind: Kind::Number(Number { min: 0.0, max: WIDEST, step: 0.25, logarithmic: false, decimals: 2, unset: None }),
        field: Field {
            set: |s, value| {
                let Softness { floor, ceiling, .. } = &mut s.technique.softness;
                floor.assign(value);
                *ceiling = ceiling.max(*floor);
            },
            ..field!(technique.softness.floor)
        },
        inert: for_soft_filters,
    },
    Parameter {
        id: "softness.ceiling",
        group: Group::Softness,
        label: "Maximum radius",
        unit: "texels",
        help: "Soft edges are at most this wide to either side: texels are never so fine that an edge would need more \
           of them, and maps keep this many texels free at their borders. A large value looks smoother and needs more \
           look-ups.",
        kind: Kind::Number(Number { min: 1.0, max: WIDEST, step: 0.5, logarithmic: false, decimals: 2, unset: None }),
        field: Field {
            set: |s, value| {
                let Softness { floor, ceiling, .. } = &mut s.technique.softness;
                ceiling.assign(value);
                *floor = floor.min(*ceiling);
            },
            ..field!(technique.softness.ceiling)
        },
        inert: for_soft_filters,
    },
];

/// Returns why the softness has no effect, or `None` if it has one.
fn for_soft_filters(s: &Settings) -> Option<&'static str> {
    let reason =
        "This filter has a fixed width in texels; set Filter to a Vogel disc or to PCSS (map.filter = vogel_16).";
    (!s.technique.filter.is_soft()).then_some(reason)
}
