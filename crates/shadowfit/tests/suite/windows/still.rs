//! Still windows: texels are fixed to the world, shape and axes depend only on the light, and sizes are on a
//! fixed scale.

use proptest::prelude::*;
use shadowfit::glam::{DVec2, DVec3, Vec3};
use shadowfit::{FittedMap, FittedMaps, Technique};

use super::{Run, World, any_seen, any_windows, street_view, town, windows};
use crate::scenes::{any_box, any_light, any_view, any_walk, share};
use crate::support::cases;
use crate::texel_phase::{apart, grid_position, shader_position};

/// Returns the exact size of a window's texels.
fn texel(map: &FittedMap) -> DVec2 {
    map.grid_position.expect("a window is on the grid").texel
}

/// Returns the rows of the light's axes.
fn axes(map: &FittedMap) -> [Vec3; 3] {
    let rows = map.projection.light_from_world.transpose();
    [rows.x_axis, rows.y_axis, rows.z_axis].map(shadowfit::glam::Vec4::truncate)
}

/// Rounding of a power of two times an f64 constant, in eighths of an octave.
const STEP: f64 = 1e-9;

/// Asserts that all windows of a frame have the axes and the shape of another frame's windows, with sizes on
/// the scale in ascending order.
fn assert_in_order(maps: &FittedMaps, first: &FittedMaps) {
    let shape = |map: &FittedMap| texel(map).y / texel(map).x;
    let mut area = 0.0;
    for map in maps.iter() {
        assert_eq!(axes(map), axes(&first[0]), "windows never turn");
        // The product with the shape is rounded once.
        assert!((shape(map) / shape(&first[0]) - 1.0).abs() < 1e-15, "{} {}", shape(map), shape(&first[0]));
        let eighths = texel(map).x.log2() * 8.0;
        assert!((eighths - eighths.round()).abs() < STEP, "{eighths} eighths of an octave");
        let now = texel(map).x * texel(map).y;
        assert!(now > area, "sizes cross: {now} after {area}");
        area = now;
    }
}

/// Distance from the eye, in texels, up to which an f32 shader computes the texel phase of a point to 0.005:
/// its sum of four products is rounded by about four times 2⁻²⁴ of the greatest one.
const FARTHEST: f64 = 0.005 / 4.0 * 16_777_216.0;

/// Compares the texel phases of points with an earlier frame. Returns the number of comparisons.
fn compare(before: &FittedMaps, now: &FittedMaps, eyes: [DVec3; 2], points: &[DVec3]) -> usize {
    let mut compared = 0;
    for (old, map) in before.iter().zip(now.iter()) {
        for point in points.iter().filter(|point| old.projection.covers(**point) && map.projection.covers(**point)) {
            let texel = texel(map);
            let farthest = eyes.map(|eye| (*point - eye).length()).into_iter().fold(0.0, f64::max);
            if farthest > FARTHEST * texel.min_element() {
                continue;
            }
            let place = shader_position(&map.projection, *point);
            let by_grid = apart(place, grid_position(&map.projection, texel, *point));
            assert!(by_grid <= 0.02, "{by_grid} texels from the f64 chain at {point}");
            if texel == self::texel(old) {
                let crawl = apart(place, shader_position(&old.projection, *point));
                assert!(crawl <= 0.005, "{crawl} texels of crawl at {point}");
                compared += 1;
            }
        }
    }
    compared
}

