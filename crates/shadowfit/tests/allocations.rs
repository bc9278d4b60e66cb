//! Checks with a counting global allocator that code for every frame does not allocate.

use allocation_counter::measure;
use shadowfit::bias::FilterRadius;
use shadowfit::cache::{CacheFrame, CacheSettings, Casters, Culling, MapCache, UpdateSchedule};
use shadowfit::culling::{OrientedBox, Sphere, Sweep, cull};
use shadowfit::demand::{CELLS, DemandGrid, DemandSpace};
use shadowfit::fit_scene;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::proof::{CoverageQuery, prove};
use shadowfit::scroll::{Scroll, tiles};
use shadowfit::settings::{
    CasterPolicy, FitKind, FitSettings, MAX_MAPS, MapSettings, RectangleKind, Shape, SplitScheme, Stabilise,
};
use shadowfit::{
    Aabb, Boxes, Cascades, CasterVolume, FitInput, FitState, PRESETS, PerspectiveCamera, Scratch, ShadowFitter,
    StaticBoxes, Technique, ViewFrustum, fit,
};

const DIRECTION: Vec3 = Vec3::new(0.3, -0.8, 0.4);

const KINDS: [FitKind; 5] =
    [FitKind::XnaSample, FitKind::FrustumAabb, FitKind::Oriented, FitKind::Sphere, FitKind::Focused];

const POLICIES: [CasterPolicy; 5] = [
    CasterPolicy::None,
    CasterPolicy::Extend,
    CasterPolicy::SceneBounds,
    CasterPolicy::PerObject,
    CasterPolicy::DepthClamp,
];

fn camera() -> PerspectiveCamera {
    PerspectiveCamera {
        eye: DVec3::new(0.0, 1.7, 5.0),
        forward: Vec3::new(0.1, -0.1, -1.0),
        up: Vec3::Y,
        fov_y: 0.8,
        aspect: 16.0 / 9.0,
        near: 0.1,
        far: 200.0,
    }
}

fn views() -> [ViewFrustum; 2] {
    let frustum = camera().frustum().expect("a good camera");
    [frustum, ViewFrustum { origin: frustum.origin + DVec3::X * 0.065, ..frustum }]
}

/// Returns boxes on a square of ground.
fn objects() -> Vec<Aabb> {
    let corner = |i: u16| Vec3::new(f32::from(i % 40) * 5.0 - 100.0, 0.0, -f32::from(i / 40) * 5.0);
    (0..1600).map(corner).map(|low| Aabb::new(low, low + Vec3::new(2.0, 5.0, 3.0))).collect()
}

/// Runs a function, asserts that it did not allocate, and returns its result.
fn without_allocation<T>(what: &str, run: impl FnOnce() -> T) -> T {
    let mut result = None;
    let allocations = measure(|| result = Some(run()));
    assert_eq!(allocations.count_total, 0, "{what}: {allocations:?}");
    result.expect("it ran")
}

#[test]
fn the_counter_counts() {
    let mut vector = Vec::new();
    let allocations = measure(|| vector.push(1));
    assert_eq!((allocations.count_total, vector.len()), (1, 1));
}

#[test]
fn no_fit_allocates() {
    let (views, objects) = (views(), objects());
    let boxes = Boxes { origin: DVec3::ZERO, boxes: &objects };
    let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, DIRECTION) };
    let mut storage = vec![DVec2::ZERO; Scratch::required(objects.len(), views.len())];
    for kind in KINDS {
        for rectangle in [RectangleKind::AxisAligned, RectangleKind::MinimumArea, RectangleKind::MinimumSquare] {
            for casters in POLICIES {
                let settings = FitSettings::default().with_kind(kind).with_rectangle(rectangle).with_casters(casters);
                let what = format!("{settings:?}");
                without_allocation(&what, || fit(&views[0], DIRECTION, &settings)).expect("a good frustum");
                let mut scratch = Scratch::new(&mut storage);
                without_allocation(&what, || fit_scene(&input, &settings, &mut scratch)).expect("a good scene");
            }
        }
    }
}

