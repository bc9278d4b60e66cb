//! A terrain with vehicles under a spotlight: one large map whose depths are stored reversed, 1 - z/w, and
//! interpolated from the vertices. Its source's comment requests a map of 32 bits, but its code creates one
//! of 8. Height map and vehicles are our own.

mod scene;
pub mod shade;
pub mod test;

use core::f32::consts::FRAC_PI_4;

use glam::{DVec3, Vec3};
use shadowfit::spot::SpotLight;
use shadowfit::{FitError, PerspectiveCamera};

use crate::lamp::{self, Lamp};
use crate::mapped::{
    CORNFLOWER, LightImage, SampleFormat, SampleFrame, SampleMapSettings, Shading, ShadowTest, StoredDepth,
};
use crate::options::{OptionKind, SampleOption, SampleValues};
use crate::sample::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView};

#[cfg(test)]
pub(crate) use scene::{HeightMap, PLACES};

/// Numbers subtracted from the stored depth, and from which z/w is subtracted. Together they make a bias of
/// 1/100.
const OFF_STORED: f32 = 0.03;
const FROM: f32 = 0.98;
/// Shading with the factor of N·L and an ambient light, which are ours.
const SHADING: Shading = Shading::new("terrain", &[include_str!("shade.wgsl")], [0.6, 0.0]);
/// Modern lighting: irradiance of the light and of the sky.
const MODERN: Shading = Shading::modern(2.6, 0.45);

pub(crate) const SAMPLE: Sample = Sample {
    id: "terrain-vehicles",
    title: "Terrain with vehicles",
    teaches: "One large map over a landscape: objects cast on the ground, on themselves and on each other. Depth is \
        stored reversed, since floats are most precise near zero, which is the far end here.",
    flaw: "The bias is 1/100 of a perspective depth, which is several units far from the light. It must be so large \
        because the source's 8-bit map has only 256 depths.",
    page: "samples/terrain-vehicles.md",
    size: [900, 600],
    view: SampleView {
        eye: DVec3::new(160.0, 30.0, 62.0),
        forward: Vec3::new(-21.0, -30.0, 68.0),
        fov_y: FRAC_PI_4,
        near: 1.0,
        far: 400.0,
        speed: 30.0,
    },
    // (0, -100, 128) / 162.432.
    direction: Vec3::new(0.0, -0.615_642, 0.788_022),
    inset: Some([0, 0, 300, 200]),
    only_subject_casts: false,
    is_measurable: true,
    controls: SampleControls::VIEWER,
    options: &[
        lamp::SHADOWS,
        SampleOption::LIGHTING,
        SampleOption {
            id: "format",
            label: "Map format",
            help: "The source's comment requests 32 bits, but its code creates 8.",
            kind: OptionKind::Choice(&[
                ("r32f", "32-bit float"),
                ("grey8", "8-bit colour"),
                ("rgba8", "8-bit RGBA, packed"),
            ]),
        },
        SampleOption::map_size("Texels each way.", &[("4096", "4096²"), ("1024", "1024²"), ("2048", "2048²")]),
        SampleOption {
            id: "off-stored",
            label: "Off the stored",
            help: "Number subtracted from the stored depth before the comparison.",
            kind: OptionKind::Number { min: 0.0, max: 0.1, default: OFF_STORED, unit: "" },
        },
        SampleOption {
            id: "from",
            label: "From",
            help: "Number from which the point's own z/w is subtracted.",
            kind: OptionKind::Number { min: 0.9, max: 1.0, default: FROM, unit: "" },
        },
        SampleOption::INSET,
        SampleOption::beside(&[
            ("none", "the same"),
            ("shadows=ours", "our map"),
            ("shadows=off", "no shadows"),
            ("format=grey8", "the 8-bit map"),
            ("lighting=modern", "modern lighting"),
        ]),
    ],
    variants: &[
        SampleVariant {
            id: "8-bit",
            label: "8 bits, as the code makes it",
            text: "On the right the 256 depths reach from 90 to 300 units. The bias of 1/100 is two and a half of \
                their steps, so the two maps hardly differ.",
            options: &[("beside", "format=grey8")],
            view: None,
        },
        SampleVariant {
            id: "8-bit-bands",
            label: "8 bits and a smaller bias",
            text: "With a bias of 0.0005, an eighth of an 8-bit step, bands of shadow cover the right half. The \
                32-bit map on the left does not need more.",
            options: &[("from", "0.9705"), ("beside", "format=grey8")],
            view: None,
        },
        SampleVariant {
            id: "on-itself",
            label: "On itself",
            text: "Posts and roof of the tractor cast shadows on its own seat and bonnet.",
            options: &[("inset", "off")],
            view: Some((DVec3::new(168.0, 14.0, 84.0), Vec3::new(-18.0, -8.0, 16.0))),
        },
        SampleVariant {
            id: "on-another",
            label: "On each other",
            text: "A blade of the helicopter casts its shadow on the jeep.",
            options: &[("inset", "off")],
            view: Some((DVec3::new(152.0, 18.0, 150.0), Vec3::new(-11.0, -14.0, 20.0))),
        },
    ],
    scene: scene::build,
    draws: drawing,
};

/// Returns the test for a map that stores 1 - z/w.
fn test(values: &SampleValues) -> ShadowTest {
    let numbers = [values.get("off-stored"), values.get("from"), 0.0, 0.0];
    ShadowTest::nearest("terrain", include_str!("test.wgsl"), numbers)
}

fn drawing(values: &SampleValues, camera: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
    let light =
        SpotLight::toward(DVec3::new(128.0, 100.0, 0.0), DVec3::new(128.0, 0.0, 128.0), FRAC_PI_4, 1.45, 90.0, 300.0);
    let size = [values.choice("map").parse().unwrap_or(4096); 2];
    let lamp = Lamp::new(&light, size, camera)?;
    let map = SampleMapSettings {
        depth: StoredDepth::ReversedAtVertices,
        clear: 0,
        ..SampleMapSettings::new(size, SampleFormat::of(values.choice("format")))
    };
    let (map, test) = lamp.shadows(values, map, test(values), true)?;
    Ok(SampleDrawing::Mapped(SampleFrame {
        camera: *camera,
        light: lamp.light(LightImage::Square),
        map,
        test,
        shading: values.lit(SHADING, MODERN),
        background: CORNFLOWER,
        double_sided: true,
    }))
}
