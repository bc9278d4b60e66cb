//! The XNA "Shadow Mapping" sample (Microsoft, XNA Creators Club, 2008): a single map whose orthographic box
//! encloses the camera's frustum, with all numbers of the source. One deviation: the character is our own
//! figure.

mod floor;
mod scene;
pub mod shade;
pub mod test;

use glam::{DVec3, UVec2, Vec3};
use shadowfit::bias::XNA_DEPTH_BIAS;
use shadowfit::settings::{FitKind, FitSettings};
use shadowfit::{FitError, PerspectiveCamera};

use crate::mapped::{
    CORNFLOWER, CasterFaces, LightImage, LightPlace, SampleFormat, SampleFrame, SampleLight, SampleMapSettings,
    Shading, ShadowTest,
};
use crate::options::{OptionKind, SampleOption, SampleValues};
use crate::sample::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView, modern};

/// Direction toward the light before normalisation.
const TO_LIGHT: Vec3 = Vec3::new(-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0);
/// Direction of travel of the light. Its length is 1 up to rounding.
const DIRECTION: Vec3 = Vec3::new(1.0 / 3.0, -2.0 / 3.0, -2.0 / 3.0);
/// Ambient light of the source.
const AMBIENT: f32 = 0.15;
/// Modern lighting: irradiance of the sun, and of sky and ground.
const MODERN: Shading = Shading::modern(1.25, 0.35);

pub(crate) const SAMPLE: Sample = Sample {
    id: "xna-shadow-mapping",
    title: "XNA Shadow Mapping",
    teaches: "A sun's shadow map from first principles: the light's box encloses the camera's view, the map stores \
        depths from the light, and each pixel compares its own depth with the stored one.",
    flaw: "The box moves with the camera and misses casters outside of the view, half of its depth range is unused, \
        and a single bias serves all slopes.",
    page: "samples/xna-shadow-mapping.md",
    size: [800, 480],
    view: SampleView {
        eye: DVec3::new(0.0, 70.0, 100.0),
        forward: Vec3::new(0.0, -0.447_213_6, -0.894_427_2),
        fov_y: core::f32::consts::FRAC_PI_4,
        near: 1.0,
        far: 1000.0,
        speed: 100.0,
    },
    direction: DIRECTION,
    inset: Some([0, 0, 128, 128]),
    only_subject_casts: true,
    controls: SampleControls {
        turn: 1.0,
        model_turn: 200.0 * core::f32::consts::PI / 180.0,
        reset: Some((DVec3::new(0.0, 50.0, 50.0), Vec3::NEG_Z)),
    },
    is_measurable: true,
    options: &OPTIONS,
    variants: &VARIANTS,
    scene: scene::build,
    draws: drawing,
};

const OPTIONS: [SampleOption; 8] = [
    SampleOption {
        id: "shadows",
        label: "Shadows",
        help: "As the source, none, or modern maps: the whole viewer with the recommended technique on the same scene.",
        kind: OptionKind::Choice(&[("source", "as the source"), ("off", "none"), ("ours", "modern maps")]),
    },
    SampleOption::LIGHTING,
    SampleOption {
        id: "format",
        label: "Map format",
        help: "The source uses 32-bit floats, else 16-bit floats, else four packed channels of 8 bits. The plain \
            8-bit map has 256 depths.",
        kind: OptionKind::Choice(&[
            ("r32f", "32-bit float"),
            ("r16f", "16-bit float"),
            ("rgba8", "8-bit RGBA, packed"),
            ("grey8", "8-bit, plain"),
        ]),
    },
    SampleOption::map_size(
        "Texels each way. A larger map is the source's first cure for aliasing.",
        &[("2048", "2048²"), ("512", "512²"), ("1024", "1024²"), ("4096", "4096²")],
    ),
    SampleOption {
        id: "bias",
        label: "Bias",
        help: "Depth subtracted from a point's depth before the comparison, in units of the stored depth.",
        kind: OptionKind::Number { min: 0.0, max: 0.01, default: XNA_DEPTH_BIAS, unit: "" },
    },
    SampleOption {
        id: "margin",
        label: "Box margin",
        help: "Enlarges the light's box on all sides: the source's cure for missing casters, at the price of \
            sharpness.",
        kind: OptionKind::Number { min: 0.0, max: 400.0, default: 0.0, unit: "units" },
    },
    SampleOption::INSET,
    SampleOption::beside(&[
        ("none", "the same"),
        ("shadows=ours", "modern maps"),
        ("shadows=off", "no shadows"),
        ("lighting=modern", "modern lighting"),
        ("format=grey8", "the plain 8-bit map"),
        ("margin=120", "an enlarged box"),
    ]),
];

