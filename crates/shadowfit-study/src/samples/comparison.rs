//! Depth testing with a comparison sampler: a lamp's depth map, compared by less-or-equal in the sampler, with a bias that
//! is divided by the angle to the light. The scene, the camera and the ambient light are our own.

use core::f32::consts::FRAC_PI_4;

use glam::{DVec3, Vec3};
use shadowfit::bias::acos_epsilon;
use shadowfit::settings::FilterKind;
use shadowfit::{FitError, PerspectiveCamera};
use shadowfit_render::samples::{
    CasterFaces, LightImage, SampleFormat, SampleFrame, SampleMapSettings, Shading, ShadowTest, StoredDepth,
};
use shadowfit_scene::builtin::still_life_lamp;

use super::lamp::{Lamp, our_map, our_test};
use super::options::{LIGHTING, OptionKind, SampleOption, SampleValues};
use super::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView};

/// Width and height of the map, in texels.
const MAP: [u32; 2] = [1024, 1024];
const AMBIENT: f32 = 0.25;
/// A dark room.
const BACKGROUND: [u8; 3] = [22, 24, 30];
/// Modern lighting: irradiance of the lamp and of the room.
const MODERN: Shading = Shading::Modern { light: 2.6, ambient: 0.16 };

pub(super) const SAMPLE: Sample = Sample {
    id: "comparison-sampler",
    title: "Comparison sampler",
    teaches: "The sampler itself compares: given a depth it answers how much of what it reads is no nearer. With linear \
              filtering that is a fraction of four comparisons, and light is mixed by it.",
    flaw: "Its bias is the wrong way round: meant to grow with the slope, it is largest where light falls head-on, a tenth \
           of the whole depth range, and least at grazing light.",
    page: "samples/comparison-sampler.md",
    size: [640, 480],
    view: SampleView {
        eye: DVec3::new(-0.6, 5.2, 10.6),
        forward: Vec3::new(0.0, -0.36, -1.0),
        fov_y: FRAC_PI_4,
        near: 0.5,
        far: 60.0,
        speed: 4.0,
    },
    direction: Vec3::new(6.6, -6.7, -5.2),
    inset: None,
    only_subject_casts: false,
    is_measurable: true,
    controls: SampleControls::VIEWER,
    options: &[
        super::options::LAMP_SHADOWS,
        LIGHTING,
        SampleOption {
            id: "variant",
            label: "Faces",
            help: "The source adds its bias to the depth, which makes sense with a map of back faces. With front faces it \
                   has to be subtracted.",
            kind: OptionKind::Choice(&[("literal", "back faces, + (the source)"), ("front", "front faces, -")]),
        },
        SampleOption {
            id: "filter",
            label: "Filter",
            help: "One comparison with an epsilon of 0.001, or the sampler's four with 0.0005.",
            kind: OptionKind::Choice(&[("linear", "linear"), ("point", "point")]),
        },
        SampleOption {
            id: "beside",
            label: "Right half",
            help: "Shows something else in the right half of the picture, on the same view.",
            kind: OptionKind::Choice(&[
                ("none", "the same"),
                ("shadows=ours", "our bias and filter"),
                ("shadows=off", "no shadows"),
                ("variant=front", "front faces, -"),
                ("filter=point", "point filter"),
                ("lighting=modern", "modern lighting"),
            ]),
        },
    ],
    variants: &[
        SampleVariant {
            id: "front",
            label: "Front faces",
            text: "Front faces in the map, and the bias subtracted: where light falls head-on it is a tenth of the depth \
                   range, so that shadows come off or vanish there.",
            options: &[("variant", "front")],
            view: None,
        },
        SampleVariant {
            id: "leaks",
            label: "Light leaks",
            text: "Back faces in the map, and the bias added: where a shadow falls head-on, what is less than a tenth of the \
                   depth range before it throws one too early, and thin things close to the light's side shine through.",
            options: &[],
            view: Some((DVec3::new(-4.2, 2.4, 4.6), Vec3::new(0.55, -0.3, -1.0))),
        },
        SampleVariant {
            id: "head-on",
            label: "Largest head-on",
            text: "Front faces on the left, our bias by the slope on the right: facing the lamp, the left half has lost its \
                   shadows.",
            options: &[("variant", "front"), ("beside", "shadows=ours")],
            view: Some((DVec3::new(-4.6, 4.6, 4.4), Vec3::new(0.6, -0.55, -0.75))),
        },
        SampleVariant {
            id: "point",
            label: "Point filter",
            text: "One comparison a pixel: the shadow's edge is a staircase of texels.",
            options: &[("filter", "point")],
            view: None,
        },
    ],
    scene: super::scenes::still_life,
    draws: drawing,
};

fn drawing(values: &SampleValues, camera: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
    let (position, target) = still_life_lamp();
    let lamp = Lamp {
        position: position.as_dvec3(),
        target: target.as_dvec3(),
        fov_y: 60.0_f32.to_radians(),
        aspect: 1.0,
        near: 4.0,
        far: 20.0,
    };
    let fit = lamp.fit(MAP, camera)?;
    let (is_literal, is_linear) = (values.choice("variant") == "literal", values.choice("filter") == "linear");
    let map = SampleMapSettings {
        size: MAP,
        format: SampleFormat::Depth32,
        depth: StoredDepth::Plain,
        clear: 1,
        faces: if is_literal { CasterFaces::Back } else { CasterFaces::Front },
        compares_linearly: is_linear,
    };
    let epsilon = acos_epsilon(if is_linear { FilterKind::Hardware2x2 } else { FilterKind::Point });
    let (test, map) = match values.choice("shadows") {
        "off" => (ShadowTest::Off, map),
        "ours" => (our_test(&fit, true)?, our_map(MAP)),
        _ => (ShadowTest::Comparison { epsilon, toward_light: !is_literal }, map),
    };
    Ok(SampleDrawing::Mapped(SampleFrame {
        camera: *camera,
        light: lamp.light(&fit, LightImage::Square),
        map,
        test,
        shading: if values.choice("lighting") == "modern" { MODERN } else { Shading::Comparison { ambient: AMBIENT } },
        background: BACKGROUND,
        sky: None,
        casts: None,
        double_sided: false,
        inset: None,
    }))
}
