//! Cached maps equal maps that are drawn from scratch, frame after frame, while the camera walks and turns,
//! casters move, start, stop and vanish, and the light steps.

#[path = "cached_maps/readers.rs"]
mod readers;
#[path = "cached_maps/town.rs"]
mod town;

use shadowfit::SingleMap;
use shadowfit::glam::{DVec3, UVec2, Vec3};
use shadowfit::settings::{FitKind, MapFormat, Shape, Stabilise};
use shadowfit::{DepthConvention, Technique};
use shadowfit_wgpu::{SunShadows, UpdateSchedule};

use crate::differences::Compared;
use readers::Readers;
use town::{Block, Pair, Town, Walk, lit_otherwise};

/// Width of the maps in texels. They are small because the software adapter draws them hundreds of times.
const SIDE: u32 = 256;

fn technique(name: &str) -> Technique {
    Technique::preset(name).expect("a preset").with_resolution(SIDE, SIDE).with_max_distance(60.0)
}

/// Results of a run.
#[derive(Debug, Default)]
struct Found {
    texels: u64,
    unequal: u64,
    /// Texels that differ in maps that are not kept, and that no visible point can read.
    unread: u64,
    /// Texels of static casters that each variant drew.
    kept_drawn: u64,
    anew_drawn: u64,
    /// Frames in which a map was cleared as a whole.
    cleared: usize,
}

/// Draws each frame twice, with caching and from scratch, and compares the maps. A map that could not be kept
/// for many frames in a row contains only casters for the visible points. It is compared only where visible
/// points read it.
fn run(technique: &Technique, frames: u32, mut step: impl FnMut(u32, &mut Town, &mut Walk, &mut SunShadows)) -> Found {
    let mut pair = Pair::new(technique);
    let (mut town, mut walk, mut found) = (Town::new(), Walk::new(), Found::default());
    for frame in 0..frames {
        step(frame, &mut town, &mut walk, &mut pair.kept);
        pair.anew.invalidate_all();
        let [kept, anew] = pair.draw(&town, &walk);
        found.kept_drawn += kept.texels;
        found.anew_drawn += anew.texels;
        found.cleared += usize::from(frame > 0 && kept.cleared > 0);
        let [kept, anew] = pair.stored();
        let readers = Readers::new(&walk.camera(), &kept.maps, technique.reading());
        for (map, (a, b)) in kept.depths.iter().zip(&anew.depths).enumerate() {
            let compared = Compared::new(&pair.engine, [a, b], SIDE);
            let mut differ = compared.differences();
            let all = differ.len();
            if !pair.kept.is_cached(map) {
                differ.retain(|found| {
                    let texel = found.texel as u32;
                    readers.tell_apart(map, UVec2::new(texel % SIDE, texel / SIDE), found.depths)
                });
            }
            compared.assert_explained(&differ, format_args!("frame {frame}, map {map}"));
            found.texels += a.len() as u64;
            found.unequal += differ.len() as u64;
            found.unread += (all - differ.len()) as u64;
        }
    }
    println!("{found:?}");
    found
}

#[test]
fn gpu_kept_windows_hold_what_windows_drawn_anew_hold() {
    let found = run(&technique("windows-4"), 150, |frame, town, walk, _| {
        walk.go_on(frame);
        town.bob(frame);
    });
    assert!(found.kept_drawn * 10 < found.anew_drawn, "{found:?}");
}

#[test]
fn gpu_kept_spheres_and_held_rectangles_hold_what_maps_drawn_anew_hold() {
    for name in ["stable-4", "calm-4"] {
        let technique = technique(name).with_format(MapFormat::Depth32Float);
        run(&technique, 60, |frame, town, walk, _| {
            walk.go_on(frame);
            town.bob(frame);
        });
    }
}

#[test]
fn gpu_reversed_depth_is_kept_too() {
    let mut technique = technique("windows-4");
    technique.fit.depth = DepthConvention::Reversed;
    run(&technique, 40, |frame, town, walk, _| {
        walk.go_on(frame);
        town.bob(frame);
    });
}

