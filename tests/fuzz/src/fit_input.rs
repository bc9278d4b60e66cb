//! Fuzz target: every float of a fit's input from raw bits gives an error or finite maps, never a panic.

use shadowfit::demand::{DepthBounds, DepthHistogram};
use shadowfit::glam::{DMat4, DVec3, Mat4, UVec2};
use shadowfit::settings::{
    BiasSettings, CasterPolicy, FilterKind, FitKind, Hysteresis, MapFormat, MapSelection, MapSettings, RectangleKind,
    Shape, SoftRadius, Softness, SplitScheme, Stabilise,
};
use shadowfit::spot::SpotLight;
use shadowfit::{
    Aabb, Boxes, Cascades, DepthConvention, FitError, FitInput, Maps, PRESETS, PerspectiveCamera, ShadowFitter,
    SingleMap, StaticBoxes, Technique, ViewFrustum, Windows,
};

use super::bytes::Bytes;
use super::finite::{check_spot, fit};

const FRAMES: usize = 3;

/// Fits a few frames, and a lamp's map.
pub fn fit_input(data: &[u8]) {
    let bytes = &mut Bytes(data);
    let technique = technique(bytes);
    let mut fitter = ShadowFitter::new(&technique);
    let mut camera = camera(bytes);
    for _ in 0..FRAMES {
        // The next frame may be valid even if this one is not.
        let _ = frame(bytes, &mut fitter, &camera);
        camera.eye += bytes.dvec3(1.0);
        camera.forward += bytes.vec3(0.1);
    }
    let (position, direction, up) = (bytes.dvec3(100.0), bytes.vec3(1.0), bytes.vec3(1.0));
    let (fov_y, aspect, near, far) =
        (bytes.f32(0.1, 3.0), bytes.f32(0.2, 3.0), bytes.f32(0.01, 1.0), bytes.f32(2.0, 90.0));
    check_spot(&SpotLight { position, direction, up, fov_y, aspect, near, far }, resolution(bytes));
}

fn frame(bytes: &mut Bytes, fitter: &mut ShadowFitter, camera: &PerspectiveCamera) -> Result<(), FitError> {
    let mut views = vec![view(bytes, camera)?];
    if bytes.below(4) == 3 {
        views.push(PerspectiveCamera { eye: camera.eye + bytes.dvec3(1.0), ..*camera }.frustum()?);
    }
    let origin = if bytes.below(2) == 0 { DVec3::ZERO } else { bytes.dvec3(1e5) };
    let [receivers, casters, static_boxes] = [0; 3].map(|_| boxes(bytes));
    let static_boxes = static_boxes.and_then(|boxes| StaticBoxes::from_boxes(Boxes { origin, boxes: &boxes }).ok());
    let bins: Vec<u32> = (0..bytes.below(48)).map(|_| bytes.u32()).collect();
    let classes = bytes.below(4);
    let histogram = DepthHistogram { near: bytes.f32(0.1, 1.0), far: bytes.f32(10.0, 1e3), bins: &bins, classes };
    let bounds = DepthBounds { near: bytes.f32(0.1, 10.0), far: bytes.f32(1.0, 1e3) };
    let listed = |boxes| Boxes { origin, boxes };
    let input = FitInput {
        receivers: receivers.as_deref().map(listed),
        casters: casters.as_deref().map(listed),
        static_boxes: static_boxes.as_ref(),
        histogram: Some(histogram).filter(|_| classes > 0),
        depth_bounds: Some(bounds).filter(|_| bytes.below(2) == 1),
        ..FitInput::new(&views, bytes.vec3(1.0))
    };
    fit(fitter, &input)
}

fn camera(bytes: &mut Bytes) -> PerspectiveCamera {
    PerspectiveCamera {
        eye: bytes.dvec3(1e4),
        forward: bytes.vec3(1.0),
        up: bytes.vec3(1.0),
        fov_y: bytes.f32(0.1, 3.0),
        aspect: bytes.f32(0.3, 3.0),
        near: bytes.f32(0.01, 1.0),
        far: bytes.f32(1.0, 1e3),
    }
}

/// Returns a view through one of the constructors.
fn view(bytes: &mut Bytes, camera: &PerspectiveCamera) -> Result<ViewFrustum, FitError> {
    let depth = depth(bytes);
    let way = bytes.below(6);
    let far = bytes.f32(1.0, 1e3);
    let mut clip_from_eye = camera.clip_from_world(depth);
    if way < 2 {
        // Replaces a single element.
        let mut elements = clip_from_eye.to_cols_array();
        elements[bytes.below(16)] = bytes.f32(-2.0, 2.0);
        clip_from_eye = Mat4::from_cols_array(&elements);
    }
    let eye_from_clip = clip_from_eye.inverse();
    match way {
        0 | 2 => ViewFrustum::from_eye_from_clip(&eye_from_clip, camera.eye, depth, far),
        1 | 3 => {
            let world_from_clip = DMat4::from_translation(camera.eye) * eye_from_clip.as_dmat4();
            ViewFrustum::from_world_from_clip_f64(&world_from_clip, camera.eye, depth, far)
        }
        4 => camera.frustum()?.slice(bytes.f32(0.01, 10.0), far),
        _ => camera.frustum(),
    }
}

