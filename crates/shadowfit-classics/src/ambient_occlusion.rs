//! Screen-space ambient occlusion from positions and normals, compared with a variant that uses depths alone,
//! and with rays. The scene is the built-in arcade. Distances are in metres.

use core::f32::consts::FRAC_PI_4;

use glam::{DVec3, Vec3};
use shadowfit::{FitError, PerspectiveCamera};
use shadowfit_scene::Scene;
use shadowfit_scene::builtin::BuiltinScene;

use crate::occlusion::{OcclusionFrame, OcclusionLight, OcclusionMethod, OcclusionSettings, OcclusionView};
use crate::options::{OptionKind, SampleOption, SampleValues};
use crate::sample::{Sample, SampleControls, SampleDrawing, SampleVariant, SampleView};

/// Direction of travel of the sun that also lights the scene.
const DIRECTION: Vec3 = Vec3::new(-0.45, -0.8, -0.4);

/// Close-up of a vase on its plinth and plants by a wall.
const AT_A_VASE: (DVec3, Vec3) = (DVec3::new(0.3, 1.25, 2.2), Vec3::new(-1.0, -0.3, -1.9));

pub(crate) const SAMPLE: Sample = Sample {
    id: "ambient-occlusion",
    title: "Ambient occlusion in screen space",
    teaches: "Nearby surfaces block light that comes from all directions. Positions and normals of the surrounding \
        pixels tell how much: a surface counts if it rises into the hemisphere above the pixel, and less with \
        distance.",
    flaw: "Only the nearest surfaces on screen can block light. With depths alone, flat faces turn grey, and objects \
        have a pale halo.",
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
            help: "By normals as the source, with front faces or also back faces. By depth alone, with its two flaws. \
                By 32 rays. Or none.",
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
            help: "The scene, or the occlusion alone, where white is open.",
            kind: OptionKind::Choice(&[("scene", "the scene"), ("occlusion", "the occlusion")]),
        },
        SampleOption::LIGHTING,
        SampleOption {
            id: "detail",
            label: "Level of detail",
            help: "Uses six directions near the camera and two far away, instead of four everywhere.",
            kind: OptionKind::Toggle { default: false },
        },
        SampleOption {
            id: "blur",
            label: "Blur",
            help: "Averages four pixels each way in a pixel's plane. The random rotations repeat after four pixels.",
            kind: OptionKind::Toggle { default: true },
        },
        SampleOption {
            id: "radius",
            label: "Radius",
            help: "Reach of the neighbours. Divided by the view depth, it is a share of the picture.",
            kind: OptionKind::Number { min: 0.02, max: 2.0, default: 0.5, unit: "" },
        },
        SampleOption {
            id: "second",
            label: "Second radius",
            help: "Radius of a second pass. The greater occlusion counts. 0 for none.",
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
            help: "Least cosine above the surface at which a neighbour blocks light.",
            kind: OptionKind::Number { min: 0.0, max: 0.5, default: 0.1, unit: "" },
        },
        SampleOption {
            id: "intensity",
            label: "Intensity",
            help: "Factor on the occlusion by front faces.",
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
            text: "White is open, dark is occluded: corners, the feet of columns, the underside of arches. The right \
                half is traced with 32 rays per pixel.",
            options: &[("show", "occlusion"), ("beside", "method=traced")],
            view: None,
        },
        SampleVariant {
            id: "depth-only",
            label: "Flaws of depth alone",
            text: "Half of the points around a wall's pixel lie behind the wall, so flat faces are grey everywhere. \
                Edges in front of a far background are pale, like a halo.",
            options: &[("show", "occlusion"), ("method", "depth"), ("beside", "method=traced")],
            view: None,
        },
        SampleVariant {
            id: "back-faces",
            label: "Back faces",
            text: "Front faces on the left, also back faces on the right: objects occlude surfaces some distance \
                behind them, too.",
            options: &[("show", "occlusion"), ("beside", "method=back")],
            view: Some(AT_A_VASE),
        },
        SampleVariant {
            id: "two-radii",
            label: "Two radii",
            text: "An additional small radius finds the narrow corners that the large one misses.",
            options: &[("show", "occlusion"), ("second", "0.15"), ("beside", "method=traced")],
            view: Some(AT_A_VASE),
        },
        SampleVariant {
            id: "raw",
            label: "Without the blur",
            text: "Each pixel rotates its four directions by a random angle. Without the blur this causes noise in \
                blocks of four pixels.",
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
