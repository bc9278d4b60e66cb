//! Views that begin beyond the shadow distance: such frames have no shadows and no errors, and held maps
//! continue after them.

use shadowfit::demand::VisibleDemandSpace;
use shadowfit::glam::{DMat4, DVec2, DVec3, DVec4, Vec3};
use shadowfit::proof::{CoverageQuery, prove};
use shadowfit::settings::FitSettings;
use shadowfit::{
    Aabb, Boxes, DepthConvention, FitError, FitInput, FitState, FittedMaps, PRESETS, PerspectiveCamera, Scratch,
    ShadowFitter, Technique, ViewFrustum, fewest_maps, fit, fit_scene,
};

use crate::support::{DIRECTION, KINDS, camera, exact};

/// A shadow distance before the near plane of [`beyond`].
const DISTANCE: f32 = 50.0;

fn beyond() -> PerspectiveCamera {
    PerspectiveCamera { near: 60.0, far: 200.0, ..camera() }
}

fn ground() -> [Aabb; 2] {
    let eye = camera().eye.as_vec3();
    let at = |x: f32, y: f32, z: f32| eye + Vec3::new(x, y, z);
    [Aabb::new(at(-90.0, -3.2, -90.0), at(90.0, -3.0, 90.0)), Aabb::new(at(1.0, -3.0, -9.0), at(3.0, 4.0, -7.0))]
}

fn techniques() -> impl Iterator<Item = (&'static str, Technique)> {
    PRESETS.iter().map(|preset| (preset.name, preset.technique().with_max_distance(DISTANCE)))
}

fn assert_shadowless(name: &str, input: &FitInput, maps: &FittedMaps, technique: &Technique) {
    assert!(maps.is_empty(), "{name}");
    for depth in [0.1, 30.0, 70.0, 150.0] {
        let view = &input.views[0];
        let point = view.origin + view.forward.as_dvec3() * depth;
        assert_eq!(maps.read(technique, point, depth), None, "{name}");
    }
    let volumes = maps.caster_volumes(input.views, technique).unwrap();
    assert!(volumes.iter().all(|volume| !volume.intersects_aabb(Vec3::splat(-1e3), Vec3::splat(1e3))), "{name}");
}

#[test]
fn matrices_of_views_beyond_the_distance_give_empty_views() {
    for depth in [DepthConvention::ZeroToOne, DepthConvention::Reversed, DepthConvention::NegativeOneToOne] {
        let matrix = beyond().clip_from_world(depth).as_dmat4().inverse();
        let orthographic =
            DMat4::from_cols(DVec4::X * 4.0, DVec4::Y * 3.0, DVec4::Z * -2.0, DVec4::new(0.0, 0.0, -90.0, 1.0));
        // With reversed depth, the orthographic matrix looks the other way.
        let is_reversed = depth == DepthConvention::Reversed;
        for matrix in [matrix, if is_reversed { matrix } else { orthographic }] {
            let view = ViewFrustum::from_eye_from_clip(&matrix.as_mat4(), camera().eye, depth, DISTANCE).unwrap();
            assert!(view.is_empty() && view.near > 59.0 && view.near.to_bits() == view.far.to_bits(), "{view:?}");
            assert!(!view.begins_before(f32::MAX));
            let views = [view];
            for (name, technique) in techniques() {
                let input = FitInput::new(&views, DIRECTION);
                let maps = *ShadowFitter::new(&technique.with_max_distance(f32::MAX)).fit(&input).unwrap();
                assert_shadowless(name, &input, &maps, &technique);
            }
        }
    }
}

