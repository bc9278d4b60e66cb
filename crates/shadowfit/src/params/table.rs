//! The rows of the parameter table, in the order that they are shown.

mod bias;
mod fit;
mod map;
mod softness;
mod splits;
mod stabilise;
mod tool;

use super::{MIN_FAR_PER_NEAR, Parameter};
use crate::tool::Settings;

/// Every parameter of [`Settings`].
pub static PARAMETERS: &[Parameter] = &[
    fit::KIND,
    fit::RECEIVERS,
    fit::NEED,
    fit::RECTANGLE,
    fit::MAX_TEXEL_RATIO,
    fit::LEAST_TEXEL,
    fit::MAX_DISTANCE,
    fit::CASTERS,
    fit::CASTER_EXTENSION,
    fit::BORDER,
    fit::MARGIN,
    fit::UP_X,
    fit::UP_Y,
    fit::UP_Z,
    splits::COUNT,
    splits::SCHEME,
    splits::LAMBDA,
    splits::MANUAL[0],
    splits::MANUAL[1],
    splits::MANUAL[2],
    splits::MANUAL[3],
    splits::MANUAL[4],
    splits::MANUAL[5],
    splits::MANUAL[6],
    splits::CHOICE,
    splits::BLEND,
    splits::OVERLAP,
    stabilise::MODE,
    stabilise::MARGIN,
    stabilise::GROWTH,
    stabilise::WASTE,
    stabilise::HORIZON,
    map::RESOLUTION,
    map::HEIGHT,
    map::FORMAT,
    map::FILTER,
    map::FADE,
    map::DEPTH,
    softness::MEASURE,
    softness::ANGLE,
    softness::METRES,
    softness::FLOOR,
    softness::CEILING,
    bias::CONSTANT,
    bias::SLOPE,
    bias::NORMAL_OFFSET,
    bias::RECEIVER_PLANE,
    bias::DEPTH_STEPS,
    tool::HOUR,
    tool::AZIMUTH,
    tool::ELEVATION,
    tool::ANIMATE,
    tool::ANIMATE_SPEED,
    tool::FOV_Y,
    tool::NEAR,
    tool::FAR,
    tool::SPEED,
    tool::MODE,
    tool::JUDGE,
    tool::MARKS,
    tool::SHADOWS,
    tool::INSET,
    tool::INSET_MAP,
    tool::INSET_BLACK,
    tool::INSET_WHITE,
    tool::OUTSIDE_BESIDE,
    tool::FREEZE_FIT,
    tool::PLAY,
];

const fn always_there(_: &Settings) -> bool {
    true
}

const fn always_active(_: &Settings) -> Option<&'static str> {
    None
}

/// Keeps the near plane below a distance that was just set.
fn pull_near(settings: &mut Settings, far: f32) {
    settings.camera.near = settings.camera.near.min(far / MIN_FAR_PER_NEAR);
}
