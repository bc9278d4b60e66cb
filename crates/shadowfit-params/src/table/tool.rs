//! The rows of the tools' settings: sun, camera and what is drawn.

use super::{always_active, always_there, pull_near};
use crate::tool::{DAY, ErrorMarks, FLYING_SPEEDS, InsetMaps, Settings, ViewMode};
use crate::{Choice, ChoiceOption, Group, Kind, MIN_FAR_PER_NEAR, Number, Optional, Parameter, Toggle};
use shadowfit::settings::MAX_MAPS;

pub(super) const HOUR: Parameter = Parameter {
    id: "light.hour",
    group: Group::Light,
    label: "Time of day",
    unit: "h",
    help: "Moves the sun as on a day in spring: it rises at 6 in the east (+x), stands 50 degrees high in the south (+z) \
           at 12, and sets at 18 in the west.",
    kind: Kind::Optional(Optional {
        min: DAY.0 as f64,
        max: DAY.1 as f64,
        step: 0.1,
        logarithmic: false,
        decimals: 2,
        unset: Some(ChoiceOption {
            id: "by_angles",
            label: "By angles",
            help: "The sun stands where azimuth and elevation say.",
        }),
        initial: 10.0,
        present: always_there,
        read: |s| s.light.hour.map(f64::from),
        write: |s, value| s.light.hour = value.map(|hour| hour as f32),
    }),
    inert: always_active,
};

/// Why the angles have no effect, or `None` where they have one.
fn by_angles(s: &Settings) -> Option<&'static str> {
    s.light.hour.map(|_| "The sun stands where the time of day says; set Time of day to By angles.")
}

pub(super) const AZIMUTH: Parameter = Parameter {
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
    inert: by_angles,
};

pub(super) const ELEVATION: Parameter = Parameter {
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
    inert: by_angles,
};

pub(super) const ANIMATE: Parameter = Parameter {
    id: "light.animate",
    group: Group::Light,
    label: "Animate",
    unit: "",
    help: "Lets the sun circle the vertical, or pass over the day where a time of day is set. Watch the shadow edges \
           crawl while the fit turns with it.",
    kind: Kind::Toggle(Toggle { read: |s| s.light.animate, write: |s, on| s.light.animate = on }),
    inert: always_active,
};

pub(super) const ANIMATE_SPEED: Parameter = Parameter {
    id: "light.animate_speed",
    group: Group::Light,
    label: "Speed of the sun",
    unit: "deg/s",
    help: "How fast the sun moves while it is animated. The real one turns 0.004 degrees a second.",
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

pub(super) const FOV_Y: Parameter = Parameter {
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

pub(super) const NEAR: Parameter = Parameter {
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
            let distance = &mut s.technique.fit.max_distance;
            *distance = distance.max(least);
        },
    }),
    inert: always_active,
};

pub(super) const FAR: Parameter = Parameter {
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

pub(super) const SPEED: Parameter = Parameter {
    id: "camera.speed",
    group: Group::Camera,
    label: "Flying speed",
    unit: "m/s",
    help: "How fast the camera flies. Raise it in large scenes.",
    kind: Kind::Number(Number {
        min: FLYING_SPEEDS.0 as f64,
        max: FLYING_SPEEDS.1 as f64,
        step: 0.1,
        logarithmic: true,
        decimals: 1,
        read: |s| f64::from(s.camera.speed),
        write: |s, value| s.camera.speed = value as f32,
    }),
    inert: always_active,
};

pub(super) const SHADOWS: Parameter = Parameter {
    id: "view.shadows",
    group: Group::View,
    label: "Shadows",
    unit: "",
    help: "Draws shadows. Turn it off to see the plain lit scene for comparison.",
    kind: Kind::Toggle(Toggle { read: |s| s.view.shadows, write: |s, on| s.view.shadows = on }),
    inert: always_active,
};

pub(super) const MODE: Parameter = Parameter {
    id: "view.mode",
    group: Group::View,
    label: "View",
    unit: "",
    help: "What the picture shows of the scene.",
    kind: Kind::Choice(Choice {
        options: &[
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
                id: "need",
                label: "Need",
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
        ],
        read: |s| ViewMode::ALL.iter().position(|mode| *mode == s.view.mode).unwrap_or(0),
        write: |s, index| s.view.mode = ViewMode::ALL[index],
    }),
    inert: always_active,
};

pub(super) const JUDGE: Parameter = Parameter {
    id: "view.judge",
    group: Group::View,
    label: "Judge live",
    unit: "",
    help: "Compares the picture with rays all the time, for the figures of its quality. Off, it is done only where the view \
           or the marks show it: a graphics card hardly notices, but without one it takes a part of the CPU.",
    kind: Kind::Toggle(Toggle { read: |s| s.view.judge, write: |s, on| s.view.judge = on }),
    inert: |s| {
        let is_shown = s.view.mode.is_judged() || s.view.marks != ErrorMarks::Off;
        is_shown.then_some("The view shows how wrong the picture is, so that it is judged anyway.")
    },
};

pub(super) const MARKS: Parameter = Parameter {
    id: "view.marks",
    group: Group::View,
    label: "Mark wrong pixels",
    unit: "",
    help: "Marks the pixels that rays prove wrong, in the colour of their class, in the views of the camera.",
    kind: Kind::Choice(Choice {
        options: &[
            ChoiceOption { id: "off", label: "Off", help: "Nothing is marked." },
            ChoiceOption { id: "outline", label: "Outline", help: "Areas of wrong pixels are outlined." },
            ChoiceOption { id: "blink", label: "Blink", help: "Wrong pixels blink." },
        ],
        read: |s| s.view.marks as usize,
        write: |s, index| s.view.marks = [ErrorMarks::Off, ErrorMarks::Outline, ErrorMarks::Blink][index],
    }),
    inert: always_active,
};

pub(super) const INSET: Parameter = Parameter {
    id: "view.inset",
    group: Group::View,
    label: "Shadow map inset",
    unit: "",
    help: "Shows shadow maps themselves in a corner: how much of them is used and what is missing from them.",
    kind: Kind::Choice(Choice {
        options: &[
            ChoiceOption { id: "off", label: "Off", help: "No map is shown." },
            ChoiceOption { id: "one", label: "One map", help: "One map is shown." },
            ChoiceOption { id: "all", label: "All maps", help: "All maps are shown, one above the other." },
        ],
        read: |s| s.view.inset as usize,
        write: |s, index| s.view.inset = [InsetMaps::Off, InsetMaps::One, InsetMaps::All][index],
    }),
    inert: always_active,
};

pub(super) const INSET_MAP: Parameter = Parameter {
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
        read: |s| f64::from(s.view.inset_map),
        write: |s, value| s.view.inset_map = value as u32,
    }),
    inert: |s| match s.view.inset {
        InsetMaps::One => None,
        InsetMaps::Off => Some("There is no inset; set Shadow map inset to One map."),
        InsetMaps::All => Some("All maps are shown; set Shadow map inset to One map."),
    },
};

