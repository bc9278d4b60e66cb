//! Bad numbers give a plan or an error, never a panic.

use shadowfit::cache::{CacheFrame, CacheSettings, Casters, InView, MapCache, UpdateSchedule};
use shadowfit::culling::Reader;
use shadowfit::glam::{DVec3, UVec2, Vec3, Vec4};
use shadowfit::{Aabb, Boxes, CasterVolume, FittedMap, StaticBoxes};

use super::fixtures::fitted;

const LIGHT: Vec3 = Vec3::new(0.45, -0.8, 0.3);

const BAD: [f64; 6] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, -1e30, 1e-310];

/// Updates a cache with a good frame, a frame with one bad number, and the good frame again.
fn update(schedule: UpdateSchedule, bad: f64, number: usize) {
    let objects =
        [Aabb::new(Vec3::new(-90.0, -1.0, -90.0), Vec3::new(90.0, 2.0, 90.0)), Aabb::new(Vec3::ZERO, Vec3::ONE)];
    let good_maps = fitted(LIGHT, 60.0, &objects);
    let tree = StaticBoxes::from_boxes(Boxes::world(&objects[..1])).expect("good boxes");
    let mut cache = MapCache::new(CacheSettings { schedule, ..CacheSettings::default() });
    let good_volumes = [CasterVolume::everywhere(DVec3::ZERO); 8];
    for is_bad in [false, true, false] {
        let (mut boxes, mut origin, mut direction, mut moves) = (objects, DVec3::ZERO, LIGHT, [false, true]);
        let mut maps: Vec<FittedMap> = good_maps.to_vec();
        let mut reader = Reader::from_eye(DVec3::ZERO, Vec3::NEG_Z);
        let mut volumes = good_volumes;
        match number {
            _ if !is_bad => {}
            0 => boxes[1].max.y = bad as f32,
            1 => boxes[0].min = Vec3::splat(bad as f32),
            2 => origin.x = bad,
            3 => direction.y = bad as f32,
            4 => reader.origin.z = bad,
            5 => (reader.eye.x, reader.forward.x) = (bad, bad as f32),
            6 => maps[1].projection.origin.x = bad,
            7 => maps[1].projection.texel_size.x = bad as f32,
            8 => maps[1].projection.box_max.y = bad as f32,
            9 => maps[1].projection.uv_from_world.x_axis = Vec4::splat(bad as f32),
            10 => maps
                .iter_mut()
                .filter_map(|map| map.grid_position.as_mut())
                .for_each(|grid_position| grid_position.depth = [bad; 2]),
            11 => maps
                .iter_mut()
                .filter_map(|map| map.grid_position.as_mut())
                .for_each(|grid_position| grid_position.texel.x = bad),
            12 => maps[0].projection.resolution = UVec2::new(0, bad as u32),
            13 => (volumes[0].planes[0], volumes[0].count) = (Vec4::splat(bad as f32), u32::MAX),
            _ => (maps[1], moves) = (FittedMap::default(), [true; 2]),
        }
        if is_bad {
            cache.invalidate(&Aabb::new(Vec3::ZERO, Vec3::splat(bad as f32)), DVec3::splat(bad));
        }
        let casters = Casters { moves: &moves, ..Casters::fixed(Boxes { origin, boxes: &boxes }) };
        let in_view = InView::Volumes(&volumes);
        let frame = CacheFrame { maps: &maps, casters, static_boxes: Some(&tree), direction, reader, in_view };
        let plan = cache.update(&frame).expect("volumes are given");
        assert_eq!(plan.maps.len(), maps.len());
        for region in &plan.regions {
            let end = region.part.stored.min.saturating_add(region.part.stored.size);
            assert!(maps.iter().any(|map| end.cmple(map.projection.resolution).all()), "{region:?}");
        }
        let _ = (cache.updates(), cache.maps_by_caster(&casters));
    }
}

#[test]
fn numbers_that_make_no_sense_give_a_plan() {
    for schedule in [UpdateSchedule::EveryFrame, UpdateSchedule::Texels(1)] {
        for bad in BAD {
            (0..15).for_each(|number| update(schedule, bad, number));
        }
    }
}

#[test]
fn without_a_view_there_is_an_error_and_nothing_to_draw() {
    let objects = [Aabb::new(Vec3::new(-90.0, -1.0, -90.0), Vec3::new(90.0, 2.0, 90.0))];
    let (maps, mut cache) = (fitted(LIGHT, 60.0, &objects), MapCache::default());
    let moving = Casters { moves: &[true], ..Casters::fixed(Boxes::world(&objects)) };
    assert!(cache.update(&CacheFrame::new(&maps, moving, &[], LIGHT)).is_err());
    assert!(cache.plan().passes.is_empty() && cache.plan().maps.is_empty());
    // Static casters do not depend on the view.
    let casters = Casters::fixed(Boxes::world(&objects));
    let plan = cache.update(&CacheFrame::new(&maps, casters, &[], LIGHT)).expect("a plan");
    assert_eq!((plan.passes.len(), plan.maps.len()), (maps.len(), maps.len()));
}
