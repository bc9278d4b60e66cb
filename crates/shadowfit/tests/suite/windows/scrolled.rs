//! A window must be redrawn only where `Scroll` requires it. Tested by drawing the depths of boxes in f64.

use shadowfit::glam::{DVec2, DVec3, UVec2, Vec3};
use shadowfit::scroll::{Scroll, TexelRect};
use shadowfit::{Aabb, CasterVolume, FittedMap, Technique};

use super::{Ray, Run, World, street_view, windows};

/// Side of the maps, in texels: small, since each texel is compared with all boxes.
const SIDE: u32 = 40;

/// Returns random boxes on a ground, some of them high up.
fn heap() -> World {
    let mut state = 12_345_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / 16_777_216.0
    };
    let mut boxes = vec![Aabb::new(Vec3::new(-60.0, -1.0, -60.0), Vec3::new(60.0, 0.0, 60.0))];
    for i in 0..60 {
        let low = Vec3::new(next() * 80.0 - 40.0, if i % 5 == 0 { next() * 12.0 } else { 0.0 }, next() * 80.0 - 40.0);
        boxes.push(Aabb::new(low, low + Vec3::new(0.3 + next() * 5.0, 0.3 + next() * 6.0, 0.3 + next() * 5.0)));
    }
    World { origin: DVec3::ZERO, boxes }
}

/// A drawn map: with all casters over it.
struct Drawn {
    map: FittedMap,
    boxes: Vec<(DVec3, DVec3)>,
}

impl Drawn {
    fn new(map: &FittedMap, world: &World, technique: &Technique) -> Self {
        let volume = CasterVolume::of_map(&map.projection, technique.fit.casters);
        let moved = |v: Vec3| v.as_dvec3() + world.origin - volume.origin;
        let drawn = world.boxes.iter().map(|b| (moved(b.min), moved(b.max)));
        let is_drawn = |b: &(DVec3, DVec3)| volume.intersects_aabb(b.0.as_vec3(), b.1.as_vec3());
        Self { map: *map, boxes: drawn.filter(is_drawn).collect() }
    }

    /// Returns the depth at a position in texels right and down: 0..1, and 1 where nothing is drawn.
    fn depth(&self, texel: DVec2) -> f64 {
        let fit = &self.map.projection;
        let rows = fit.light_from_world.transpose();
        let [x, y, z] = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.truncate().as_dvec3());
        let t = fit.light_from_world.w_axis.truncate().as_dvec3();
        let (range, near) = (f64::from(fit.depth_range), f64::from(fit.box_max.z));
        let size = fit.texel_size.as_dvec2();
        let across =
            DVec2::new(f64::from(fit.box_min.x) + texel.x * size.x, f64::from(fit.box_max.y) - texel.y * size.y);
        // The ray begins far before the near plane, where hits would be clipped.
        let start = |z_of: f64| x * (across.x - t.x) + y * (across.y - t.y) + z * (z_of - t.z);
        let begin = near + 1e3;
        let ray = Ray::new(start(begin), -z);
        let depths = self.boxes.iter().filter_map(|b| ray.entry(*b)).map(|(way, _)| (begin - way - near) / -range);
        depths.filter(|depth| (0.0..=1.0).contains(depth)).fold(1.0, f64::min)
    }
}

fn is_in(rect: &TexelRect, x: u32, y: u32) -> bool {
    (rect.min.x..rect.min.x + rect.size.x).contains(&x) && (rect.min.y..rect.min.y + rect.size.y).contains(&y)
}

/// Possible shift of a texel's position, as a share of a texel: twice the rounding of the map's f32
/// translation.
const PLACE: f64 = 0.01;

/// Rounding of depths, as a share of the depth range: by the map's f32 translation along the light.
const DEPTH: f64 = 1e-5;

/// Compares the kept texels of a map with a freshly drawn map. Returns the number of compared texels.
fn compare(old: &Drawn, now: &Drawn, scroll: &Scroll) -> usize {
    let mut compared = 0;
    for (x, y) in (0..SIDE).flat_map(|x| (0..SIDE).map(move |y| (x, y))) {
        if scroll.exposed().any(|rect| is_in(&rect, x, y)) {
            continue;
        }
        let centre = UVec2::new(x, y).as_dvec2() + 0.5;
        let kept = old.depth(centre + scroll.shift.as_dvec2());
        // An edge may lie between the two positions of the texel's centre.
        let around = [(0.0, 0.0), (-PLACE, -PLACE), (PLACE, -PLACE), (-PLACE, PLACE), (PLACE, PLACE)];
        let fresh = around.map(|(dx, dy)| now.depth(centre + DVec2::new(dx, dy)));
        let (low, high) = fresh.iter().fold((f64::MAX, f64::MIN), |(low, high), z| (low.min(*z), high.max(*z)));
        assert!(kept >= low - DEPTH && kept <= high + DEPTH, "{kept} was kept at ({x}, {y}), {low} to {high} is drawn");
        compared += 1;
    }
    compared
}

#[test]
fn what_is_not_exposed_need_not_be_drawn_anew() {
    for (direction, count) in [(Vec3::new(0.3, -0.8, 0.4), 4), (Vec3::new(0.9, -0.3, 0.2), 3), (Vec3::NEG_Y, 2)] {
        let (world, technique) = (heap(), windows(count, SIDE));
        let mut run = Run::new(world.clone(), &technique);
        let (mut before, mut compared, mut shifted): (Option<Vec<Drawn>>, usize, usize) = (None, 0, 0);
        for frame in 0..40_u16 {
            let f = f64::from(frame);
            let eye = DVec3::new(-20.0 + f * 0.6, 3.0, 25.0 - f * 0.4);
            let view = street_view(eye, Vec3::new(0.4 + 0.01 * f32::from(frame), -0.2, -1.0));
            let maps = run.frame(&view, direction);
            let now: Vec<Drawn> = maps.iter().map(|map| Drawn::new(map, &world, &technique)).collect();
            for (old, now) in before.iter().flatten().zip(&now) {
                let scroll = Scroll::between(&old.map, &now.map);
                let (a, b) = (old.map.grid_position.unwrap(), now.map.grid_position.unwrap());
                if a.texel != b.texel {
                    assert!(scroll.is_new);
                    continue;
                }
                // Right and down on the world grid, unless the window moved by more than its size.
                let by = [b.first[0] - a.first[0], a.first[1] - b.first[1]];
                let is_away = by.iter().any(|by| by.unsigned_abs() >= u64::from(SIDE));
                assert_eq!(scroll.is_new, is_away);
                assert_eq!(scroll.depth_changed, is_away || a.depth != b.depth);
                if scroll.is_redraw() {
                    continue;
                }
                assert_eq!([scroll.shift.x, scroll.shift.y].map(i64::from), by);
                compared += compare(old, now, &scroll);
                shifted += usize::from(by != [0, 0]);
            }
            before = Some(now);
        }
        assert!(compared > 20_000 && shifted >= 10, "{compared} texels of {shifted} shifted windows were compared");
    }
}
