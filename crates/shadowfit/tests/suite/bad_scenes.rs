//! Bad numbers in all inputs of whole scenes: an error or finite maps, never a panic. An error leaves the
//! fitter unchanged.

use proptest::prelude::*;
use shadowfit::NormalCone;
use shadowfit::demand::{DepthBounds, DepthHistogram};
use shadowfit::glam::{DVec2, DVec3, Mat4, UVec2, Vec3};
use shadowfit::settings::{
    CasterPolicy, Edges, FilterKind, FitKind, FitSettings, Hysteresis, MapSelection, RectangleKind, Shape, SoftRadius,
    SplitScheme, Stabilise,
};
use shadowfit::{
    Aabb, Boxes, Cascades, FitError, FitInput, FitState, FittedMaps, LightProjection, Maps, Scratch, SingleMap,
    Technique, ViewFrustum, Windows,
};

use crate::support::{DIRECTION, ShaderDepths, camera, cases, every_stabilise, sliced};

/// All inputs of a scene's fit.
#[derive(Clone, Debug)]
struct Inputs {
    views: Vec<ViewFrustum>,
    direction: Vec3,
    origins: [DVec3; 2],
    receivers: Vec<Aabb>,
    cones: Vec<NormalCone>,
    casters: Vec<Aabb>,
    near: f32,
    far: f32,
    bounds: DepthBounds,
    bins: Vec<u32>,
    classes: usize,
    settings: Technique,
    storage: usize,
}

fn good() -> Inputs {
    let eye = camera().eye.as_vec3();
    let around = |offset: Vec3, half: f32| Aabb::new(eye + offset - half, eye + offset + half);
    Inputs {
        views: vec![camera().frustum().unwrap(), camera().frustum().unwrap()],
        direction: DIRECTION,
        origins: [DVec3::ZERO; 2],
        receivers: vec![around(Vec3::new(3.0, -4.0, -8.0), 5.0), around(Vec3::new(12.0, -16.0, -32.0), 9.0)],
        cones: vec![NormalCone::ALL; 2],
        casters: vec![around(Vec3::new(1.0, 9.0, -3.0), 3.0), around(Vec3::new(3.0, 30.0, -8.0), 2.0)],
        near: 0.5,
        far: 60.0,
        bounds: DepthBounds { near: 1.0, far: 50.0 },
        bins: vec![1, 5, 9, 2, 0, 3],
        classes: 2,
        settings: Technique::preset("calm-4").unwrap().with_count(3),
        storage: Scratch::required(2, 2),
    }
}

impl Inputs {
    fn with<T>(&self, run: impl FnOnce(&FitInput, &mut Scratch) -> T) -> T {
        let histogram = DepthHistogram { near: self.near, far: self.far, bins: &self.bins, classes: self.classes };
        let input = FitInput {
            receivers: Some(Boxes { origin: self.origins[0], boxes: &self.receivers }),
            receiver_cones: &self.cones,
            casters: Some(Boxes { origin: self.origins[1], boxes: &self.casters }),
            histogram: Some(histogram),
            depth_bounds: Some(self.bounds),
            ..FitInput::new(&self.views, self.direction)
        };
        let mut storage = vec![DVec2::NAN; self.storage];
        run(&input, &mut Scratch::new(&mut storage))
    }

    fn fit(&self, fitter: &mut FitState) -> Result<FittedMaps, FitError> {
        self.with(|input, scratch| fitter.fit(input, &self.settings, scratch))
    }

    fn single(&self) -> Result<LightProjection, FitError> {
        let settings = FitSettings { shape: self.settings.maps.shape().unwrap_or_default(), map: self.settings.fit };
        self.with(|input, scratch| shadowfit::fit_scene(input, &settings, scratch))
    }

    /// Changes cascades. Leaves other maps unchanged.
    fn cascades(&mut self, change: impl FnOnce(&mut Cascades)) {
        if let Maps::Cascades(cascades) = &mut self.settings.maps {
            change(cascades);
        }
    }

    /// Changes the stabilisation of cascades and single maps.
    fn stabilise(&mut self, change: impl FnOnce(&mut Stabilise)) {
        match &mut self.settings.maps {
            Maps::Windows(_) => {}
            Maps::Cascades(Cascades { stabilise, .. }) | Maps::Single(SingleMap { stabilise, .. }) => change(stabilise),
        }
    }

