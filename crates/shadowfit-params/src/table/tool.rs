//! The rows for the tools' settings: sun, camera and view.

use core::f64::consts::TAU;

use shadowfit::settings::MAX_MAPS;

use super::{always_active, pull_near};
use crate::field::{Field, Plain as _, choice, field};
use crate::tool::{DAY, ErrorMarks, FLYING_SPEEDS, HEIGHTS, InsetMaps, Settings, ViewMode, remainder};
use crate::{ChoiceOption, Group, Kind, MIN_FAR_PER_NEAR, Number, Parameter, Unset, Value};

/// Names and help texts of the views, in the order of [`ViewMode::ALL`].
const VIEWS: &[ChoiceOption] = &[
    ChoiceOption { id: "final", label: "Final", help: "The scene with the shadows of the maps." },
    ChoiceOption {
        id: "truth",
        label: "Truth",
        help: "The scene with ray-traced shadows: how the final picture should look.",
    },
    ChoiceOption {
        id: "error",
        label: "Errors",
        help: "The final picture in grey, with each pixel that rays prove wrong in the colour of its class.",
    },
    ChoiceOption {
        id: "pixels_per_texel",
        label: "Pixels per texel",
        help: "Screen pixels per shadow texel: red where texels are visible, blue where they are finer than the \
                       picture needs.",
    },
    ChoiceOption {
        id: "maps",
        label: "Maps",
        help: "The map that each point reads, in the colours of the table of maps.",
    },
    ChoiceOption {
        id: "texel_grid",
        label: "Texel grid",
        help: "The texels of the maps on the surfaces that read them.",
    },
    ChoiceOption {
        id: "demand",
        label: "Demand",
        help: "The scene from the light's direction: the texel size that the picture needs at each place, under the \
                       outlines of the maps.",
    },
    ChoiceOption {
        id: "updates",
        label: "Map updates",
        help: "All maps side by side: kept texels, redrawn texels, and moving casters.",
    },
    ChoiceOption {
        id: "outside",
        label: "Outside",
        help: "The camera from outside, with its frustum and the boxes of the maps. A caster outside a map's box casts \
                       no shadow there.",
    },
    ChoiceOption {
        id: "traced",
        label: "Traced",
        help: "The scene in grey. Colours show the pixels near edges that rays decided, and the undecided pixels that \
                       were left to the filter.",
    },
];

/// Returns the name and the help of a view.
pub fn view_option(mode: ViewMode) -> &'static ChoiceOption {
    let index = ViewMode::ALL.iter().position(|each| *each == mode).unwrap_or(0);
    &VIEWS[index]
}

