//! The cost of changed casters: redrawn texels and casters of a plan, in a town of 10,000 boxes.

use shadowfit::cache::{CacheFrame, CacheSettings, Casters, InView, MapCache, PassKind, UpdateSchedule};
use shadowfit::culling::Reader;
use shadowfit::glam::{DVec3, UVec2, Vec3};
use shadowfit::scroll::TexelRect;
use shadowfit::settings::MAX_MAPS;
use shadowfit::{Aabb, Boxes, FittedMap, FittedMaps, StaticBoxes};

use super::fixtures::{SIDE, fitted};

const LIGHT: Vec3 = Vec3::new(0.45, -0.8, 0.3);

/// Boxes along each side of the town, 3 m apart.
const ROW: usize = 100;

/// Number of texels of a map.
const WHOLE: u64 = SIDE as u64 * SIDE as u64;

fn town() -> Vec<Aabb> {
    let block = |i: usize| {
        let corner = Vec3::new((i % ROW) as f32 - 50.0, 0.0, (i / ROW) as f32 - 80.0) * 3.0;
        Aabb::new(corner, corner + Vec3::new(1.5, 1.0 + (i % 7) as f32, 1.5))
    };
    (0..ROW * ROW).map(block).collect()
}

/// A cache whose maps have drawn the town.
struct Drawn {
    cache: MapCache,
    maps: FittedMaps,
}

/// The work of a frame for a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Redrawn {
    texels: u64,
    casters: usize,
    rects: usize,
    /// Texels that are restored from the static casters' layer.
    mended: u64,
}

impl Drawn {
    fn new(boxes: &[Aabb], keys: &[u64]) -> Self {
        let maps = fitted(LIGHT, 150.0, boxes);
        let settings = CacheSettings { layer: UVec2::splat(SIDE), ..CacheSettings::default() };
        let mut drawn = Self { cache: MapCache::new(settings), maps };
        drawn.draw(boxes, &[], keys);
        drawn
    }

    fn draw(&mut self, boxes: &[Aabb], moves: &[bool], keys: &[u64]) -> Vec<Redrawn> {
        self.frame(&Casters { moves, keys, ..Casters::fixed(Boxes::world(boxes)) }, None)
    }

    fn frame(&mut self, casters: &Casters<'_>, static_boxes: Option<&StaticBoxes>) -> Vec<Redrawn> {
        let frame = CacheFrame {
            maps: &self.maps,
            casters: *casters,
            static_boxes,
            direction: LIGHT,
            reader: Reader::from_eye(DVec3::ZERO, Vec3::NEG_Z),
            in_view: InView::Volumes(&[]),
        };
        let plan = self.cache.update(&frame).expect("a plan");
        let mut redrawn = vec![Redrawn::default(); self.maps.len()];
        for pass in &plan.passes {
            let map = &mut redrawn[pass.map];
            map.mended += plan.rects[pass.mended.clone()].iter().map(TexelRect::area).sum::<u64>();
            for region in plan.regions_of(pass).iter().filter(|_| pass.content != PassKind::Moving) {
                map.texels += region.part.stored.area();
                map.casters += region.casters.len() + region.static_boxes.len();
                map.rects += 1;
            }
        }
        redrawn
    }
}

fn nothing(redrawn: &[Redrawn]) -> bool {
    redrawn.iter().all(|map| *map == Redrawn::default())
}

/// Returns the boxes of the town, with the selected ones raised.
fn raised(boxes: &[Aabb], is_raised: impl Fn(usize) -> bool) -> Vec<Aabb> {
    let raise = |(number, aabb): (usize, &Aabb)| {
        let by = if is_raised(number) { 0.5 } else { 0.0 };
        Aabb::new(aabb.min, aabb.max + Vec3::Y * by)
    };
    boxes.iter().enumerate().map(raise).collect()
}

fn chosen(boxes: &[Aabb], is_chosen: impl Fn(usize) -> bool) -> Vec<Aabb> {
    boxes.iter().enumerate().filter(|(number, _)| is_chosen(*number)).map(|(_, aabb)| *aabb).collect()
}