    /// Changes the hysteresis, if there is one.
    fn hold(&mut self, change: impl FnOnce(&mut Hysteresis)) {
        self.stabilise(|stabilise| {
            if let Stabilise::Hysteresis(hold) = stabilise {
                change(hold);
            }
        });
    }

    fn set_count(&mut self, number: u32) {
        match &mut self.settings.maps {
            Maps::Windows(Windows { count, .. }) | Maps::Cascades(Cascades { count, .. }) => *count = number,
            Maps::Single(_) => {}
        }
    }

    fn set_blend(&mut self, texels: f32) {
        match &mut self.settings.maps {
            Maps::Windows(windows) => windows.blend = texels,
            Maps::Cascades(cascades) => cascades.selection = MapSelection::Coverage { blend: texels },
            Maps::Single(_) => {}
        }
    }

    fn set_max_oversize(&mut self, factor: f32) {
        if let Maps::Windows(windows) = &mut self.settings.maps {
            windows.max_depth_oversize = factor;
        }
        self.stabilise(|stabilise| match stabilise {
            Stabilise::Off => {}
            Stabilise::Snap { max_oversize } => *max_oversize = factor,
            Stabilise::Hysteresis(hold) => hold.max_oversize = factor,
        });
    }

    /// Fits twice, so that the second frame uses the state of the first.
    fn check(&self, name: &str) {
        let mut fitter = FitState::new();
        for _ in 0..2 {
            for map in self.fit(&mut fitter).iter().flat_map(|maps| maps.iter()) {
                assert!(is_finite(&map.projection), "{name}: {map:?}");
                assert!(!map.near().is_nan() && !map.far().is_nan() && !map.covered_from().is_nan(), "{name}: {map:?}");
            }
        }
        if let Ok(fit) = self.single() {
            assert!(is_finite(&fit), "{name}: {fit:?}");
        }
    }
}

fn is_finite(fit: &LightProjection) -> bool {
    [fit.light_from_world, fit.clip_from_light, fit.clip_from_world, fit.uv_from_world].iter().all(Mat4::is_finite)
        && fit.texel_size.is_finite()
        && fit.texel_size.min_element() > 0.0
        && fit.depth_range.is_finite()
        && fit.depth_range > 0.0
        && fit.box_min.is_finite()
        && fit.box_max.is_finite()
}