#[test]
fn a_technique_s_distance_before_the_view_leaves_it_without_maps() {
    let (views, boxes) = ([beyond().frustum().unwrap()], ground());
    let boxes = Some(Boxes::world(&boxes));
    assert!(views[0].begins_before(60.5) && !views[0].begins_before(60.0));
    for (name, technique) in techniques() {
        for receivers in [None, boxes] {
            let input = FitInput { receivers, casters: receivers, ..FitInput::new(&views, DIRECTION) };
            let maps = *ShadowFitter::new(&technique).fit(&input).unwrap();
            assert_shadowless(name, &input, &maps, &technique);
            let mut storage = vec![DVec2::ZERO; input.scratch()];
            assert_eq!(fewest_maps(&input, &technique, 1.5, &mut Scratch::new(&mut storage)), Ok(1), "{name}");
        }
    }
}

#[test]
fn a_single_map_of_such_a_view_is_marked_empty_and_proven() {
    let (boxes, mut storage) = (ground(), vec![DVec2::ZERO; 1024]);
    let matrix = beyond().clip_from_world(DepthConvention::Reversed).inverse();
    let empty = ViewFrustum::from_eye_from_clip(&matrix, camera().eye, DepthConvention::Reversed, DISTANCE).unwrap();
    for (view, distance) in [(beyond().frustum().unwrap(), DISTANCE), (empty, f32::MAX)] {
        for kind in KINDS {
            let settings = FitSettings { map: exact(kind).map, ..exact(kind) }.with_max_distance(distance);
            let (views, boxes) = ([view], Some(Boxes::world(&boxes)));
            let input = FitInput { receivers: boxes, casters: boxes, ..FitInput::new(&views, DIRECTION) };
            let maps = [
                fit(&view, DIRECTION, &settings).unwrap(),
                fit_scene(&input, &settings, &mut Scratch::new(&mut storage)).unwrap(),
            ];
            for map in maps {
                assert!(map.is_empty && map.clip_from_world.is_finite() && map.texel_size.min_element() > 0.0);
                let query = CoverageQuery { is_shared: true, ..CoverageQuery::of_fit(&settings, Default::default()) };
                let proof = prove(&input, &map, &query, &mut Scratch::new(&mut storage)).unwrap();
                assert!(proof.is_proven(), "{proof:?}");
            }
        }
    }
}

/// Both halves of a split screen. One of them begins beyond the shadow distance.
#[test]
fn a_view_beyond_the_distance_adds_nothing_to_the_maps_of_others() {
    let boxes = ground();
    let boxes = Some(Boxes::world(&boxes));
    let near = camera().frustum().unwrap();
    let matrix = beyond().clip_from_world(DepthConvention::Reversed).inverse();
    let empty = ViewFrustum::from_eye_from_clip(&matrix, near.origin, DepthConvention::Reversed, DISTANCE).unwrap();
    for (name, technique) in techniques() {
        for receivers in [None, boxes] {
            let fitted = |views: &[ViewFrustum]| {
                let input = FitInput { receivers, casters: receivers, ..FitInput::new(views, DIRECTION) };
                let mut fitter = ShadowFitter::new(&technique);
                let maps = [(); 3].map(|()| *fitter.fit(&input).unwrap());
                let mut storage = vec![DVec2::ZERO; input.scratch()];
                for map in maps[2].iter().filter(|_| name != "xna-1") {
                    let query = CoverageQuery::of_map(map, &technique, technique.filter_radius_in(&map.projection))
                        .with_normal_offset(map.bias.normal_offset);
                    let proof = prove(&input, &map.projection, &query, &mut Scratch::new(&mut storage)).unwrap();
                    assert!(proof.is_proven(), "{name}: {proof:?}");
                }
                maps[2]
            };
            let alone = fitted(&[near]);
            let far = beyond().frustum().unwrap();
            for views in [[near, empty], [empty, near], [near, far], [far, near]] {
                let both = fitted(&views);
                assert_eq!(both.len(), alone.len(), "{name}");
                for (both, alone) in both.iter().zip(alone.iter()) {
                    let [a, b] = [both, alone].map(|map| map.projection.texel_size);
                    assert!((a / b - 1.0).abs().max_element() < 0.01, "{name}: {a} and {b}");
                    assert_eq!(both.projection.is_empty, alone.projection.is_empty, "{name}");
                }
            }
        }
    }
}

