//! The rows of what a fit is given.

use super::always_active;
use crate::field::{choice, field};
use crate::{BoxSource, ChoiceOption, Group, Kind, Parameter};

/// In the order that they are shown.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "input.boxes",
        group: Group::Input,
        label: "Boxes of the scene",
        unit: "",
        help: "Which boxes tell the fit where the scene shows shadows. Clusters of triangles hug large meshes more closely \
           than one box for each object.",
        kind: Kind::Choice(&[
            ChoiceOption { id: "clusters", label: "Triangle clusters", help: "Boxes around clusters of triangles." },
            ChoiceOption { id: "objects", label: "Objects", help: "One box for each object." },
        ]),
        field: choice!(inputs.boxes in [BoxSource::Clusters, BoxSource::Objects]),
        inert: always_active,
    },
    Parameter {
        id: "input.visible_demand",
        group: Group::Input,
        label: "The frame before",
        unit: "",
        help: "Whether the fit is told what the frame before showed: windows are placed by it, and cascades split. Without it \
           what is visible is guessed from the boxes, which costs sharpness and nothing else.",
        kind: Kind::Toggle,
        field: field!(inputs.visible_demand),
        inert: |s| {
            (!s.technique.maps.uses_visible_demand())
                .then_some("These maps do not go by it; set Fit to Windows, or Splits to From what is visible.")
        },
    },
];