/// A number of the input with its name.
type Setter = (&'static str, fn(&mut Inputs, f64));

/// Every float except the camera's, which have their own tests.
const SETTERS: [Setter; 57] = [
    ("view origin x", |i, v| i.views[0].origin.x = v),
    ("view origin y", |i, v| i.views[1].origin.y = v),
    ("near corner", |i, v| i.views[0].corners[1].x = v as f32),
    ("far corner", |i, v| i.views[0].corners[6].y = v as f32),
    ("other corner", |i, v| i.views[1].corners[4].z = v as f32),
    ("view near", |i, v| i.views[0].near = v as f32),
    ("view far", |i, v| i.views[0].far = v as f32),
    ("other near", |i, v| i.views[1].near = v as f32),
    ("other far", |i, v| i.views[1].far = v as f32),
    ("forward x", |i, v| i.views[0].forward.x = v as f32),
    ("forward", |i, v| i.views[0].forward = Vec3::splat(v as f32)),
    ("direction x", |i, v| i.direction.x = v as f32),
    ("direction", |i, v| i.direction = Vec3::splat(v as f32)),
    ("receivers' origin", |i, v| i.origins[0].y = v),
    ("casters' origin", |i, v| i.origins[1].z = v),
    ("receiver min", |i, v| i.receivers[0].min.x = v as f32),
    ("receiver max", |i, v| i.receivers[1].max.y = v as f32),
    ("caster min", |i, v| i.casters[0].min.z = v as f32),
    ("caster max", |i, v| i.casters[1].max.x = v as f32),
    ("cone axis", |i, v| i.cones[0].axis.x = v as f32),
    ("cone angle", |i, v| i.cones[0].cos_half_angle = v as f32),
    ("depth bound near", |i, v| i.bounds.near = v as f32),
    ("depth bound far", |i, v| i.bounds.far = v as f32),
    ("histogram near", |i, v| i.near = v as f32),
    ("histogram far", |i, v| i.far = v as f32),
    ("histogram bin", |i, v| i.bins.iter_mut().take(1).for_each(|bin| *bin = v as u32)),
    ("histogram bins", |i, v| i.bins.truncate(v as usize % 9)),
    ("histogram classes", |i, v| i.classes = v as usize),
    ("max distance", |i, v| i.settings.fit.max_distance = v as f32),
    ("margin", |i, v| i.settings.fit.margin = v as f32),
    ("kernel margin", |i, v| i.settings.fit.border = Some(v as f32)),
    ("extension", |i, v| i.settings.fit.caster_extension = v as f32),
    ("up x", |i, v| i.settings.fit.up.x = v as f32),
    ("up", |i, v| i.settings.fit.up = Vec3::splat(v as f32)),
    ("resolution", |i, v| i.settings.fit.resolution = UVec2::new(v as u32, 512)),
    ("count", |i, v| i.set_count(v as u32)),
    ("lambda", |i, v| i.cascades(|cascades| cascades.splits = SplitScheme::Practical(v as f32))),
    ("first manual split", |i, v| {
        i.cascades(|cascades| cascades.splits = SplitScheme::Manual([v as f32, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0]));
    }),
    ("second manual split", |i, v| {
        i.cascades(|cascades| cascades.splits = SplitScheme::Manual([2.0, v as f32, 10.0, 11.0, 12.0, 13.0, 14.0]));
    }),
    ("overlap", |i, v| i.cascades(|cascades| cascades.selection = MapSelection::ViewDepth { overlap: v as f32 })),
    ("blend", |i, v| i.set_blend(v as f32)),
    ("hold margin", |i, v| i.hold(|hold| hold.margin = v as f32)),
    ("hold growth", |i, v| i.hold(|hold| hold.max_growth = v as f32)),
    ("oversize", |i, v| i.set_max_oversize(v as f32)),
    ("softness in metres", |i, v| i.settings.softness.radius = SoftRadius::Metres(v as f32)),
    ("softness by angle", |i, v| i.settings.softness.radius = SoftRadius::SunAngle(v as f32)),
    ("softness floor", |i, v| i.settings.softness.floor = v as f32),
    ("softness ceiling", |i, v| i.settings.softness.ceiling = v as f32),
    ("softness of PCSS", |i, v| {
        (i.settings.filter, i.settings.softness.radius) = (FilterKind::Pcss, SoftRadius::Metres(v as f32));
    }),
    ("fade", |i, v| i.settings.fade = v as f32),
    ("least texel", |i, v| i.settings.fit.least_texel = v as f32),
    ("constant bias", |i, v| i.settings.bias.constant = v as f32),
    ("slope-scaled bias", |i, v| i.settings.bias.slope = v as f32),
    ("normal offset", |i, v| i.settings.bias.normal_offset = v as f32),
    ("receiver-plane bias", |i, v| i.settings.bias.receiver_plane = v as f32),
    ("depth steps", |i, v| i.settings.bias.depth_steps = v as f32),
    ("hold horizon", |i, v| i.hold(|hold| hold.look_ahead = v as u32)),
];

const VALUES: [f64; 22] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    0.0,
    -0.0,
    1e-45,
    -1e-45,
    f32::MIN_POSITIVE as f64,
    1e-20,
    1e-10,
    1.0,
    -1.0,
    2.0,
    9.0,
    1e6,
    -1e6,
    1e10,
    1e18,
    1e20,
    -1e20,
    f32::MAX as f64,
    f32::MIN as f64,
];

const KINDS: [FitKind; 5] =
    [FitKind::XnaSample, FitKind::FrustumAabb, FitKind::Oriented, FitKind::Sphere, FitKind::Focused];

/// Returns cascades, single maps and windows with these kinds of fits, where they have a kind.
fn maps_of(kinds: &[FitKind]) -> Vec<Maps> {
    let shapes = kinds.iter().map(|kind| Shape::new(*kind));
    let all = shapes.flat_map(|shape| every_stabilise().map(|stabilise| (shape, stabilise)));
    let cascades = |(shape, stabilise)| Cascades { count: 3, shape, stabilise, ..Cascades::default() }.into();
    let one = |(shape, stabilise)| SingleMap { shape, stabilise }.into();
    let windows = Windows::default().with_count(3).into();
    all.clone().map(cascades).chain(all.map(one)).chain([windows]).collect()
}

fn every_maps() -> Vec<Maps> {
    maps_of(&KINDS)
}

/// Returns whether maps have a number of this name.
fn have(maps: &Maps, name: &str) -> bool {
    let stabilise = if let Maps::Windows(_) = maps { None } else { Some(maps.as_single().stabilise) };
    match name {
        "lambda" | "first manual split" | "second manual split" | "overlap" => matches!(maps, Maps::Cascades(_)),
        "blend" => !matches!(maps, Maps::Single(_)),
        "hold margin" | "hold growth" => matches!(stabilise, Some(Stabilise::Hysteresis(_))),
        "oversize" => stabilise != Some(Stabilise::Off),
        _ => true,
    }
}

