//! The headlight street in its two stages: a lamp's map projected on the scene, and the shadow that it tells. Its source
//! stores depths in a colour map of 8 bits. One deviation: cars and lamp posts are our own models.

use core::f32::consts::{FRAC_PI_2, FRAC_PI_4};

use glam::{DVec3, Vec3};
use shadowfit::{FitError, PerspectiveCamera};
use shadowfit_render::samples::{
    CasterFaces, LightImage, SampleFormat, SampleFrame, SampleMapSettings, Shading, ShadowTest, StoredDepth,
};

use super::lamp::{Lamp, our_map, our_test};
use super::options::{LIGHTING, OptionKind, SampleOption, SampleValues};
use super::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView};

/// Where the camera of both stages stands, and its way to what it looks at.
const EYE: DVec3 = DVec3::new(-25.0, 13.0, 18.0);
const FORWARD: Vec3 = Vec3::new(25.0, -11.0, -30.0);
/// Where the headlight is.
const HEADLIGHT: DVec3 = DVec3::new(-18.0, 5.0, -2.0);
/// Width and height of the source's window, in pixels, and of its map, in texels.
const WINDOW: [u32; 2] = [500, 500];
/// Depth that a pixel of the second stage may lie behind the stored one: more than two steps of 8 bits.
const BIAS: f32 = 0.01;
const POWER: f32 = 2.0;
const AMBIENT: f32 = 0.5;
/// Modern lighting: irradiance of the headlight and of the night around it.
const MODERN: Shading = Shading::Modern { light: 3.0, ambient: 0.12 };
/// Flying speed, in units a second.
const SPEED: f32 = 15.0;

pub(super) const PROJECTIVE: Sample = Sample {
    id: "headlight-projective",
    title: "Headlight: projective texture",
    teaches: "A picture projected onto a scene: each point is taken into the lamp's clip space, and x and y after the \
              division by w are where it looks the picture up. The picture here is the lamp's own map of depths.",
    flaw: "Nothing tests whether a point is in the lamp's image, so that the border smears over the rest of the street, and \
           points behind the lamp see it upside down.",
    page: "samples/headlight-projective.md",
    size: WINDOW,
    view: SampleView { eye: EYE, forward: FORWARD, fov_y: FRAC_PI_4, near: 1.0, far: 200.0, speed: SPEED },
    direction: Vec3::new(16.0, -2.0, -8.0),
    inset: None,
    only_subject_casts: false,
    is_measurable: false,
    controls: SampleControls::VIEWER,
    options: &[
        SampleOption {
            id: "shadows",
            label: "Projection",
            help: "The lamp's depths on the scene, or the plain lit scene that the source starts from.",
            kind: OptionKind::Choice(&[("source", "as the source"), ("off", "none")]),
        },
        FORMAT,
        SampleOption {
            id: "beside",
            label: "Right half",
            help: "Shows something else in the right half of the picture, on the same view.",
            kind: OptionKind::Choice(&[
                ("none", "the same"),
                ("shadows=off", "the plain scene"),
                ("format=r32f", "the 32-bit map"),
            ]),
        },
    ],
    variants: &[SampleVariant {
        id: "lamp-post",
        label: "A lamp post on the wall",
        text: "The wall behind the lamp post carries the lamp post's grey: what the lamp sees at a texel is painted on all \
               that lies behind it.",
        options: &[],
        view: Some((DVec3::new(-6.0, 11.0, 2.0), Vec3::new(17.0, -4.0, -13.0))),
    }],
    scene: super::scenes::street,
    draws: projective,
};

