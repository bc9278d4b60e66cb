//! Depth testing with a comparison sampler. The sampler compares depths with a lamp's map. The bias depends
//! on the angle of the light.
//!
//! The formulas are from the source. We chose scene, camera, lamp, ambient light and the size of the map.

pub mod shade;
mod still_life;
pub mod test;

use glam::{DVec3, Vec3};
use shadowfit::bias::acos_epsilon;
use shadowfit::settings::FilterKind;
use shadowfit::spot::SpotLight;
use shadowfit::{FitError, PerspectiveCamera};

use crate::lamp::{self, Lamp};
use crate::mapped::{
    CasterFaces, LightImage, MapRead, SampleFormat, SampleFrame, SampleMapSettings, Shading, ShadowTest,
};
use crate::options::{OptionKind, SampleOption, SampleValues};
use crate::sample::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView};

#[cfg(test)]
pub(crate) use still_life::lamp as lamp_of_the_scene;

/// Width and height of the map.
const MAP: [u32; 2] = [1024; 2];
/// Vertical angle of the lamp's image: 60°.
const IMAGE: f32 = core::f32::consts::FRAC_PI_3;
const NEAR: f32 = 4.0;
const FAR: f32 = 20.0;
/// Shading, with an ambient light of 0.25.
const SHADING: Shading = Shading::new("comparison", &[include_str!("shade.wgsl")], [0.25, 0.0]);
/// Alternative position of the lamp: high above the black knight.
const ABOVE: Vec3 = Vec3::new(-1.35, 12.0, 1.3);
/// Background of a dark room.
const BACKGROUND: [u8; 3] = [38, 42, 52];
/// Modern lighting: irradiance of the lamp and of the room.
const MODERN: Shading = Shading::modern(1.3, 0.25);

pub(crate) const SAMPLE: Sample = Sample {
    id: "comparison-sampler",
    title: "Depth testing with a comparison sampler",
    teaches: "The sampler compares depths and returns the share of lit texels, which is a fraction with linear \
        filtering. The bias depends on the angle between surface and light.",
    flaw: "The bias is meant to grow with the slope but does the opposite. It is largest where the light is \
        perpendicular to a surface, and smallest in grazing light.",
    page: "samples/comparison-sampler.md",
    size: [640, 480],
    view: SampleView {
        eye: DVec3::new(1.3, 3.5, 8.9),
        forward: Vec3::new(-1.2, -2.3, -9.8),
        fov_y: core::f32::consts::FRAC_PI_4,
        near: 0.1,
        far: 40.0,
        speed: 3.0,
    },
    // (6.6, -6.7, -5.2) / 10.7466.
    direction: Vec3::new(0.614_147, -0.623_452, -0.483_873),
    inset: None,
    only_subject_casts: false,
    is_measurable: true,
    controls: SampleControls::VIEWER,
    options: &OPTIONS,
    variants: &VARIANTS,
    scene: still_life::build,
    draws: drawing,
};

const OPTIONS: [SampleOption; 6] = [
    lamp::SHADOWS,
    SampleOption::LIGHTING,
    SampleOption {
        id: "variant",
        label: "Faces in the map",
        help: "The source moves the compared depth away from the lamp, which is right for back faces. For front faces \
            it must move toward the lamp.",
        kind: OptionKind::Choice(&[("literal", "back faces, +"), ("front", "front faces, -")]),
    },
    SampleOption {
        id: "filter",
        label: "Filter",
        help: "The nearest texel with an epsilon of 0.001, or linear filtering of four texels with 0.0005.",
        kind: OptionKind::Choice(&[("point", "nearest texel"), ("linear", "linear")]),
    },
    SampleOption {
        id: "lamp",
        label: "Lamp",
        help: "From the side, or from high above the black knight, where its light is perpendicular to the board.",
        kind: OptionKind::Choice(&[("aside", "from the side"), ("above", "from above")]),
    },
    SampleOption::beside(&[
        ("none", "the same"),
        ("shadows=ours", "our map"),
        ("shadows=off", "no shadows"),
        ("variant=front", "front faces, -"),
        ("filter=linear", "linear"),
        ("lighting=modern", "modern lighting"),
    ]),
];

