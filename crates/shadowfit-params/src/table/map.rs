//! The rows for the contents of a shadow map and its filter.

use glam::UVec2;
use shadowfit::DepthConvention;
use shadowfit::settings::{Edges, FilterKind, MapFormat};

use super::always_active;
use crate::field::{Field, Plain as _, choice, code, field};
use crate::{ChoiceOption, Group, Kind, Number, Parameter, Unset, Value};

/// Least and greatest side of a map, in texels.
pub(super) const SIDES: (f64, f64) = (256.0, 8192.0);

/// Rows in display order.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "map.resolution",
        group: Group::Map,
        label: "Resolution",
        unit: "texels",
        help: "Width of each shadow map, and its height if it is square. Doubling it makes edges half as jagged and \
           takes four times the memory and fill rate: a map of 2048×2048 texels takes 16 MiB.",
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
        help: "Height of each shadow map, if it is not square.",
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
        help: "Texture format of the stored depths. All 32-bit formats give the same shadows. Coarser formats take \
           less memory and need a larger bias (Depth steps). Colour formats are compared in the shader, as in the XNA \
           sample.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "depth32float",
                label: "Depth 32-bit float",
                help: "A depth texture, compared by the sampler.",
            },
            ChoiceOption {
                id: "depth24_unorm",
                label: "Depth 24-bit",
                help: "A depth texture with 16,777,216 steps over the map's depth range, the default of WebGL engines. \
                       Some devices store it as 32-bit floats.",
            },
            ChoiceOption {
                id: "depth16_unorm",
                label: "Depth 16-bit",
                help: "A depth texture with half the memory, and 65,536 steps over the map's depth range.",
            },
            ChoiceOption {
                id: "r32float",
                label: "Colour 32-bit float",
                help: "One colour channel with its own depth buffer, compared in the shader, as in the XNA sample.",
            },
            ChoiceOption {
                id: "r16_float",
                label: "Colour 16-bit float",
                help: "One 16-bit float colour channel with its own depth buffer, the XNA sample's second choice: \
                       steps of 1/2,048 in the far half of the map's depth range.",
            },
            ChoiceOption {
                id: "rgba8_packed",
                label: "Packed in four channels",
                help: "A 32-bit float packed into the four channels of an 8-bit colour, the XNA sample's third choice: \
                       works everywhere, and loses no precision.",
            },
            ChoiceOption {
                id: "r8_grey",
                label: "8-bit grey",
                help: "256 steps over the map's depth range, for demonstration: far too coarse, which shows as bands \
                       of acne.",
            },
        ]),
        field: choice!(technique.format: MapFormat [Depth32Float, Depth24Unorm, Depth16Unorm, R32Float, R16Float, Rgba8Packed, R8Grey]),
        inert: always_active,
    },
    Parameter {
        id: "map.filter",
        group: Group::Map,
        label: "Filter",
        unit: "",
        help: "How stored depths become a shadow. A wider filter smooths jagged edges and removes shadows that are \
           thinner than the filter. It also needs a larger normal offset, but not a larger receiver-plane bias.",
        kind: Kind::Choice(&[
            ChoiceOption {
                id: "point",
                label: "Point",
                help: "One comparison with the nearest texel: each texel shows as a hard square.",
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
                help: "A tent over 36 texels, in nine hardware look-ups: smooth edges. Shadows thinner than two texels \
                       fade.",
            },
            ChoiceOption {
                id: "pcf_7x7",
                label: "PCF 7×7",
                help: "A tent over 64 texels, in sixteen hardware look-ups: smoother still. Shadows thinner than three \
                       texels fade.",
            },
            ChoiceOption {
                id: "vogel_8",
                label: "Vogel disc, 8 look-ups",
                help: "Eight look-ups over a disc that is rotated from pixel to pixel. The group Soft edges sets its \
                       radius in the world, so that near and far edges are equally soft. Shows some noise.",
            },
            ChoiceOption {
                id: "vogel_16",
                label: "Vogel disc, 16 look-ups",
                help: "Sixteen look-ups over a disc: less noise than with eight.",
            },
            ChoiceOption {
                id: "vogel_32",
                label: "Vogel disc, 32 look-ups",
                help: "32 look-ups over a disc: the least noise, at twice the cost of 16.",
            },
            ChoiceOption {
                id: "pcss",
                label: "PCSS",
                help: "A disc that widens with the distance to the caster: sharp where a shadow begins, soft far from \
                       the caster. The most expensive filter. Not available with depth clamp.",
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
        help: "Whether the filter or shadow rays decide pixels near shadow edges. Rays make edges exact at any texel \
           size. They need the scene's triangles, a depth buffer before shading, and time for each pixel near an edge.",
        kind: Kind::Choice(&[
            ChoiceOption { id: "filtered", label: "Filtered", help: "The filter decides everywhere." },
            ChoiceOption {
                id: "traced",
                label: "Traced",
                help: "If all texels that the filter reads give one verdict, the map decides. Otherwise rays decide.",
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
        help: "Rays toward the sun for each pixel that the maps cannot decide. One gives exact but jagged edges, four \
           give smooth ones. The cost grows with their number.",
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
        help: "Share of the shadow distance over which shadows fade out: 0.1 is the last tenth. 0 ends them at a hard \
           line.",
        kind: Kind::Number(Number { min: 0.0, max: 1.0, step: 0.05, logarithmic: false, decimals: 2, unset: None }),
        field: field!(technique.fade),
        inert: |s| {
            (s.technique.fit.max_distance == f32::MAX)
                .then_some("Shadows reach the far plane; set Shadow distance to a number (fit.max_distance = 100).")
        },
    },
    Parameter {
        id: "map.depth",
        group: Group::Map,
        label: "Depth convention",
        unit: "",
        help: "Stored depths of the map's near and far planes. The picture stays the same; choose the convention of \
           your graphics API and depth comparison.",
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