/// Why the depths of insets have no effect, or `None` where they have one.
fn with_inset(s: &Settings) -> Option<&'static str> {
    let is_shown = s.view.inset != InsetMaps::Off || s.view.mode == ViewMode::Updates;
    (!is_shown).then_some("No map is shown; turn on Shadow map inset, or set View to Map updates.")
}

pub(super) const INSET_BLACK: Parameter = Parameter {
    id: "view.inset_black",
    group: Group::View,
    label: "Black at depth",
    unit: "",
    help: "Stored depth that insets show as black.",
    kind: Kind::Optional(Optional {
        min: 0.0,
        max: 1.0,
        step: 0.01,
        logarithmic: false,
        decimals: 3,
        unset: Some(ChoiceOption {
            id: "automatic",
            label: "Automatic",
            help: "Black and white are the depths between which the scene lies in the map.",
        }),
        initial: 0.0,
        present: always_there,
        read: |s| s.view.inset_depths.map(|[black, _]| f64::from(black)),
        write: |s, value| {
            let white = s.view.inset_depths.map_or(1.0, |[_, white]| white);
            s.view.inset_depths = value.map(|black| [black as f32, white]);
        },
    }),
    inert: with_inset,
};

pub(super) const INSET_WHITE: Parameter = Parameter {
    id: "view.inset_white",
    group: Group::View,
    label: "White at depth",
    unit: "",
    help: "Stored depth that insets show as white. Below the one of black, near and far are swapped.",
    kind: Kind::Optional(Optional {
        min: 0.0,
        max: 1.0,
        step: 0.01,
        logarithmic: false,
        decimals: 3,
        unset: None,
        initial: 0.5,
        present: |s| s.view.inset_depths.is_some(),
        read: |s| s.view.inset_depths.map(|[_, white]| f64::from(white)),
        write: |s, value| {
            if let (Some([_, white]), Some(value)) = (&mut s.view.inset_depths, value) {
                *white = value as f32;
            }
        },
    }),
    inert: |s| match s.view.inset_depths {
        Some(_) => with_inset(s),
        None => Some("Black and white follow from the scene; set Black at depth to a number (view.inset_black = 0)."),
    },
};

pub(super) const OUTSIDE_BESIDE: Parameter = Parameter {
    id: "view.outside_beside",
    group: Group::View,
    label: "Outside view beside",
    unit: "",
    help: "Shows the view from outside beside the picture: the camera's frustum, the boxes of the maps, and the casters \
           that are in none of them.",
    kind: Kind::Toggle(Toggle { read: |s| s.view.outside_beside, write: |s, on| s.view.outside_beside = on }),
    inert: always_active,
};

pub(super) const FREEZE_FIT: Parameter = Parameter {
    id: "view.freeze_fit",
    group: Group::View,
    label: "Freeze the fit",
    unit: "",
    help: "Keeps the shadow maps where they look now while the camera flies on, to see from elsewhere what they \
           cover.",
    kind: Kind::Toggle(Toggle { read: |s| s.view.freeze_fit, write: |s, on| s.view.freeze_fit = on }),
    inert: always_active,
};

pub(super) const PLAY: Parameter = Parameter {
    id: "view.play",
    group: Group::View,
    label: "Play animation",
    unit: "",
    help: "Plays the scene's animation. Pause it to study one frame.",
    kind: Kind::Toggle(Toggle { read: |s| s.view.play, write: |s, on| s.view.play = on }),
    inert: always_active,
};

/// An angle as a compass shows it, 0 to 360: the azimuth of an animated sun is kept in -180 to 180, and settings that were
/// filled by hand may have any.
fn turn(degrees: f64) -> f64 {
    // 2π in f32 is a little more than a turn, and setting 360 should read 360.
    const TOLERANCE: f64 = 1e-4;
    if (0.0..=360.0 + TOLERANCE).contains(&degrees) { degrees } else { (degrees % 360.0 + 360.0) % 360.0 }
}
