//! The rows of the tools' settings: sun, camera and what is drawn.

use std::f64::consts::TAU;

use shadowfit::settings::MAX_MAPS;

use super::{always_active, pull_near};
use crate::field::{Field, Plain as _, choice, field};
use crate::tool::{DAY, ErrorMarks, FLYING_SPEEDS, HEIGHTS, InsetMaps, Settings, ViewMode};
use crate::{ChoiceOption, Group, Kind, MIN_FAR_PER_NEAR, Number, Parameter, Unset, Value};

/// Names and help texts of the views, in the order of [`ViewMode::ALL`].
const VIEWS: &[ChoiceOption] = &[
    ChoiceOption { id: "final", label: "Final", help: "The scene with the shadows of the maps." },
    ChoiceOption {
        id: "truth",
        label: "Truth",
        help: "The scene with the shadows that rays find: what the final picture should look like.",
    },
    ChoiceOption {
        id: "error",
        label: "Errors",
        help: "The final picture in grey, and each pixel that rays prove wrong in the colour of its class.",
    },
    ChoiceOption {
        id: "pixels_per_texel",
        label: "Pixels per texel",
        help: "How many screen pixels a shadow texel covers: red where texels can be seen, blue where they are \
                       finer than the picture needs.",
    },
    ChoiceOption {
        id: "maps",
        label: "Maps",
        help: "Which map each point reads, in the colours of the table of the maps.",
    },
    ChoiceOption {
        id: "texel_grid",
        label: "Texel grid",
        help: "The texels of the maps on the surfaces that read them.",
    },
    ChoiceOption {
        id: "demand",
        label: "Demand",
        help: "The scene as the light sees it: where the picture asks for how fine a texel, and the maps laid \
                       over it.",
    },
    ChoiceOption {
        id: "updates",
        label: "Map updates",
        help: "All maps side by side: what was kept in them, what was drawn anew, and what moves.",
    },
    ChoiceOption {
        id: "outside",
        label: "Outside",
        help: "The camera from outside, with its frustum and the boxes of the maps drawn. A caster outside a \
                       map's box throws no shadow there.",
    },
    ChoiceOption {
        id: "traced",
        label: "Traced",
        help: "The scene in grey, and in colours the pixels whose edges rays made, and those that were left to the \
                       filter.",
    },
];

/// Returns the name and the help of a view.
pub fn view_option(mode: ViewMode) -> &'static ChoiceOption {
    let index = ViewMode::ALL.iter().position(|each| *each == mode).unwrap_or(0);
    &VIEWS[index]
}

