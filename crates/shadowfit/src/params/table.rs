//! The rows of the parameter table, in the order that they are shown.

mod fit;

use glam::UVec2;

use super::{Choice, ChoiceOption, Group, Kind, MIN_FAR_PER_NEAR, Number, Parameter, Toggle};
use crate::{DepthConvention, FilterKind, MapFormat, Settings};

/// Every knob of [`Settings`].
pub static PARAMETERS: &[Parameter] = &[
    fit::KIND,
    fit::RECTANGLE,
    fit::MAX_DISTANCE,
    fit::CASTERS,
    fit::CASTER_EXTENSION,
    fit::KERNEL_MARGIN,
    fit::MARGIN,
    RESOLUTION,
    FORMAT,
    FILTER,
    DEPTH,
    BIAS_CONSTANT,
    BIAS_SLOPE,
    NORMAL_OFFSET,
    RECEIVER_PLANE,
    AZIMUTH,
    ELEVATION,
    ANIMATE,
    ANIMATE_SPEED,
    FOV_Y,
    NEAR,
    FAR,
    SPEED,
    SHADOWS,
    INSET,
    OUTSIDE,
    FREEZE_FIT,
    PLAY,
];

const SIDES: [u32; 6] = [256, 512, 1024, 2048, 4096, 8192];

const RESOLUTION: Parameter = Parameter {
    id: "map.resolution",
    group: Group::Map,
    label: "Resolution",
    unit: "texels",
    help: "Width and height of the shadow map. Each doubling halves the jaggies and costs four times the \
           memory and fill.",
    kind: Kind::Choice(Choice {
        options: &[
            ChoiceOption { id: "256", label: "256", help: "Coarse on purpose: every texel can be seen." },
            ChoiceOption { id: "512", label: "512", help: "1 MiB at 32 bits a texel." },
            ChoiceOption { id: "1024", label: "1024", help: "4 MiB at 32 bits a texel." },
            ChoiceOption { id: "2048", label: "2048", help: "16 MiB at 32 bits a texel." },
            ChoiceOption { id: "4096", label: "4096", help: "64 MiB at 32 bits a texel." },
            ChoiceOption { id: "8192", label: "8192", help: "256 MiB at 32 bits a texel." },
        ],
        read: |s| {
            let side = s.fit.resolution.max_element();
            SIDES.iter().rposition(|&option| option <= side).unwrap_or(0)
        },
        write: |s, index| {
            if let Some(&side) = SIDES.get(index) {
                s.fit.resolution = UVec2::splat(side);
            }
        },
    }),
    inert: always_active,
};

const FORMAT: Parameter = Parameter {
    id: "map.format",
    group: Group::Map,
    label: "Format",
    unit: "",
    help: "The texture format that stores the depths. Both hold 32-bit floats and give the same shadows; the \
           colour format shows what the comparison costs without a comparison sampler.",
    kind: Kind::Choice(Choice {
        options: &[
            ChoiceOption {
                id: "depth32float",
                label: "Depth 32-bit float",
                help: "A depth texture, compared by the sampler.",
            },
            ChoiceOption {
                id: "r32float",
                label: "Colour 32-bit float",
                help: "One colour channel with a depth buffer of its own, compared in the shader, as the XNA \
                       sample has it.",
            },
        ],
        read: |s| match s.format {
            MapFormat::Depth32Float => 0,
            MapFormat::R32Float => 1,
        },
        write: |s, index| s.format = if index == 0 { MapFormat::Depth32Float } else { MapFormat::R32Float },
    }),
    inert: always_active,
};

const FILTER: Parameter = Parameter {
    id: "map.filter",
    group: Group::Map,
    label: "Filter",
    unit: "",
    help: "How the stored depths become a shadow factor. A wider filter softens jaggies, and loses what is \
           thinner than it; by the normal offset alone it needs more bias, since it reaches farther.",
    kind: Kind::Choice(Choice {
        options: &[
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
                help: "A tent over 36 texels, in nine hardware look-ups: jaggies are gone, and so is what is thinner \
                       than two texels.",
            },
        ],
        read: |s| FilterKind::ALL.iter().position(|filter| *filter == s.filter).unwrap_or(0),
        write: |s, index| s.filter = FilterKind::ALL.get(index).copied().unwrap_or_default(),
    }),
    inert: always_active,
};

