//! From a small room onto a plain and back: window sizes follow a change of scene.

use shadowfit::Aabb;
use shadowfit::glam::{DVec3, Vec3};

use super::{Run, World, quantile, street_view, windows};

/// Returns a room of 5 by 4 m with a door and furniture, on a plain with boxes up to 250 m away.
pub(super) fn room_on_a_plain() -> World {
    let b = |min: [f32; 3], max: [f32; 3]| Aabb::new(Vec3::from_array(min), Vec3::from_array(max));
    let mut boxes = vec![
        b([-300.0, -1.0, -300.0], [300.0, 0.0, 300.0]),
        // Three walls, and a fourth in front with a door of 1 m. There is no roof, so that the sun shines in.
        b([-2.6, 0.0, -2.1], [2.6, 2.4, -2.0]),
        b([-2.6, 0.0, -2.0], [-2.5, 2.4, 2.0]),
        b([2.5, 0.0, -2.0], [2.6, 2.4, 2.0]),
        b([-2.6, 0.0, 2.0], [-0.5, 2.4, 2.1]),
        b([0.5, 0.0, 2.0], [2.6, 2.4, 2.1]),
        // A table on four legs, two chairs, a shelf, and small objects on the table.
        b([-1.6, 0.70, -1.4], [-0.2, 0.75, -0.6]),
        b([-1.55, 0.0, -1.35], [-1.5, 0.7, -1.3]),
        b([-0.3, 0.0, -1.35], [-0.25, 0.7, -1.3]),
        b([-1.55, 0.0, -0.7], [-1.5, 0.7, -0.65]),
        b([-0.3, 0.0, -0.7], [-0.25, 0.7, -0.65]),
        b([-1.1, 0.0, -0.4], [-0.7, 0.45, 0.0]),
        b([0.1, 0.0, -1.2], [0.5, 0.45, -0.8]),
        b([1.9, 0.0, -1.9], [2.4, 1.9, -0.9]),
        b([-1.2, 0.75, -1.1], [-1.1, 0.87, -1.0]),
        b([-0.8, 0.75, -1.2], [-0.5, 0.78, -1.0]),
    ];
    for i in 0..40_u8 {
        let (a, r) = (f32::from(i) * 2.4, 12.0 + f32::from(i) * 6.0);
        let (x, z, s) = (r * a.cos(), r * a.sin(), 1.0 + f32::from(i % 5));
        boxes.push(Aabb::new(Vec3::new(x - s, 0.0, z - s), Vec3::new(x + s, 1.5 * s, z + s)));
    }
    World { origin: DVec3::ZERO, boxes }
}

/// Frames at each station. After them, the maps must be as sharp as a new fitter's.
const STAY: usize = 90;

/// Frames for a new fitter, until its search has ended.
const ANEW: usize = 90;

/// Greatest ratio of the 95% quantile of pixels per texel to that of a new fitter. The current plan may cost
/// 1.1 to 1.35 times the best one before it is replaced. That cost is a mean, so the quantile may differ by
/// more.
const LIMIT: f64 = 1.45;

/// Greatest geometric mean of this ratio over all stations.
const MEAN_LIMIT: f64 = 1.1;

#[test]
fn windows_follow_out_of_a_small_room_onto_a_plain_and_back() {
    let table = street_view(DVec3::new(0.8, 1.6, 1.0), Vec3::new(-0.9, -0.5, -1.0));
    let corner = street_view(DVec3::new(-1.8, 1.2, 1.2), Vec3::new(1.0, -0.3, -0.9));
    let plain = street_view(DVec3::new(0.0, 1.7, 12.0), Vec3::new(0.3, -0.05, 1.0));
    let tower = street_view(DVec3::new(0.0, 25.0, 30.0), Vec3::new(-0.5, -0.2, 1.0));
    let stations =
        [("table", table), ("corner", corner), ("plain", plain), ("height", tower), ("plain", plain), ("table", table)];
    let (mut failures, mut logs) = (Vec::new(), Vec::new());
    for (light, count) in
        [(Vec3::new(0.5, -0.8, 0.3), 4), (Vec3::new(0.8, -0.4, 0.3), 4), (Vec3::new(0.5, -0.8, 0.3), 8)]
    {
        let mut run = Run::new(room_on_a_plain(), &windows(count, 2048));
        for _ in 0..60 {
            run.frame(&table, light);
        }
        let mut from = table;
        for (name, to) in stations {
            // On foot: one second of walking.
            for i in 1..=60_u8 {
                let share = f64::from(i) / 60.0;
                let forward = from.forward.as_dvec3().lerp(to.forward.as_dvec3(), share) + DVec3::X * 1e-3;
                run.frame(&street_view(from.eye.lerp(to.eye, share), forward.as_vec3()), light);
            }
            let mut anew = Run::new(room_on_a_plain(), &run.technique);
            let fresh = (0..ANEW).map(|_| anew.frame(&to, light)).last().unwrap();
            let fresh = quantile(&fresh, &run.technique, &run.world, &to, light).unwrap();
            let arrived = run.frame(&to, light);
            let first = quantile(&arrived, &run.technique, &run.world, &to, light).unwrap() / fresh;
            let settled = (1..STAY).map(|_| run.frame(&to, light)).last().unwrap();
            let last = quantile(&settled, &run.technique, &run.world, &to, light).unwrap() / fresh;
            let line =
                format!("{count} windows, {name}: {first:.2} on arrival, {last:.2} after {STAY} frames, of {fresh:.2}");
            println!("{line}");
            failures.extend((last > LIMIT).then_some(line));
            logs.push(last.ln());
            from = to;
        }
    }
    let mean = (logs.iter().sum::<f64>() / logs.len() as f64).exp();
    println!("{mean:.3} on average");
    failures.extend((mean > MEAN_LIMIT).then(|| format!("{mean:.2} on average")));
    assert!(failures.is_empty(), "far less sharp than what begins anew: {failures:#?}");
}
