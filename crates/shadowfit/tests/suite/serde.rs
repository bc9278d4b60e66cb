//! Feature `serde`: saved values read back bit by bit, and a restored fitter continues as if it had not been
//! saved.

use std::fmt::Debug;

use serde::{Serialize, de::DeserializeOwned};
use shadowfit::NormalCone;
use shadowfit::bias::FilterRadius;
use shadowfit::culling::{CasterPlanes, OrientedBox, Sphere};
use shadowfit::diagnostics::{AcneMargin, Coverage, DepthStorage, PixelsPerTexel};
use shadowfit::glam::{DVec2, DVec3, UVec2, Vec3};
use shadowfit::light_steps::{LightStepState, LightSteps};
use shadowfit::proof::{CoverageProof, CoverageQuery, MapPlane, Margins};
use shadowfit::settings::{
    BiasSettings, CasterPolicy, Edges, FitKind, FitSettings, MapSelection, RectangleKind, SplitScheme,
};
use shadowfit::spot::SpotBias;
use shadowfit::{
    Aabb, Bias, Cascades, DepthConvention, FitInput, FitState, Scratch, SingleMap, Technique, ViewFrustum, Windows,
};

use crate::support::{DIRECTION, camera, every_stabilise, fitted};

fn read_back<T: Serialize + DeserializeOwned>(value: &T) -> T {
    serde_json::from_str(&serde_json::to_string(value).unwrap()).unwrap()
}

/// Compares the `Debug` texts, which distinguish all bits.
fn survives<T: Serialize + DeserializeOwned + Debug>(value: &T) {
    assert_eq!(format!("{value:?}"), format!("{:?}", read_back(value)));
}

#[test]
fn settings_survive() {
    let single = FitSettings::default()
        .with_kind(FitKind::Oriented)
        .with_rectangle(RectangleKind::MinimumSquare)
        .with_casters(CasterPolicy::DepthClamp)
        .with_depth(DepthConvention::NegativeOneToOne)
        .with_max_distance(f32::MAX)
        .with_margin(0.1);
    survives(&single);
    let technique = Technique::default().with_fit(single.map);
    let splits = SplitScheme::Manual([1.0, 2.5, 0.1, 1e-7, 3e9, 0.3, 7.0]);
    let cascades = Cascades { shape: single.shape, splits, ..Cascades::default() };
    survives(&technique.with_maps(cascades));
    survives(&technique.with_maps(cascades.with_splits(SplitScheme::Practical(0.7))));
    for stabilise in every_stabilise() {
        let selection = MapSelection::ViewDepth { overlap: 0.1 };
        survives(&technique.with_maps(cascades.with_stabilise(stabilise).with_selection(selection)));
        survives(&technique.with_maps(SingleMap { shape: single.shape, stabilise }));
    }
    survives(&technique.with_maps(Windows { count: 7, blend: 0.1, max_depth_oversize: 1.3 }));
    survives(&technique.with_edges(Edges::Traced { samples: 7 }));
    survives(&LightSteps::default());
}

#[test]
fn settings_that_a_file_does_not_name_have_their_defaults() {
    let technique: Technique = serde_json::from_str(r#"{"bias": {"slope": 2.0}}"#).unwrap();
    let bias = BiasSettings::default().with_slope(2.0);
    assert_eq!(technique, Technique { bias, ..Technique::default() });
    let technique: Technique = serde_json::from_str(r#"{"maps": {"Cascades": {"count": 3}}}"#).unwrap();
    assert_eq!(technique, Technique::default().with_maps(Cascades::default().with_count(3)));
}

#[test]
fn inputs_survive() {
    let camera = camera();
    survives(&camera);
    survives(&camera.frustum().unwrap());
    survives(&crate::spot::lamp());
    survives(&Aabb::EMPTY);
    survives(&Sphere { centre: DIRECTION, radius: 0.1 });
    survives(&OrientedBox { centre: DIRECTION, half_axes: [Vec3::X, Vec3::Y, DIRECTION] });
    survives(&NormalCone { axis: DIRECTION, cos_half_angle: 0.3 });
    survives(&camera.frustum().unwrap().enclosing_sphere().unwrap());
}

#[test]
fn outputs_survive() {
    let fit = fitted(&camera(), DIRECTION, &FitSettings::default());
    survives(&fit);
    survives(&fit.world_matrices());
    survives(&fit.caster_volume());
    survives(&CasterPlanes::from(&fit.caster_volume()));
    let bias = Bias::automatic(FilterRadius::POINT, DepthStorage::Float16, &fit).unwrap();
    survives(&bias);
    survives(&bias.on_plane(&fit, Vec3::Y).unwrap());
    survives(&FilterRadius::HARDWARE_2X2.over_disc(3.0));
    survives(&Coverage::BeforeNear);
    survives(&CoverageQuery::of_fit(&FitSettings::default(), FilterRadius::POINT));
    survives(&CoverageProof::Uncovered { plane: MapPlane::Far, point: DVec3::splat(0.1), by: 0.3 });
    survives(&CoverageProof::Proven(Margins { planes: [0.1; 6], casters: 2.5 }));
    survives(&AcneMargin { metres: 0.1, texels: -0.3 });
    survives(&PixelsPerTexel { worse_axis: 0.1, area: 0.7 });
    let spot = crate::spot::lamp().fit(UVec2::splat(512), DepthConvention::Reversed).unwrap();
    survives(&spot);
    survives(&SpotBias::automatic(FilterRadius::POINT, DepthStorage::Float16, &spot).unwrap());
}

#[test]
fn lights_that_step_go_on() {
    let settings = LightSteps::default().with_fade(1.0);
    let mut steps = LightStepState::default();
    steps.update(DIRECTION, &settings, 0.1).unwrap();
    steps.update(Vec3::NEG_Y, &settings, 0.1).unwrap();
    let mut other = read_back(&steps);
    assert_eq!(steps.update(Vec3::NEG_Y, &settings, 0.3), other.update(Vec3::NEG_Y, &settings, 0.3));
}

#[test]
fn a_fitter_that_was_saved_goes_on_as_the_one_that_was_not() {
    for settings in [Technique::preset("calm-4").unwrap(), Technique::default()] {
        let mut storage = [DVec2::ZERO; Scratch::required(0, 4)];
        let mut fit = |fitter: &mut FitState, frame: u8| {
            let mut camera = camera();
            camera.eye.x += f64::from(frame) * 0.3;
            let views: [ViewFrustum; 1] = [camera.frustum().unwrap()];
            fitter.fit(&FitInput::new(&views, DIRECTION), &settings, &mut Scratch::new(&mut storage)).unwrap()
        };
        let mut fitter = FitState::new();
        for frame in 0..3 {
            survives(&fit(&mut fitter, frame));
        }
        let mut other = read_back(&fitter);
        for frame in 3..12 {
            assert_eq!(fit(&mut fitter, frame), fit(&mut other, frame), "frame {frame}");
        }
        assert_ne!(fit(&mut FitState::new(), 11), fit(&mut fitter, 11), "the state matters");
    }
}

#[test]
fn a_damaged_number_of_maps_is_read_as_the_greatest() {
    let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
    let views = [camera().frustum().unwrap()];
    let maps = FitState::new()
        .fit(&FitInput::new(&views, DIRECTION), &Technique::default(), &mut Scratch::new(&mut storage))
        .unwrap();
    let mut json = serde_json::to_value(maps).unwrap();
    json["count"] = 1000.into();
    let damaged: shadowfit::FittedMaps = serde_json::from_value(json).unwrap();
    assert_eq!(damaged.len(), shadowfit::settings::MAX_MAPS);
}