#[test]
fn each_bad_number_gives_an_error_or_finite_maps_and_so_does_each_in_some_fit() {
    assert_refused_or_finite(|fit, setter, value| (fit + setter + value).is_multiple_of(3));
}

#[test]
#[ignore = "the full product of numbers and fits: cargo xtask test --all"]
fn each_bad_number_in_each_fit_gives_an_error_or_finite_maps() {
    assert_refused_or_finite(|_, _, _| true);
}

/// Asserts that the selected numbers give an error or finite maps. `is_picked` gets the indices of fit, input
/// and value.
fn assert_refused_or_finite(is_picked: impl Fn(usize, usize, usize) -> bool) {
    for (fit, maps) in every_maps().into_iter().enumerate() {
        for (setter, (name, set)) in SETTERS.into_iter().enumerate().filter(|(_, (name, _))| have(&maps, name)) {
            let values = VALUES.into_iter().enumerate().filter(|(value, _)| is_picked(fit, setter, *value));
            for (_, value) in values {
                let mut inputs = good();
                inputs.settings.maps = maps;
                inputs.settings.fit.casters = CasterPolicy::PerObject;
                set(&mut inputs, value);
                inputs.check(name);
            }
        }
    }
}

/// Lengths, positions and directions: NaN and infinity are always refused.
#[test]
fn what_is_not_finite_is_refused_and_leaves_the_fitter_as_it_was() {
    let harmless = ["cone axis", "cone angle", "histogram near", "histogram far", "histogram bin", "histogram bins"];
    let integers = ["histogram classes", "resolution", "count", "hold horizon"];
    for maps in maps_of(&[FitKind::Focused]) {
        let floats = SETTERS.into_iter().filter(|(name, _)| !harmless.contains(name) && !integers.contains(name));
        for (name, set) in floats.filter(|(name, _)| have(&maps, name)) {
            for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut before = good();
                before.settings.maps = maps;
                let mut bad = before.clone();
                set(&mut bad, value);
                // An infinite corner makes an empty box, which is allowed.
                let is_emptied = matches!(name, "receiver min" | "caster min") && value == f64::INFINITY
                    || matches!(name, "receiver max" | "caster max") && value == f64::NEG_INFINITY;
                let mut fitter = FitState::new();
                before.fit(&mut fitter).unwrap();
                let result = bad.fit(&mut fitter);
                if !is_emptied {
                    assert!(matches!(result, Err(FitError::NotFinite { .. })), "{name} = {value}: {result:?}");
                    let mut undisturbed = FitState::new();
                    before.fit(&mut undisturbed).unwrap();
                    assert_eq!(before.fit(&mut fitter), before.fit(&mut undisturbed), "{name} = {value}");
                }
            }
        }
    }
}

#[test]
fn counts_outside_of_one_to_eight_windows_and_two_to_eight_slices_are_refused() {
    let refused = |maps: Maps| {
        let mut inputs = good();
        inputs.settings.maps = maps;
        let result = inputs.fit(&mut FitState::new());
        let count = f64::from(maps.count());
        assert!(matches!(result, Err(FitError::OutOfRange { value, .. }) if value == count), "{maps:?}: {result:?}");
    };
    for count in [0, 9, u32::MAX] {
        refused(Windows::default().with_count(count).into());
        refused(Cascades::default().with_count(count).into());
    }
    refused(Cascades::default().with_count(1).into());
}

