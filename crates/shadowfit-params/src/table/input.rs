//! The rows for the inputs of a fit.

use super::always_active;
use crate::field::{choice, field};
use crate::{BoxSource, ChoiceOption, Group, Kind, Parameter};

/// Rows in display order.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "input.boxes",
        group: Group::Input,
        label: "Boxes of the scene",
        unit: "",
        help: "Bounding boxes that tell the fit where casters and receivers are. Boxes around triangle clusters \
           enclose large meshes more closely than one box per object.",
        kind: Kind::Choice(&[
            ChoiceOption { id: "clusters", label: "Triangle clusters", help: "Boxes around clusters of triangles." },
            ChoiceOption { id: "objects", label: "Objects", help: "One box per object." },
        ]),
        field: choice!(inputs.boxes in [BoxSource::Clusters, BoxSource::Objects]),
        inert: always_active,
    },
    Parameter {
        id: "input.visible_demand",
        group: Group::Input,
        label: "Visible demand",
        unit: "",
        help: "Fits windows and splits cascades by the visible points of a recent frame. If off, the fit estimates \
           them from the boxes, which costs only sharpness.",
        kind: Kind::Toggle,
        field: field!(inputs.visible_demand),
        inert: |s| {
            (!s.technique.maps.uses_visible_demand())
                .then_some("These maps ignore visible demand; set Fit to Windows, or Splits to From visible demand.")
        },
    },
];
