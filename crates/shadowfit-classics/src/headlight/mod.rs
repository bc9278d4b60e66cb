//! The headlight street: parts that its two stages share.

pub mod projective;
pub mod real_shadow;
mod street;

use core::f32::consts::FRAC_PI_2;

use glam::{DVec3, Vec3};
use shadowfit::spot::SpotLight;

use crate::mapped::{SampleFormat, SampleMapSettings, Shading};
use crate::options::{OptionKind, SampleOption, SampleValues};

/// Width and height of the source's window and of its map.
const SIZE: [u32; 2] = [500; 2];
/// Eye and direction of view of the source.
const EYE: DVec3 = DVec3::new(-25.0, 13.0, 18.0);
const FORWARD: Vec3 = Vec3::new(25.0, -11.0, -30.0);
/// Position of the headlight, in the street's units.
const HEADLIGHT: DVec3 = DVec3::new(-18.0, 5.0, -2.0);
/// Modern lighting: irradiance of the lamp and of its surroundings.
const MODERN: Shading = Shading::modern(2.4, 0.25);

/// Option for the map's format.
const FORMAT: SampleOption = SampleOption {
    id: "format",
    label: "Map format",
    help: "The source first uses a colour texture, which has 256 depths, and later 32-bit floats.",
    kind: OptionKind::Choice(&[("grey8", "8-bit colour"), ("r32f", "32-bit float")]),
};

/// Returns the settings of the source's map: as large as its window, cleared to 0, with all faces.
fn map(values: &SampleValues) -> SampleMapSettings {
    SampleMapSettings { clear: 0, ..SampleMapSettings::new(SIZE, SampleFormat::of(values.choice("format"))) }
}

/// Returns the headlight, which projects a square image of 90° from its place in the street.
fn headlight(target: DVec3, near: f32) -> SpotLight {
    SpotLight::toward(HEADLIGHT, target, FRAC_PI_2, 1.0, near, 100.0)
}