#[test]
fn no_fit_of_several_maps_allocates() {
    let (views, objects) = (views(), objects());
    let boxes = Boxes { origin: DVec3::ZERO, boxes: &objects };
    let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, DIRECTION) };
    let mut storage = vec![DVec2::ZERO; Scratch::required(objects.len(), views.len())];
    for kind in KINDS {
        for stabilise in [Stabilise::Off, Stabilise::Snap { max_oversize: 1.8 }, Stabilise::default()] {
            for splits in [SplitScheme::Logarithmic, SplitScheme::Practical(0.5), SplitScheme::FromBoxes] {
                let cascades = Cascades { count: 4, shape: Shape::new(kind), stabilise, splits, ..Cascades::default() };
                let fit = MapSettings::default().with_casters(CasterPolicy::PerObject);
                let settings = Technique::default().with_maps(cascades).with_fit(fit);
                let (what, mut fitter) = (format!("{settings:?}"), FitState::new());
                for _ in 0..2 {
                    let mut scratch = Scratch::new(&mut storage);
                    let maps = without_allocation(&what, || fitter.fit(&input, &settings, &mut scratch));
                    assert_eq!(maps.expect("a good scene").len(), 4);
                }
            }
        }
    }
}

/// With and without a demand grid, in the first frames, whose search takes the most effort, and in later
/// ones.
#[test]
fn no_fit_of_windows_allocates() {
    let (views, objects) = (views(), objects());
    let boxes = Boxes { origin: DVec3::ZERO, boxes: &objects };
    let mut counts = vec![0; CELLS];
    let space = DemandSpace::new(&views[0], DIRECTION, Vec3::Y, f32::MAX).expect("a good view");
    for i in 0..4000_u16 {
        let (x, z) = (f32::from(i % 80) * 0.5 - 20.0, -f32::from(i / 80) * 2.0);
        let pixel = 0.001 * (1.0 - z);
        let place = Vec3::new(x, -1.7, z);
        let cell = without_allocation("a cell", || space.index(place, Vec3::Y, Vec3::X * pixel, Vec3::Z * pixel));
        counts[cell.expect("it is lit")] += 1;
    }
    let grids = [DemandGrid { space, counts: &counts }];
    let known = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, DIRECTION) };
    let mut storage = vec![DVec2::ZERO; Scratch::required(objects.len(), views.len())];
    for (name, grids) in [("windows-4", &[][..]), ("windows-4", &grids), ("windows-8", &grids)] {
        let (technique, mut fitter) = (Technique::preset(name).expect("a preset"), FitState::new());
        for demand in [&[][..], grids, grids, grids, &[], grids] {
            let (input, mut scratch) = (FitInput { demand, ..known }, Scratch::new(&mut storage));
            let maps = without_allocation(name, || fitter.fit(&input, &technique, &mut scratch));
            assert_eq!(maps.expect("a good scene").len(), technique.maps.count() as usize);
        }
    }
}

/// Boxes in a tree, some of them moving, after the buffers have grown to the need of a view.
#[test]
fn no_fit_and_no_culling_of_a_tree_allocates_in_steady_frames() {
    let (views, objects) = (views(), objects());
    let mut tree = StaticBoxes::from_boxes(Boxes::world(&objects)).expect("good boxes");
    for preset in PRESETS {
        let mut fitter = ShadowFitter::new(&preset.technique());
        for frame in 0..6_u16 {
            let fallen = u32::from(frame) * 31;
            let aabb = tree.get(fallen).expect("it is in use");
            tree.set(fallen, Aabb::new(aabb.min + 0.1, aabb.max + 0.1)).expect("it is in use");
            let fit = |fitter: &mut ShadowFitter| {
                let input = FitInput { static_boxes: Some(&tree), ..FitInput::new(&views, DIRECTION) };
                let maps = *fitter.fit(&input).expect("maps");
                let volumes = maps.caster_volumes(&views, &preset.technique()).expect("volumes");
                let mut found = 0;
                tree.cull(&volumes, |_, _| found += 1);
                assert!(found > 0);
            };
            if frame < 2 {
                fit(&mut fitter);
            } else {
                without_allocation(preset.name, || fit(&mut fitter));
            }
        }
    }
}

