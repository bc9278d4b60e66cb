//! With an unmoving camera, the windows stop changing after some frames.

use proptest::prelude::*;
use shadowfit::FittedMaps;
use shadowfit::glam::{DVec3, Vec3};

use super::{Run, World, any_seen, any_windows, street_view, town, windows};
use crate::scenes::{SceneView, any_box, any_light, any_view};
use crate::support::cases;

/// Greatest number of frames of the search, and number of frames without a change after it.
const SEARCH: u32 = 400;
const REST: u32 = 200;

/// Runs with an unmoving camera. Returns the last frame with a change of a map, and the number of changes.
fn settle(run: &mut Run, view: &SceneView, direction: Vec3) -> (u32, u32) {
    let mut before: Option<FittedMaps> = None;
    let (mut last, mut changes) = (0, 0);
    for frame in 0..SEARCH + REST {
        let now = run.frame(view, direction);
        if before.is_some_and(|before| before != now) {
            (last, changes) = (frame, changes + 1);
        }
        before = Some(now);
    }
    (last, changes)
}

#[test]
fn nothing_changes_in_a_town_where_the_camera_stands_still() {
    for (count, is_seen) in [(4, true), (8, true), (4, false)] {
        for direction in [Vec3::new(0.3, -0.8, 0.4), Vec3::new(1.0, -0.2, 0.1), Vec3::NEG_Y] {
            for forward in [Vec3::new(0.0, -0.1, -1.0), Vec3::new(1.0, -0.6, 0.3)] {
                let view = street_view(DVec3::new(12.0, 6.0, 20.0), forward);
                let mut run = Run::new(town(), &windows(count, 1024)).seen_if(is_seen);
                let (last, changes) = settle(&mut run, &view, direction);
                let what = format!("{direction} {forward} {count} windows, seen: {is_seen}");
                assert!(last < SEARCH, "frame {last} changed, {changes} did: {what}");
                println!("{changes} changes, the last in frame {last}");
            }
        }
    }
}

proptest! {
    #![proptest_config(cases(16))]

    #[test]
    fn nothing_changes_in_any_scene_where_the_camera_stands_still(
        view in any_view(), direction in any_light(), technique in any_windows(), is_seen in any_seen(),
        plans in prop::collection::vec(any_box(), 1..10),
    ) {
        prop_assume!(view.lens.near < f64::from(technique.fit.max_distance));
        let origin = view.eye.round();
        let boxes = plans.iter().map(|plan| plan.aabb(&view, origin)).collect();
        let mut run = Run::new(World { origin, boxes }, &technique).seen_if(is_seen);
        let (last, changes) = settle(&mut run, &view, direction);
        prop_assert!(last < SEARCH, "frame {last} changed, {changes} did");
    }
}
