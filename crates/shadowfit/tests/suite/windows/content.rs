//! Completeness of the maps that points read: depth ranges, culling and the proof of windows.

use proptest::prelude::*;
use shadowfit::bias::FilterRadius;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::proof::{CoverageProof, CoverageQuery, prove};
use shadowfit::settings::CasterPolicy;
use shadowfit::{Aabb, Boxes, FitInput, FitState, FittedMap, Scratch, ShadowFitter, StaticBoxes};

use super::{World, any_seen, any_windows, windows};
use crate::read_by_coverage::{Sample, any_samples, check};
use crate::scenes::{any_box, any_light, any_view, any_walk};
use crate::support::cases;

proptest! {
    #![proptest_config(cases(250))]

    #[test]
    fn every_caster_above_a_visible_point_is_in_the_window_that_the_point_reads(
        view in any_view(), direction in any_light(), technique in any_windows(), walk in any_walk(), is_seen in any_seen(),
        plans in prop::collection::vec(any_box(), 1..12), samples in any_samples(),
    ) {
        prop_assume!(view.lens.near < f64::from(technique.fit.max_distance));
        let origin = view.eye.round();
        let world = World { origin, boxes: plans.iter().map(|plan| plan.aabb(&view, origin)).collect() };
        let mut run = super::Run::new(world.clone(), &technique).seen_if(is_seen);
        let mut view = view;
        let last = f64::from(technique.fit.max_distance);
        for _ in 0..5 {
            let maps = run.frame(&view, direction);
            let points = samples.iter().map(|sample| {
                let aabb = &world.boxes[sample.receiver % world.boxes.len()];
                let (min, max) = (aabb.min.as_dvec3(), aabb.max.as_dvec3());
                origin + min + (max - min) * DVec3::from_array(sample.place)
            });
            let (seen, samples): (Vec<DVec3>, Vec<Sample>) =
                points.zip(&samples).filter(|(point, _)| view.sees(*point - view.eye, last)).unzip();
            let views = [view.frustum()];
            check(&maps, &world.input(&views, direction, &[]), &technique, &seen, &samples);
            view = walk.moved(&view);
        }
    }

    /// The last window is proven to cover all visible points, and every window to have all casters over it.
    #[test]
    fn windows_are_proven(
        view in any_view(), direction in any_light(), technique in any_windows(), walk in any_walk(), is_seen in any_seen(),
        plans in prop::collection::vec(any_box(), 0..12),
    ) {
        prop_assume!(view.lens.near < f64::from(technique.fit.max_distance));
        let technique = technique.with_fit(technique.fit.with_border(technique.fit.border.unwrap_or(4.0).max(2.0)));
        let origin = view.eye.round();
        let world = World { origin, boxes: plans.iter().map(|plan| plan.aabb(&view, origin)).collect() };
        let mut run = super::Run::new(world.clone(), &technique).seen_if(is_seen);
        let mut view = view;
        let mut storage = vec![DVec2::ZERO; Scratch::required(world.boxes.len(), 1)];
        for frame in 0..5 {
            let maps = run.frame(&view, direction);
            let views = [view.frustum()];
            for (i, map) in maps.iter().enumerate() {
                let query = CoverageQuery::of_map(map, &technique, FilterRadius::HARDWARE_2X2);
                let input = world.input(&views, direction, &[]);
                let proof = prove(&input, &map.projection, &query, &mut Scratch::new(&mut storage)).unwrap();
                prop_assert!(proof.is_proven(), "frame {frame}, map {i}: {proof:?} of {map:?}");
            }
            view = walk.moved(&view);
        }
    }
}

/// A tower that receives no shadows. Its top is lost if the near plane is at the receivers.
#[test]
fn a_near_plane_that_is_cut_is_found_in_every_window_under_the_tower() {
    let view = super::street_view(DVec3::new(0.0, 1.7, 0.0), Vec3::new(0.0, -0.3, -1.0));
    let (views, direction) = ([view.frustum()], Vec3::NEG_Y);
    let ground = [Aabb::new(Vec3::new(-100.0, -0.1, -200.0), Vec3::new(100.0, 0.0, 10.0))];
    let tower = [ground[0], Aabb::new(Vec3::new(-1.0, 0.0, -8.0), Vec3::new(1.0, 100.0, -6.0))];
    let (receivers, casters) = [&ground[..], &tower].map(|boxes| Some(Boxes { origin: DVec3::ZERO, boxes })).into();
    let input = FitInput { receivers, casters, ..FitInput::new(&views, direction) };
    let mut storage = vec![DVec2::ZERO; Scratch::required(tower.len(), 1)];
    let mut scratch = Scratch::new(&mut storage);
    // Whether a window contains the tower's foot, and its proof.
    let mut proofs = |policy| -> Vec<(bool, CoverageProof)> {
        let technique = windows(4, 1024);
        let technique = technique.with_fit(technique.fit.with_casters(policy));
        let maps = FitState::new().fit(&input, &technique, &mut scratch).unwrap();
        let proof = |map: &FittedMap| {
            let query = CoverageQuery::of_map(map, &technique, FilterRadius::HARDWARE_2X2);
            let foot = map.projection.texels_to_edge(DVec3::new(0.0, -0.05, -7.0));
            (foot.is_some(), prove(&input, &map.projection, &query, &mut scratch).unwrap())
        };
        maps.iter().map(proof).collect()
    };
    assert!(proofs(CasterPolicy::PerObject).iter().all(|(_, proof)| proof.is_proven()));
    let cut = proofs(CasterPolicy::None);
    assert!(cut.iter().filter(|(is_under, _)| *is_under).count() >= 2, "{cut:?}");
    for (is_under, proof) in cut {
        // The depth range over the ground alone is only a few metres.
        let is_lost = matches!(proof, CoverageProof::CasterLost { by, .. } if by > 95.0);
        assert!(is_lost || !is_under, "{proof:?}");
    }
}

