//! Cameras, lights and comparisons that the tests share.

use proptest::prelude::*;
use serde_json::Value;
use shadowfit::glam::{DVec3, Mat4, Vec3};
use shadowfit::settings::{FitKind, FitSettings, MapSelection, Stabilise};
use shadowfit::{Cascades, FittedMap, LightProjection, Maps, PerspectiveCamera, Technique};

/// Both fits.
pub(crate) const KINDS: [FitKind; 2] = [FitKind::XnaSample, FitKind::FrustumAabb];

/// Returns settings that add nothing to the frustum's own box.
pub(crate) fn exact(kind: FitKind) -> FitSettings {
    FitSettings::default()
        .with_kind(kind)
        .with_margin(0.0)
        .with_caster_extension(0.0)
        .with_max_distance(f32::MAX)
        .with_border(0.0)
}

/// Snapping with the default oversize limit of held maps.
pub(crate) const SNAP: Stabilise = Stabilise::Snap { max_oversize: 1.8 };

/// Returns every kind of stabilisation, with default values.
pub(crate) fn every_stabilise() -> [Stabilise; 3] {
    [Stabilise::Off, SNAP, Stabilise::default()]
}

/// Returns a technique with `cascades.count` cascades, or a single map for a count of 1.
pub(crate) fn sliced(fit: &FitSettings, cascades: Cascades) -> Technique {
    let maps = Maps::from(cascades.with_shape(fit.shape)).with_count(cascades.count);
    Technique::default().with_maps(maps).with_fit(fit.map)
}

/// Returns the technique with another selection of cascades. Other maps are unchanged.
pub(crate) fn read_by(technique: &Technique, selection: MapSelection) -> Technique {
    match technique.maps {
        Maps::Cascades(cascades) => technique.with_maps(cascades.with_selection(selection)),
        Maps::Windows(_) | Maps::Single(_) => *technique,
    }
}

/// Returns a plain camera away from the world's origin.
pub(crate) fn camera() -> PerspectiveCamera {
    PerspectiveCamera {
        eye: DVec3::new(12.0, 3.0, -40.0),
        forward: Vec3::new(0.3, -0.4, -0.8),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 1.6,
        near: 0.25,
        far: 80.0,
    }
}

/// A plain light.
pub(crate) const DIRECTION: Vec3 = Vec3::new(0.3, -0.8, 0.4);

/// Returns a configuration with this number of cases, unless `PROPTEST_CASES` is set. Scenes to which a
/// property does not apply are skipped without a limit.
pub(crate) fn cases(count: u32) -> ProptestConfig {
    ProptestConfig { max_global_rejects: u32::MAX, ..ProptestConfig::with_cases(count) }
}

/// Numbers between two bounds, in steps of 2⁻²⁴ of their distance.
///
/// Proptest's own f32 ranges fail an assertion of their sampler about once in a million draws.
pub(crate) fn double(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (0..=1_u32 << 24).prop_map(move |i| low + (high - low) * f64::from(i) / f64::from(1_u32 << 24))
}

/// [`double`] rounded to f32.
pub(crate) fn float(low: f64, high: f64) -> impl Strategy<Value = f32> {
    double(low, high).prop_map(|v| v as f32)
}

/// Returns a unit direction for two numbers in 0..1. Uniform numbers give uniform directions.
fn on_sphere(height: f64, turn: f64) -> Vec3 {
    let y = 2.0 * height - 1.0;
    let r = (1.0 - y * y).max(0.0).sqrt();
    let a = turn * std::f64::consts::TAU;
    DVec3::new(r * a.cos(), y, r * a.sin()).as_vec3()
}

/// Any unit direction.
pub(crate) fn any_direction() -> impl Strategy<Value = Vec3> {
    (double(0.0, 1.0), double(0.0, 1.0)).prop_map(|(height, turn)| on_sphere(height, turn))
}