pub(super) const REAL_SHADOW: Sample = Sample {
    id: "headlight-real-shadow",
    title: "Headlight: real shadow",
    teaches: "The same map tells light from shadow: a point is lit where its own depth is no more than the stored one. \
              It also shows what 256 depths do: the bias of a hundredth is two and a half of their steps.",
    flaw: "The lamp's image ends at its square, whose corners show on the street, and a bias of a hundredth detaches \
           shadows.",
    page: "samples/headlight-real-shadow.md",
    size: WINDOW,
    view: SampleView { eye: EYE, forward: FORWARD, fov_y: FRAC_PI_4, near: 5.0, far: 100.0, speed: SPEED },
    direction: Vec3::new(16.0, -8.0, -8.0),
    inset: None,
    only_subject_casts: false,
    is_measurable: true,
    controls: SampleControls::VIEWER,
    options: &[
        super::options::LAMP_SHADOWS,
        LIGHTING,
        FORMAT,
        SampleOption {
            id: "bias",
            label: "Bias",
            help: "Depth that a point may lie behind the stored one, in units of the stored depth. A step of 8 bits is \
                   0.0039.",
            kind: OptionKind::Number { min: 0.0, max: 0.05, default: BIAS, unit: "" },
        },
        SampleOption {
            id: "image",
            label: "Light image",
            help: "The picture that the lamp throws: a square that shows its corners, a round beam, or two headlights.",
            kind: OptionKind::Choice(&[
                ("square", "square, as the source"),
                ("round", "round"),
                ("headlights", "two headlights"),
            ]),
        },
        SampleOption {
            id: "power",
            label: "Power",
            help: "Factor of the lamp's light.",
            kind: OptionKind::Number { min: 0.0, max: 4.0, default: POWER, unit: "" },
        },
        SampleOption {
            id: "ambient",
            label: "Ambient light",
            help: "Light where the lamp does not shine.",
            kind: OptionKind::Number { min: 0.0, max: 1.0, default: AMBIENT, unit: "" },
        },
        SampleOption {
            id: "beside",
            label: "Right half",
            help: "Shows something else in the right half of the picture, on the same view.",
            kind: OptionKind::Choice(&[
                ("none", "the same"),
                ("shadows=ours", "our map"),
                ("shadows=off", "no shadows"),
                ("format=r32f", "the 32-bit map"),
                ("image=headlights", "two headlights"),
                ("lighting=modern", "modern lighting"),
            ]),
        },
    ],
    variants: &[
        SampleVariant {
            id: "formats",
            label: "8 bits beside 32",
            text: "On the left 256 depths, on the right a 32-bit float: from here the two hardly differ.",
            options: &[("beside", "format=r32f")],
            view: None,
        },
        SampleVariant {
            id: "close-8-bit",
            label: "Close up: 8 bits",
            text: "The shadow of a lamp post close up, from 256 depths: its foot comes off in steps of the depth.",
            options: &[],
            view: Some(CLOSE),
        },
        SampleVariant {
            id: "close-32-bit",
            label: "Close up: 32 bits",
            text: "The same with a 32-bit float: what is left is the map's size of 500 texels and the bias.",
            options: &[("format", "r32f")],
            view: Some(CLOSE),
        },
        SampleVariant {
            id: "acne",
            label: "No bias, 8 bits",
            text: "Without the hundredth, two neighbouring depths of 256 are enough for stripes over road and wall.",
            options: &[("bias", "0")],
            view: None,
        },
        SampleVariant {
            id: "headlights",
            label: "Cure: a light image",
            text: "Two soft beams instead of the square: the image is dark before its border is reached, so that no corner \
                   shows.",
            options: &[("image", "headlights")],
            view: None,
        },
    ],
    scene: super::scenes::street,
    draws: real_shadow,
};

/// At the foot of a lamp post.
const CLOSE: (DVec3, Vec3) = (DVec3::new(-1.0, 5.0, 1.5), Vec3::new(6.0, -4.2, -9.0));

const FORMAT: SampleOption = SampleOption {
    id: "format",
    label: "Map format",
    help: "The source stores depths in a colour map of 8 bits: 256 levels. Beside it the 32-bit float.",
    kind: OptionKind::Choice(&[("grey8", "8-bit colour"), ("r32f", "32-bit float")]),
};

/// The map as the source has it: as large as the window, cleared to 0.
fn map(values: &SampleValues) -> SampleMapSettings {
    SampleMapSettings {
        size: WINDOW,
        format: if values.choice("format") == "r32f" { SampleFormat::R32Float } else { SampleFormat::Grey8 },
        depth: StoredDepth::Plain,
        clear: 0,
        faces: CasterFaces::All,
        compares_linearly: false,
    }
}

fn projective(values: &SampleValues, camera: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
    let lamp = Lamp {
        position: HEADLIGHT,
        target: DVec3::new(-2.0, 3.0, -10.0),
        fov_y: FRAC_PI_2,
        aspect: 1.0,
        near: 5.0,
        far: 100.0,
    };
    let fit = lamp.fit(WINDOW, camera)?;
    let is_off = values.choice("shadows") == "off";
    Ok(SampleDrawing::Mapped(SampleFrame {
        camera: *camera,
        light: lamp.light(&fit, LightImage::Square),
        map: map(values),
        test: ShadowTest::Off,
        // The light's power and the ambient light of this stage are seen in the plain scene alone.
        shading: if is_off { Shading::Headlight { power: 1.0, ambient: 0.2 } } else { Shading::Projective },
        background: [0; 3],
        sky: None,
        casts: None,
        double_sided: true,
        inset: None,
    }))
}

fn real_shadow(values: &SampleValues, camera: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
    let lamp = Lamp {
        position: HEADLIGHT,
        target: DVec3::new(-2.0, -3.0, -10.0),
        fov_y: FRAC_PI_2,
        aspect: 1.0,
        near: 1.0,
        far: 100.0,
    };
    let fit = lamp.fit(WINDOW, camera)?;
    let image = match values.choice("image") {
        "round" => LightImage::Round,
        "headlights" => LightImage::Headlights,
        _ => LightImage::Square,
    };
    let (test, map) = match values.choice("shadows") {
        "off" => (ShadowTest::Off, map(values)),
        "ours" => (our_test(&fit, false)?, our_map(WINDOW)),
        _ => (ShadowTest::RealShadow { bias: values.get("bias") }, map(values)),
    };
    let source = Shading::Headlight { power: values.get("power"), ambient: values.get("ambient") };
    Ok(SampleDrawing::Mapped(SampleFrame {
        camera: *camera,
        light: lamp.light(&fit, image),
        map,
        test,
        shading: if values.choice("lighting") == "modern" { MODERN } else { source },
        background: [0; 3],
        sky: None,
        casts: None,
        double_sided: true,
        inset: None,
    }))
}