proptest! {
    #![proptest_config(cases(250))]

    #[test]
    fn points_keep_their_place_in_the_texels_of_windows_that_keep_their_size(
        view in any_view(), direction in any_light(), technique in any_windows(), walk in any_walk(), is_seen in any_seen(),
        plans in prop::collection::vec(any_box(), 1..10),
        places in prop::collection::vec([share(), share(), share()], 8),
    ) {
        prop_assume!(view.lens.near < f64::from(technique.fit.max_distance));
        let origin = view.eye.round();
        let boxes = plans.iter().map(|plan| plan.aabb(&view, origin)).collect();
        let points: Vec<DVec3> = places.iter().map(|[x, y, z]| view.eye + view.point(*x, *y, view.lens.far * z)).collect();
        let mut run = Run::new(World { origin, boxes }, &technique).seen_if(is_seen);
        let (mut view, mut eye) = (view, view.eye);
        let first = run.frame(&view, direction);
        let mut before = first;
        for _ in 0..7 {
            view = walk.moved(&view);
            let now = run.frame(&view, direction);
            assert_in_order(&now, &first);
            compare(&before, &now, [eye, view.eye], &points);
            (before, eye) = (now, view.eye);
        }
    }
}

/// Walks through the town far from the world's origin, so that the other tests are not vacuous.
#[test]
fn a_walk_through_a_town_moves_no_texel_up_to_100_km_from_the_origin() {
    for far_out in [0.0, 1e3, 1e4, 1e5] {
        let offset = DVec3::new(far_out, 0.0, -far_out);
        let world = World { origin: offset, ..town() };
        let mut run = Run::new(world, &windows(4, 1024));
        let at = |frame: u16| {
            let f = f64::from(frame);
            let turn = (f * 0.004).sin() as f32;
            street_view(offset + DVec3::new(12.0 + f * 0.03, 1.7, 20.0 - f * 0.08), Vec3::new(turn, -0.1, -1.0))
        };
        let direction = Vec3::new(0.5, -0.6, 0.3);
        let points: Vec<DVec3> = (0..200_u16)
            .map(|i| offset + DVec3::new(f64::from(i % 20) * 4.0 - 30.0, 0.1, -f64::from(i / 20) * 6.0))
            .collect();
        let first = run.frame(&at(0), direction);
        let (mut before, mut compared) = (first, 0);
        for frame in 1..90 {
            let now = run.frame(&at(frame), direction);
            assert_in_order(&now, &first);
            compared += compare(&before, &now, [at(frame - 1).eye, at(frame).eye], &points);
            before = now;
        }
        assert!(compared > 20_000, "{compared} places were compared");
    }
}

/// Returns the number of windows, except the last, whose texels differ.
fn resized(before: &FittedMaps, now: &FittedMaps) -> usize {
    let all = before.len() - 1;
    before[..all].iter().zip(&now[..all]).filter(|(old, map)| texel(old) != texel(map)).count()
}

/// Frames of extended search after the visible demand is first known, and one frame for the estimate from
/// boxes.
const BEGINNING: u16 = 6;

/// Number of frames of the walk. Windows change their size at least five times in it.
const FRAMES: u16 = 150;

#[test]
fn at_most_one_window_but_the_last_changes_its_size_in_a_frame() {
    for (technique, is_seen, light) in [
        (windows(4, 1024), true, Vec3::new(0.3, -0.8, 0.4)),
        (windows(8, 1024), true, Vec3::new(0.9, -0.3, 0.2)),
        (Technique::default(), false, Vec3::new(0.3, -0.8, 0.4)),
    ] {
        let mut run = Run::new(town(), &technique).seen_if(is_seen);
        let at = |frame: u16| {
            let a = f64::from(frame) * 0.01;
            let eye = DVec3::new(40.0 * a.sin(), 1.7 + 10.0 * (1.0 - (a * 3.0).cos()), 40.0 * a.cos());
            street_view(eye, DVec3::new(a.cos(), -0.3, -a.sin()).as_vec3())
        };
        let mut before = run.frame(&at(0), light);
        let mut changes = 0;
        for frame in 1..FRAMES {
            let now = run.frame(&at(frame), light);
            let resized = resized(&before, &now);
            assert!(frame <= BEGINNING || resized <= 1, "{resized} sizes changed in frame {frame}");
            changes += usize::from(frame > BEGINNING) * resized;
            before = now;
        }
        println!("{changes} changes of size in {FRAMES} frames");
    }
}