/// Returns the number of texels of the least rectangle around some boxes, for each map.
fn around(maps: &[FittedMap], boxes: &[Aabb]) -> Vec<u64> {
    let rect = |map: &FittedMap| {
        let rects = boxes.iter().map(|aabb| TexelRect::of_box(&map.projection, aabb, DVec3::ZERO));
        rects.filter(|rect| !rect.is_empty()).reduce(TexelRect::union).unwrap_or_default().area()
    };
    maps.iter().map(rect).collect()
}

/// A change of a list.
type Change<'a, T, R = ()> = &'a dyn Fn(&mut Vec<T>) -> R;

#[test]
fn any_permutation_redraws_nothing() {
    let boxes = town();
    let keys: Vec<u64> = (0..boxes.len() as u64).map(|key| key * 7919 % 4001).collect();
    for keys in [&keys[..], &[]] {
        let mut drawn = Drawn::new(&boxes, keys);
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        let orders: [Change<usize>; 4] = [
            &|order| order.reverse(),
            &|order| order.rotate_left(4321),
            &|order| order.sort_by(|a, b| boxes[*a].min.x.total_cmp(&boxes[*b].min.x)),
            &|order| order.sort_by_key(|number| number * 7919 % 10_007),
        ];
        for change in orders {
            change(&mut order);
            let turned: Vec<Aabb> = order.iter().map(|number| boxes[*number]).collect();
            let keys: Vec<u64> = order.iter().filter_map(|number| keys.get(*number).copied()).collect();
            assert!(nothing(&drawn.draw(&turned, &[], &keys)));
        }
    }
}

#[test]
fn what_is_put_in_or_taken_out_anywhere_redraws_its_own_place() {
    let boxes = town();
    let near = 70 * ROW + 50;
    let changes: [Change<Aabb, Aabb>; 3] = [
        &|list| list.remove(near),
        &|list| {
            let came = Aabb::new(Vec3::new(1.0, 0.0, -37.0), Vec3::new(2.0, 1.0, -36.0));
            list.insert(0, came);
            came
        },
        &|list| list.swap_remove(near),
    ];
    for change in changes {
        let mut drawn = Drawn::new(&boxes, &[]);
        let mut list = boxes.clone();
        let changed = change(&mut list);
        let touched = around(&drawn.maps, &[changed]);
        let redrawn = drawn.draw(&list, &[], &[]);
        for (map, touched) in redrawn.iter().zip(touched) {
            assert_eq!(map.rects, usize::from(touched > 0), "{redrawn:?}");
            assert!(map.texels <= touched + touched / 2 + 1000, "{redrawn:?}");
        }
        assert!(redrawn.iter().map(|map| map.casters).sum::<usize>() < 400, "{redrawn:?}");
    }
}

#[test]
fn a_thousand_of_ten_thousand_boxes_in_one_corner_redraw_that_corner() {
    let boxes = town();
    let is_corner = |number: usize| number % ROW < 32 && number / ROW >= 60 && number / ROW < 92;
    let mut drawn = Drawn::new(&boxes, &[]);
    let changed = raised(&boxes, is_corner);
    let redrawn = drawn.draw(&changed, &[], &[]);
    let corner = around(&drawn.maps, &chosen(&changed, is_corner));
    assert!(corner.iter().any(|texels| *texels > 0 && *texels < WHOLE / 2), "{corner:?}");
    for (map, corner) in redrawn.iter().zip(corner) {
        assert!(map.texels <= corner + corner / 10, "{redrawn:?}");
        assert!(map.casters < 4000, "{redrawn:?}");
    }
}

#[test]
fn scattered_changes_are_drawn_each_for_itself_however_many_they_are() {
    let boxes = town();
    for count in [8, 32, 33, 60] {
        let mut drawn = Drawn::new(&boxes, &[]);
        // Low-discrepancy numbers.
        let chosen: Vec<usize> =
            (0..count).map(|i| 1000 * 6 + ((f64::from(i) * 0.754_877_67).fract() * 3900.0) as usize).collect();
        let redrawn = drawn.draw(&raised(&boxes, |number| chosen.contains(&number)), &[], &[]);
        let texels: u64 = redrawn.iter().map(|map| map.texels).sum();
        assert!(texels < WHOLE / 2, "{count}: {redrawn:?}");
        assert!(redrawn.iter().all(|map| map.rects <= 2 * count as usize), "{count}: {redrawn:?}");
    }
}