/// Returns the depth ranges of the maps of a ground, in metres. The ground is in a list or in a tree of
/// static boxes.
fn depths_over(ground: &[Aabb], stands: bool, direction: Vec3) -> Vec<f32> {
    let view = super::street_view(DVec3::new(0.0, 1.7, 0.0), Vec3::new(0.3, -0.2, -1.0));
    let technique = windows(4, 1024).with_max_distance(300.0);
    let list = Boxes { origin: DVec3::ZERO, boxes: ground };
    let tree = StaticBoxes::from_boxes(list).unwrap();
    let views = [view.frustum()];
    let nothing = FitInput::new(&views, direction);
    let input = if stands {
        FitInput { static_boxes: Some(&tree), ..nothing }
    } else {
        FitInput { receivers: Some(list), casters: Some(list), ..nothing }
    };
    let maps = *ShadowFitter::new(&technique).fit(&input).unwrap();
    maps.iter().map(|map| map.projection.depth_range).collect()
}

/// A box of 60 km, and tiles of 200 m up to the end of the view.
#[test]
fn a_ground_in_one_box_has_nearly_the_depths_of_its_tiles() {
    let square =
        |x: f32, z: f32, half: f32| Aabb::new(Vec3::new(x - half, -1.0, z - half), Vec3::new(x + half, 0.0, z + half));
    let tiles: Vec<Aabb> = (0..400_u16)
        .map(|i| square(f32::from(i % 20) * 200.0 - 1900.0, f32::from(i / 20) * 200.0 - 1900.0, 100.0))
        .collect();
    for direction in [Vec3::new(0.6, -0.2, 0.5), Vec3::new(0.3, -0.8, -0.4), Vec3::NEG_Y] {
        for stands in [false, true] {
            let [one, tiled] =
                [&[square(0.0, 0.0, 3e4)][..], &tiles].map(|ground| depths_over(ground, stands, direction));
            for (one, tiled) in one.iter().zip(&tiled) {
                assert!(*one <= 2.0 * tiled, "{one} m, and {tiled} m over tiles, {direction}, in a tree: {stands}");
            }
        }
    }
}

#[test]
fn a_bias_below_the_rounding_of_depths_is_found_with_the_numbers() {
    let view = super::street_view(DVec3::new(0.0, 1.7, 0.0), Vec3::new(0.0, -0.3, -1.0));
    let (views, direction) = ([view.frustum()], Vec3::new(0.3, -0.8, -0.4));
    let ground = [Aabb::new(Vec3::new(-1e4, -1.0, -1e4), Vec3::new(1e4, 0.0, 1e4))];
    let boxes = Some(Boxes { origin: DVec3::ZERO, boxes: &ground });
    let input = FitInput { receivers: boxes, casters: boxes, ..FitInput::new(&views, direction) };
    let technique = windows(4, 1024);
    let maps = *ShadowFitter::new(&technique).fit(&input).unwrap();
    let mut storage = vec![DVec2::ZERO; Scratch::required(1, 1)];
    for map in maps.iter() {
        for (share, is_enough) in [(1.0, true), (0.0, false)] {
            let mut map = *map;
            map.bias.constant_depth *= share;
            let query = CoverageQuery::of_map(&map, &technique, FilterRadius::HARDWARE_2X2);
            let proof = prove(&input, &map.projection, &query, &mut Scratch::new(&mut storage)).unwrap();
            assert_eq!(proof.is_proven(), is_enough, "{proof:?}");
            let is_told =
                matches!(proof, CoverageProof::DepthTooCoarse(found) if found.bias == 0.0 && found.needed > found.step);
            assert_eq!(is_told, !is_enough, "{proof:?}");
        }
    }
}
