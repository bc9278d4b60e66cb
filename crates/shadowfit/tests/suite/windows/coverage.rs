//! All visible points are covered: a wrong demand grid only costs sharpness.

use proptest::prelude::*;
use shadowfit::demand::{CELLS, DemandGrid, DemandSpace};
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::{Aabb, Boxes, FitInput, FitState, FittedMaps, Scratch, Technique, ViewFrustum};

use super::{Demand, any_windows, hits, windows};
use crate::scenes::{BoxPlan, SceneView, any_box, any_lens, any_light, any_view, any_walk, share};
use crate::support::{any_direction, cases};

/// The demand grid that a frame gets.
#[derive(Clone, Copy, Debug)]
enum GridPlan {
    None,
    /// The points that are visible now.
    Right,
    /// The points that were visible in the first frame.
    Stale,
    /// All points in one cell.
    OneCell(usize, u32),
    /// The same count in every cell.
    All(u32),
    /// Random counts in one of N cells.
    Random(u64, u32),
    /// Random counts with other sizes of cells and texels (as powers of two) and another origin (in metres).
    Elsewhere(i32, i32, f64),
}

fn any_grid() -> impl Strategy<Value = GridPlan> {
    let many = || prop_oneof![Just(1_u32), Just(1000), Just(u32::MAX)];
    prop_oneof![
        1 => Just(GridPlan::None),
        3 => Just(GridPlan::Right),
        1 => Just(GridPlan::Stale),
        1 => (0..CELLS, many()).prop_map(|(cell, count)| GridPlan::OneCell(cell, count)),
        1 => many().prop_map(GridPlan::All),
        1 => (any::<u64>(), 1..1000_u32).prop_map(|(seed, one_in)| GridPlan::Random(seed, one_in)),
        1 => (-120..120, -120..120, prop_oneof![Just(0.0), Just(1e4), Just(1e12)])
            .prop_map(|(cell, texel, away)| GridPlan::Elsewhere(cell, texel, away)),
    ]
}

/// Returns pseudo-random counts (G. Marsaglia: "Xorshift RNGs", 2003).
fn random_counts(seed: u64, one_in: u32) -> Vec<u32> {
    let mut state = seed | 1;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 32) as u32
    };
    (0..CELLS).map(|_| if next() % one_in == 0 { next() >> (next() % 32) } else { 0 }).collect()
}

impl GridPlan {
    fn demand(self, space: DemandSpace, right: &Demand, stale: &Demand) -> Option<Demand> {
        let counts = match self {
            Self::None => return None,
            Self::Right => return Some(right.clone()),
            Self::Stale => return Some(stale.clone()),
            Self::OneCell(cell, count) => (0..CELLS).map(|i| if i == cell { count } else { 0 }).collect(),
            Self::All(count) => vec![count; CELLS],
            Self::Random(seed, one_in) => random_counts(seed, one_in),
            Self::Elsewhere(..) => random_counts(7, 50),
        };
        let space = match self {
            Self::Elsewhere(cell, texel, away) => DemandSpace {
                cell: space.cell * (cell as f32).exp2(),
                texel: space.texel * (texel as f32).exp2(),
                origin: space.origin + DVec3::new(away, -away, away),
                ..space
            },
            _ => space,
        };
        Some(Demand { space, counts })
    }
}

/// Rounding of positions in a map, in texels: the map's f32 translation is rounded by 2⁻²⁴ of the distance of
/// its middle from the eye, which is up to a few of its extents, of up to 2048 texels.
const ROUNDING: f64 = 1e-3;

/// Asserts that the last window covers a visible point with the filter's footprint, and that the point reads
/// a window.
fn assert_covered(maps: &FittedMaps, technique: &Technique, point: DVec3, view_depth: f64) {
    let last = &maps[maps.len() - 1].projection;
    let needed = f64::from(technique.filter_radius().min(technique.border())) - ROUNDING;
    let free = last.texels_to_edge(point).unwrap_or(f64::MIN);
    assert!(free >= needed, "{point} has {free} of {needed} texels to the border of {last:?}");
    // Beyond the shadow distance no map is read, so clamp view depths that rounding moved there.
    let view_depth = view_depth.min(f64::from(technique.fit.max_distance));
    assert!(maps.read(technique, point, view_depth).is_some(), "{point} reads nothing");
}