#[test]
fn gpu_casters_that_change_are_drawn_where_they_were_and_where_they_are() {
    run(&technique("windows-4"), 120, |frame, town, walk, _| {
        walk.go_on(frame / 2);
        town.bob(frame);
        let last = town.blocks.len() - 1;
        match frame % 12 {
            // One caster is moved, one starts to move or stops, one vanishes or comes back, two swap numbers.
            3 => town.blocks[frame as usize * 7 % last].centre += DVec3::new(1.5, 0.3, -0.7),
            5 => {
                let moves = &mut town.moves[frame as usize * 5 % last];
                *moves = !*moves;
            }
            8 => town.blocks[frame as usize * 11 % last].half *= -1.0,
            10 => town.blocks.swap(frame as usize * 3 % last, last),
            _ => {}
        }
    });
}

/// Makes blocks appear, vanish and change their order, in a different way each frame.
fn stream(frame: u32, town: &mut Town) {
    let number = frame as usize * 7 % town.blocks.len();
    match frame % 8 {
        0 => drop(town.blocks.splice(number..town.blocks.len().min(number + 3), [])),
        1 => town.blocks.reverse(),
        2 => {
            // Streets appear at the front of the list: moved copies of other blocks.
            for i in 0..5 {
                let mut block = town.blocks[(number + i * 31) % town.blocks.len()];
                block.id = 1000 + u64::from(frame) * 10 + i as u64;
                block.centre += DVec3::new(3.0 - i as f64, 0.0, 2.0 * i as f64 - 5.0);
                town.blocks.insert(0, block);
            }
        }
        3 => town.blocks.sort_by(|a, b| a.centre.x.total_cmp(&b.centre.x)),
        4 => drop(town.blocks.remove(number)),
        5 => town.blocks.rotate_left(number),
        _ => {}
    }
}

#[test]
fn gpu_streams_in_any_order_hold_what_maps_drawn_anew_hold() {
    let found = run(&technique("windows-4"), 96, |frame, town, walk, _| {
        walk.go_on(frame / 2);
        if frame == 0 {
            *town = Town::still();
        }
        stream(frame, town);
    });
    assert!(found.kept_drawn * 4 < found.anew_drawn, "{found:?}");
}

#[test]
fn gpu_streams_of_casters_with_keys_that_move_and_change_their_shapes_are_kept_too() {
    // In the first case the same casters always move. In the second the moving ones are chosen by number, so
    // that others start and stop in each frame.
    let ways: [fn(usize, &Block) -> bool; 2] = [|_, block| block.id % 9 == 3, |number, _| number % 9 == 3];
    for moves in ways {
        run(&technique("windows-4"), 96, |frame, town, walk, _| {
            walk.go_on(frame / 2);
            stream(frame, town);
            let numbered = town.blocks.iter().enumerate();
            town.moves = numbered.map(|(number, block)| frame > 20 && moves(number, block)).collect();
            // Shapes change within the same box, and the key changes with them. Without keys, shapes stay.
            town.has_keys = frame % 40 < 30;
            if town.has_keys && frame % 40 > 0 {
                for number in [frame as usize * 5, frame as usize * 11] {
                    let block = &mut town.blocks[number % 200];
                    block.fill = 1.5 - block.fill;
                }
            }
        });
    }
}

#[test]
fn gpu_maps_that_cannot_be_kept_lack_only_casters_that_nothing_in_view_tells_apart() {
    let found = run(&technique("windows-4"), 40, |frame, town, walk, _| {
        walk.go_on(frame);
        // All casters change in most frames, so that the third redraw in a row draws only casters for the
        // visible points.
        if frame % 8 < 6 {
            town.blocks.iter_mut().for_each(|block| block.centre.x += 0.3);
        }
    });
    assert!(found.unread > 1000 * 40, "{found:?}");
}

#[test]
fn gpu_a_frame_in_which_all_changes_draws_what_maps_drawn_anew_draw() {
    let technique = technique("windows-4");
    let mut pair = Pair::new(&technique);
    let (mut town, walk) = (Town::new(), Walk::new());
    for frame in 0..40 {
        town.bob(frame);
        pair.anew.invalidate_all();
        let [kept, anew] = pair.draw(&town, &walk);
        if frame % 10 == 9 {
            town.blocks.iter_mut().for_each(|block| block.centre.x += 0.3);
        }
        if frame > 9 && frame % 10 == 0 {
            assert_eq!(kept.texels, anew.texels, "frame {frame}");
            assert_eq!(kept.passes, 4, "frame {frame}");
        }
    }
}