/// The near plane moves across the shadow distance and back, as in a cut-away view.
#[test]
fn held_maps_are_the_same_after_frames_without_shadows() {
    let boxes = ground();
    let boxes = Some(Boxes::world(&boxes));
    let matrix = beyond().clip_from_world(DepthConvention::Reversed).inverse();
    let eye = camera().eye;
    let empty = ViewFrustum::from_eye_from_clip(&matrix, eye, DepthConvention::Reversed, DISTANCE).unwrap();
    let shown = camera().frustum().unwrap();
    for (name, technique) in techniques() {
        let mut fitter = ShadowFitter::new(&technique);
        let mut at = |view: ViewFrustum| {
            let views = [view];
            let input = FitInput { receivers: boxes, casters: boxes, ..FitInput::new(&views, DIRECTION) };
            *fitter.fit(&input).unwrap()
        };
        // The windows have settled by then.
        let before = (0..400).map(|_| at(shown)).last().unwrap();
        for gap in [beyond().frustum().unwrap(), empty] {
            assert!((0..5).all(|_| at(gap).is_empty()), "{name}");
            for frame in 0..3 {
                let after = at(shown);
                for (map, (a, b)) in after.iter().zip(before.iter()).enumerate() {
                    assert_eq!(a.grid_position, b.grid_position, "{name}, frame {frame}, map {map}");
                    assert_eq!(a.projection, b.projection, "{name}, frame {frame}, map {map}");
                }
            }
        }
    }
}

#[test]
fn distances_that_are_none_and_views_turned_inside_out_are_still_refused() {
    let view = camera().frustum().unwrap();
    let matrix = camera().clip_from_world(DepthConvention::Reversed).inverse();
    for distance in [0.0, -1.0] {
        let read = ViewFrustum::from_eye_from_clip(&matrix, DVec3::ZERO, DepthConvention::Reversed, distance);
        assert!(matches!(read, Err(FitError::NearNotBelowFar { .. })));
        let technique = Technique::default().with_max_distance(distance);
        let mut storage = vec![DVec2::ZERO; 4096];
        let fitted =
            FitState::new().fit(&FitInput::new(&[view], DIRECTION), &technique, &mut Scratch::new(&mut storage));
        assert!(matches!(fitted, Err(FitError::NearNotBelowFar { .. })));
    }
    let turned = ViewFrustum { near: view.far, far: view.near, ..view };
    assert!(ShadowFitter::default().fit(&FitInput::new(&[turned], DIRECTION)).is_err());
    // The view has nothing to count.
    assert!(matches!(VisibleDemandSpace::new(&view, DIRECTION, Vec3::Y, 0.2), Err(FitError::NearNotBelowFar { .. })));
}

/// Orthographic views may be completely behind the eye.
#[test]
fn a_view_behind_the_eye_has_windows() {
    let corners = [-2.0_f32, -8.0]
        .map(|depth| [(-4.0, 3.0), (4.0, 3.0), (4.0, -3.0), (-4.0, -3.0)].map(|(x, y)| Vec3::new(x, y, -depth)));
    let [far, near] = corners;
    let corners = core::array::from_fn(|i| if i < 4 { near[i] } else { far[i - 4] });
    let view = ViewFrustum { origin: DVec3::ZERO, corners, near: -8.0, far: -2.0, forward: Vec3::NEG_Z };
    let boxes = [Aabb::new(Vec3::new(-9.0, -1.0, 1.0), Vec3::new(9.0, 0.0, 9.0))];
    let (views, boxes) = ([view], Some(Boxes::world(&boxes)));
    for (name, technique) in PRESETS.iter().map(|preset| (preset.name, preset.technique())) {
        let input = FitInput { receivers: boxes, casters: boxes, ..FitInput::new(&views, DIRECTION) };
        let maps = *ShadowFitter::new(&technique).fit(&input).unwrap();
        assert!(maps.read(&technique, DVec3::new(0.0, 0.0, 5.0), -5.0).is_some(), "{name}");
    }
}