/// Returns sampled points of a view and visible points of boxes: world positions and view depths.
fn visible(
    view: &SceneView,
    origin: DVec3,
    boxes: Option<&[Aabb]>,
    last: f64,
    places: &[[f64; 3]],
) -> Vec<(DVec3, f64)> {
    let far = last.min(view.lens.far);
    let in_view = places.iter().map(|[x, y, z]| {
        // Equally many points in each octave of depth.
        view.point(*x, *y, view.lens.near * (far / view.lens.near).powf(*z))
    });
    let forward = view.axes()[2];
    let mut seen = Vec::new();
    for (i, p) in in_view.enumerate() {
        let Some(boxes) = boxes else {
            seen.push(p);
            continue;
        };
        let local = view.eye + p - origin;
        let is_in = |b: &Aabb| local.cmpge(b.min.as_dvec3()).all() && local.cmple(b.max.as_dvec3()).all();
        seen.extend(boxes.iter().any(is_in).then_some(p));
        if let Some(b) = boxes.get(i % boxes.len().max(1)).filter(|b| !b.is_empty()) {
            let (min, max) = (b.min.as_dvec3(), b.max.as_dvec3());
            let p = min + (max - min) * DVec3::from_array(places[i]) + origin - view.eye;
            seen.extend(Some(p).filter(|p| view.sees(*p, far)));
        }
    }
    seen.into_iter().map(|p| (view.eye + p, p.dot(forward))).collect()
}

fn any_places() -> impl Strategy<Value = Vec<[f64; 3]>> {
    prop::collection::vec([share(), share(), share()], 24)
}

/// Boxes of a scene: none known, or some, with or without a wide ground.
fn any_scene() -> impl Strategy<Value = Option<(Vec<BoxPlan>, Option<f32>)>> {
    let ground = prop_oneof![2 => Just(None), 1 => prop::sample::select(vec![1e2_f32, 1e4, 1e6]).prop_map(Some)];
    prop_oneof![1 => Just(None), 5 => (prop::collection::vec(any_box(), 0..14), ground).prop_map(Some)]
}

proptest! {
    #![proptest_config(cases(250))]

    #[test]
    fn every_visible_point_is_held_with_the_filters_reach_whatever_the_grid_says(
        view in any_view(), direction in any_light(), technique in any_windows(), walk in any_walk(),
        scene in any_scene(), places in any_places(), grids in prop::collection::vec(any_grid(), 6),
    ) {
        prop_assume!(view.lens.near < f64::from(technique.fit.max_distance));
        let origin = view.eye.round();
        let boxes = scene.map(|(plans, ground)| {
            let ground = ground.map(|r| Aabb::new(Vec3::new(-r, -12.0, -r), Vec3::new(r, -10.0, r)));
            plans.iter().map(|plan| plan.aabb(&view, origin)).chain(ground).chain([Aabb::EMPTY]).collect::<Vec<_>>()
        });
        let known: &[Aabb] = boxes.as_deref().unwrap_or_default();
        let last = f64::from(technique.fit.max_distance);
        let mut storage = vec![DVec2::ZERO; Scratch::required(known.len(), 1)];
        let (mut fitter, mut view, mut stale) = (FitState::new(), view, None);
        for plan in grids {
            let views = [view.frustum()];
            let space = DemandSpace::new(&views[0], direction, technique.fit.up, technique.fit.max_distance).unwrap();
            let right = Demand::of(&view, &hits(&view, origin, known, last), direction, &technique);
            let demand = plan.demand(space, &right, stale.get_or_insert(right.clone()));
            let demand: Vec<DemandGrid> = demand.iter().map(Demand::grid).collect();
            let receivers = boxes.as_deref().map(|boxes| Boxes { origin, boxes });
            let input = FitInput { receivers, casters: receivers, demand: &demand, ..FitInput::new(&views, direction) };
            let maps = fitter.fit(&input, &technique, &mut Scratch::new(&mut storage)).unwrap();
            prop_assert_eq!(maps.len(), technique.maps.count() as usize);
            for (point, depth) in visible(&view, origin, boxes.as_deref(), last, &places) {
                assert_covered(&maps, &technique, point, depth);
            }
            view = walk.moved(&view);
        }
    }

    #[test]
    fn what_any_of_several_views_sees_is_held(
        views in (any_view(), any_lens(), any_lens(), any_direction(), any_direction()), direction in any_light(),
        technique in any_windows(), walk in any_walk(), plans in prop::collection::vec(any_box(), 1..10),
        places in any_places(), with_grids in any::<bool>(),
    ) {
        let (first, second, third, forward, up) = views;
        prop_assume!(forward.cross(up).length() > 0.1);
        let beside = SceneView { lens: second, eye: first.eye + DVec3::new(0.07, 0.0, 0.03), ..first };
        let away = SceneView { lens: third, eye: first.eye + DVec3::splat(first.lens.far), forward, up };
        let mut all = [first, beside, away];
        prop_assume!(all.iter().all(|view| view.lens.near < f64::from(technique.fit.max_distance)));
        let origin = first.eye.round();
        let boxes: Vec<Aabb> =
            plans.iter().enumerate().map(|(i, plan)| plan.aabb(&all[i % all.len()], origin)).collect();
        let last = f64::from(technique.fit.max_distance);
        let mut storage = vec![DVec2::ZERO; Scratch::required(boxes.len(), all.len())];
        let mut fitter = FitState::new();
        let mut needs: Vec<Demand> = Vec::new();
        for _ in 0..4 {
            let frusta: Vec<ViewFrustum> = all.iter().map(SceneView::frustum).collect();
            let grids: Vec<DemandGrid> = needs.iter().map(Demand::grid).collect();
            let known = Some(Boxes { origin, boxes: &boxes });
            let input = FitInput { receivers: known, casters: known, demand: &grids, ..FitInput::new(&frusta, direction) };
            let maps = fitter.fit(&input, &technique, &mut Scratch::new(&mut storage)).unwrap();
            for view in &all {
                for (point, depth) in visible(view, origin, Some(&boxes), last, &places) {
                    assert_covered(&maps, &technique, point, depth);
                }
            }
            if with_grids {
                let demand = |view: &SceneView| Demand::of(view, &hits(view, origin, &boxes, last), direction, &technique);
                needs = all.iter().map(demand).collect();
            }
            all = all.map(|view| walk.moved(&view));
        }
    }
}