const DEPTH: Parameter = Parameter {
    id: "map.depth",
    group: Group::Map,
    label: "Depth convention",
    unit: "",
    help: "Which depths the near and far planes of the map get. The picture stays the same; choose what your \
           graphics API and depth comparison expect.",
    kind: Kind::Choice(Choice {
        options: &[
            ChoiceOption {
                id: "zero_to_one",
                label: "0 to 1",
                help: "Near is 0, far is 1: wgpu, Direct3D, Vulkan and Metal.",
            },
            ChoiceOption { id: "reversed", label: "1 to 0 (reversed)", help: "Near is 1, far is 0." },
            ChoiceOption { id: "negative_one_to_one", label: "-1 to 1 (OpenGL)", help: "Near is -1, far is 1." },
        ],
        read: |s| match s.fit.depth {
            DepthConvention::ZeroToOne => 0,
            DepthConvention::Reversed => 1,
            DepthConvention::NegativeOneToOne => 2,
        },
        write: |s, index| {
            s.fit.depth = match index {
                0 => DepthConvention::ZeroToOne,
                1 => DepthConvention::Reversed,
                _ => DepthConvention::NegativeOneToOne,
            };
        },
    }),
    inert: always_active,
};

const BIAS_CONSTANT: Parameter = Parameter {
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
        read: |s| f64::from(s.bias.constant),
        write: |s, value| s.bias.constant = value as f32,
    }),
    inert: always_active,
};

const BIAS_SLOPE: Parameter = Parameter {
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
        read: |s| f64::from(s.bias.slope),
        write: |s, value| s.bias.slope = value as f32,
    }),
    inert: always_active,
};

const NORMAL_OFFSET: Parameter = Parameter {
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
        read: |s| f64::from(s.bias.normal_offset),
        write: |s, value| s.bias.normal_offset = value as f32,
    }),
    inert: always_active,
};

const RECEIVER_PLANE: Parameter = Parameter {
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
        read: |s| f64::from(s.bias.receiver_plane),
        write: |s, value| s.bias.receiver_plane = value as f32,
    }),
    inert: always_active,
};

const AZIMUTH: Parameter = Parameter {
    id: "light.azimuth",
    group: Group::Light,
    label: "Azimuth",
    unit: "deg",
    help: "Compass angle of the point that the light comes from, from +z toward +x.",
    kind: Kind::Number(Number {
        min: 0.0,
        max: 360.0,
        step: 1.0,
        logarithmic: false,
        decimals: 1,
        read: |s| turn(f64::from(s.light.azimuth).to_degrees()),
        write: |s, value| s.light.azimuth = value.to_radians() as f32,
    }),
    inert: always_active,
};

const ELEVATION: Parameter = Parameter {
    id: "light.elevation",
    group: Group::Light,
    label: "Elevation",
    unit: "deg",
    help: "Angle of the sun above the horizon. A low sun throws long shadows and grazes the ground, which is \
           the hardest case for biases.",
    kind: Kind::Number(Number {
        min: 0.0,
        max: 90.0,
        step: 1.0,
        logarithmic: false,
        decimals: 1,
        read: |s| f64::from(s.light.elevation).to_degrees(),
        write: |s, value| s.light.elevation = value.to_radians() as f32,
    }),
    inert: always_active,
};

const ANIMATE: Parameter = Parameter {
    id: "light.animate",
    group: Group::Light,
    label: "Animate",
    unit: "",
    help: "Lets the sun circle the vertical. Watch the shadow edges crawl while the fit turns with it.",
    kind: Kind::Toggle(Toggle { read: |s| s.light.animate, write: |s, on| s.light.animate = on }),
    inert: always_active,
};

const ANIMATE_SPEED: Parameter = Parameter {
    id: "light.animate_speed",
    group: Group::Light,
    label: "Speed of the sun",
    unit: "deg/s",
    help: "How fast the sun circles while it is animated. The real one turns 0.004 degrees a second.",
    kind: Kind::Number(Number {
        min: 0.0,
        max: 180.0,
        step: 0.5,
        logarithmic: true,
        decimals: 2,
        read: |s| f64::from(s.light.animate_speed).to_degrees(),
        write: |s, value| s.light.animate_speed = value.to_radians() as f32,
    }),
    inert: |s| (!s.light.animate).then_some("The sun stands still; turn on Animate."),
};

const FOV_Y: Parameter = Parameter {
    id: "camera.fov_y",
    group: Group::Camera,
    label: "Field of view",
    unit: "deg",
    help: "Vertical angle of the lens. A wide view spreads the shadow map over more ground.",
    kind: Kind::Number(Number {
        min: 5.0,
        max: 150.0,
        step: 1.0,
        logarithmic: false,
        decimals: 1,
        read: |s| f64::from(s.camera.fov_y).to_degrees(),
        write: |s, value| s.camera.fov_y = value.to_radians() as f32,
    }),
    inert: always_active,
};