#[test]
fn settings_without_meaning_are_refused() {
    let refused: [Setter; 32] = [
        ("lambda above", |i, _| i.cascades(|cascades| cascades.splits = SplitScheme::Practical(1.1))),
        ("lambda below", |i, _| i.cascades(|cascades| cascades.splits = SplitScheme::Practical(-0.1))),
        ("splits that fall", |i, _| {
            i.cascades(|cascades| cascades.splits = SplitScheme::Manual([5.0, 4.0, 6.0, 7.0, 8.0, 9.0, 10.0]));
        }),
        ("splits that stay", |i, _| {
            i.cascades(|cascades| cascades.splits = SplitScheme::Manual([5.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0]));
        }),
        ("overlap above", |i, _| i.cascades(|cascades| cascades.selection = MapSelection::ViewDepth { overlap: 1.1 })),
        ("overlap below", |i, _| i.cascades(|cascades| cascades.selection = MapSelection::ViewDepth { overlap: -0.1 })),
        ("blend above", |i, _| i.set_blend(64.1)),
        ("blend below", |i, _| i.set_blend(-0.1)),
        ("windows' blend above", |i, _| i.settings.maps = Windows::default().with_blend(64.1).into()),
        ("windows' blend below", |i, _| i.settings.maps = Windows::default().with_blend(-0.1).into()),
        ("windows' oversize above", |i, _| i.settings.maps = Windows::default().with_max_depth_oversize(100.1).into()),
        ("windows' oversize below", |i, _| i.settings.maps = Windows::default().with_max_depth_oversize(0.9).into()),
        ("snapped oversize above", |i, _| {
            i.stabilise(|stabilise| *stabilise = Stabilise::Snap { max_oversize: 100.1 });
        }),
        ("snapped oversize below", |i, _| i.stabilise(|stabilise| *stabilise = Stabilise::Snap { max_oversize: 0.9 })),
        ("fade above", |i, _| i.settings.fade = 1.1),
        ("fade below", |i, _| i.settings.fade = -0.1),
        ("least texel", |i, _| i.settings.fit.least_texel = -0.1),
        ("least texel above", |i, _| i.settings.fit.least_texel = 1e19),
        ("depth steps above", |i, _| i.settings.bias.depth_steps = 16.1),
        ("depth steps below", |i, _| i.settings.bias.depth_steps = -0.1),
        ("softness below", |i, _| i.settings.softness.radius = SoftRadius::Metres(-0.1)),
        ("softness above", |i, _| i.settings.softness.radius = SoftRadius::Metres(1001.0)),
        ("a sun below", |i, _| i.settings.softness.radius = SoftRadius::SunAngle(-0.1)),
        ("a sun above", |i, _| i.settings.softness.radius = SoftRadius::SunAngle(0.8)),
        ("a ceiling below the floor", |i, _| {
            (i.settings.softness.floor, i.settings.softness.ceiling) = (4.1, 4.0);
        }),
        ("ceiling below", |i, _| (i.settings.softness.floor, i.settings.softness.ceiling) = (0.0, 0.9)),
        ("ceiling above", |i, _| i.settings.softness.ceiling = 64.1),
        ("oversize", |i, _| i.hold(|hold| hold.max_oversize = 0.9)),
        ("growth", |i, _| i.hold(|hold| hold.max_growth = 0.9)),
        ("hold margin", |i, _| i.hold(|hold| hold.margin = -0.1)),
        ("kernel as wide as the map", |i, _| i.settings.fit.border = Some(1e4)),
        ("no view", |i, _| i.views.clear()),
    ];
    for (name, set) in refused {
        let mut inputs = good();
        set(&mut inputs, 0.0);
        assert!(inputs.fit(&mut FitState::new()).is_err(), "{name}");
    }
}

#[test]
fn penumbrae_by_distance_are_refused_where_depth_clamp_loses_the_distance() {
    let traced = Edges::Traced { samples: 4 };
    for maps in every_maps() {
        for (casters, filter, edges, needs) in [
            (CasterPolicy::DepthClamp, FilterKind::Pcss, Edges::Filtered, true),
            (CasterPolicy::DepthClamp, FilterKind::Vogel16, Edges::Filtered, false),
            (CasterPolicy::DepthClamp, FilterKind::Vogel16, traced, true),
            (CasterPolicy::DepthClamp, FilterKind::Pcf5x5, traced, false),
            (CasterPolicy::PerObject, FilterKind::Pcss, traced, false),
        ] {
            let mut inputs = good();
            (inputs.settings.maps, inputs.settings.fit.casters) = (maps, casters);
            (inputs.settings.filter, inputs.settings.edges) = (filter, edges);
            // The XNA sample's fit has no caster policy.
            let is_refused = needs && maps.shape().is_none_or(|shape| shape.kind != FitKind::XnaSample);
            let result = inputs.fit(&mut FitState::new());
            let refusal = matches!(result, Err(FitError::ClampedCasters));
            assert!(
                refusal == is_refused && result.is_ok() != is_refused,
                "{maps:?} {casters:?} {filter:?} {edges:?}: {result:?}"
            );
        }
    }
}