fn boxes(bytes: &mut Bytes) -> Option<Vec<Aabb>> {
    let count = bytes.below(14);
    let aabb = |bytes: &mut Bytes| {
        let (min, size) = (bytes.vec3(100.0), bytes.vec3(20.0));
        // Some are inside out.
        Aabb { min, max: min + if bytes.byte() < 248 { size.abs() } else { size } }
    };
    (count < 13).then(|| (0..count).map(|_| aabb(bytes)).collect())
}

fn depth(bytes: &mut Bytes) -> DepthConvention {
    bytes.pick(&[DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne])
}

fn resolution(bytes: &mut Bytes) -> UVec2 {
    let mut side = || match bytes.below(8) {
        0 => bytes.u32(),
        1 => 1,
        shift => 64 << shift,
    };
    UVec2::new(side(), side())
}

/// Returns a preset, or one with random settings.
fn technique(bytes: &mut Bytes) -> Technique {
    use CasterPolicy::{DepthClamp, Extend, None, PerObject, SceneBounds};
    let preset = bytes.pick(&PRESETS).technique();
    if bytes.below(4) == 0 {
        return preset;
    }
    let maps = match bytes.below(4) {
        0 => Windows {
            count: bytes.below(10) as u32,
            blend: bytes.f32(0.0, 64.0),
            max_depth_oversize: bytes.f32(1.0, 4.0),
        }
        .into(),
        1 => SingleMap { shape: shape(bytes), stabilise: stabilise(bytes) }.into(),
        _ => cascades(bytes),
    };
    let fit = MapSettings {
        max_distance: bytes.f32(1.0, 1e3),
        margin: bytes.f32(0.0, 2.0),
        border: Some(bytes.f32(0.0, 9.0)).filter(|_| bytes.below(2) == 1),
        casters: bytes.pick(&[None, Extend, SceneBounds, PerObject, DepthClamp]),
        caster_extension: bytes.f32(0.0, 1e3),
        up: bytes.vec3(1.0),
        least_texel: bytes.f32(0.0, 0.01),
        resolution: resolution(bytes),
        depth: depth(bytes),
    };
    let radius = [SoftRadius::Metres(bytes.f32(0.0, 1.0)), SoftRadius::SunAngle(bytes.f32(0.0, 0.1))];
    Technique {
        maps,
        fit,
        filter: bytes.pick(&FilterKind::ALL),
        softness: Softness { radius: bytes.pick(&radius), floor: bytes.f32(0.0, 9.0), ceiling: bytes.f32(0.0, 64.0) },
        fade: bytes.f32(0.0, 1.0),
        bias: BiasSettings {
            constant: bytes.f32(0.0, 4.0),
            slope: bytes.f32(0.0, 4.0),
            normal_offset: bytes.f32(0.0, 4.0),
            receiver_plane: bytes.f32(0.0, 4.0),
            depth_steps: bytes.f32(0.0, 16.0),
        },
        format: bytes.pick(&MapFormat::ALL),
        ..preset
    }
}

fn shape(bytes: &mut Bytes) -> Shape {
    let kinds = [FitKind::XnaSample, FitKind::FrustumAabb, FitKind::Oriented, FitKind::Sphere, FitKind::Focused];
    let rectangles = [RectangleKind::AxisAligned, RectangleKind::MinimumArea, RectangleKind::MinimumSquare];
    Shape { kind: bytes.pick(&kinds), rectangle: bytes.pick(&rectangles), max_texel_ratio: bytes.f32(1.0, 9.0) }
}

fn stabilise(bytes: &mut Bytes) -> Stabilise {
    let hold = Hysteresis {
        margin: bytes.f32(0.0, 0.5),
        max_growth: bytes.f32(1.0, 3.0),
        max_oversize: bytes.f32(1.0, 4.0),
        look_ahead: if bytes.below(8) == 7 { bytes.u32() } else { bytes.below(64) as u32 },
    };
    bytes.pick(&[Stabilise::Off, Stabilise::Snap { max_oversize: hold.max_oversize }, Stabilise::Hysteresis(hold)])
}

fn cascades(bytes: &mut Bytes) -> Maps {
    let mut cut = bytes.f32(0.1, 1.0);
    let manual = [0; 7].map(|_| {
        cut += bytes.f32(0.0, 50.0);
        cut
    });
    let schemes = [
        SplitScheme::Uniform,
        SplitScheme::Logarithmic,
        SplitScheme::Practical(bytes.f32(0.0, 1.0)),
        SplitScheme::Manual(manual),
        SplitScheme::FromBoxes,
        SplitScheme::FromHistogram,
    ];
    let selections = [
        MapSelection::ViewDepth { overlap: bytes.f32(0.0, 1.0) },
        MapSelection::Coverage { blend: bytes.f32(0.0, 64.0) },
    ];
    Cascades {
        count: bytes.below(10) as u32,
        shape: shape(bytes),
        splits: bytes.pick(&schemes),
        selection: bytes.pick(&selections),
        stabilise: stabilise(bytes),
    }
    .into()
}