/// A walk past static casters in a list and in a tree, and a few moving ones, after the buffers have grown in
/// the first frames.
#[test]
fn no_plan_of_cached_maps_allocates_in_steady_frames() {
    let (technique, listed) = (Technique::default(), objects());
    let tree = StaticBoxes::from_boxes(Boxes::world(&listed[..800])).expect("good boxes");
    let mut boxes = listed[800..].to_vec();
    let moves: Vec<bool> = (0..boxes.len()).map(|number| number % 50 == 0).collect();
    for (culling, schedule) in [
        (Culling::Swept, UpdateSchedule::EveryFrame),
        (Culling::WholeMap, UpdateSchedule::Texels(100_000)),
        (Culling::Swept, UpdateSchedule::Every([1, 2, 3, 4, 1, 1, 1, 1])),
    ] {
        let mut cache = MapCache::new(CacheSettings { culling, schedule, ..CacheSettings::of(&technique) });
        let (mut fitter, mut eye, mut drawn) = (ShadowFitter::new(&technique), camera(), 0);
        for frame in 0..120 {
            eye.eye += DVec3::new(0.02, 0.0, -0.03);
            let up = if frame % 2 == 0 { 0.1 } else { -0.1 };
            boxes.iter_mut().zip(&moves).filter(|(_, moves)| **moves).for_each(|(aabb, _)| aabb.max.y += up);
            let (views, casters) = ([eye.frustum().expect("a good camera")], Boxes::world(&boxes));
            let input =
                FitInput { casters: Some(casters), static_boxes: Some(&tree), ..FitInput::new(&views, DIRECTION) };
            let maps = *fitter.fit(&input).expect("maps");
            let casters = Casters { boxes: casters, moves: &moves, keys: &[] };
            let frame_of =
                CacheFrame { static_boxes: Some(&tree), ..CacheFrame::new(&maps, casters, &views, DIRECTION) };
            if frame < 60 {
                cache.update(&frame_of).expect("a plan");
            } else {
                drawn += without_allocation("a plan", || cache.update(&frame_of)).expect("a plan").passes.len();
            }
        }
        assert!(drawn > 20, "{drawn} passes");
    }
}

#[test]
fn no_proof_and_no_scrolling_allocates() {
    let (views, objects) = (views(), objects());
    let boxes = Boxes { origin: DVec3::ZERO, boxes: &objects };
    let input = FitInput { receivers: Some(boxes), casters: Some(boxes), ..FitInput::new(&views, DIRECTION) };
    let mut storage = vec![DVec2::ZERO; Scratch::required(objects.len(), views.len())];
    let mut scratch = Scratch::new(&mut storage);
    let cascades = Cascades { shape: Shape::new(FitKind::Sphere), ..Cascades::default() };
    let fit = MapSettings::default().with_casters(CasterPolicy::PerObject);
    let settings = Technique::default().with_maps(cascades).with_fit(fit);
    let mut fitter = FitState::new();
    let before = fitter.fit(&input, &settings, &mut scratch).expect("a good scene");
    let now = fitter.fit(&input, &settings, &mut scratch).expect("a good scene");
    for (before, map) in before.iter().zip(now.iter()) {
        let query = CoverageQuery::of_map(map, &settings, FilterRadius::POINT);
        let verified = without_allocation("verify", || prove(&input, &map.projection, &query, &mut scratch));
        assert!(verified.expect("a good map").is_proven());
        let scroll = without_allocation("scroll", || Scroll::between(before, map));
        assert!(!scroll.is_redraw());
        let count = without_allocation("tiles", || tiles(map, 256).expect("a map on the grid").count());
        assert!(count >= 64);
    }
}

#[test]
fn no_culling_allocates() {
    let (views, boxes) = (views(), objects());
    let mut storage = [DVec2::ZERO; Scratch::required(0, 2)];
    let settings = Technique::preset("calm-4").expect("a preset");
    let input = FitInput::new(&views, DIRECTION);
    let maps = FitState::new().fit(&input, &settings, &mut Scratch::new(&mut storage)).expect("good views");
    let mut volumes = [CasterVolume::everywhere(DVec3::ZERO); MAX_MAPS];
    for count in [1, 2] {
        for (volume, map) in volumes.iter_mut().zip(maps.iter()) {
            let range = map.depths.expect("a range");
            let [near, far] = [range.covered_from.expect("a cascade"), range.far.unwrap_or(100.0)].map(|x| x as f32);
            let sweep = Sweep { near, far, ..Sweep::new(&views[..count]) };
            *volume =
                without_allocation("sweep", || CasterVolume::swept(&map.projection, &sweep)).expect("a good sweep");
        }
    }
    let volumes = &volumes[..maps.len()];
    let spheres: Vec<_> = boxes.iter().map(|b| Sphere { centre: (b.min + b.max) * 0.5, radius: 3.0 }).collect();
    let half_axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let oriented: Vec<_> = spheres.iter().map(|s| OrientedBox { centre: s.centre, half_axes }).collect();
    let mut masks = vec![0; boxes.len()];
    without_allocation("boxes", || cull(volumes, DVec3::ZERO, &boxes, &mut masks));
    assert!(masks.contains(&0) && masks.iter().any(|mask| *mask != 0));
    without_allocation("spheres", || cull(volumes, DVec3::ZERO, &spheres, &mut masks));
    without_allocation("oriented boxes", || cull(volumes, DVec3::ZERO, &oriented, &mut masks));
}
