//! The rows of soft filters: how wide penumbrae are.

use shadowfit::settings::{SoftRadius, Softness};

use crate::field::{Field, Plain as _, code, field};
use crate::tool::Settings;
use crate::{ChoiceOption, Group, Kind, Number, Parameter, Value};

/// Widest radius of a filter that the table allows, in texels: with it the border is less than a quarter of the smallest
/// map, and a look-up does not read too much.
const WIDEST: f64 = 32.0;

/// Widest penumbra that the table allows, in metres.
const WIDEST_METRES: f64 = 10.0;

/// Largest sun that the table allows, as an angular radius in degrees.
const LARGEST_SUN: f64 = 30.0;

/// In the order that they are shown.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "softness.measure",
        group: Group::Softness,
        label: "Width from",
        unit: "",
        help: "What the width of soft edges follows from. It is the same in the world for all maps, so that edges are as soft \
           in each of them.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "sun_angle",
                label: "Angle of the sun",
                help: "By how large the sun looks in the sky, as in nature.",
            },
            ChoiceOption { id: "metres", label: "Metres", help: "A width that is set in metres." },
        ]),
        field: Field {
            get: |s| match s.technique.softness.radius {
                SoftRadius::SunAngle(_) => Some(Value::Option(0)),
                SoftRadius::Metres(_) => Some(Value::Option(1)),
            },
            set: |s, value| {
                let radius = &mut s.technique.softness.radius;
                // The width stays as it is, unless it is larger than the largest sun's.
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
        help: "Half of the angle that the sun takes up in the sky: 0.27 is the real one, more is a hazy day. PCSS softens \
           edges by the distance to the caster; the Vogel discs take it to be 5 m.",
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
        help: "How far soft edges reach to either side, across the light. With PCSS it is that of a shadow 5 m from its \
           caster, and grows with the distance.",
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
                Some("The width follows from the sun; set Width from to Metres (softness.measure = metres).")
            }
        },
    },
    Parameter {
        id: "softness.floor",
        group: Group::Softness,
        label: "Least radius",
        unit: "texels",
        help: "Soft edges are at least this wide to either side, so that they hide the map's texels where these are coarse. \
           Raising it above the greatest radius raises that too.",
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
        label: "Greatest radius",
        unit: "texels",
        help: "Soft edges are at most this wide to either side. Maps have no finer texels than that allows, and as many more \
           texels stay free at their borders: a large one looks smoother, and needs more look-ups.",
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

/// Why the softness has no effect, or `None` where it has one.
fn for_soft_filters(s: &Settings) -> Option<&'static str> {
    let reason =
        "The filter's width is a number of texels; set Filter to a Vogel disc or to PCSS (map.filter = vogel_16).";
    (!s.technique.filter.is_soft()).then_some(reason)
}