#[test]
fn gpu_what_is_removed_in_view_is_gone_at_once_whatever_the_schedule() {
    let technique = technique("windows-4");
    for schedule in [UpdateSchedule::Texels(1), UpdateSchedule::Every([60; 8])] {
        let mut pair = Pair::new(&technique);
        pair.kept.set_schedule(schedule);
        let (mut town, walk) = (Town::still(), Walk::new());
        for _ in 0..60 {
            pair.draw(&town, &walk);
        }
        // Remove all blocks except the ground, a few at a time.
        for left in [200, 120, 60, 30, 1] {
            town.blocks.truncate(left);
            pair.anew.invalidate_all();
            pair.draw(&town, &walk);
            let share = lit_otherwise(&pair.stored(), &walk);
            assert!(share < 1e-3, "{share} of the points with {left} blocks, {schedule:?}");
        }
    }
}

#[test]
fn gpu_the_first_caster_that_moves_finds_all_that_stood_still_before() {
    run(&technique("windows-4"), 40, |frame, town, walk, _| {
        walk.go_on(frame / 4);
        if frame == 0 {
            *town = Town::still();
        }
        if frame == 12 {
            town.moves = vec![false, true, true];
        }
        if frame == 25 {
            town.moves.clear();
        }
        if frame == 33 {
            town.moves = vec![false, false, true];
        }
        town.bob(frame);
    });
}

#[test]
fn gpu_a_light_that_steps_and_a_camera_that_jumps_leave_nothing_behind() {
    run(&technique("windows-4"), 60, |frame, town, walk, kept| {
        walk.go_on(frame);
        town.bob(frame);
        if frame % 20 == 7 {
            walk.direction = Vec3::new(0.4, -0.8, 0.01 * frame as f32).normalize();
        }
        if frame % 20 == 13 {
            walk.eye += DVec3::new(17.0, 0.0, -9.0);
            kept.invalidate_all();
        }
    });
}

#[test]
fn gpu_what_stands_still_is_not_drawn_again() {
    let technique = technique("windows-4");
    let mut pair = Pair::new(&technique);
    let (town, walk) = (Town::still(), Walk::new());
    let [first, _] = pair.draw(&town, &walk);
    assert_eq!(first.passes, 4);
    let frames: Vec<usize> = (0..40).map(|_| pair.draw(&town, &walk)[0].passes).collect();
    // Windows move for some frames, then they settle.
    assert_eq!(frames[30..], [0; 10], "{frames:?}");
}

#[test]
fn gpu_maps_that_wait_are_read_as_they_were_drawn_and_have_their_turn() {
    let technique = technique("windows-4");
    let drawn = |schedule: UpdateSchedule| {
        let mut pair = Pair::new(&technique);
        pair.kept.set_schedule(schedule);
        let (mut town, mut walk) = (Town::new(), Walk::new());
        let mut drawn = [0; 4];
        for frame in 0..64 {
            walk.go_on(frame);
            town.bob(frame);
            pair.draw(&town, &walk);
            let mut passes = [false; 4];
            for pass in pair.kept.passes() {
                passes[pass.map()] = true;
            }
            for (count, is_drawn) in drawn.iter_mut().zip(passes) {
                *count += usize::from(is_drawn);
            }
            pair.assert_proven(&town, &walk);
        }
        drawn
    };
    let always = drawn(UpdateSchedule::EveryFrame);
    let sometimes = drawn(UpdateSchedule::Every([1, 2, 4, 4, 1, 1, 1, 1]));
    assert_eq!(sometimes[0], always[0]);
    for (map, interval) in [(1, 2), (2, 4), (3, 4)] {
        assert!(sometimes[map] * 2 >= always[map] / interval, "{sometimes:?} of {always:?}");
        assert!(sometimes[map] < always[map], "{sometimes:?} of {always:?}");
    }
    let few = drawn(UpdateSchedule::Texels(1));
    assert!(few.iter().sum::<usize>() < sometimes.iter().sum() && few.iter().all(|count| *count > 4), "{few:?}");
}

#[test]
fn gpu_a_single_map_is_kept_by_the_same_rules() {
    let one = SingleMap { shape: Shape::new(FitKind::Sphere), stabilise: Stabilise::Snap { max_oversize: 1.8 } };
    let technique = technique("windows-4").with_maps(one);
    run(&technique, 40, |frame, town, walk, _| {
        walk.go_on(frame);
        town.bob(frame);
    });
}
