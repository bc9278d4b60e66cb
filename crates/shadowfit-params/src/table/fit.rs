//! The rows for the fit of each map.

use shadowfit::settings::{CasterPolicy, FitKind, RectangleKind, Shape};
use shadowfit::{Cascades, Maps, SingleMap};

use super::{always_active, or_greatest, pull_near, unless_greatest};
use crate::field::{Field, choice, code, field};
use crate::tool::Settings;
use crate::{ChoiceOption, Group, Kind, Number, Parameter, Unset, Value};

/// Widest border, in texels: wider than the reach of all but the softest filters, and less than a quarter of
/// the smallest map that the table allows.
const WIDEST_BORDER: f64 = 32.0;

/// Fit of each option of `fit.kind`; `None` for windows.
const KINDS: [Option<FitKind>; 6] = [
    Some(FitKind::Focused),
    None,
    Some(FitKind::Oriented),
    Some(FitKind::Sphere),
    Some(FitKind::FrustumAabb),
    Some(FitKind::XnaSample),
];

/// Rows in display order.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "fit.kind",
        group: Group::Fit,
        label: "Fit",
        unit: "",
        help: "The rule that fits a shadow map. Windows are sharp, and their shadow edges hardly crawl. Focused maps \
           are as sharp, but not as stable. The sphere is as stable, but coarser. The frustum box is the simplest. The \
           XNA sample's rule loses casters outside the view.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "focused",
                label: "Focused on the scene",
                help: "The smallest rectangle around the visible parts of the scene's boxes: the finest texels.",
            },
            ChoiceOption {
                id: "windows",
                label: "Windows",
                help: "Rectangles on a texel grid that is fixed to the world, each placed where it improves the most \
                       visible pixels. Sharp without splits, and edges hardly crawl when the camera moves or turns.",
            },
            ChoiceOption {
                id: "oriented",
                label: "Oriented rectangle",
                help: "The smallest rectangle around the camera frustum as seen from the light. It turns with the \
                       camera.",
            },
            ChoiceOption {
                id: "sphere",
                label: "Stable sphere",
                help: "The sphere around the camera frustum, on a fixed texel grid: coarser, but no edge crawls when \
                       the camera moves or turns.",
            },
            ChoiceOption {
                id: "frustum_aabb",
                label: "Frustum box",
                help: "The box of the whole camera frustum along the light's axes, including its empty parts.",
            },
            ChoiceOption {
                id: "xna_sample",
                label: "XNA sample",
                help: "The box of Microsoft's XNA Shadow Mapping sample (2008), with twice the necessary depth range. \
                       It loses casters outside the view.",
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
        help: "Shape and rotation of the rectangle that the oriented and the focused fit place around the covered \
           area. The smallest area gives the finest texels; a square makes them equally fine in both directions.",
        kind: Kind::Choice(&[
            ChoiceOption { id: "minimum_area", label: "Smallest area", help: "Turned to the smallest area." },
            ChoiceOption {
                id: "minimum_square",
                label: "Smallest square",
                help: "The smallest square: texels are as wide as they are high.",
            },
            ChoiceOption {
                id: "axis_aligned",
                label: "Not turned",
                help: "Along the light's own axes: larger, but it turns only with the light.",
            },
        ]),
        field: choice!(technique.maps, Maps::Cascades(Cascades { shape: Shape { rectangle: part, .. }, .. })
            | Maps::Single(SingleMap { shape: Shape { rectangle: part, .. }, .. }) => part
            in [RectangleKind::MinimumArea, RectangleKind::MinimumSquare, RectangleKind::AxisAligned]),
        inert: |s| {
            (!matches!(kind(s), Some(FitKind::Oriented | FitKind::Focused)))
                .then_some("Only the oriented and the focused fit can turn their rectangle; choose one of them.")
        },
    },
    Parameter {
        id: "fit.max_texel_ratio",
        group: Group::Fit,
        label: "Longest texels",
        unit: "×",
        help: "Greatest ratio of a texel's length to its width. Long texels blur edges more in one direction; a low \
           limit makes blur even and texels coarser.",
        kind: Kind::Number(Number {
            min: 1.0,
            max: 64.0,
            step: 0.1,
            logarithmic: true,
            decimals: 1,
            unset: Some(Unset {
                option: ChoiceOption { id: "none", label: "no limit", help: "Texels may have any shape." },
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
                Some("The XNA sample's fit does not limit the shape of texels; choose another fit.")
            }
            None => Some("The light's elevation sets the texel shape of windows; choose another fit."),
            Some(FitKind::Sphere) if s.technique.fit.resolution.x == s.technique.fit.resolution.y => {
                Some("The texels of the stable sphere are already square; choose another fit.")
            }
            _ => None,
        },
    },
    Parameter {
        id: "fit.least_texel",
        group: Group::Fit,
        label: "Minimum texel",
        unit: "m",
        help: "Lower limit of the texel size; 0 means no limit. It keeps edges uniform when the camera comes close. A \
           coarser map also covers more, and so moves less. Soft filters set their own limit.",
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
        help: "Distance from the camera at which shadows end. Lower it to sharpen shadows near the camera; raise it if \
           shadows end too close.",
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
                    help: "Shadows reach the camera's far plane.",
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
        help: "Place of the map's near plane, which faces the light. Casters between the light and this plane are \
           lost, except with Depth clamp. By objects is best; By extension needs no list of the objects.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "list",
                label: "By objects",
                help: "At the first object, as seen from the light, that can cast a shadow into view: no caster is \
                       lost and no depth range is wasted.",
            },
            ChoiceOption {
                id: "extend",
                label: "By extension",
                help: "At the covered area, moved toward the light by the caster extension.",
            },
            ChoiceOption {
                id: "scene_bounds",
                label: "By scene box",
                help: "At the one box around all objects: no caster is lost, but its empty corners waste depth range.",
            },
            ChoiceOption {
                id: "depth_clamp",
                label: "Depth clamp",
                help: "At the covered area. The GPU flattens casters between the light and the near plane onto the \
                       plane (pancaking). This gives the finest depth steps and loses no casters.",
            },
            ChoiceOption {
                id: "none",
                label: "None",
                help: "At the covered area. Casters between the light and the near plane are lost, which leaves holes, \
                       as in the XNA sample.",
            },
        ]),
        field: choice!(technique.fit.casters: CasterPolicy [PerObject, Extend, SceneBounds, DepthClamp, None]),
        inert: |s| {
            (kind(s) == Some(FitKind::XnaSample)).then_some("The XNA sample's fit ignores casters; choose another fit.")
        },
    },
    Parameter {
        id: "fit.caster_extension",
        group: Group::Fit,
        label: "Caster extension",
        unit: "m",
        help: "Moves the map's near plane toward the light, so that casters outside the view still cast shadows into \
           it. Raise it if shadows of tall or off-screen objects are missing; a long extension costs depth precision.",
        kind: Kind::Number(Number { min: 0.0, max: 10_000.0, step: 1.0, logarithmic: true, decimals: 1, unset: None }),
        field: field!(technique.fit.caster_extension),
        inert: |s| match (kind(s), s.technique.fit.casters) {
            (Some(FitKind::XnaSample), _) => Some("The XNA sample's fit has no caster extension; choose another fit."),
            (_, CasterPolicy::Extend) => None,
            (_, CasterPolicy::PerObject | CasterPolicy::SceneBounds) => {
                Some("The near plane is placed by the objects, if these are known; set Casters to By extension.")
            }
            _ => Some("The near plane does not use the extension; set Casters to By extension."),
        },
    },
    Parameter {
        id: "fit.border",
        group: Group::Fit,
        label: "Border",
        unit: "texels",
        help: "Free texels between the covered area and the map's border, for the reach of the filter and of the \
           normal offset.",
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
                    help: "Equal to the reach of the filter and the normal offset.",
                },
                initial: 3.0,
            }),
        }),
        field: field!(technique.fit.border),
        inert: |s| {
            (kind(s) == Some(FitKind::XnaSample))
                .then_some("The XNA sample's fit has no border; choose another fit, or use the box margin.")
        },
    },
    Parameter {
        id: "fit.margin",
        group: Group::Fit,
        label: "Box margin",
        unit: "m",
        help: "Enlarges the light's box on all six sides: the XNA sample's own cure for missing casters. It spreads \
           the same texels over more ground, so prefer Casters with all other fits.",
        kind: Kind::Number(Number { min: 0.0, max: 1_000.0, step: 0.1, logarithmic: true, decimals: 1, unset: None }),
        field: field!(technique.fit.margin),
        inert: always_active,
    },
    up("fit.up_x", "Up, x", field!(technique.fit.up.x)),
    up("fit.up_y", "Up, y", field!(technique.fit.up.y)),
    up("fit.up_z", "Up, z", field!(technique.fit.up.z)),
];

/// Returns the fit of each map; `None` for windows.
pub(super) fn kind(s: &Settings) -> Option<FitKind> {
    s.technique.maps.shape().map(|shape| shape.kind)
}

/// Returns the row for a component of the up direction.
const fn up(id: &'static str, label: &'static str, field: Field) -> Parameter {
    Parameter {
        id,
        group: Group::Fit,
        label,
        unit: "",
        help: "Up direction of the world as three components: 0, 1, 0 if y is up, 0, 0, 1 if z is up. The map's axes \
               follow it.",
        kind: Kind::Number(Number { min: -1.0, max: 1.0, step: 0.1, logarithmic: false, decimals: 2, unset: None }),
        field,
        inert: always_active,
    }
}
