//! The rows of a shadow map: what it stores and how it is read.

use glam::UVec2;
use shadowfit::DepthConvention;
use shadowfit::settings::{Edges, FilterKind, MapFormat};

use super::always_active;
use crate::field::{Field, Plain as _, choice, code, field};
use crate::{ChoiceOption, Group, Kind, Number, Parameter, Unset, Value};

/// Least and greatest side of a map, in texels.
pub(super) const SIDES: (f64, f64) = (256.0, 8192.0);

/// In the order that they are shown.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "map.resolution",
        group: Group::Map,
        label: "Resolution",
        unit: "texels",
        help: "Width of each shadow map, and its height where it is square. Doubling it makes edges half as jagged and \
           takes four times the memory and fill rate: a map of 2048 texels has 16 MiB.",
        kind: Kind::Number(Number {
            min: SIDES.0,
            max: SIDES.1,
            step: 256.0,
            logarithmic: true,
            decimals: 0,
            unset: None,
        }),
        field: Field {
            get: |s| Some(s.technique.fit.resolution.x.value()),
            set: |s, value| {
                let resolution = &mut s.technique.fit.resolution;
                let is_square = resolution.x == resolution.y;
                resolution.x.assign(value);
                if is_square {
                    resolution.y = resolution.x;
                }
            },
            code: code!(fit.resolution),
            is_of_variant: false,
        },
        inert: always_active,
    },
    Parameter {
        id: "map.height",
        group: Group::Map,
        label: "Height",
        unit: "texels",
        help: "Height of each shadow map, if they are not square.",
        kind: Kind::Number(Number {
            min: SIDES.0,
            max: SIDES.1,
            step: 256.0,
            logarithmic: true,
            decimals: 0,
            unset: Some(Unset {
                option: ChoiceOption { id: "square", label: "as the width", help: "Maps are square." },
                initial: 1024.0,
            }),
        }),
        field: Field {
            get: |s| {
                let UVec2 { x, y } = s.technique.fit.resolution;
                Some(if x == y { Value::Unset } else { y.value() })
            },
            set: |s, value| {
                let resolution = &mut s.technique.fit.resolution;
                resolution.y = resolution.x;
                resolution.y.assign(value);
            },
            code: code!(fit.resolution),
            is_of_variant: false,
        },
        inert: always_active,
    },
    Parameter {
        id: "map.format",
        group: Group::Map,
        label: "Format",
        unit: "",
        help: "The texture format that stores the depths. Those with 32 bits give the same shadows; coarser ones take less \
           memory, and demand a larger bias (Depth steps). Colour formats are compared in the shader, as the XNA sample \
           does.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "depth32float",
                label: "Depth 32-bit float",
                help: "A depth texture, compared by the sampler.",
            },
            ChoiceOption {
                id: "depth16_unorm",
                label: "Depth 16-bit",
                help: "A depth texture of half the memory, with 65,536 steps over the map's depth.",
            },
            ChoiceOption {
                id: "r32float",
                label: "Colour 32-bit float",
                help: "One colour channel with a depth buffer of its own, compared in the shader, as the XNA \
                       sample has it.",
            },
            ChoiceOption {
                id: "r16_float",
                label: "Colour 16-bit float",
                help: "The same with a 16-bit float, the XNA sample's second choice: 2,048 steps over the far half of \
                       the map's depth.",
            },
            ChoiceOption {
                id: "rgba8_packed",
                label: "Packed in four channels",
                help: "A 32-bit float in the four channels of an ordinary colour, the XNA sample's third choice: works \
                       everywhere, and loses nothing.",
            },
            ChoiceOption {
                id: "r8_grey",
                label: "8-bit grey",
                help: "256 steps over the map's depth: far too coarse, as the bands of acne show.",
            },
        ]),
        field: choice!(technique.format: MapFormat [Depth32Float, Depth16Unorm, R32Float, R16Float, Rgba8Packed, R8Grey]),
        inert: always_active,
    },
    Parameter {
        id: "map.filter",
        group: Group::Map,
        label: "Filter",
        unit: "",
        help: "How the stored depths become a shadow. A wider filter softens jagged edges and loses shadows that are \
           thinner than it. It also reaches farther, so that the normal offset has to grow with it; the receiver \
           plane does not.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "point",
                label: "Point",
                help: "One comparison with the nearest texel: every texel shows as a hard square.",
            },
            ChoiceOption {
                id: "hardware_2x2",
                label: "2×2 comparison",
                help: "Four comparisons, weighted bilinearly: percentage-closer filtering by the sampler.",
            },
            ChoiceOption {
                id: "pcf_3x3",
                label: "PCF 3×3",
                help: "A tent over 16 texels, in four hardware look-ups: soft edges about two texels wide.",
            },
            ChoiceOption {
                id: "pcf_5x5",
                label: "PCF 5×5",
                help: "A tent over 36 texels, in nine hardware look-ups: edges are smooth, and shadows thinner than two \
                       texels fade.",
            },
            ChoiceOption {
                id: "pcf_7x7",
                label: "PCF 7×7",
                help: "A tent over 64 texels, in sixteen hardware look-ups: smoother still, and shadows thinner than \
                       three texels fade.",
            },
            ChoiceOption {
                id: "vogel_8",
                label: "Vogel disc, 8 look-ups",
                help: "Look-ups spread over a disc as wide as the softness says, turned from pixel to pixel: edges are \
                       as soft near and far, with some noise.",
            },
            ChoiceOption { id: "vogel_16", label: "Vogel disc, 16 look-ups", help: "The same with less noise." },
            ChoiceOption {
                id: "vogel_32",
                label: "Vogel disc, 32 look-ups",
                help: "The same with the least noise, and twice the cost.",
            },
            ChoiceOption {
                id: "pcss",
                label: "PCSS",
                help: "A disc as wide as the distance to the caster makes the edge: sharp where a shadow begins, soft \
                       far from what casts it. The dearest. It cannot be had with depth clamp.",
            },
        ]),
        field: choice!(technique.filter: FilterKind [
            Point, Hardware2x2, Pcf3x3, Pcf5x5, Pcf7x7, Vogel8, Vogel16, Vogel32, Pcss
        ]),
        inert: always_active,
    },
    Parameter {
        id: "map.edges",
        group: Group::Map,
        label: "Edges",
        unit: "",
        help: "Whether the filter makes the edges of shadows, or rays do where the maps are not sure. Rays make them exact, \
           whatever the texels; they need the scene's triangles and a depth buffer before the picture is shaded, and time \
           for each pixel near an edge.",
        kind: Kind::Choice(&[
            ChoiceOption { id: "filtered", label: "Filtered", help: "The filter's shadow everywhere." },
            ChoiceOption {
                id: "traced",
                label: "Traced",
                help: "Where all texels that the filter reads agree, they decide; elsewhere rays do.",
            },
        ]),
        field: Field {
            get: |s| Some(Value::Option(usize::from(s.technique.edges.are_traced()))),
            set: |s, value| {
                let edges = &mut s.technique.edges;
                *edges = match (value, *edges) {
                    (Value::Option(0), _) => Edges::Filtered,
                    (Value::Option(_), Edges::Filtered) => Edges::Traced { samples: Edges::USUAL_SAMPLES },
                    (_, same) => same,
                };
            },
            code: code!(edges),
            is_of_variant: false,
        },
        inert: always_active,
    },
    Parameter {
        id: "map.edge_samples",
        group: Group::Map,
        label: "Rays per pixel",
        unit: "rays",
        help: "Rays toward the sun from each pixel that the maps are not sure of. One gives exact, jagged edges, four smooth \
           ones; the time that rays take grows with their number.",
        kind: Kind::Number(Number {
            min: 1.0,
            max: Edges::MAX_SAMPLES as f64,
            step: 1.0,
            logarithmic: true,
            decimals: 0,
            unset: None,
        }),
        field: field!(technique.edges, Edges::Traced { samples } => samples),
        inert: |s| {
            (!s.technique.edges.are_traced()).then_some("No rays are traced; set Edges to Traced (map.edges = traced).")
        },
    },
    Parameter {
        id: "map.fade",
        group: Group::Map,
        label: "Fade out",
        unit: "",
        help: "Share of the shadow distance over which shadows fade away before its end: 0.1 is the last tenth. 0 ends them \
           at a line.",
        kind: Kind::Number(Number { min: 0.0, max: 1.0, step: 0.05, logarithmic: false, decimals: 2, unset: None }),
        field: field!(technique.fade),
        inert: |s| {
            (s.technique.fit.max_distance == f32::MAX)
                .then_some("Shadows end with the view; set Shadow distance to a number (fit.max_distance = 100).")
        },
    },
    Parameter {
        id: "map.depth",
        group: Group::Map,
        label: "Depth convention",
        unit: "",
        help: "Which depths the near and far planes of the map get. The picture stays the same; choose what your \
           graphics API and depth comparison expect.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "zero_to_one",
                label: "0 to 1",
                help: "Near is 0, far is 1: wgpu, Direct3D, Vulkan and Metal.",
            },
            ChoiceOption { id: "reversed", label: "1 to 0 (reversed)", help: "Near is 1, far is 0." },
            ChoiceOption { id: "negative_one_to_one", label: "-1 to 1 (OpenGL)", help: "Near is -1, far is 1." },
        ]),
        field: choice!(technique.fit.depth: DepthConvention [ZeroToOne, Reversed, NegativeOneToOne]),
        inert: always_active,
    },
];
