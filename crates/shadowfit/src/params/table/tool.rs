//! The rows of the tools' settings: sun, camera and what is drawn.

use super::{always_active, pull_near};
use crate::params::{Group, Kind, MIN_FAR_PER_NEAR, Number, Parameter, Toggle};
use crate::settings::MAX_MAPS;
use crate::tool::FLYING_SPEEDS;

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
    inert: always_active,
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
    inert: always_active,
};

pub(super) const ANIMATE: Parameter = Parameter {
    id: "light.animate",
    group: Group::Light,
    label: "Animate",
    unit: "",
    help: "Lets the sun circle the vertical. Watch the shadow edges crawl while the fit turns with it.",
    kind: Kind::Toggle(Toggle { read: |s| s.light.animate, write: |s, on| s.light.animate = on }),
    inert: always_active,
};

pub(super) const ANIMATE_SPEED: Parameter = Parameter {
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

pub(super) const INSET: Parameter = Parameter {
    id: "view.inset",
    group: Group::View,
    label: "Shadow map inset",
    unit: "",
    help: "Shows one of the shadow maps itself in a corner: how much of it is used and what is missing from it.",
    kind: Kind::Toggle(Toggle { read: |s| s.view.inset, write: |s, on| s.view.inset = on }),
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
    inert: |s| (!s.view.inset).then_some("There is no inset; turn on Shadow map inset."),
};

pub(super) const TINT_MAPS: Parameter = Parameter {
    id: "view.tint_maps",
    group: Group::View,
    label: "Tint by map",
    unit: "",
    help: "Tints each point by the map that it reads, in the colours of the table of the maps.",
    kind: Kind::Toggle(Toggle { read: |s| s.view.tint_maps, write: |s, on| s.view.tint_maps = on }),
    inert: always_active,
};

pub(super) const OUTSIDE: Parameter = Parameter {
    id: "view.outside",
    group: Group::View,
    label: "Outside view",
    unit: "",
    help: "Looks at the camera from outside, with its frustum and the boxes of the maps drawn. A caster outside \
           a map's box throws no shadow there.",
    kind: Kind::Toggle(Toggle { read: |s| s.view.outside, write: |s, on| s.view.outside = on }),
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

/// An angle as a compass shows it: the azimuth of an animated sun grows without limit, but reads 0
/// to 360.
fn turn(degrees: f64) -> f64 {
    // 2π in f32 is a little more than a turn, and setting 360 should read 360.
    const TOLERANCE: f64 = 1e-4;
    if (0.0..=360.0 + TOLERANCE).contains(&degrees) { degrees } else { (degrees % 360.0 + 360.0) % 360.0 }
}
