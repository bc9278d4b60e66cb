//! Static boxes in a tree give the same maps and casters as the same boxes in lists.

use shadowfit::culling::cull;
use shadowfit::demand::VisibleDemandSpace;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::proof::{CoverageQuery, prove};
use shadowfit::{
    Aabb, Boxes, FitError, FitInput, FitState, FittedMaps, PRESETS, PerspectiveCamera, Scratch, ShadowFitter,
    StaticBoxes, Technique, ViewFrustum, VisibleDemand,
};

use crate::support::DIRECTION;

/// Origin of the tree and the lists, away from the eye.
const ORIGIN: DVec3 = DVec3::new(5000.0, 10.0, -300.0);

/// Returns houses of different heights on a square of ground, 3 m apart.
fn town(side: u16) -> Vec<Aabb> {
    let house = |i: u16| {
        let (x, z) = (f32::from(i % side) * 3.0, f32::from(i / side) * 3.0);
        let corner = Vec3::new(x, 0.0, z) - Vec3::new(1.5, 0.0, 1.5) * f32::from(side);
        Aabb::new(corner, corner + Vec3::new(2.0, 1.0 + f32::from(i * 7 % 11), 1.6))
    };
    (0..side * side).map(house).collect()
}

/// Returns the view at a frame of a turning walk through the town.
fn view(frame: u16) -> ViewFrustum {
    let angle = f32::from(frame) * 0.21;
    let camera = PerspectiveCamera {
        eye: ORIGIN + DVec3::new(f64::from(frame) * 1.3, 3.0, 4.0),
        forward: Vec3::new(angle.sin(), -0.05, -angle.cos()),
        up: Vec3::Y,
        fov_y: 0.9,
        aspect: 1.6,
        near: 0.1,
        far: 90.0,
    };
    camera.frustum().expect("a camera")
}

/// Returns the visible demand of the ground, without a depth buffer.
fn seen(view: &ViewFrustum, technique: &Technique) -> VisibleDemand {
    let space =
        VisibleDemandSpace::new(view, DIRECTION, technique.fit.up, technique.fit.max_distance).expect("a space");
    let mut seen = VisibleDemand::new(space);
    for i in 0..3000_u16 {
        let (across, depth) = (f32::from(i % 60) / 30.0 - 1.0, 2.0 + f32::from(i / 60));
        let place = view.forward * depth + view.forward.cross(Vec3::Y) * (across * depth * 0.7);
        let pixel = depth * 0.001;
        if let Some(cell) = space.demand.index(place.with_y(-3.0), Vec3::Y, Vec3::X * pixel, Vec3::Z * pixel) {
            seen.count_cell(cell);
        }
    }
    seen
}

/// Returns the maps of a walk. `of` adds the boxes to the inputs.
fn walk<'a>(technique: &Technique, tells: bool, of: impl Fn(FitInput<'a>) -> FitInput<'a>) -> Vec<FittedMaps> {
    let mut fitter = ShadowFitter::new(technique);
    (0..12)
        .map(|frame| {
            let views: &[_] = Box::leak(Box::new([view(frame), view(frame + 1)]));
            let count = 1 + usize::from(frame > 8);
            if tells && frame % 3 == 1 {
                fitter.set_visible_demand(seen(&views[0], technique));
            }
            *fitter.fit(&of(FitInput::new(&views[..count], DIRECTION))).expect("maps")
        })
        .collect()
}

/// Asserts that the maps of two walks are equal up to rounding: the order of the boxes may change the
/// rounding of the outline of visible receivers.
fn assert_same(name: &str, one: &[FittedMaps], other: &[FittedMaps]) {
    for (frame, (one, other)) in one.iter().zip(other).enumerate() {
        for (one, other) in one.iter().zip(other.iter()) {
            let clip = [one, other].map(|map| map.projection.clip_from_world.to_cols_array());
            let is_same = clip[0].iter().zip(clip[1]).all(|(a, b)| (a - b).abs() <= 1e-5 * b.abs().max(1e-3));
            assert!(is_same, "{name}, frame {frame}: {one:?} and {other:?}");
        }
    }
}

#[test]
fn every_technique_has_the_same_maps_from_a_tree_as_from_lists() {
    let boxes = town(40);
    let list = Boxes { origin: ORIGIN, boxes: &boxes };
    let tree = StaticBoxes::from_boxes(list).expect("good boxes");
    for preset in PRESETS {
        for tells in [false, true] {
            // Shadows do not end before the picture does, so that all visible boxes count, from lists and
            // tree alike.
            let technique = preset.technique().with_fit(preset.technique().fit.with_max_distance(90.0));
            let of_lists = |input| FitInput { receivers: Some(list), casters: Some(list), ..input };
            let of_tree = |input| FitInput { static_boxes: Some(&tree), ..input };
            let (of_tree, of_lists) = (walk(&technique, tells, of_tree), walk(&technique, tells, of_lists));
            if ["windows-4", "windows-8", "stable-4"].contains(&preset.name) {
                assert_eq!(of_tree, of_lists, "{} {tells}", preset.name);
            }
            assert_same(preset.name, &of_tree, &of_lists);
        }
    }
}