#[test]
fn numbers_of_rays_out_of_range_are_refused_with_the_number() {
    for (samples, is_refused) in [(0, true), (1, false), (4, false), (64, false), (65, true), (u32::MAX, true)] {
        let mut inputs = good();
        inputs.settings.edges = Edges::Traced { samples };
        let result = inputs.fit(&mut FitState::new());
        let value = f64::from(samples);
        let refusal = FitError::OutOfRange { input: "the rays of a pixel", value, min: 1.0, max: 64.0 };
        assert_eq!(result.err(), is_refused.then_some(refusal), "{samples}");
    }
}

#[test]
fn any_number_of_views_is_an_error_or_is_fitted() {
    for maps in every_maps() {
        for count in [1, 2, 8, 9, 10, 11, 40] {
            let mut inputs = good();
            inputs.views = vec![inputs.views[0]; count];
            inputs.settings.maps = maps;
            inputs.storage = Scratch::required(2, count);
            inputs.check("views");
        }
    }
}

#[test]
fn a_workspace_of_any_length_is_too_small_or_enough() {
    let mut was_small = 0;
    for maps in every_maps() {
        for storage in 0..=Scratch::required(2, 2) {
            let mut inputs = good();
            inputs.settings.maps = maps;
            inputs.cascades(|cascades| cascades.splits = SplitScheme::Uniform);
            inputs.storage = storage;
            let results = [inputs.single().map(|_| ()), inputs.fit(&mut FitState::new()).map(|_| ())];
            for result in results {
                match result {
                    Ok(()) => {}
                    Err(FitError::ScratchTooSmall { given, required }) => {
                        assert!(given < required && given <= storage, "{given} {required}");
                        was_small += 1;
                    }
                    Err(error) => panic!("{storage}: {error}"),
                }
            }
        }
    }
    assert!(was_small > 0);
}

/// Small boxes on a circle across the light: each adds corners to the outline, and they do not hide one
/// another.
#[test]
fn the_required_workspace_is_enough_for_boxes_on_a_circle() {
    let view = ViewFrustum { ..camera().frustum().unwrap() };
    let middle = (view.corners[4..].iter().sum::<Vec3>() * 0.125).as_dvec3();
    for count in [1, 3, 50, 400] {
        let boxes: Vec<Aabb> = (0..count)
            .map(|i| {
                let angle = f64::from(i) / f64::from(count) * std::f64::consts::TAU;
                let centre = middle + DVec3::new(angle.cos(), 0.0, angle.sin()) * 8.0;
                Aabb::new((centre - 1e-4).as_vec3(), (centre + 1e-4).as_vec3())
            })
            .collect();
        for stabilise in every_stabilise() {
            for rectangle in [RectangleKind::AxisAligned, RectangleKind::MinimumArea, RectangleKind::MinimumSquare] {
                let fit = FitSettings::default().with_rectangle(rectangle).with_casters(CasterPolicy::PerObject);
                let splits = SplitScheme::Uniform;
                let inputs = Inputs {
                    views: vec![view],
                    direction: Vec3::NEG_Y,
                    origins: [view.origin; 2],
                    receivers: boxes.clone(),
                    casters: boxes.clone(),
                    cones: Vec::new(),
                    settings: sliced(&fit, Cascades { count: 2, splits, stabilise, ..Cascades::default() }),
                    storage: Scratch::required(boxes.len(), 1),
                    ..good()
                };
                inputs.single().unwrap();
                let mut fitter = FitState::new();
                inputs.fit(&mut fitter).unwrap();
                inputs.fit(&mut fitter).unwrap();
            }
        }
    }
}

proptest! {
    #![proptest_config(cases(3000))]

    /// Several numbers at once, including any bit pattern.
    #[test]
    fn no_bit_patterns_panic_and_every_map_that_is_made_is_finite(
        bits in prop::collection::vec((0..SETTERS.len(), any::<u32>(), any::<bool>()), 1..6),
        maps in prop::sample::select(every_maps()),
        policy in prop::sample::select(vec![CasterPolicy::None, CasterPolicy::Extend, CasterPolicy::SceneBounds, CasterPolicy::PerObject]),
        splits in crate::scenes::any_splits(),
    ) {
        let mut inputs = good();
        inputs.settings.maps = maps;
        inputs.settings.fit.casters = policy;
        inputs.cascades(|cascades| cascades.splits = splits);
        for (i, bits, is_raw) in bits {
            let value = if is_raw { f64::from(f32::from_bits(bits)) } else { VALUES[bits as usize % VALUES.len()] };
            SETTERS[i].1(&mut inputs, value);
        }
        inputs.check("several");
    }
}