/// Cameras in any orientation: 11° to 115° of view, near/far ratios up to 10,000, up to 1 km out.
pub(crate) fn any_camera() -> impl Strategy<Value = PerspectiveCamera> {
    let eye = (double(-1e3, 1e3), double(-1e3, 1e3), double(-1e3, 1e3));
    let lens = (float(0.2, 2.0), float(0.5, 3.0), float(-2.0, 1.0), float(0.3, 4.0));
    (eye, any_direction(), any_direction(), lens)
        .prop_filter("up must not be parallel to forward", |(_, f, u, _)| f.cross(*u).length() > 0.1)
        .prop_map(|((x, y, z), forward, up, (fov_y, aspect, near, ratio))| {
            let near = 10.0_f32.powf(near);
            let far = near * 10.0_f32.powf(ratio);
            PerspectiveCamera { eye: DVec3::new(x, y, z), forward, up, fov_y, aspect, near, far }
        })
}

/// Either fit.
pub(crate) fn any_kind() -> impl Strategy<Value = FitKind> {
    prop_oneof![Just(FitKind::XnaSample), Just(FitKind::FrustumAabb)]
}

/// Returns the fit of a camera with these settings. It must succeed.
pub(crate) fn fitted(camera: &PerspectiveCamera, direction: Vec3, settings: &FitSettings) -> LightProjection {
    shadowfit::fit(&camera.frustum().unwrap(), direction, settings).unwrap()
}

/// Transforms a point as a vertex shader does: an affine matrix times a point, in f32.
pub(crate) fn apply(matrix: &Mat4, point: Vec3) -> Vec3 {
    (*matrix * point.extend(1.0)).truncate()
}

/// Returns the numbers of a JSON array, with nested arrays flattened.
pub(crate) fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(values) => values.iter().flat_map(numbers).collect(),
        number => vec![number.as_f64().unwrap()],
    }
}

/// Returns the greatest difference as a share of the greatest expected element.
pub(crate) fn relative_error(actual: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(actual.len(), expected.len());
    let largest = expected.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    actual.iter().zip(expected).fold(0.0, |m: f64, (a, e)| m.max((a - e).abs())) / largest
}

/// One case of the published vectors of the XNA fit.
pub(crate) struct XnaCase {
    pub(crate) camera: PerspectiveCamera,
    pub(crate) direction: Vec3,
    pub(crate) json: Value,
}

/// Returns all cases of the published vectors.
pub(crate) fn xna_cases() -> Vec<XnaCase> {
    let text = include_str!("../data/xna_fit_cases.json");
    let file: Value = serde_json::from_str(text).unwrap();
    file["cases"].as_array().unwrap().iter().map(xna_case).collect()
}

fn xna_case(json: &Value) -> XnaCase {
    let vector = |v: &Value| DVec3::from_slice(&numbers(v));
    let number = |name: &str| json["camera"][name].as_f64().unwrap() as f32;
    let camera = PerspectiveCamera {
        eye: vector(&json["camera"]["eye"]),
        forward: vector(&json["camera"]["forward"]).as_vec3(),
        up: Vec3::Y,
        fov_y: number("fov_y"),
        aspect: number("aspect"),
        near: number("near"),
        far: number("far"),
    };
    // The file's light points from the scene toward the light.
    XnaCase { camera, direction: -vector(&json["to_light"]).as_vec3(), json: json.clone() }
}

/// View depths of a map in f32, as shaders compare them.
pub(crate) trait ShaderDepths {
    /// Returns its beginning, or `f32::MAX` if it has no range.
    fn near(&self) -> f32;
    /// Returns its end: `f32::MAX` if it has no end, `f32::MIN` if no point reads it.
    fn far(&self) -> f32;
    /// Returns the view depth from which it covers all visible points, or `f32::MAX` if it need not.
    fn covered_from(&self) -> f32;
}

impl ShaderDepths for FittedMap {
    fn near(&self) -> f32 {
        let range = self.depths.filter(|range| range.far.is_some() || range.covered_from.is_some());
        range.map_or(f32::MAX, |range| range.near as f32)
    }

    fn far(&self) -> f32 {
        self.depths.map_or(f32::MIN, |range| range.far.map_or(f32::MAX, |far| far as f32))
    }

    fn covered_from(&self) -> f32 {
        self.depths.and_then(|range| range.covered_from).map_or(f32::MAX, |near| near as f32)
    }
}
