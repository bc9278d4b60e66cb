//! Depth testing with a comparison sampler: a lamp's map that the sampler itself compares, with a bias by the angle of the
//! light.
//!
//! The formulas are those of the source; scene, camera, lamp, ambient light and the size of the map are our own choice.

use glam::{DVec3, Vec3};
use shadowfit::{FitError, PerspectiveCamera, SpotLight};
use shadowfit_render::samples::{
    CasterFaces, LightImage, SampleFormat, SampleFrame, SampleMapSettings, Shading, ShadowTest, StoredDepth,
};
use shadowfit_scene::builtin::still_life_lamp;

use super::lamp::Lamp;
use super::options::{OptionKind, SampleOption, SampleValues};
use super::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView};

/// Width and height of the map.
const MAP: [u32; 2] = [1024; 2];
/// Vertical angle of the lamp's image: 60°.
const IMAGE: f32 = core::f32::consts::FRAC_PI_3;
const NEAR: f32 = 4.0;
const FAR: f32 = 20.0;
const AMBIENT: f32 = 0.25;
/// Numerator of the source's bias with point sampling, and with linear filtering.
const EPSILONS: [f32; 2] = [0.001, 0.0005];
/// A dark room's.
const BACKGROUND: [u8; 3] = [38, 42, 52];
/// Modern lighting: irradiance of the lamp and of the room.
const MODERN: Shading = Shading::Modern { light: 2.6, ambient: 0.35 };

pub(super) const SAMPLE: Sample = Sample {
    id: "comparison-sampler",
    title: "Depth testing with a comparison sampler",
    teaches: "The sampler compares: it returns the share of texels that are no nearer than the point, which with linear \
              filtering is a fraction. The bias depends on the angle between surface and light.",
    flaw: "The bias is meant to grow with the slope and does the opposite: it is largest where the light falls straight on a \
           surface, and least where the light grazes it.",
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
    scene: super::scenes::still_life,
    draws: drawing,
};

const OPTIONS: [SampleOption; 5] = [
    super::lamp::SHADOWS,
    super::options::LIGHTING,
    SampleOption {
        id: "variant",
        label: "Faces in the map",
        help: "The source moves the compared depth away from the lamp, which makes sense with back faces; with front faces it \
               must move toward the lamp.",
        kind: OptionKind::Choice(&[("literal", "back faces, +"), ("front", "front faces, -")]),
    },
    SampleOption {
        id: "filter",
        label: "Filter",
        help: "The nearest texel with an epsilon of 0.001, or four texels with 0.0005.",
        kind: OptionKind::Choice(&[("point", "nearest texel"), ("linear", "linear")]),
    },
    SampleOption {
        id: "beside",
        label: "Right half",
        help: "Shows something else in the right half of the picture, on the same view.",
        kind: OptionKind::Choice(&[
            ("none", "the same"),
            ("shadows=ours", "modern maps"),
            ("shadows=off", "no shadows"),
            ("variant=front", "front faces, -"),
            ("filter=linear", "linear"),
            ("lighting=modern", "modern lighting"),
        ]),
    },
];

/// Toward what the lamp shines on straight.
const HEAD_ON: (DVec3, Vec3) = (DVec3::new(-3.2, 2.6, 3.4), Vec3::new(1.5, -1.5, -2.6));
/// Along what the light grazes.
const GRAZING: (DVec3, Vec3) = (DVec3::new(3.4, 1.9, 1.8), Vec3::new(-2.6, -0.9, -2.4));

const VARIANTS: [SampleVariant; 5] = [
    SampleVariant {
        id: "head-on-literal",
        label: "Largest head-on: back faces, +",
        text: "",
        options: &[],
        view: Some(HEAD_ON),
    },
    SampleVariant {
        id: "head-on-front",
        label: "Largest head-on: front faces, -",
        text: "",
        options: &[("variant", "front")],
        view: Some(HEAD_ON),
    },
    SampleVariant {
        id: "grazing-front",
        label: "Least at grazing light: front faces, -",
        text: "",
        options: &[("variant", "front")],
        view: Some(GRAZING),
    },
    SampleVariant {
        id: "grazing-literal",
        label: "Grazing light: back faces, +",
        text: "",
        options: &[],
        view: Some(GRAZING),
    },
    SampleVariant {
        id: "grazing-ours",
        label: "Cure: a bias by slope",
        text: "",
        options: &[("variant", "front"), ("beside", "shadows=ours")],
        view: Some(GRAZING),
    },
];

fn lamp() -> SpotLight {
    let (position, target) = still_life_lamp();
    SpotLight::toward(position.as_dvec3(), target.as_dvec3(), IMAGE, 1.0, NEAR, FAR)
}

fn drawing(values: &SampleValues, camera: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
    let lamp = Lamp::new(&lamp(), MAP, camera)?;
    let is_front = values.choice("variant") == "front";
    let is_linear = values.choice("filter") == "linear";
    let map = SampleMapSettings {
        size: MAP,
        format: SampleFormat::Depth32,
        depth: StoredDepth::Plain,
        clear: 1,
        faces: if is_front { CasterFaces::Front } else { CasterFaces::Back },
        compares_linearly: is_linear,
    };
    let (map, test) = match values.choice("shadows") {
        "off" => (map, ShadowTest::Off),
        "ours" => (lamp.our_map(), lamp.our_test(true)?),
        _ => (map, ShadowTest::Comparison { epsilon: EPSILONS[usize::from(is_linear)], toward_light: is_front }),
    };
    let is_modern = values.choice("lighting") == "modern";
    Ok(SampleDrawing::Mapped(SampleFrame {
        camera: *camera,
        light: lamp.light(LightImage::Square),
        map,
        test,
        shading: if is_modern { MODERN } else { Shading::Comparison { ambient: AMBIENT } },
        background: BACKGROUND,
        casts: None,
        double_sided: false,
        inset: None,
    }))
}
