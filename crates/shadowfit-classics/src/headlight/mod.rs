//! The headlight street: what its two stages share.

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
/// Where the source looks from, and where to.
const EYE: DVec3 = DVec3::new(-25.0, 13.0, 18.0);
const FORWARD: Vec3 = Vec3::new(25.0, -11.0, -30.0);
/// Where the headlight is, in the street's units.
const HEADLIGHT: DVec3 = DVec3::new(-18.0, 5.0, -2.0);
/// Modern lighting: irradiance of the lamp and of its surroundings.
const MODERN: Shading = Shading::modern(2.4, 0.25);

/// What the map stores.
const FORMAT: SampleOption = SampleOption {
    id: "format",
    label: "Map format",
    help: "The source first takes a colour texture, which has 256 depths, and then 32-bit floats.",
    kind: OptionKind::Choice(&[("grey8", "8-bit colour"), ("r32f", "32-bit float")]),
};

/// The source's map: as large as its window, cleared to 0, of all faces.
fn map(values: &SampleValues) -> SampleMapSettings {
    SampleMapSettings { clear: 0, ..SampleMapSettings::new(SIZE, SampleFormat::of(values.choice("format"))) }
}

/// A square image of 90° that the headlight throws from its place in the street.
fn headlight(target: DVec3, near: f32) -> SpotLight {
    SpotLight::toward(HEADLIGHT, target, FRAC_PI_2, 1.0, near, 100.0)
}
