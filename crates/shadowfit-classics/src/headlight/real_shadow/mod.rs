//! Headlight street, second stage: the lamp lights visible surfaces, with a map of 8 or 32 bits.
//!
//! The numbers are the source's, as in the first stage. The light images are our own.

pub mod shade;
pub mod test;

use glam::{DVec3, Vec3};
use shadowfit::{FitError, PerspectiveCamera};

use super::{EYE, FORMAT, FORWARD, MODERN, SIZE, headlight, map, street};
use crate::lamp::{self, Lamp};
use crate::mapped::{LightImage, SampleFrame, Shading, ShadowTest};
use crate::options::{OptionKind, SampleOption, SampleValues};
use crate::sample::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView};

const TARGET: DVec3 = DVec3::new(-2.0, -3.0, -10.0);
const NEAR: f32 = 1.0;
/// The source's bias, which it derives from the step of 1/256 of an 8-bit map.
const BIAS: f32 = 0.01;
const POWER: f32 = 2.0;
const AMBIENT: f32 = 0.5;

pub(crate) const SAMPLE: Sample = Sample {
    id: "headlight-real-shadow",
    title: "Headlight: real shadow",
    teaches: "A lamp's shadow map: a point is lit if it lies in the lamp's image and is no farther than the stored \
        depth plus a bias. The bias depends on the map's format.",
    flaw: "The lamp's image is a square with corners. In perspective, few of the 256 depths are left far from the \
        lamp, so the shadow is coarse close up.",
    page: "samples/headlight-real-shadow.md",
    size: SIZE,
    view: SampleView {
        eye: EYE,
        forward: FORWARD,
        fov_y: core::f32::consts::FRAC_PI_4,
        near: 5.0,
        far: 100.0,
        speed: 15.0,
    },
    // (2, -1, -1) / √6.
    direction: Vec3::new(0.816_496_6, -0.408_248_3, -0.408_248_3),
    inset: None,
    only_subject_casts: false,
    is_measurable: true,
    controls: SampleControls::VIEWER,
    options: &OPTIONS,
    variants: &VARIANTS,
    scene: street::build,
    draws: drawing,
};

const OPTIONS: [SampleOption; 8] = [
    lamp::SHADOWS,
    SampleOption::LIGHTING,
    FORMAT,
    SampleOption {
        id: "bias",
        label: "Bias",
        help: "Depth subtracted from a point's depth before the comparison, in units of the stored depth. The \
            source's 1/100 is two and a half steps of 8 bits.",
        kind: OptionKind::Number { min: 0.0, max: 0.05, default: BIAS, unit: "" },
    },
    SampleOption {
        id: "power",
        label: "Power",
        help: "Factor of the lamp's diffuse light.",
        kind: OptionKind::Number { min: 0.0, max: 4.0, default: POWER, unit: "" },
    },
    SampleOption {
        id: "ambient",
        label: "Ambient light",
        help: "Light that every point receives.",
        kind: OptionKind::Number { min: 0.0, max: 1.0, default: AMBIENT, unit: "" },
    },
    SampleOption {
        id: "image",
        label: "Light image",
        help: "Image that the lamp projects: its whole square, a round beam, or the two beams of headlights.",
        kind: OptionKind::Choice(&[("square", "square"), ("round", "round"), ("headlights", "headlights")]),
    },
    SampleOption::beside(&[
        ("none", "the same"),
        ("shadows=ours", "our map"),
        ("shadows=off", "no shadows"),
        ("format=r32f", "32-bit float"),
        ("image=headlights", "headlights"),
        ("lighting=modern", "modern lighting"),
    ]),
];

/// In front of the shadow of the farther lamp post on the wall.
const CLOSE: (DVec3, Vec3) = (DVec3::new(1.0, 8.5, -40.0), Vec3::new(12.0, -1.5, -8.5));
/// Above the road, with the whole lit area in view.
const ABOVE: (DVec3, Vec3) = (DVec3::new(-34.0, 26.0, 14.0), Vec3::new(34.0, -20.0, -22.0));

const VARIANTS: [SampleVariant; 8] = [
    SampleVariant {
        id: "formats",
        label: "8 bits beside 32",
        text: "From the source's view, the map of 256 depths (left) and the map of floats (right) hardly differ.",
        options: &[("beside", "format=r32f")],
        view: None,
    },
    SampleVariant {
        id: "close-formats",
        label: "Close: 8 bits beside 32",
        text: "Close to the farther lamp post's shadow: with 256 depths (left) it is a block with a jagged outline, \
            with floats (right) it ends in a point.",
        options: &[("beside", "format=r32f")],
        view: Some(CLOSE),
    },
    SampleVariant {
        id: "close-8-bit",
        label: "Close: 8 bits",
        text: "Post and wall are 13 units apart, which is two and a half of 256 steps and equals the bias. Rounding \
            decides which points are in shadow, so the outline follows whole texels.",
        options: &[],
        view: Some(CLOSE),
    },
    SampleVariant {
        id: "close-32-bit",
        label: "Close: 32 bits",
        text: "The same view with floats: depths between texels are smooth. The shadow ends in a point where the bias \
            equals the distance from the post to the wall.",
        options: &[("format", "r32f")],
        view: Some(CLOSE),
    },
    SampleVariant {
        id: "acne",
        label: "Why 1/100",
        text: "With a bias of 1/1000, a quarter of the 8-bit map's step, rounding causes stripes of shadow \
            everywhere. 1/100 is two and a half steps.",
        options: &[("bias", "0.001")],
        view: None,
    },
    SampleVariant {
        id: "corners",
        label: "The square's corners",
        text: "The lamp's image ends at the borders of its map: a square of light with corners on road, wall and pavement.",
        options: &[],
        view: Some(ABOVE),
    },
    SampleVariant {
        id: "round",
        label: "Cure: a round image",
        text: "A light image with a soft rim hides the square.",
        options: &[("image", "round")],
        view: Some(ABOVE),
    },
    SampleVariant {
        id: "headlights",
        label: "Cure: headlights",
        text: "Two beams side by side, like a car's.",
        options: &[("image", "headlights")],
        view: Some(ABOVE),
    },
];

/// Returns the test for a bias in units of the stored depth: linear, lit inside the light's image.
fn test(bias: f32) -> ShadowTest {
    ShadowTest { reach: 1.0, ..ShadowTest::nearest("real shadow", include_str!("test.wgsl"), [bias, 0.0, 0.0, 0.0]) }
}

/// Returns the shading for the factors of the diffuse and the ambient light.
pub(crate) const fn shading(power_and_ambient: [f32; 2]) -> Shading {
    Shading::new("headlight", &[include_str!("shade.wgsl")], power_and_ambient)
}

fn image(values: &SampleValues) -> LightImage {
    match values.choice("image") {
        "round" => LightImage::Round,
        "headlights" => LightImage::Headlights,
        _ => LightImage::Square,
    }
}

fn drawing(values: &SampleValues, camera: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
    let lamp = Lamp::new(&headlight(TARGET, NEAR), SIZE, camera)?;
    let (map, test) = lamp.shadows(values, map(values), test(values.get("bias")), false)?;
    Ok(SampleDrawing::Mapped(SampleFrame {
        camera: *camera,
        light: lamp.light(image(values)),
        map,
        test,
        shading: values.lit(shading(["power", "ambient"].map(|id| values.get(id))), MODERN),
        background: [0; 3],
        double_sided: true,
    }))
}
