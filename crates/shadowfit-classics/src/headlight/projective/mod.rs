//! Headlight street, first stage: the depths that a lamp sees, projected back on the street as greys.
//!
//! Camera, lamp and map size are the source's numbers. The map is as large as the window. Cars and lamp posts
//! are our own models.

use glam::{DVec3, Vec3};
use shadowfit::{FitError, PerspectiveCamera};

use super::{EYE, FORMAT, FORWARD, MODERN, SIZE, headlight, map, real_shadow, street};
use crate::lamp::{self, Lamp};
use crate::mapped::{LightImage, SampleFrame, Shading, ShadowTest};
use crate::options::{SampleOption, SampleValues};
use crate::sample::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView};

const TARGET: DVec3 = DVec3::new(-2.0, 3.0, -10.0);
const NEAR: f32 = 5.0;
/// Power and ambient light of the source's lit scene.
const LIT: [f32; 2] = [1.0, 0.2];
/// Shading with greys. It reads the map itself and needs no shadow test.
const GREYS: Shading =
    Shading { reads_map: true, ..Shading::new("projective", &[include_str!("shade.wgsl")], [0.0; 2]) };

pub(crate) const SAMPLE: Sample = Sample {
    id: "headlight-projective",
    title: "Headlight: projective texturing",
    teaches: "How a lamp's picture is projected on a scene: the lamp's view and projection transform every point to a \
        position in the lamp's map. The point shows the depth stored there, which is the nearest surface's.",
    flaw: "There is no test whether a point lies in the map. Its borders smear over everything beside it, and a \
        mirrored copy appears behind the lamp.",
    page: "samples/headlight-projective.md",
    size: SIZE,
    view: SampleView {
        eye: EYE,
        forward: FORWARD,
        fov_y: core::f32::consts::FRAC_PI_4,
        near: 1.0,
        far: 200.0,
        speed: 15.0,
    },
    // (16, -2, -8) / 18.
    direction: Vec3::new(8.0 / 9.0, -1.0 / 9.0, -4.0 / 9.0),
    // A picture of greys has no shadows that rays could judge.
    is_measurable: false,
    inset: None,
    only_subject_casts: false,
    controls: SampleControls::VIEWER,
    options: &OPTIONS,
    variants: &VARIANTS,
    scene: street::build,
    draws: drawing,
};

const OPTIONS: [SampleOption; 4] = [
    lamp::SHADOWS,
    SampleOption {
        help: "Lighting of the scene without shadows or with our shadows: as the source, or modern. The greys are not \
            lit.",
        ..SampleOption::LIGHTING
    },
    FORMAT,
    SampleOption::beside(&[
        ("none", "the same"),
        ("shadows=ours", "our map"),
        ("shadows=off", "no shadows"),
        ("format=r32f", "32-bit float"),
    ]),
];

const VARIANTS: [SampleVariant; 3] = [
    SampleVariant {
        id: "close",
        label: "The post on the wall",
        text: "Behind the lamp post the wall shows the post's grey, which is darker than the wall's since the post is \
            nearer to the lamp.",
        options: &[],
        view: Some((DVec3::new(-6.0, 9.0, 6.0), Vec3::new(19.0, -2.0, -12.0))),
    },
    SampleVariant {
        id: "smear",
        label: "Borders smear",
        text: "The lamp's image ends at a line across the road to the near end of the wall. The area in front of it \
            shows the outermost column of the map, stretched to the edge of the street.",
        options: &[],
        view: Some((DVec3::new(-8.0, 16.0, 26.0), Vec3::new(14.0, -16.0, -24.0))),
    },
    SampleVariant {
        id: "behind",
        label: "Behind the lamp",
        text: "The car behind the lamp shows the map on its back, upside down: w is negative there, so the division \
            by w flips it.",
        options: &[],
        view: Some((DVec3::new(-44.0, 12.0, 4.0), Vec3::new(26.0, -8.0, -7.0))),
    },
];

fn drawing(values: &SampleValues, camera: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
    let lamp = Lamp::new(&headlight(TARGET, NEAR), SIZE, camera)?;
    let (map, test) = lamp.shadows(values, map(values), ShadowTest::OFF, false)?;
    let lit = values.lit(real_shadow::shading(LIT), MODERN);
    Ok(SampleDrawing::Mapped(SampleFrame {
        camera: *camera,
        light: lamp.light(LightImage::Square),
        map,
        test,
        shading: if values.choice("shadows") == "source" { GREYS } else { lit },
        background: [0; 3],
        double_sided: true,
    }))
}
