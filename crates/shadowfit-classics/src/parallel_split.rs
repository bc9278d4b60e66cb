//! Parallel-split shadow maps: the view is divided by depth into slices with a map each (F. Zhang, H. Sun, L.
//! Xu and L. Lun, "Parallel-split shadow maps for large-scale virtual environments", 2006). The core's own
//! techniques draw it, on the built-in plain.

use core::f32::consts::FRAC_PI_4;

use glam::{DVec3, UVec2, Vec3};
use shadowfit::settings::{FitKind, MapSelection, Shape, SplitScheme, Stabilise};
use shadowfit::{Cascades, FitError, PerspectiveCamera, Technique};
use shadowfit_scene::Scene;
use shadowfit_scene::builtin::BuiltinScene;

use crate::options::{OptionKind, SampleOption, SampleValues};
use crate::sample::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView, modern};

/// Distance up to which there are shadows, in metres.
const DISTANCE: f32 = 400.0;
/// Weight of the logarithmic splits in the practical ones.
const LAMBDA: f32 = 0.75;

/// View close to the ground, along a long shadow.
const LOW: (DVec3, Vec3) = (DVec3::new(0.2, 13.7, 1.6), Vec3::new(-0.05, -0.16, -1.0));

pub(crate) const SAMPLE: Sample = Sample {
    id: "parallel-split",
    title: "Parallel-split shadow maps",
    teaches: "One map cannot be fine near the camera and also reach far. Each cascade covers a range of view depths \
        with its own map: small and fine near the eye, wide and coarse far away. Practical splits lie between equal \
        and logarithmic ones.",
    flaw: "Splits depend on depth alone and not on the scene: much of each map is invisible, and shadows change their \
        sharpness between two maps.",
    page: "samples/parallel-split.md",
    size: [800, 450],
    view: SampleView {
        eye: DVec3::new(0.2, 14.656, 2.5),
        forward: Vec3::new(-0.05, -0.115, -1.0),
        fov_y: FRAC_PI_4,
        near: 0.1,
        far: 1000.0,
        speed: 8.0,
    },
    direction: Vec3::new(0.600_5, -0.366_3, 0.710_7),
    inset: None,
    only_subject_casts: false,
    is_measurable: true,
    controls: SampleControls::VIEWER,
    options: &[
        SampleOption {
            id: "shadows",
            label: "Shadows",
            help: "Split by depth as the source, none, or the recommended modern technique.",
            kind: OptionKind::Choice(&[("source", "split by depth"), ("off", "no shadows"), ("ours", "modern maps")]),
        },
        SampleOption {
            id: "splits",
            label: "Splits",
            help: "Practical splits are a mean of the other two.",
            kind: OptionKind::Choice(&[
                ("practical", "practical"),
                ("uniform", "uniform"),
                ("logarithmic", "logarithmic"),
            ]),
        },
        SampleOption {
            id: "lambda",
            label: "λ",
            help: "Weight of the logarithmic splits in the practical ones.",
            kind: OptionKind::Number { min: 0.0, max: 1.0, default: LAMBDA, unit: "" },
        },
        SampleOption {
            id: "maps",
            label: "Maps",
            help: "One for each slice of the view.",
            kind: OptionKind::Choice(&[("4", "4"), ("1", "1"), ("2", "2"), ("3", "3")]),
        },
        SampleOption::map_size("Texels each way.", &[("2048", "2048²"), ("512", "512²"), ("1024", "1024²")]),
        SampleOption {
            id: "blend",
            label: "Blend",
            help: "Share of a slice that is blended into the next one.",
            kind: OptionKind::Number { min: 0.0, max: 0.5, default: 0.1, unit: "" },
        },
        SampleOption {
            id: "tint",
            label: "Tint",
            help: "Tints each point by the map that it reads.",
            kind: OptionKind::Toggle { default: false },
        },
    ],
    variants: &[
        SampleVariant {
            id: "tinted",
            label: "Tinted",
            text: "Each slice of the view in its tint. Blended areas show both.",
            options: &[("tint", "on")],
            view: None,
        },
        SampleVariant {
            id: "uniform",
            label: "Uniform splits",
            text: "Cascades of equal depth, here with maps of 512²: the first one covers a hundred metres, so shadows \
                at the camera are blurred.",
            options: &[("splits", "uniform"), ("map", "512")],
            view: Some(LOW),
        },
        SampleVariant {
            id: "logarithmic",
            label: "Logarithmic splits",
            text: "Cascades of equal ratio, here with maps of 512²: fine at the camera, but a single map covers \
                almost everything far away.",
            options: &[("splits", "logarithmic"), ("map", "512"), ("tint", "on")],
            view: Some(LOW),
        },
        SampleVariant {
            id: "one-map",
            label: "One map only",
            text: "The whole view in one map of 512²: coarse everywhere.",
            options: &[("maps", "1"), ("map", "512")],
            view: Some(LOW),
        },
        SampleVariant {
            id: "practical",
            label: "Practical splits",
            text: "The same view with practical splits and maps of 512², for comparison.",
            options: &[("map", "512")],
            view: Some(LOW),
        },
    ],
    scene,
    draws: drawing,
};

fn scene() -> Scene {
    BuiltinScene::Plain.build()
}

#[expect(clippy::unnecessary_wraps, reason = "the table of samples holds functions that can fail")]
fn drawing(values: &SampleValues, _: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
    let is_tinted = values.is_on("tint");
    if values.choice("shadows") == "ours" {
        return Ok(SampleDrawing::Technique { technique: modern(DISTANCE), is_tinted });
    }
    let splits = match values.choice("splits") {
        "uniform" => SplitScheme::Uniform,
        "logarithmic" => SplitScheme::Logarithmic,
        _ => SplitScheme::Practical(values.get("lambda")),
    };
    let size: u32 = values.choice("map").parse().unwrap_or(2048);
    let cascades = Cascades::default()
        .with_shape(Shape::new(FitKind::FrustumAabb))
        .with_splits(splits)
        .with_selection(MapSelection::ViewDepth { overlap: values.get("blend") })
        .with_stabilise(Stabilise::Off);
    let count = values.choice("maps").parse().unwrap_or(4);
    let mut technique = Technique::default().with_maps(cascades).with_count(count);
    technique.fit =
        technique.fit.with_resolution(UVec2::splat(size)).with_max_distance(DISTANCE).with_caster_extension(DISTANCE);
    Ok(SampleDrawing::Technique { technique, is_tinted })
}