/// View toward surfaces that face the lamp: ring and vase.
const HEAD_ON: (DVec3, Vec3) = (DVec3::new(-1.2, 2.6, 3.4), Vec3::new(3.1, -1.8, -4.4));
/// The black knight from behind.
const KNIGHT: (DVec3, Vec3) = (DVec3::new(-0.3, 1.6, 0.3), Vec3::new(-1.2, -1.3, 1.0));
/// View toward surfaces in grazing light: the side of the ring and of the pedestal.
const GRAZING: (DVec3, Vec3) = (DVec3::new(-1.4, 2.8, 1.6), Vec3::new(1.4, -1.7, -3.9));

const VARIANTS: [SampleVariant; 7] = [
    SampleVariant {
        id: "head-on",
        label: "Head-on: back faces, +",
        text: "The bias is largest where the light is perpendicular to a surface. It moves the depth behind the back \
            face of lit objects. Dark patches appear on the thin wall of the vase and in the highlights of the ring.",
        options: &[],
        view: Some(HEAD_ON),
    },
    SampleVariant {
        id: "head-on-front",
        label: "Head-on: front faces, -",
        text: "The same view with front faces has no patches. The bias now moves depths toward the lamp, so shadows \
            can only get lost.",
        options: &[("variant", "front")],
        view: Some(HEAD_ON),
    },
    SampleVariant {
        id: "leak",
        label: "Light leaks: front faces, -",
        text: "The lamp hangs high above the black knight. Its light is perpendicular to the board there. The bias \
            exceeds the height of the pieces, so the muzzle casts no shadow.",
        options: &[("variant", "front"), ("lamp", "above")],
        view: Some(KNIGHT),
    },
    SampleVariant {
        id: "leak-cured",
        label: "Cure of the leak: ours",
        text: "The same view with our bias, which is smallest in perpendicular light: the muzzle casts its shadow.",
        options: &[("shadows", "ours"), ("lamp", "above")],
        view: Some(KNIGHT),
    },
    SampleVariant {
        id: "grazing",
        label: "Grazing light: front faces, -",
        text: "The bias is smallest in grazing light, which needs it most: stripes of acne appear on the pedestal and \
            the ring.",
        options: &[("filter", "linear"), ("variant", "front")],
        view: Some(GRAZING),
    },
    SampleVariant {
        id: "grazing-back",
        label: "Grazing light: back faces, +",
        text: "With back faces, lit surfaces are not in the map and have no acne.",
        options: &[("filter", "linear")],
        view: Some(GRAZING),
    },
    SampleVariant {
        id: "slope-scaled",
        label: "Cure: a bias that grows with the slope",
        text: "On the right our map: each look-up is compared with the depth of the surface's own plane.",
        options: &[("filter", "linear"), ("variant", "front"), ("beside", "shadows=ours")],
        view: Some(GRAZING),
    },
];

/// Returns the test, with the epsilon of its filter. The source moves the compared depth away from the light,
/// for maps of back faces. For front faces it moves toward the light.
fn test(is_linear: bool, toward_light: bool) -> ShadowTest {
    let epsilon = acos_epsilon(if is_linear { FilterKind::Hardware2x2 } else { FilterKind::Point });
    let sign = if toward_light { -1.0 } else { 1.0 };
    ShadowTest {
        reads: MapRead::Compared,
        reach: if is_linear { 1.0 } else { 0.5 },
        ..ShadowTest::nearest("comparison", include_str!("test.wgsl"), [epsilon, sign, 0.0, 0.0])
    }
}

fn lamp(values: &SampleValues) -> SpotLight {
    let (position, target) = match values.choice("lamp") {
        "above" => (ABOVE, ABOVE.with_y(0.0)),
        _ => still_life::lamp(),
    };
    SpotLight::toward(position.as_dvec3(), target.as_dvec3(), IMAGE, 1.0, NEAR, FAR)
}

fn drawing(values: &SampleValues, camera: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
    let lamp = Lamp::new(&lamp(values), MAP, camera)?;
    let is_front = values.choice("variant") == "front";
    let is_linear = values.choice("filter") == "linear";
    let map = SampleMapSettings {
        faces: if is_front { CasterFaces::Front } else { CasterFaces::Back },
        compares_linearly: is_linear,
        ..SampleMapSettings::new(MAP, SampleFormat::Depth32)
    };
    let (map, test) = lamp.shadows(values, map, test(is_linear, is_front), true)?;
    Ok(SampleDrawing::Mapped(SampleFrame {
        camera: *camera,
        light: lamp.light(LightImage::Square),
        map,
        test,
        shading: values.lit(SHADING, MODERN),
        background: BACKGROUND,
        double_sided: false,
    }))
}
