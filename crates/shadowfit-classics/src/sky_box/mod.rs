//! A sky box around the built-in courtyard: a cube seen from inside, at the same distance from every camera
//! position. The scene is shaded by its texture, ambient and diffuse light, with one map around the camera.

mod cube;
mod face;
mod picture;

use core::f32::consts::FRAC_PI_4;

use glam::{DVec3, UVec2, Vec3};
use shadowfit::settings::FitSettings;
use shadowfit::{FitError, PerspectiveCamera};
use shadowfit_scene::Scene;
use shadowfit_scene::builtin::BuiltinScene;

use crate::headlight::real_shadow;
use crate::mapped::{
    CORNFLOWER, LightImage, LightPlace, SampleFormat, SampleFrame, SampleLight, SampleMapSettings, Shading, ShadowTest,
};
use crate::options::{OptionKind, SampleOption, SampleValues};
use crate::sample::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView};
use crate::xna;

pub use cube::{SkyBox, SkyBoxUniform, WGSL};
pub use face::{direction_of, face_of};
pub use picture::SkyPicture;

/// Width and height of the map, in texels.
const MAP: u32 = 2048;
/// Distance up to which there are shadows, and height of casters above, in metres.
const DISTANCE: f32 = 30.0;
/// Depth bias of the map, in texel sizes.
const BIAS_TEXELS: f32 = 3.0;
/// Initial elevation and azimuth of the sun, in degrees. The azimuth is from +z toward +x.
const ELEVATION: f32 = 30.0;
const AZIMUTH: f32 = 76.0;
/// Diffuse and ambient light, as factors of the texture.
const POWER_AND_AMBIENT: [f32; 2] = [0.75, 0.42];

pub(crate) const SAMPLE: Sample = Sample {
    id: "sky-box",
    title: "Sky box",
    teaches: "A cube around the camera, seen from inside. The position on the cube is the texture coordinate, so its \
        size does not matter. The camera's translation is left out and depth is not written, so all objects appear in \
        front of it.",
    flaw: "It has no depth: nothing in it comes nearer as the camera moves, and no object can be behind it.",
    page: "samples/sky-box.md",
    size: [800, 480],
    view: SampleView {
        eye: DVec3::new(-2.4, 1.5, 6.0),
        forward: Vec3::new(3.2, 0.75, -5.6),
        fov_y: FRAC_PI_4 * 1.2,
        near: 0.1,
        far: 200.0,
        speed: 4.0,
    },
    direction: Vec3::new(-0.840, -0.5, -0.209),
    is_measurable: false,
    inset: None,
    only_subject_casts: false,
    controls: SampleControls::VIEWER,
    options: &[
        SampleOption {
            id: "sky",
            label: "Sky box",
            help: "Draws the sky behind all objects. Without it the background is plain.",
            kind: OptionKind::Toggle { default: true },
        },
        SampleOption {
            id: "elevation",
            label: "Sun's elevation",
            help: "Elevation of the light, and of the sun in the sky.",
            kind: OptionKind::Number { min: 3.0, max: 80.0, default: ELEVATION, unit: "°" },
        },
        SampleOption {
            id: "azimuth",
            label: "Sun's azimuth",
            help: "From +z toward +x.",
            kind: OptionKind::Number { min: 0.0, max: 360.0, default: AZIMUTH, unit: "°" },
        },
        SampleOption {
            id: "shadows",
            label: "Shadows",
            help: "With one map around the camera, or none.",
            kind: OptionKind::Choice(&[("source", "one map"), ("off", "none")]),
        },
        SampleOption::LIGHTING,
        SampleOption::beside(&[("none", "the same"), ("sky=off", "no sky"), ("lighting=modern", "modern lighting")]),
    ],
    variants: &[
        SampleVariant {
            id: "sun",
            label: "Toward the sun",
            text: "The sun in the sky matches the direction of the light: shadows point away from it.",
            options: &[],
            view: Some((DVec3::new(-6.0, 1.6, 1.5), Vec3::new(0.9, 0.3, 0.12))),
        },
        SampleVariant {
            id: "corner",
            label: "A corner of the cube",
            text: "Three faces of the cube meet in the middle of this picture, but no edge is visible.",
            options: &[],
            view: Some((DVec3::new(-2.4, 1.6, 6.0), Vec3::new(1.0, 1.0, -1.0))),
        },
        SampleVariant {
            id: "evening",
            label: "Evening",
            text: "A low sun: sky, light and shadows match.",
            options: &[("elevation", "6")],
            view: None,
        },
    ],
    scene,
    draws: drawing,
};

fn scene() -> Scene {
    BuiltinScene::Courtyard.build()
}

fn drawing(values: &SampleValues, camera: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
    let (elevation, azimuth) = (values.get("elevation").to_radians(), values.get("azimuth").to_radians());
    let to_light =
        Vec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos()).normalize();
    let settings = FitSettings::default()
        .with_resolution(UVec2::splat(MAP))
        .with_max_distance(DISTANCE)
        .with_caster_extension(DISTANCE);
    let fit = shadowfit::fit(&camera.frustum()?, -to_light, &settings)?;
    let bias = BIAS_TEXELS * fit.texel_size.max_element() / fit.depth_range;
    Ok(SampleDrawing::Mapped(SampleFrame {
        camera: *camera,
        light: SampleLight {
            clip_from_world: fit.clip_from_world,
            place: LightPlace::Toward(to_light),
            image: LightImage::Square,
        },
        map: SampleMapSettings::new([MAP; 2], SampleFormat::R32Float),
        test: if values.choice("shadows") == "off" { ShadowTest::OFF } else { xna::test(bias) },
        shading: values.lit(real_shadow::shading(POWER_AND_AMBIENT), Shading::modern(1.8, 0.5)),
        background: CORNFLOWER,
        double_sided: false,
    }))
}