/// Rows in display order.
pub(super) const ROWS: &[Parameter] = &[
    Parameter {
        id: "light.hour",
        group: Group::Light,
        label: "Time of day",
        unit: "h",
        help: "Moves the sun as on a day in spring: it rises at 6 in the east (+x), is 50 degrees high in the south \
           (+z) at 12, and sets at 18 in the west.",
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
                    help: "Azimuth and elevation place the sun.",
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
        help: "Compass angle of the sun, from +z toward +x. Setting it detaches the sun from the file's light.",
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
        help: "Angle of the sun above the horizon. A low sun casts long shadows and grazes the ground, which is the \
           hardest case for biases. Setting it detaches the sun from the file's light.",
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
        help: "Number of the directional light in the scene file that serves as the sun. It moves with the file's \
           animation. The menu Scene lists the lights by name.",
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
                    help: "Time of day, azimuth and elevation place the sun.",
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
        help: "Moves the sun around the vertical axis, or through the day if a time of day is set. Shadow edges crawl \
           while the maps turn with the sun.",
        kind: Kind::Toggle,
        field: field!(light.animate),
        inert: always_active,
    },
    Parameter {
        id: "light.animate_speed",
        group: Group::Light,
        label: "Speed of the sun",
        unit: "deg/s",
        help: "Speed of the animated sun. The real sun turns 0.004 degrees a second.",
        kind: Kind::Number(Number { min: 0.0, max: 180.0, step: 0.5, logarithmic: true, decimals: 2, unset: None }),
        field: field!(light.animate_speed),
        inert: |s| (!s.light.animate).then_some("The sun does not move; turn on Animate."),
    },
    Parameter {
        id: "camera.file",
        group: Group::Camera,
        label: "Camera of the file",
        unit: "",
        help: "Number of the file's camera to follow, including its animation. Flying stops following it. The menu \
           Scene lists the cameras by name.",
        kind: Kind::Number(Number {
            min: 1.0,
            max: MOST_OF_A_FILE,
            step: 1.0,
            logarithmic: true,
            decimals: 0,
            unset: Some(Unset {
                option: ChoiceOption { id: "free", label: "Free flight", help: "You fly the camera." },
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
        help: "Height of the picture of an orthographic lens. Flying forward or back changes it.",
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
        help: "Vertical field of view of the lens. A wide view spreads the shadow map over more ground.",
        kind: Kind::Number(Number { min: 0.1, max: 179.5, step: 1.0, logarithmic: false, decimals: 1, unset: None }),
        field: field!(camera.fov_y),
        inert: |s| s.camera.height.map(|_| "The lens is orthographic; set Height of the view to Perspective."),
    },
    Parameter {
        id: "camera.near",
        group: Group::Camera,
        label: "Near plane",
        unit: "m",
        help: "Nothing nearer than this is drawn. Far plane and shadow distance stay at twice this or more.",
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
        help: "Nothing farther than this is drawn, and shadows end here at the latest. The near plane stays at half of \
           this or less.",
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
        help: "Speed of the flying camera. Raise it in large scenes.",
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
        help: "The displayed picture.",
        kind: Kind::Choice(VIEWS),
        field: choice!(view.mode in ViewMode::ALL),
        inert: always_active,
    },
    Parameter {
        id: "view.judge",
        group: Group::View,
        label: "Judge live",
        unit: "",
        help: "Compares every picture with rays, for the quality figures. If off, pictures are judged only for views \
           and marks that need it. This costs little on a graphics card; without one, it takes part of the CPU.",
        kind: Kind::Toggle,
        field: field!(view.judge),
        inert: |s| {
            let is_shown = s.view.mode.is_judged() || s.view.marks != ErrorMarks::Off;
            is_shown.then_some("The view or the marks need judged pictures, so they are judged anyway.")
        },
    },
    Parameter {
        id: "view.marks",
        group: Group::View,
        label: "Mark wrong pixels",
        unit: "",
        help: "Marks pixels that rays prove wrong, in the colour of their class, in views of the camera.",
        kind: Kind::Choice(&[
            ChoiceOption { id: "off", label: "Off", help: "Nothing is marked." },
            ChoiceOption { id: "outline", label: "Outline", help: "Outlines areas of wrong pixels." },
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
        help: "Lets blended surfaces cast shadows where their alpha is at least 0.5, since many files blend \
           everything. Turn it off for glass and smoke with a higher alpha.",
        kind: Kind::Toggle,
        field: field!(view.blended_cast),
        inert: always_active,
    },
    Parameter {
        id: "view.inset",
        group: Group::View,
        label: "Shadow map inset",
        unit: "",
        help: "Shows shadow maps in a corner: how much of each is used and what is missing from it.",
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
        help: "Number of the map in the inset. Map 1 is the nearest one, or the finest window.",
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
                    help: "Black and white are the least and the greatest depth of the scene in the map.",
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
        help: "Stored depth that insets show as white. A value below Black at depth swaps near and far.",
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
                Some("Black and white are set automatically; set Black at depth to a number (view.inset_black = 0).")
            }
        },
    },
    Parameter {
        id: "view.ray_offset",
        group: Group::View,
        label: "Start of shadow rays",
        unit: "m",
        help: "Distance above the surface at which the shadow rays of the judge and of exact edges start. Surfaces \
           closer together than this cast no shadow on each other in the truth.",
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
                    help: "1 mm; less in a model below 2 m, more if coordinates exceed 1 km.",
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
        help: "Shows the view from outside beside the picture: the camera's frustum, the boxes of the maps, and the \
           casters that are in no map.",
        kind: Kind::Toggle,
        field: field!(view.outside_beside),
        inert: always_active,
    },
    Parameter {
        id: "view.freeze_fit",
        group: Group::View,
        label: "Freeze the fit",
        unit: "",
        help: "Keeps the current shadow maps while the camera flies on, so that you can see from elsewhere what they \
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

/// Greatest number of a file's light or camera that can be chosen, more than any file has.
const MOST_OF_A_FILE: f64 = 1e6;

/// Returns why the angles have no effect, or `None` if they have one.
fn by_angles(s: &Settings) -> Option<&'static str> {
    s.light.hour.map(|_| "The time of day places the sun; set Time of day to By angles.")
}

/// Returns why the depths of insets have no effect, or `None` if they have one.
fn with_inset(s: &Settings) -> Option<&'static str> {
    let is_shown = s.view.inset != InsetMaps::Off || s.view.mode == ViewMode::Updates;
    (!is_shown).then_some("No map is shown; turn on Shadow map inset, or set View to Map updates.")
}

/// Returns an angle as a compass shows it, 0 to 2π. The azimuth of an animated sun lies in -π to π, and
/// settings from a file may hold any angle.
fn turn(radians: f64) -> f64 {
    // 2π in f32 exceeds a full turn slightly. An angle that was set to 360 degrees should read as 360.
    const TOLERANCE: f64 = 1e-6;
    if (0.0..=TAU + TOLERANCE).contains(&radians) { radians } else { remainder(radians, TAU) }
}