#[test]
fn a_part_in_a_tree_and_a_part_in_lists_are_together_what_both_are_in_one() {
    let boxes = town(30);
    let all = Boxes { origin: ORIGIN, boxes: &boxes };
    let (some, rest) = boxes.split_at(250);
    // Insert one by one, in another order, with boxes that are removed again and boxes that are moved later.
    let mut tree = StaticBoxes::new(ORIGIN);
    for aabb in rest.iter().rev() {
        let gone = tree.insert(Aabb::new(aabb.min - 7.0, aabb.max + 50.0)).expect("a box");
        let number = tree.insert(Aabb::new(aabb.min + 40.0, aabb.max + 40.0)).expect("a box");
        tree.set(number, *aabb).expect("it is in use");
        tree.remove(gone);
    }
    let list = Boxes { origin: ORIGIN, boxes: some };
    for name in ["windows-4", "stable-4", "calm-4", "focused-4", "aabb-1"] {
        let technique = Technique::preset(name).expect("a preset");
        let technique = technique.with_fit(technique.fit.with_max_distance(90.0));
        let of_lists = |input| FitInput { receivers: Some(all), casters: Some(all), ..input };
        let of_both =
            |input| FitInput { receivers: Some(list), casters: Some(list), static_boxes: Some(&tree), ..input };
        assert_same(name, &walk(&technique, true, of_both), &walk(&technique, true, of_lists));
    }
}

#[test]
fn a_tree_culls_as_its_boxes_are_culled() {
    let boxes = town(50);
    let list = Boxes { origin: ORIGIN, boxes: &boxes };
    let tree = StaticBoxes::from_boxes(list).expect("good boxes");
    for name in ["windows-8", "stable-4", "calm-4"] {
        let technique = Technique::preset(name).expect("a preset");
        let mut fitter = ShadowFitter::new(&technique);
        for frame in 0..6 {
            let views = [view(frame * 3)];
            let input = FitInput { static_boxes: Some(&tree), ..FitInput::new(&views, DIRECTION) };
            let maps = *fitter.fit(&input).expect("maps");
            let mut volumes = maps.caster_volumes(&views, &technique).expect("volumes").to_vec();
            volumes[0] = maps[0].projection.caster_volume();
            let (mut of_list, mut of_tree) = (vec![0; boxes.len()], vec![0; boxes.len()]);
            cull(&volumes, ORIGIN, &boxes, &mut of_list);
            tree.cull(&volumes, |number, mask| of_tree[number as usize] = mask);
            assert_eq!(of_tree, of_list, "{name} {frame}");
            assert!(of_tree.contains(&0) && of_tree.iter().any(|mask| mask.count_ones() > 1));
        }
    }
    tree.cull(&[], |number, _| panic!("{number} in no volume"));
}

#[test]
fn what_is_behind_the_view_casts_into_it_from_a_tree_too() {
    // A tower behind the eye, under a sun from behind: its shadow falls into view.
    let mut tree = StaticBoxes::new(DVec3::ZERO);
    tree.insert(Aabb::new(Vec3::new(-50.0, -0.1, -100.0), Vec3::new(50.0, 0.0, 100.0))).expect("ground");
    tree.insert(Aabb::new(Vec3::new(-1.0, 0.0, 30.0), Vec3::new(1.0, 40.0, 32.0))).expect("a tower");
    let camera = PerspectiveCamera {
        eye: DVec3::new(0.0, 2.0, 0.0),
        forward: Vec3::NEG_Z,
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: 1.6,
        near: 0.1,
        far: 80.0,
    };
    let views = [camera.frustum().expect("a camera")];
    let input = FitInput { static_boxes: Some(&tree), ..FitInput::new(&views, Vec3::new(0.0, -0.7, -1.0)) };
    for preset in PRESETS.iter().filter(|preset| preset.name != "xna-1") {
        let maps = *ShadowFitter::new(&preset.technique()).fit(&input).expect("maps");
        let mut storage = vec![DVec2::ZERO; input.scratch()];
        for map in maps.iter() {
            let query =
                CoverageQuery::of_map(map, &preset.technique(), preset.technique().filter_radius_in(&map.projection));
            let proof = prove(&input, &map.projection, &query, &mut Scratch::new(&mut storage)).expect("a proof");
            assert!(proof.is_proven(), "{}: {proof:?}", preset.name);
        }
        let volumes = maps.caster_volumes(&views, &preset.technique()).expect("volumes");
        let mut found = Vec::new();
        tree.cull(&volumes, |number, _| found.push(number));
        assert!(found.contains(&1), "{}: the tower casts", preset.name);
    }
}

#[test]
fn memory_that_an_input_asks_for_is_enough_and_less_is_refused_by_number() {
    let tree = StaticBoxes::from_boxes(Boxes { origin: ORIGIN, boxes: &town(40) }).expect("good boxes");
    let views = [view(0), view(2)];
    let input = FitInput { static_boxes: Some(&tree), ..FitInput::new(&views, DIRECTION) };
    for preset in PRESETS {
        let mut storage = vec![DVec2::ZERO; input.scratch()];
        let maps = FitState::new().fit(&input, &preset.technique(), &mut Scratch::new(&mut storage));
        assert_eq!(
            maps.as_ref(),
            Ok(ShadowFitter::new(&preset.technique()).fit(&input).expect("maps")),
            "{}",
            preset.name
        );
        if preset.name != "xna-1" {
            let small = FitState::new().fit(&input, &preset.technique(), &mut Scratch::new(&mut storage[..20]));
            assert!(
                matches!(small, Err(FitError::ScratchTooSmall { given: 20, required }) if required > 20),
                "{small:?}"
            );
        }
    }
}

#[test]
fn an_empty_tree_is_an_empty_scene() {
    let tree = StaticBoxes::new(DVec3::ZERO);
    let views = [view(0)];
    let input = FitInput { static_boxes: Some(&tree), ..FitInput::new(&views, DIRECTION) };
    let lists = FitInput {
        receivers: Some(Boxes::default()),
        casters: Some(Boxes::default()),
        ..FitInput::new(&views, DIRECTION)
    };
    for preset in PRESETS {
        let [of_tree, of_lists] =
            [input, lists].map(|input| *ShadowFitter::new(&preset.technique()).fit(&input).expect("maps"));
        assert_eq!(of_tree, of_lists, "{}", preset.name);
    }
}
