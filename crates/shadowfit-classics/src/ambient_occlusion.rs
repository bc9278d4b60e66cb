//! Screen-space ambient occlusion from positions and normals, beside a variant that knows depths alone, and beside rays.
//! The scene is the built-in arcade; distances are metres.

use core::f32::consts::FRAC_PI_4;

use glam::{DVec3, Vec3};
use shadowfit::{FitError, PerspectiveCamera};
use shadowfit_scene::Scene;
use shadowfit_scene::builtin::BuiltinScene;

use crate::occlusion::{OcclusionFrame, OcclusionLight, OcclusionMethod, OcclusionSettings, OcclusionView};
use crate::options::{OptionKind, SampleOption, SampleValues};
use crate::sample::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView};

/// Direction of travel of the sun that lights the scene besides.
const DIRECTION: Vec3 = Vec3::new(-0.45, -0.8, -0.4);

/// A vase on its plinth and plants by a wall, from close by.
const AT_A_VASE: (DVec3, Vec3) = (DVec3::new(0.3, 1.25, 2.2), Vec3::new(-1.0, -0.3, -1.9));

pub(crate) const SAMPLE: Sample = Sample {
    id: "ambient-occlusion",
    title: "Ambient occlusion in screen space",
    teaches: "What is near hides light that comes from everywhere. Positions and normals of the pixels around tell how much: \
              what stands in the hemisphere over a pixel's surface, and how far away.",
    flaw: "Only what is on screen can hide, and of it only the nearest surfaces. With depths alone flat faces turn grey, and \
           things have a pale halo.",
    page: "samples/ambient-occlusion.md",
    size: [640, 480],
    view: SampleView {
        eye: DVec3::new(0.28, 1.6, 4.3),
        forward: Vec3::new(-0.06, 0.01, -1.0),
        fov_y: FRAC_PI_4,
        near: 0.1,
        far: 60.0,
        speed: 3.0,
    },
    direction: DIRECTION,
    inset: None,
    only_subject_casts: false,
    is_measurable: true,
    controls: SampleControls::VIEWER,
    options: &[
        SampleOption {
            id: "method",
            label: "Method",
            help: "By normals as the source: front faces alone, or back faces besides; by depth alone, with its two flaws; by \
                   32 rays; or none.",
            kind: OptionKind::Choice(&[
                ("front", "normals, front faces"),
                ("back", "normals, front and back faces"),
                ("depth", "depth alone"),
                ("traced", "ray-traced"),
                ("off", "none"),
            ]),
        },
        SampleOption {
            id: "show",
            label: "Show",
            help: "The scene, or the occlusion alone: white where nothing is hidden.",
            kind: OptionKind::Choice(&[("scene", "the scene"), ("occlusion", "the occlusion")]),
        },
        SampleOption::LIGHTING,
        SampleOption {
            id: "detail",
            label: "Level of detail",
            help: "Six directions near the camera and two far away, in place of four.",
            kind: OptionKind::Toggle { default: false },
        },
        SampleOption {
            id: "blur",
            label: "Blur",
            help: "Averages over four pixels each way in a pixel's plane, over which the random turns repeat.",
            kind: OptionKind::Toggle { default: true },
        },
        SampleOption {
            id: "radius",
            label: "Radius",
            help: "Reach of the neighbours: divided by the view depth it is a share of the picture.",
            kind: OptionKind::Number { min: 0.02, max: 2.0, default: 0.5, unit: "" },
        },
        SampleOption {
            id: "second",
            label: "Second radius",
            help: "A second pass, of which the greater occlusion counts; 0 for none.",
            kind: OptionKind::Number { min: 0.0, max: 2.0, default: 0.0, unit: "" },
        },
        SampleOption {
            id: "scale",
            label: "Scale",
            help: "Factor of distances in the fall-off 1 / (1 + d).",
            kind: OptionKind::Number { min: 0.0, max: 10.0, default: 2.0, unit: "1/m" },
        },
        SampleOption {
            id: "bias",
            label: "Bias",
            help: "Cosine that a neighbour has to rise over the surface before it hides anything.",
            kind: OptionKind::Number { min: 0.0, max: 0.5, default: 0.1, unit: "" },
        },
        SampleOption {
            id: "intensity",
            label: "Intensity",
            help: "Factor of what front faces hide.",
            kind: OptionKind::Number { min: 0.0, max: 10.0, default: 3.0, unit: "" },
        },
        SampleOption::beside(&[
            ("none", "the same"),
            ("method=traced", "ray-traced"),
            ("method=depth", "depth alone"),
            ("method=back", "back faces too"),
            ("method=off", "none"),
        ]),
    ],
    variants: &[
        SampleVariant {
            id: "alone",
            label: "Occlusion alone",
            text: "White is open, dark is hidden: corners, the feet of columns, the underside of arches. The right half is \
                   traced with 32 rays a pixel.",
            options: &[("show", "occlusion"), ("beside", "method=traced")],
            view: None,
        },
        SampleVariant {
            id: "depth-only",
            label: "Flaws of depth alone",
            text: "Half of the points around a wall's pixel lie behind the wall: flat faces are grey all over, and edges \
                   toward what is far are pale, like a halo.",
            options: &[("show", "occlusion"), ("method", "depth"), ("beside", "method=traced")],
            view: None,
        },
        SampleVariant {
            id: "back-faces",
            label: "Back faces",
            text: "Front faces on the left, back faces besides on the right: things hide what is behind them at some distance, \
                   too.",
            options: &[("show", "occlusion"), ("beside", "method=back")],
            view: Some(AT_A_VASE),
        },
        SampleVariant {
            id: "two-radii",
            label: "Two radii",
            text: "A small radius besides the large one finds the narrow corners that the large one steps over.",
            options: &[("show", "occlusion"), ("second", "0.15"), ("beside", "method=traced")],
            view: Some(AT_A_VASE),
        },
        SampleVariant {
            id: "raw",
            label: "Without the blur",
            text: "Each pixel turns its four directions by a random angle; without the blur that is noise in blocks of four \
                   pixels.",
            options: &[("show", "occlusion"), ("blur", "off")],
            view: Some(AT_A_VASE),
        },
    ],
    scene,
    draws: drawing,
};

fn scene() -> Scene {
    BuiltinScene::Arcade.build()
}

#[expect(clippy::unnecessary_wraps, reason = "the table of samples holds functions that can fail")]
fn drawing(values: &SampleValues, _: &PerspectiveCamera) -> Result<SampleDrawing, FitError> {
    let method = values.choice("method");
    let second = values.get("second");
    let settings = OcclusionSettings {
        radius: values.get("radius"),
        scale: values.get("scale"),
        bias: values.get("bias"),
        intensity: values.get("intensity"),
        back_faces: method == "back",
        level_of_detail: values.is_on("detail"),
        blur: values.is_on("blur"),
        second_radius: (second > 0.0).then_some(second),
        method: if method == "depth" { OcclusionMethod::DepthOnly } else { OcclusionMethod::Normals },
    };
    let frame = OcclusionFrame {
        settings: (method != "off").then_some(settings),
        light: OcclusionLight::new(-DIRECTION.normalize()),
        view: match (values.choice("show"), values.choice("lighting")) {
            ("occlusion", _) => OcclusionView::Occlusion,
            (_, "modern") => OcclusionView::Modern,
            _ => OcclusionView::Classic,
        },
        background: Vec3::new(0.62, 0.74, 0.9),
    };
    Ok(SampleDrawing::Occlusion { frame, is_traced: method == "traced" })
}
