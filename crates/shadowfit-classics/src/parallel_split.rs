//! Parallel-split shadow maps: the view is sliced by depth, and each slice has a map (F. Zhang, H. Sun, L. Xu and L. Lun,
//! "Parallel-split shadow maps for large-scale virtual environments", 2006). Drawn by the core's own techniques, on the
//! built-in plain.

use core::f32::consts::FRAC_PI_4;

use glam::{DVec3, UVec2, Vec3};
use shadowfit::settings::{FitKind, MapSelection, Shape, SplitScheme, Stabilise};
use shadowfit::{Cascades, FitError, PerspectiveCamera, Technique};
use shadowfit_scene::Scene;
use shadowfit_scene::builtin::BuiltinScene;

use crate::options::{OptionKind, SampleOption, SampleValues};
use crate::sample::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView, modern};

/// How far shadows reach, in metres.
const DISTANCE: f32 = 400.0;
/// Weight of the logarithmic splits among the practical ones.
const LAMBDA: f32 = 0.75;

/// Low over the ground, along a long shadow.
const LOW: (DVec3, Vec3) = (DVec3::new(0.2, 13.7, 1.6), Vec3::new(-0.05, -0.16, -1.0));

pub(crate) const SAMPLE: Sample = Sample {
    id: "parallel-split",
    title: "Parallel-split shadow maps",
    teaches: "One map cannot be fine near the camera and reach far. Cascades by depth get a map each: small and \
              fine near the eye, wide and coarse far away. Practical splits lie between equal and logarithmic ones.",
    flaw: "Splits know the depth alone and not what is there: boxes hold much that nobody sees, and shadows change their \
           sharpness where one map ends.",
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
            help: "Split by depth as the source, none, or the technique that is recommended today.",
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
            help: "Weight of the logarithmic splits among the practical ones.",
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
            help: "How much of a slice is blended into the next one.",
            kind: OptionKind::Number { min: 0.0, max: 0.5, default: 0.1, unit: "" },
        },
        SampleOption {
            id: "tint",
            label: "Tint",
            help: "Shows each point in the tint of the map that it reads.",
            kind: OptionKind::Toggle { default: false },
        },
    ],
    variants: &[
        SampleVariant {
            id: "tinted",
            label: "Tinted",
            text: "Each slice of the view in its tint; where two are blended, both.",
            options: &[("tint", "on")],
            view: None,
        },
        SampleVariant {
            id: "uniform",
            label: "Uniform splits",
            text: "Cascades of equal depth, here with maps of 512²: the first one reaches a hundred metres, so that shadows at the \
                   camera are washed out.",
            options: &[("splits", "uniform"), ("map", "512")],
            view: Some(LOW),
        },
        SampleVariant {
            id: "logarithmic",
            label: "Logarithmic splits",
            text: "Cascades of equal ratio, here with maps of 512²: fine at the camera, and one map for nearly all that is far.",
            options: &[("splits", "logarithmic"), ("map", "512"), ("tint", "on")],
            view: Some(LOW),
        },
        SampleVariant {
            id: "one-map",
            label: "One map only",
            text: "All of the view in one map of 512²: fine nowhere.",
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