const NEAR: Parameter = Parameter {
    id: "camera.near",
    group: Group::Camera,
    label: "Near plane",
    unit: "m",
    help: "Nothing nearer than this is drawn. Far plane and shadow distance are kept at twice this or more.",
    kind: Kind::Number(Number {
        min: 0.01,
        max: 100.0,
        step: 0.01,
        logarithmic: true,
        decimals: 3,
        read: |s| f64::from(s.camera.near),
        write: |s, value| {
            s.camera.near = value as f32;
            let least = MIN_FAR_PER_NEAR * s.camera.near;
            s.camera.far = s.camera.far.max(least);
            s.fit.max_distance = s.fit.max_distance.max(least);
        },
    }),
    inert: always_active,
};

const FAR: Parameter = Parameter {
    id: "camera.far",
    group: Group::Camera,
    label: "Far plane",
    unit: "m",
    help: "Nothing farther than this is drawn; shadows end here at the latest. The near plane is kept at half \
           of this or less.",
    kind: Kind::Number(Number {
        min: 1.0,
        max: 10_000.0,
        step: 1.0,
        logarithmic: true,
        decimals: 1,
        read: |s| f64::from(s.camera.far),
        write: |s, value| {
            s.camera.far = value as f32;
            pull_near(s, value as f32);
        },
    }),
    inert: always_active,
};

const SPEED: Parameter = Parameter {
    id: "camera.speed",
    group: Group::Camera,
    label: "Flying speed",
    unit: "m/s",
    help: "How fast the camera flies. Raise it in large scenes.",
    kind: Kind::Number(Number {
        min: 0.1,
        max: 1_000.0,
        step: 0.1,
        logarithmic: true,
        decimals: 1,
        read: |s| f64::from(s.camera.speed),
        write: |s, value| s.camera.speed = value as f32,
    }),
    inert: always_active,
};

const SHADOWS: Parameter = Parameter {
    id: "view.shadows",
    group: Group::View,
    label: "Shadows",
    unit: "",
    help: "Draws shadows. Turn it off to see the plain lit scene for comparison.",
    kind: Kind::Toggle(Toggle { read: |s| s.view.shadows, write: |s, on| s.view.shadows = on }),
    inert: always_active,
};

const INSET: Parameter = Parameter {
    id: "view.inset",
    group: Group::View,
    label: "Shadow map inset",
    unit: "",
    help: "Shows the shadow map itself in a corner: how much of it is used and what is missing from it.",
    kind: Kind::Toggle(Toggle { read: |s| s.view.inset, write: |s, on| s.view.inset = on }),
    inert: always_active,
};

const OUTSIDE: Parameter = Parameter {
    id: "view.outside",
    group: Group::View,
    label: "Outside view",
    unit: "",
    help: "Looks at the camera from outside, with its frustum and the light's box drawn. A caster outside the \
           box throws no shadow.",
    kind: Kind::Toggle(Toggle { read: |s| s.view.outside, write: |s, on| s.view.outside = on }),
    inert: always_active,
};

const FREEZE_FIT: Parameter = Parameter {
    id: "view.freeze_fit",
    group: Group::View,
    label: "Freeze the fit",
    unit: "",
    help: "Keeps the shadow map where it looks now while the camera flies on, to see from elsewhere what it \
           covers.",
    kind: Kind::Toggle(Toggle { read: |s| s.view.freeze_fit, write: |s, on| s.view.freeze_fit = on }),
    inert: always_active,
};

const PLAY: Parameter = Parameter {
    id: "view.play",
    group: Group::View,
    label: "Play animation",
    unit: "",
    help: "Plays the scene's animation. Pause it to study one frame.",
    kind: Kind::Toggle(Toggle { read: |s| s.view.play, write: |s, on| s.view.play = on }),
    inert: always_active,
};

const fn always_active(_: &Settings) -> Option<&'static str> {
    None
}

/// Keeps the near plane below a distance that was just set.
fn pull_near(settings: &mut Settings, far: f32) {
    settings.camera.near = settings.camera.near.min(far / MIN_FAR_PER_NEAR);
}

/// An angle as a compass shows it: an animated sun keeps counting, its azimuth reads 0 to 360.
fn turn(degrees: f64) -> f64 {
    // 2π in f32 is a little more than a turn, and setting 360 should read 360.
    const SLACK: f64 = 1e-4;
    if (0.0..=360.0 + SLACK).contains(&degrees) { degrees } else { (degrees % 360.0 + 360.0) % 360.0 }
}
