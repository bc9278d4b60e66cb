//! The rows of soft filters: how wide penumbrae are.

use crate::tool::Settings;
use crate::{Choice, ChoiceOption, Group, Kind, Number, Optional, Parameter};
use shadowfit::settings::{SoftRadius, Softness};
use shadowfit::softness::USUAL_DISTANCE;

/// Widest radius of a filter that the table allows, in texels: with it the border is less than a quarter of the smallest
/// map, and a look-up does not read too much.
const WIDEST: f64 = 32.0;

/// Widest penumbra that the table allows, in metres.
const WIDEST_METRES: f64 = 10.0;

/// Largest sun that the table allows, as an angular radius in degrees.
const LARGEST_SUN: f64 = 30.0;

/// Why the softness has no effect, or `None` where it has one.
fn for_soft_filters(s: &Settings) -> Option<&'static str> {
    let reason =
        "The filter's width is a number of texels; set Filter to a Vogel disc or to PCSS (map.filter = vogel_16).";
    (!s.technique.filter.is_soft()).then_some(reason)
}

pub(super) const MEASURE: Parameter = Parameter {
    id: "softness.measure",
    group: Group::Softness,
    label: "Width from",
    unit: "",
    help: "What the width of soft edges follows from. It is the same in the world for all maps, so that edges are as soft \
           in each of them.",
    kind: Kind::Choice(Choice {
        options: &[
            ChoiceOption {
                id: "sun_angle",
                label: "Angle of the sun",
                help: "By how large the sun looks in the sky, as in nature.",
            },
            ChoiceOption { id: "metres", label: "Metres", help: "A width that is set in metres." },
        ],
        read: |s| match s.technique.softness.radius {
            SoftRadius::SunAngle(_) => 0,
            SoftRadius::Metres(_) => 1,
        },
        write: |s, index| {
            let radius = &mut s.technique.softness.radius;
            // The width stays as it is.
            *radius = match (index, *radius) {
                (0, SoftRadius::Metres(metres)) => SoftRadius::SunAngle(libm::atanf(metres / USUAL_DISTANCE)),
                (1, SoftRadius::SunAngle(radians)) => SoftRadius::Metres(libm::tanf(radians) * USUAL_DISTANCE),
                (_, same) => same,
            };
        },
    }),
    inert: for_soft_filters,
};

pub(super) const ANGLE: Parameter = Parameter {
    id: "softness.angle",
    group: Group::Softness,
    label: "Radius of the sun",
    unit: "deg",
    help: "Half of the angle that the sun takes up in the sky: 0.27 is the real one, more is a hazy day. PCSS softens \
           edges by the distance to the caster; the Vogel discs take it to be 5 m.",
    kind: Kind::Optional(Optional {
        min: 0.0,
        max: LARGEST_SUN,
        step: 0.01,
        logarithmic: true,
        decimals: 2,
        unset: None,
        initial: 0.27,
        present: |s| matches!(s.technique.softness.radius, SoftRadius::SunAngle(_)),
        read: |s| match s.technique.softness.radius {
            SoftRadius::SunAngle(radians) => Some(f64::from(radians).to_degrees()),
            SoftRadius::Metres(_) => None,
        },
        write: |s, value| {
            if let (SoftRadius::SunAngle(radians), Some(value)) = (&mut s.technique.softness.radius, value) {
                *radians = value.to_radians() as f32;
            }
        },
    }),
    inert: |s| match s.technique.softness.radius {
        SoftRadius::SunAngle(_) => for_soft_filters(s),
        SoftRadius::Metres(_) => {
            Some("The width is set in metres; set Width from to Angle of the sun (softness.measure = sun_angle).")
        }
    },
};

pub(super) const METRES: Parameter = Parameter {
    id: "softness.metres",
    group: Group::Softness,
    label: "Radius",
    unit: "m",
    help: "How far soft edges reach to either side, across the light. With PCSS it is that of a shadow 5 m from its \
           caster, and grows with the distance.",
    kind: Kind::Optional(Optional {
        min: 0.0,
        max: WIDEST_METRES,
        step: 0.01,
        logarithmic: true,
        decimals: 3,
        unset: None,
        initial: 0.05,
        present: |s| matches!(s.technique.softness.radius, SoftRadius::Metres(_)),
        read: |s| match s.technique.softness.radius {
            SoftRadius::Metres(metres) => Some(f64::from(metres)),
            SoftRadius::SunAngle(_) => None,
        },
        write: |s, value| {
            if let (SoftRadius::Metres(metres), Some(value)) = (&mut s.technique.softness.radius, value) {
                *metres = value as f32;
            }
        },
    }),
    inert: |s| match s.technique.softness.radius {
        SoftRadius::Metres(_) => for_soft_filters(s),
        SoftRadius::SunAngle(_) => {
            Some("The width follows from the sun; set Width from to Metres (softness.measure = metres).")
        }
    },
};

pub(super) const FLOOR: Parameter = Parameter {
    id: "softness.floor",
    group: Group::Softness,
    label: "Least radius",
    unit: "texels",
    help: "Soft edges are at least this wide to either side, so that they hide the map's texels where these are coarse. \
           Raising it above the greatest radius raises that too.",
    kind: Kind::Number(Number {
        min: 0.0,
        max: WIDEST,
        step: 0.25,
        logarithmic: false,
        decimals: 2,
        read: |s| f64::from(s.technique.softness.floor),
        write: |s, value| {
            let Softness { floor, ceiling, .. } = &mut s.technique.softness;
            *floor = value as f32;
            *ceiling = ceiling.max(*floor);
        },
    }),
    inert: for_soft_filters,
};

pub(super) const CEILING: Parameter = Parameter {
    id: "softness.ceiling",
    group: Group::Softness,
    label: "Greatest radius",
    unit: "texels",
    help: "Soft edges are at most this wide to either side. Maps have no finer texels than that allows, and as many more \
           texels stay free at their borders: a large one looks smoother, and needs more look-ups.",
    kind: Kind::Number(Number {
        min: 1.0,
        max: WIDEST,
        step: 0.5,
        logarithmic: false,
        decimals: 2,
        read: |s| f64::from(s.technique.softness.ceiling),
        write: |s, value| {
            let Softness { floor, ceiling, .. } = &mut s.technique.softness;
            *ceiling = value as f32;
            *floor = floor.min(*ceiling);
        },
    }),
    inert: for_soft_filters,
};