/// Endless ground, with the eye from a hand's breadth to a tower's height above it, under a high, a low and a
/// level sun, and a sun from below.
#[test]
fn ground_without_an_end_is_held_as_far_as_shadows_reach() {
    let boxes = [Aabb::new(Vec3::new(-1e7, -1.0, -1e7), Vec3::new(1e7, 0.0, 1e7))];
    let lights = [(0.0, -1.0), (0.3, -0.8), (1.0, -0.05), (1.0, 0.0), (0.4, 0.6), (0.0, 1.0)];
    for (count, (x, y)) in (1..=8).flat_map(|count| lights.map(|light| (count, light))) {
        let technique = windows(count, 512).with_max_distance(400.0);
        for height in [0.2, 1.7, 80.0] {
            let mut fitter = FitState::new();
            for frame in 0..4_u8 {
                let eye = DVec3::new(f64::from(frame) * 30.0, height, 0.0);
                let view = super::street_view(eye, Vec3::new(1.0, -0.3, f32::from(frame)));
                let (views, ground) = ([view.frustum()], Some(Boxes { origin: DVec3::ZERO, boxes: &boxes }));
                let direction = Vec3::new(x, y, 0.3);
                let input = FitInput { receivers: ground, casters: ground, ..FitInput::new(&views, direction) };
                let mut storage = [DVec2::ZERO; Scratch::required(1, 1)];
                let maps = fitter.fit(&input, &technique, &mut Scratch::new(&mut storage)).unwrap();
                let seen = hits(&view, DVec3::ZERO, &boxes, 400.0);
                assert!(seen.len() > 100);
                for hit in seen {
                    assert_covered(&maps, &technique, view.eye + hit.point, hit.point.dot(view.axes()[2]));
                }
            }
        }
    }
}

/// Without receivers no map is read. When receivers appear, they are covered at once.
#[test]
fn windows_over_nothing_are_empty_and_hold_what_comes() {
    let technique = windows(4, 512);
    let view = super::street_view(DVec3::new(0.0, 1.7, 0.0), Vec3::new(0.2, -0.2, -1.0));
    let (views, mut fitter) = ([view.frustum()], FitState::new());
    let town = super::town();
    let mut storage = vec![DVec2::ZERO; Scratch::required(town.boxes.len(), 1)];
    for boxes in [&[][..], &town.boxes, &[Aabb::EMPTY], &town.boxes[..1], &[]] {
        let known = Some(Boxes { origin: DVec3::ZERO, boxes });
        let input = FitInput { receivers: known, casters: known, ..FitInput::new(&views, Vec3::new(0.3, -0.8, 0.4)) };
        let maps = fitter.fit(&input, &technique, &mut Scratch::new(&mut storage)).unwrap();
        let seen = hits(&view, DVec3::ZERO, boxes, f64::MAX);
        assert!(maps.iter().all(|map| map.projection.is_empty == seen.is_empty()));
        for hit in seen {
            assert_covered(&maps, &technique, view.eye + hit.point, hit.point.dot(view.axes()[2]));
        }
    }
}