/// In the order that they are shown.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "light.hour",
        group: Group::Light,
        label: "Time of day",
        unit: "h",
        help: "Moves the sun as on a day in spring: it rises at 6 in the east (+x), stands 50 degrees high in the south (+z) \
           at 12, and sets at 18 in the west.",
        kind: Kind::Number(Number {
            min: DAY.0 as f64,
            max: DAY.1 as f64,
            step: 0.1,
            logarithmic: false,
            decimals: 2,
            unset: Some(Unset {
                option: ChoiceOption {
                    id: "by_angles",
                    label: "By angles",
                    help: "The sun stands where azimuth and elevation say.",
                },
                initial: 10.0,
            }),
        }),
        field: field!(light.hour),
        inert: always_active,
    },
    Parameter {
        id: "light.azimuth",
        group: Group::Light,
        label: "Azimuth",
        unit: "deg",
        help: "Compass angle of the point that the light comes from, from +z toward +x. Setting it takes the sun from the \
           file.",
        kind: Kind::Number(Number { min: 0.0, max: 360.0, step: 1.0, logarithmic: false, decimals: 1, unset: None }),
        field: Field {
            get: |s| Some(Value::Number(turn(f64::from(s.light.azimuth)))),
            set: |s, value| {
                s.light.azimuth.assign(value);
                s.light.file = None;
            },
            ..field!(light.azimuth)
        },
        inert: by_angles,
    },
    Parameter {
        id: "light.elevation",
        group: Group::Light,
        label: "Elevation",
        unit: "deg",
        help: "Angle of the sun above the horizon. A low sun throws long shadows and grazes the ground, which is \
           the hardest case for biases. Setting it takes the sun from the file.",
        kind: Kind::Number(Number { min: 0.0, max: 90.0, step: 1.0, logarithmic: false, decimals: 1, unset: None }),
        field: Field {
            set: |s, value| {
                s.light.elevation.assign(value);
                s.light.file = None;
            },
            ..field!(light.elevation)
        },
        inert: by_angles,
    },
    Parameter {
        id: "light.file",
        group: Group::Light,
        label: "Sun of the file",
        unit: "",
        help: "Number of the file's directional light that is the sun. It moves as the file's animation moves it. The menu \
           Scene lists the lights by name.",
        kind: Kind::Number(Number {
            min: 1.0,
            max: MOST_OF_A_FILE,
            step: 1.0,
            logarithmic: true,
            decimals: 0,
            unset: Some(Unset {
                option: ChoiceOption {
                    id: "by_hand",
                    label: "By hand",
                    help: "The sun stands where time of day, azimuth and elevation say.",
                },
                initial: 1.0,
            }),
        }),
        field: field!(light.file),
        inert: by_angles,
    },
    Parameter {
        id: "light.animate",
        group: Group::Light,
        label: "Animate",
        unit: "",
        help: "Lets the sun circle the vertical, or pass over the day where a time of day is set. Watch the shadow edges \
           crawl while the fit turns with it.",
        kind: Kind::Toggle,
        field: field!(light.animate),
        inert: always_active,
    },
    Parameter {
        id: "light.animate_speed",
        group: Group::Light,
        label: "Speed of the sun",
        unit: "deg/s",
        help: "How fast the sun moves while it is animated. The real one turns 0.004 degrees a second.",
        kind: Kind::Number(Number { min: 0.0, max: 180.0, step: 0.5, logarithmic: true, decimals: 2, unset: None }),
        field: field!(light.animate_speed),
        inert: |s| (!s.light.animate).then_some("The sun stands still; turn on Animate."),
    },
    Parameter {
        id: "camera.file",
        group: Group::Camera,
        label: "Camera of the file",
        unit: "",
        help: "Number of the file's camera that is followed, also while the file's animation moves it. Flying ends that. The \
           menu Scene lists the cameras by name.",
        kind: Kind::Number(Number {
            min: 1.0,
            max: MOST_OF_A_FILE,
            step: 1.0,
            logarithmic: true,
            decimals: 0,
            unset: Some(Unset {
                option: ChoiceOption { id: "free", label: "Free flight", help: "The camera goes where you fly it." },
                initial: 1.0,
            }),
        }),
        field: field!(camera.file),
        inert: always_active,
    },
    Parameter {
        id: "camera.height",
        group: Group::Camera,
        label: "Height of the view",
        unit: "m",
        help: "Height of the picture of an orthographic lens, whose lines of sight are parallel. Flying forward or back changes \
           it.",
        kind: Kind::Number(Number {
            min: HEIGHTS.0 as f64,
            max: HEIGHTS.1 as f64,
            step: 0.1,
            logarithmic: true,
            decimals: 2,
            unset: Some(Unset {
                option: ChoiceOption { id: "perspective", label: "Perspective", help: "The lens has a field of view." },
                initial: 10.0,
            }),
        }),
        field: field!(camera.height),
        inert: always_active,
    },
    Parameter {
        id: "camera.fov_y",
        group: Group::Camera,
        label: "Field of view",
        unit: "deg",
        help: "Vertical angle of the lens. A wide view spreads the shadow map over more ground.",
        kind: Kind::Number(Number { min: 0.1, max: 179.5, step: 1.0, logarithmic: false, decimals: 1, unset: None }),
        field: field!(camera.fov_y),
        inert: |s| s.camera.height.map(|_| "The lens is orthographic; set Height of the view to Perspective."),
    },
    Parameter {
        id: "camera.near",
        group: Group::Camera,
        label: "Near plane",
        unit: "m",
        help: "Nothing nearer than this is drawn. Far plane and shadow distance are kept at twice this or more.",
        kind: Kind::Number(Number { min: 1e-6, max: 100.0, step: 0.01, logarithmic: true, decimals: 3, unset: None }),
        field: Field {
            set: |s, value| {
                s.camera.near.assign(value);
                let least = MIN_FAR_PER_NEAR * s.camera.near;
                s.camera.far = s.camera.far.max(least);
                let distance = &mut s.technique.fit.max_distance;
                *distance = distance.max(least);
            },
            ..field!(camera.near)
        },
        inert: always_active,
    },
    Parameter {
        id: "camera.far",
        group: Group::Camera,
        label: "Far plane",
        unit: "m",
        help: "Nothing farther than this is drawn; shadows end here at the latest. The near plane is kept at half \
           of this or less.",
        kind: Kind::Number(Number { min: 1e-4, max: 1e6, step: 1.0, logarithmic: true, decimals: 1, unset: None }),
        field: Field {
            set: |s, value| {
                s.camera.far.assign(value);
                pull_near(s, s.camera.far);
            },
            ..field!(camera.far)
        },
        inert: always_active,
    },
    Parameter {
        id: "camera.speed",
        group: Group::Camera,
        label: "Flying speed",
        unit: "m/s",
        help: "How fast the camera flies. Raise it in large scenes.",
        kind: Kind::Number(Number {
            min: FLYING_SPEEDS.0 as f64,
            max: 10_000.0,
            step: 0.1,
            logarithmic: true,
            decimals: 1,
            unset: None,
        }),
        field: field!(camera.speed),
        inert: always_active,
    },
    Parameter {
        id: "view.mode",
        group: Group::View,
        label: "View",
        unit: "",
        help: "What the picture shows of the scene.",
        kind: Kind::Choice(VIEWS),
        field: choice!(view.mode in ViewMode::ALL),
        inert: always_active,
    },
    Parameter {
        id: "view.judge",
        group: Group::View,
        label: "Judge live",
        unit: "",
        help: "Compares the picture with rays all the time, for the figures of its quality. Off, it is done only where the view \
           or the marks show it: a graphics card hardly notices, but without one it takes a part of the CPU.",
        kind: Kind::Toggle,
        field: field!(view.judge),
        inert: |s| {
            let is_shown = s.view.mode.is_judged() || s.view.marks != ErrorMarks::Off;
            is_shown.then_some("The view shows how wrong the picture is, so that it is judged anyway.")
        },
    },
    Parameter {
        id: "view.marks",
        group: Group::View,
        label: "Mark wrong pixels",
        unit: "",
        help: "Marks the pixels that rays prove wrong, in the colour of their class, in the views of the camera.",
        kind: Kind::Choice(&[
            ChoiceOption { id: "off", label: "Off", help: "Nothing is marked." },
            ChoiceOption { id: "outline", label: "Outline", help: "Areas of wrong pixels are outlined." },
            ChoiceOption { id: "blink", label: "Blink", help: "Wrong pixels blink." },
        ]),
        field: choice!(view.marks in [ErrorMarks::Off, ErrorMarks::Outline, ErrorMarks::Blink]),
        inert: always_active,
    },
    Parameter {
        id: "view.shadows",
        group: Group::View,
        label: "Shadows",
        unit: "",
        help: "Draws shadows. Turn it off to see the plain lit scene for comparison.",
        kind: Kind::Toggle,
        field: field!(view.shadows),
        inert: always_active,
    },
    Parameter {
        id: "view.blended_cast",
        group: Group::View,
        label: "Blended surfaces cast",
        unit: "",
        help: "Lets surfaces that are blended cast shadows where their alpha is at least 0.5: many files blend everything. \
           Turn it off for glass and smoke of higher alpha.",
        kind: Kind::Toggle,
        field: field!(view.blended_cast),
        inert: always_active,
    },
    Parameter {
        id: "view.inset",
        group: Group::View,
        label: "Shadow map inset",
        unit: "",
        help: "Shows shadow maps themselves in a corner: how much of them is used and what is missing from them.",
        kind: Kind::Choice(&[
            ChoiceOption { id: "off", label: "Off", help: "No map is shown." },
            ChoiceOption { id: "one", label: "One map", help: "One map is shown." },
            ChoiceOption { id: "all", label: "All maps", help: "All maps are shown, one above the other." },
        ]),
        field: choice!(view.inset in [InsetMaps::Off, InsetMaps::One, InsetMaps::All]),
        inert: always_active,
    },
    Parameter {
        id: "view.inset_map",
        group: Group::View,
        label: "Map in the inset",
        unit: "",
        help: "Which map the inset shows, map 1 being the nearest, or the finest window.",
        kind: Kind::Number(Number {
            min: 1.0,
            max: MAX_MAPS as f64,
            step: 1.0,
            logarithmic: false,
            decimals: 0,
            unset: None,
        }),
        field: field!(view.inset_map),
        inert: |s| match s.view.inset {
            InsetMaps::One => None,
            InsetMaps::Off => Some("There is no inset; set Shadow map inset to One map."),
            InsetMaps::All => Some("All maps are shown; set Shadow map inset to One map."),
        },
    },
    Parameter {
        id: "view.inset_black",
        group: Group::View,
        label: "Black at depth",
        unit: "",
        help: "Stored depth that insets show as black.",
        kind: Kind::Number(Number {
            min: 0.0,
            max: 1.0,
            step: 0.01,
            logarithmic: false,
            decimals: 3,
            unset: Some(Unset {
                option: ChoiceOption {
                    id: "automatic",
                    label: "Automatic",
                    help: "Black and white are the depths between which the scene lies in the map.",
                },
                initial: 0.0,
            }),
        }),
        field: Field {
            get: |s| Some(s.view.inset_depths.map_or(Value::Unset, |[black, _]| black.value())),
            set: |s, value| {
                let white = s.view.inset_depths.map_or(1.0, |[_, white]| white);
                s.view.inset_depths = value.number().map(|black| [black as f32, white]);
            },
            code: None,
            is_of_variant: false,
        },
        inert: with_inset,
    },
    Parameter {
        id: "view.inset_white",
        group: Group::View,
        label: "White at depth",
        unit: "",
        help: "Stored depth that insets show as white. Below the one of black, near and far are swapped.",
        kind: Kind::Number(Number { min: 0.0, max: 1.0, step: 0.01, logarithmic: false, decimals: 3, unset: None }),
        field: Field {
            get: |s| s.view.inset_depths.map(|[_, white]| white.value()),
            set: |s, value| {
                if let Some([_, white]) = &mut s.view.inset_depths {
                    white.assign(value);
                }
            },
            code: None,
            is_of_variant: true,
        },
        inert: |s| match s.view.inset_depths {
            Some(_) => with_inset(s),
            None => {
                Some("Black and white follow from the scene; set Black at depth to a number (view.inset_black = 0).")
            }
        },
    },
    Parameter {
        id: "view.ray_offset",
        group: Group::View,
        label: "Start of shadow rays",
        unit: "m",
        help: "Distance above the surface at which the shadow rays of the judge and of exact edges start. Surfaces that lie \
           closer together throw no shadow on each other in truth.",
        kind: Kind::Number(Number {
            min: 1e-7,
            max: 10.0,
            step: 0.001,
            logarithmic: true,
            decimals: 6,
            unset: Some(Unset {
                option: ChoiceOption {
                    id: "automatic",
                    label: "Automatic",
                    help: "A millimetre; less in a model below 2 m, more where coordinates exceed 1 km.",
                },
                initial: 1e-3,
            }),
        }),
        field: field!(view.ray_offset),
        inert: always_active,
    },
    Parameter {
        id: "view.outside_beside",
        group: Group::View,
        label: "Outside view beside",
        unit: "",
        help: "Shows the view from outside beside the picture: the camera's frustum, the boxes of the maps, and the casters \
           that are in none of them.",
        kind: Kind::Toggle,
        field: field!(view.outside_beside),
        inert: always_active,
    },
    Parameter {
        id: "view.freeze_fit",
        group: Group::View,
        label: "Freeze the fit",
        unit: "",
        help: "Keeps the shadow maps where they look now while the camera flies on, to see from elsewhere what they \
           cover.",
        kind: Kind::Toggle,
        field: field!(view.freeze_fit),
        inert: always_active,
    },
    Parameter {
        id: "view.play",
        group: Group::View,
        label: "Play animation",
        unit: "",
        help: "Plays the scene's animation. Pause it to study one frame.",
        kind: Kind::Toggle,
        field: field!(view.play),
        inert: always_active,
    },
];

/// Greatest number of a light or camera of a file that can be chosen: more than files have.
const MOST_OF_A_FILE: f64 = 1e6;

/// Why the angles have no effect, or `None` where they have one.
fn by_angles(s: &Settings) -> Option<&'static str> {
    s.light.hour.map(|_| "The sun stands where the time of day says; set Time of day to By angles.")
}

/// Why the depths of insets have no effect, or `None` where they have one.
fn with_inset(s: &Settings) -> Option<&'static str> {
    let is_shown = s.view.inset != InsetMaps::Off || s.view.mode == ViewMode::Updates;
    (!is_shown).then_some("No map is shown; turn on Shadow map inset, or set View to Map updates.")
}

/// An angle as a compass shows it, 0 to 2π: the azimuth of an animated sun is kept in -π to π, and settings that were
/// filled by hand may have any.
fn turn(radians: f64) -> f64 {
    // 2π in f32 is a little more than a turn, and setting 360 degrees should read 360.
    const TOLERANCE: f64 = 1e-6;
    if (0.0..=TAU + TOLERANCE).contains(&radians) { radians } else { radians.rem_euclid(TAU) }
}
