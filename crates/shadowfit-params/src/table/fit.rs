//! The rows of the fit of each map.

use shadowfit::settings::{CasterPolicy, FitKind, RectangleKind, Shape};
use shadowfit::{Cascades, Maps, SingleMap};

use super::{always_active, or_greatest, pull_near, unless_greatest};
use crate::field::{Field, choice, code, field};
use crate::tool::Settings;
use crate::{ChoiceOption, Group, Kind, Number, Parameter, Unset, Value};

/// Widest border, in texels: wider than the reach of filters but for the softest, and less than a quarter of the smallest
/// map that the table allows.
const WIDEST_BORDER: f64 = 32.0;

/// The meaning of the options of the kind: the rule of cascades or of one map, or windows.
const KINDS: [Option<FitKind>; 6] = [
    Some(FitKind::Focused),
    None,
    Some(FitKind::Oriented),
    Some(FitKind::Sphere),
    Some(FitKind::FrustumAabb),
    Some(FitKind::XnaSample),
];

/// In the order that they are shown.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "fit.kind",
        group: Group::Fit,
        label: "Fit",
        unit: "",
        help: "The rule that decides where a shadow map looks. Windows are sharp and still, focused maps as sharp, the sphere \
           coarser and as still. The frustum box is the plainest; the XNA sample's rule loses casters outside the view.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "focused",
                label: "Focused on the scene",
                help: "The least rectangle around what the camera sees of the scene's boxes: the finest texels.",
            },
            ChoiceOption {
                id: "windows",
                label: "Windows",
                help: "Rectangles on a grid of texels that is fixed to the world, each where it helps most of what is \
                       visible. They demand no splits: sharp, and still when the camera moves or turns.",
            },
            ChoiceOption {
                id: "oriented",
                label: "Oriented rectangle",
                help: "The least rectangle around the camera frustum as the light sees it, turned with it.",
            },
            ChoiceOption {
                id: "sphere",
                label: "Stable sphere",
                help: "The sphere around the camera frustum on a fixed grid of texels: coarser, but no edge crawls \
                       when the camera moves or turns.",
            },
            ChoiceOption {
                id: "frustum_aabb",
                label: "Frustum box",
                help: "The box of the camera frustum in the light's axes, whether there is anything to see in it or \
                       only air.",
            },
            ChoiceOption {
                id: "xna_sample",
                label: "XNA sample",
                help: "The box of Microsoft's XNA Shadow Mapping sample (2008), with twice the depth that is \
                       needed. It loses casters outside the view.",
            },
        ]),
        field: Field {
            get: |s| {
                let kind = s.technique.maps.shape().map(|shape| shape.kind);
                KINDS.iter().position(|option| *option == kind).map(Value::Option)
            },
            set: |s, value| {
                let maps = s.technique.maps;
                let Value::Option(index) = value else { return };
                s.technique.maps = match KINDS.get(index) {
                    Some(Some(kind)) => maps.with_kind(*kind),
                    _ => maps.as_windows().into(),
                };
            },
            code: code!(maps),
            is_of_variant: false,
        },
        inert: always_active,
    },
    Parameter {
        id: "fit.rectangle",
        group: Group::Fit,
        label: "Rectangle",
        unit: "",
        help: "How the oriented and the focused fit lay their rectangle around what they cover. The least area has the \
           finest texels; a square has equal ones both ways.",
        kind: Kind::Choice(&[
            ChoiceOption { id: "minimum_area", label: "Least area", help: "Turned so that its area is least." },
            ChoiceOption {
                id: "minimum_square",
                label: "Least square",
                help: "The least square: texels are as wide as they are high.",
            },
            ChoiceOption {
                id: "axis_aligned",
                label: "Not turned",
                help: "Along the light's own axes: larger, but it turns only when the light does.",
            },
        ]),
        field: choice!(technique.maps, Maps::Cascades(Cascades { shape: Shape { rectangle: part, .. }, .. })
            | Maps::Single(SingleMap { shape: Shape { rectangle: part, .. }, .. }) => part
            in [RectangleKind::MinimumArea, RectangleKind::MinimumSquare, RectangleKind::AxisAligned]),
        inert: |s| {
            (!matches!(kind(s), Some(FitKind::Oriented | FitKind::Focused)))
                .then_some("Only the oriented and the focused fit can turn; choose one of them.")
        },
    },
    Parameter {
        id: "fit.max_texel_ratio",
        group: Group::Fit,
        label: "Longest texels",
        unit: "×",
        help: "How many times as long as wide a texel may be. Long texels blur edges more one way than the other; a low \
           limit makes blur even and texels coarser.",
        kind: Kind::Number(Number {
            min: 1.0,
            max: 64.0,
            step: 0.1,
            logarithmic: true,
            decimals: 1,
            unset: Some(Unset {
                option: ChoiceOption { id: "none", label: "no limit", help: "Texels may be of any shape." },
                initial: 2.0,
            }),
        }),
        field: Field {
            get: |s| s.technique.maps.shape().map(|shape| unless_greatest(shape.max_texel_ratio)),
            set: |s, value| {
                let maps = &mut s.technique.maps;
                if let Some(shape) = maps.shape() {
                    *maps = maps.with_shape(shape.with_max_texel_ratio(or_greatest(value)));
                }
            },
            code: code!(maps),
            is_of_variant: true,
        },
        inert: |s| match kind(s) {
            Some(FitKind::XnaSample) => {
                Some("The XNA sample's fit has no limit to its texels' shape; choose another fit.")
            }
            None => Some("The texels of windows have a shape that the light's height sets; choose another fit."),
            Some(FitKind::Sphere) if s.technique.fit.resolution.x == s.technique.fit.resolution.y => {
                Some("The texels of the stable sphere are as long as wide already; choose another fit.")
            }
            _ => None,
        },
    },
    Parameter {
        id: "fit.least_texel",
        group: Group::Fit,
        label: "Least texel",
        unit: "m",
        help: "Maps have no finer texels than this; 0 is no limit. It keeps edges alike where the camera comes close, and a \
           map that may be coarser covers more and moves less. Soft filters set a limit of their own.",
        kind: Kind::Number(Number { min: 0.0, max: 10.0, step: 0.001, logarithmic: true, decimals: 4, unset: None }),
        field: field!(technique.fit.least_texel),
        inert: |s| {
            (kind(s) == Some(FitKind::XnaSample))
                .then_some("The XNA sample's fit has no such limit; choose another fit.")
        },
    },
    Parameter {
        id: "fit.max_distance",
        group: Group::Fit,
        label: "Shadow distance",
        unit: "m",
        help: "Shadows end at this distance from the camera. Lower it to spend the texels near the camera, which \
           sharpens shadows there; raise it when shadows vanish too close.",
        kind: Kind::Number(Number {
            min: 1.0,
            max: 100_000.0,
            step: 1.0,
            logarithmic: true,
            decimals: 1,
            unset: Some(Unset {
                option: ChoiceOption {
                    id: "far_plane",
                    label: "far plane",
                    help: "Shadows reach as far as the camera sees.",
                },
                initial: 100.0,
            }),
        }),
        field: Field {
            get: |s| Some(unless_greatest(s.technique.fit.max_distance)),
            set: |s, value| {
                s.technique.fit.max_distance = or_greatest(value);
                pull_near(s, s.technique.fit.max_distance);
            },
            code: code!(fit.max_distance),
            is_of_variant: false,
        },
        inert: always_active,
    },
    Parameter {
        id: "fit.casters",
        group: Group::Fit,
        label: "Casters",
        unit: "",
        help: "What places the map's near plane, before which casters are lost. The objects themselves place it best; the \
           extension needs no knowledge of them.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "list",
                label: "By objects",
                help: "At the first object that can throw a shadow into view: none is lost, no depth is wasted.",
            },
            ChoiceOption {
                id: "extend",
                label: "By extension",
                help: "The near plane moves toward the light by the caster extension.",
            },
            ChoiceOption {
                id: "scene_bounds",
                label: "By scene box",
                help: "At the one box around all objects: none is lost, but depth is wasted under its empty corners.",
            },
            ChoiceOption {
                id: "depth_clamp",
                label: "Depth clamp",
                help: "At what is covered: the GPU flattens casters before it onto the near plane (pancaking). The \
                       finest depth steps, and no casters are lost.",
            },
            ChoiceOption {
                id: "none",
                label: "None",
                help: "At what is covered: casters before it are lost, which leaves holes, as in the XNA sample.",
            },
        ]),
        field: choice!(technique.fit.casters: CasterPolicy [PerObject, Extend, SceneBounds, DepthClamp, None]),
        inert: |s| {
            (kind(s) == Some(FitKind::XnaSample))
                .then_some("The XNA sample's fit takes no account of casters; choose another fit.")
        },
    },
    Parameter {
        id: "fit.caster_extension",
        group: Group::Fit,
        label: "Caster extension",
        unit: "m",
        help: "Moves the map's near plane toward the light, so that casters outside the view still throw their \
           shadows into it. Raise it when shadows of tall or off-screen objects are missing; a long range \
           costs depth precision.",
        kind: Kind::Number(Number { min: 0.0, max: 10_000.0, step: 1.0, logarithmic: true, decimals: 1, unset: None }),
        field: field!(technique.fit.caster_extension),
        inert: |s| match (kind(s), s.technique.fit.casters) {
            (Some(FitKind::XnaSample), _) => Some("The XNA sample's fit has no caster extension; choose another fit."),
            (_, CasterPolicy::Extend) => None,
            (_, CasterPolicy::PerObject | CasterPolicy::SceneBounds) => {
                Some("The objects place the near plane where they are known; set Casters to By extension.")
            }
            _ => Some("The near plane is placed by something else; set Casters to By extension."),
        },
    },
    Parameter {
        id: "fit.border",
        group: Group::Fit,
        label: "Border",
        unit: "texels",
        help: "Texels that stay free between what is covered and the map's border, so that the filter and the normal offset \
           find depths there.",
        kind: Kind::Number(Number {
            min: 0.0,
            max: WIDEST_BORDER,
            step: 0.5,
            logarithmic: false,
            decimals: 1,
            unset: Some(Unset {
                option: ChoiceOption {
                    id: "auto",
                    label: "from filter and bias",
                    help: "As many as the filter and the normal offset can reach.",
                },
                initial: 3.0,
            }),
        }),
        field: field!(technique.fit.border),
        inert: |s| {
            (kind(s) == Some(FitKind::XnaSample))
                .then_some("The XNA sample's fit keeps no texels free; choose another fit, or use the box margin.")
        },
    },
    Parameter {
        id: "fit.margin",
        group: Group::Fit,
        label: "Box margin",
        unit: "m",
        help: "Enlarges the light's box on all six sides: the XNA sample's own cure for missing casters. It spreads \
           the same texels over more ground, so prefer the choice of casters where there is one.",
        kind: Kind::Number(Number { min: 0.0, max: 1_000.0, step: 0.1, logarithmic: true, decimals: 1, unset: None }),
        field: field!(technique.fit.margin),
        inert: always_active,
    },
    up("fit.up_x", "Up, x", field!(technique.fit.up.x)),
    up("fit.up_y", "Up, y", field!(technique.fit.up.y)),
    up("fit.up_z", "Up, z", field!(technique.fit.up.z)),
];

/// The rule of each map's fit; `None` of windows.
pub(super) fn kind(s: &Settings) -> Option<FitKind> {
    s.technique.maps.shape().map(|shape| shape.kind)
}

/// A component of the direction that is up.
const fn up(id: &'static str, label: &'static str, field: Field) -> Parameter {
    Parameter {
        id,
        group: Group::Fit,
        label,
        unit: "",
        help: "Which way is up in the world, as three components of a direction: 0, 1, 0 where y is up, 0, 0, 1 \
               where z is. The map's axes follow it.",
        kind: Kind::Number(Number { min: -1.0, max: 1.0, step: 0.1, logarithmic: false, decimals: 2, unset: None }),
        field,
        inert: always_active,
    }
}