/// In front of the character, close to it.
const CLOSE: (DVec3, Vec3) = (DVec3::new(-26.0, 58.0, 62.0), Vec3::new(0.36, -0.32, -0.88));
/// Beside a foot, over the floor.
const AT_THE_FOOT: (DVec3, Vec3) = (DVec3::new(16.0, 14.0, 16.0), Vec3::new(-0.1, -0.62, -0.78));
/// Behind the character, whose head and back are out of view.
const BEHIND: (DVec3, Vec3) = (DVec3::new(-14.0, 34.0, -4.0), Vec3::new(28.0, -32.0, -30.0));
/// Farther behind, with the whole character out of view.
const FAR_BEHIND: (DVec3, Vec3) = (DVec3::new(6.0, 34.0, -14.0), Vec3::new(0.12, -0.62, -0.78));

const VARIANTS: [SampleVariant; 9] = [
    SampleVariant {
        id: "acne",
        label: "Self-shadow acne",
        text: "Without a bias the character shadows itself in stripes: a texel stores one depth for a whole patch of \
            a slope.",
        options: &[("bias", "0")],
        view: Some(CLOSE),
    },
    SampleVariant {
        id: "acne-8-bit",
        label: "Acne by format: 8 bits",
        text: "The original bias with 256 stored depths: a step is four times the bias, so whole patches are in \
            shadow.",
        options: &[("format", "grey8")],
        view: Some(CLOSE),
    },
    SampleVariant {
        id: "acne-16-bit",
        label: "By format: 16-bit float",
        text: "A 16-bit float rounds by at most 0.00012 here, an eighth of the bias: hardly anything changes.",
        options: &[("format", "r16f")],
        view: Some(CLOSE),
    },
    SampleVariant {
        id: "aliasing",
        label: "Aliasing close up",
        text: "Near the ground the texels of the single map are larger than pixels: the shadow's edge is a staircase.",
        options: &[],
        view: Some(AT_THE_FOOT),
    },
    SampleVariant {
        id: "hole",
        label: "Hole behind the model",
        text: "The camera is behind the character, whose head and back are out of view. Casters outside the view's \
            box are missing in the map, so the shadow has holes.",
        options: &[],
        view: Some(BEHIND),
    },
    SampleVariant {
        id: "missing-caster",
        label: "Caster off screen",
        text: "The camera looks at the expected place of the shadow. The character is out of view, so its shadow is \
            missing. On the right a margin of 120 units brings both back.",
        options: &[("beside", "margin=120")],
        view: Some(FAR_BEHIND),
    },
    SampleVariant {
        id: "wasted-resolution",
        label: "Equal near and far",
        text: "Texels have the same size near and far. At the camera the shadow is made of blocks, while most of the \
            map (in the corner) covers invisible places.",
        options: &[],
        view: Some((DVec3::new(44.0, 7.0, -64.0), Vec3::new(-34.0, -3.0, 44.0))),
    },
    SampleVariant {
        id: "larger-map",
        label: "Cure: a larger map",
        text: "4096² texels halve the staircase of the close-up, at four times the memory.",
        options: &[("map", "4096")],
        view: Some(AT_THE_FOOT),
    },
    SampleVariant {
        id: "larger-box",
        label: "Cure: an enlarged box",
        text: "A margin of 120 units closes the holes of the view from behind, but makes every texel larger.",
        options: &[("margin", "120")],
        view: Some(BEHIND),
    },
];

/// Returns the test for a bias in units of the stored depth.
pub(crate) fn test(bias: f32) -> ShadowTest {
    ShadowTest::nearest("xna", include_str!("test.wgsl"), [bias, 0.0, 0.0, 0.0])
}

/// Returns the shading, with ambient light that the texture does not colour.
fn shading(ambient: f32) -> Shading {
    Shading::new("xna", &[include_str!("shade.wgsl")], [ambient, 0.0])
}

fn drawing(values: &SampleValues, camera: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
    let size: u32 = values.choice("map").parse().unwrap_or(2048);
    let settings = FitSettings::default()
        .with_kind(FitKind::XnaSample)
        .with_resolution(UVec2::splat(size))
        .with_max_distance(camera.far)
        .with_margin(values.get("margin"));
    let fit = shadowfit::fit(&camera.frustum()?, DIRECTION, &settings)?;
    let test = match values.choice("shadows") {
        "off" => ShadowTest::OFF,
        "ours" => return Ok(SampleDrawing::Technique { technique: modern(camera.far), is_tinted: false }),
        _ => test(values.get("bias")),
    };
    Ok(SampleDrawing::Mapped(SampleFrame {
        camera: *camera,
        light: SampleLight {
            clip_from_world: fit.clip_from_world,
            place: LightPlace::Toward(TO_LIGHT.normalize()),
            image: LightImage::Square,
        },
        map: SampleMapSettings {
            faces: CasterFaces::Front,
            ..SampleMapSettings::new([size; 2], SampleFormat::of(values.choice("format")))
        },
        test,
        shading: values.lit(shading(AMBIENT), MODERN),
        background: CORNFLOWER,
        double_sided: false,
    }))
}