#[test]
fn maps_that_no_change_touches_redraw_nothing() {
    let boxes = town();
    let mut drawn = Drawn::new(&boxes, &[]);
    // Half of all boxes, behind the eye: outside the finest maps.
    let is_behind = |number: usize| number / ROW >= 92 || number / ROW < 30;
    let redrawn = drawn.draw(&raised(&boxes, is_behind), &[], &[]);
    let touched = around(&drawn.maps, &chosen(&boxes, is_behind));
    assert!(touched.contains(&0) && touched.iter().any(|texels| *texels > 0), "{touched:?}");
    for (map, touched) in redrawn.iter().zip(touched) {
        assert_eq!(map.texels > 0, touched > 0);
    }
}

#[test]
fn a_frame_in_which_all_changes_draws_each_map_once() {
    let boxes = town();
    let mut moves = vec![false; boxes.len()];
    let mut drawn = Drawn::new(&boxes, &[]);
    for moving in [false, true] {
        moves[78 * ROW + 50] = moving;
        (0..3).for_each(|_| drop(drawn.draw(&boxes, &moves, &[])));
        let redrawn = drawn.draw(&raised(&boxes, |_| true), &moves, &[]);
        assert!(redrawn.iter().all(|map| map.texels == WHOLE && map.mended == 0), "{redrawn:?}");
        // The static casters' layers are drawn next. After that, nothing is drawn.
        let layers = drawn.draw(&raised(&boxes, |_| true), &moves, &[]);
        assert!(layers.iter().all(|map| map.texels <= WHOLE && map.mended == 0), "{layers:?}");
        assert!(nothing(&drawn.draw(&raised(&boxes, |_| true), &moves, &[])));
        (0..3).for_each(|_| drop(drawn.draw(&boxes, &moves, &[])));
    }
}

#[test]
fn what_is_removed_in_view_is_never_late() {
    let boxes = town();
    for schedule in [UpdateSchedule::Texels(1), UpdateSchedule::Every([100; MAX_MAPS])] {
        let mut drawn = Drawn::new(&boxes, &[]);
        drawn.cache.settings.schedule = schedule;
        let near = 78 * ROW + 50;
        // New casters may appear late. Casters that are removed or move away must disappear at once.
        let mut list = boxes.clone();
        list.push(Aabb::new(Vec3::new(1.0, 0.0, -7.0), Vec3::new(2.0, 9.0, -6.0)));
        let came = drawn.draw(&list, &[], &[]);
        list.remove(near);
        let went = drawn.draw(&list, &[], &[]);
        let touched = around(&drawn.maps, &[boxes[near]]);
        for map in 0..drawn.maps.len() {
            assert_eq!(went[map].texels > 0, touched[map] > 0, "{schedule:?}: {went:?}");
        }
        assert!(came.iter().filter(|map| map.texels > 0).count() <= 1, "{schedule:?}: {came:?}");
    }
}

#[test]
fn standing_casters_are_drawn_where_their_tree_changes() {
    let boxes = town();
    let mut tree = StaticBoxes::from_boxes(Boxes::world(&boxes)).expect("good boxes");
    let mut drawn = Drawn::new(&boxes, &[]);
    let none = Casters::default();
    let first = drawn.frame(&none, Some(&tree));
    assert!(first.iter().all(|map| map.texels == WHOLE && map.casters > 0), "{first:?}");
    assert!(nothing(&drawn.frame(&none, Some(&tree))));
    let near = 78 * ROW as u32 + 50;
    tree.remove(near);
    let removed = drawn.frame(&none, Some(&tree));
    let touched = around(&drawn.maps, &[boxes[near as usize]]);
    for (map, touched) in removed.iter().zip(touched) {
        assert!(map.rects == usize::from(touched > 0) && map.texels <= 2 * touched, "{removed:?}");
    }
    // Both ways of passing the same casters draw the same number of them.
    let listed = Drawn::new(&boxes, &[]).draw(&raised(&boxes, |_| true), &[], &[]);
    tree.insert(boxes[near as usize]).expect("a box");
    let other = StaticBoxes::from_boxes(Boxes::world(&raised(&boxes, |_| true))).expect("good boxes");
    let static_boxes = drawn.frame(&none, Some(&other));
    assert_eq!(static_boxes, listed);
    assert!(nothing(&drawn.frame(&none, Some(&other))));
    assert!(drawn.frame(&none, None).iter().all(|map| map.texels == WHOLE && map.casters == 0));
}
