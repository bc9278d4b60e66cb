//! The state of a fitter of windows, and the inputs that it ignores and refuses.

use shadowfit::demand::{CELLS, DemandGrid, DemandSpace};
use shadowfit::glam::{DQuat, DVec2, DVec3, Vec3};
use shadowfit::{FitError, FitInput, FitState, FittedMaps, Scratch, ViewFrustum};

use super::{Demand, Run, hits, street_view, town, windows};
use crate::scenes::SceneView;

const LIGHT: Vec3 = Vec3::new(0.3, -0.8, 0.4);

fn walk(frame: u16) -> SceneView {
    let f = f64::from(frame);
    street_view(DVec3::new(12.0 + f * 0.3, 1.7, 20.0 - f * 0.5), Vec3::new(0.01 * f32::from(frame), -0.15, -1.0))
}

fn run_of(count: u32) -> Run {
    Run::new(town(), &windows(count, 1024))
}

#[test]
fn reset_forgets_all_earlier_frames() {
    let mut run = run_of(4);
    for frame in 0..20 {
        run.frame(&walk(frame), LIGHT);
    }
    let demand = run.demand.clone();
    let kept =
        Run { world: town(), storage: run.storage.clone(), ..Run { fitter: run.fitter.clone(), demand, ..run_of(4) } };
    run.fitter.reset();
    let mut fresh = Run { fitter: FitState::new(), demand: kept.demand.clone(), ..run_of(4) };
    let (reset, fresh) = (run.frame(&walk(60), LIGHT), fresh.frame(&walk(60), LIGHT));
    assert_eq!(reset, fresh);
    let mut kept = kept;
    assert_ne!(kept.frame(&walk(60), LIGHT), fresh, "the state matters");
}

#[test]
fn another_technique_begins_anew() {
    let mut run = run_of(4);
    for frame in 0..20 {
        run.frame(&walk(frame), LIGHT);
    }
    run.technique = windows(5, 512);
    let mut fresh = Run { demand: run.demand.clone(), technique: run.technique, ..run_of(4) };
    assert_eq!(run.frame(&walk(20), LIGHT), fresh.frame(&walk(20), LIGHT));
}

#[test]
fn a_cut_without_a_reset_leaves_nothing_uncovered_and_grows_sharp_again() {
    let mut run = run_of(4);
    for frame in 0..20 {
        run.frame(&walk(frame), LIGHT);
    }
    let there = street_view(DVec3::new(-120.0, 30.0, -110.0), Vec3::new(1.0, -0.3, 0.8));
    for _ in 0..30 {
        let maps = run.frame(&there, LIGHT);
        for hit in hits(&there, DVec3::ZERO, &run.world.boxes, f64::MAX) {
            assert!(maps[3].projection.texels_to_edge(there.eye + hit.point).is_some_and(|free| free > 2.0));
        }
    }
}

#[cfg(feature = "serde")]
#[test]
fn a_fitter_that_was_saved_goes_on_as_the_one_that_was_not() {
    let mut run = run_of(4);
    for frame in 0..10 {
        run.frame(&walk(frame), LIGHT);
    }
    let json = serde_json::to_string(&run.fitter).unwrap();
    let mut other = Run { fitter: serde_json::from_str(&json).unwrap(), demand: run.demand.clone(), ..run_of(4) };
    for frame in 10..40 {
        assert_eq!(run.frame(&walk(frame), LIGHT), other.frame(&walk(frame), LIGHT), "frame {frame}");
    }
}

#[test]
fn an_error_leaves_the_fitter_as_it_was() {
    let (mut run, mut other) = (run_of(4), run_of(4));
    for frame in 0..10 {
        assert_eq!(run.frame(&walk(frame), LIGHT), other.frame(&walk(frame), LIGHT));
        let views = [walk(frame + 100).frustum()];
        let bad = run.world.input(&views, Vec3::NAN, &[]);
        assert!(run.fitter.fit(&bad, &run.technique, &mut Scratch::new(&mut run.storage)).is_err());
        let small = run.world.input(&views, LIGHT, &[]);
        assert!(run.fitter.fit(&small, &run.technique, &mut Scratch::new(&mut [])).is_err());
    }
}

#[test]
fn too_little_storage_is_an_error_and_what_is_required_is_enough() {
    let (world, views) = (town(), [walk(0).frustum(), walk(30).frustum()]);
    let input = world.input(&views, LIGHT, &[]);
    let required = Scratch::required(world.boxes.len(), views.len());
    let fit = |len: usize| FitState::new().fit(&input, &windows(8, 64), &mut Scratch::new(&mut vec![DVec2::ZERO; len]));
    let whole = fit(required).unwrap();
    let mut refused = 0;
    for len in (0..required).step_by(61).chain([required - 1]) {
        match fit(len) {
            Ok(maps) => assert_eq!(maps, whole, "{len} elements"),
            Err(error) => {
                assert!(
                    matches!(error, FitError::ScratchTooSmall { given, required } if given <= len && required > given)
                );
                refused += 1;
            }
        }
    }
    assert!(refused > 5);
}

/// Returns the fits of one frame with some grids, by a new fitter and by one that has fitted two frames.
fn with_grids(grids: &[DemandGrid], view: &SceneView, light: Vec3) -> [FittedMaps; 2] {
    let (world, technique) = (town(), windows(4, 1024));
    let mut storage = vec![DVec2::ZERO; Scratch::required(world.boxes.len(), 1)];
    let views = [view.frustum()];
    let mut fit = |fitter: &mut FitState| {
        fitter.fit(&world.input(&views, light, grids), &technique, &mut Scratch::new(&mut storage)).unwrap()
    };
    let mut fitter = FitState::new();
    [fit(&mut fitter), fit(&mut fitter)]
}

#[test]
fn grids_that_cannot_be_used_are_ignored() {
    let view = walk(0);
    let seen = hits(&view, DVec3::ZERO, &town().boxes, f64::MAX);
    let right = Demand::of(&view, &seen, LIGHT, &windows(4, 1024));
    let (without, with) = (with_grids(&[], &view, LIGHT), with_grids(&[right.grid()], &view, LIGHT));
    assert_ne!(with, without, "a right grid matters");
    let space = right.space;
    let mut bad = vec![
        DemandSpace { direction: (DQuat::from_rotation_x(0.1) * LIGHT.as_dvec3()).as_vec3().normalize(), ..space },
        DemandSpace { direction: -space.direction, ..space },
        DemandSpace { direction: Vec3::NAN, ..space },
        DemandSpace { direction: Vec3::ZERO, ..space },
        DemandSpace { origin: DVec3::NAN, ..space },
        DemandSpace { origin: DVec3::new(0.0, f64::INFINITY, 0.0), ..space },
        DemandSpace { x: Vec3::NAN, ..space },
        DemandSpace { y: Vec3::new(0.0, f32::INFINITY, 0.0), ..space },
    ];
    for number in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        bad.extend([DemandSpace { cell: number, ..space }, DemandSpace { texel: number, ..space }]);
    }
    for space in bad {
        let grid = DemandGrid { space, ..right.grid() };
        assert_eq!(with_grids(&[grid], &view, LIGHT), without, "{space:?}");
        assert_eq!(with_grids(&[grid, right.grid()], &view, LIGHT), with, "beside a good one: {space:?}");
    }
    let long = vec![1; CELLS + 1];
    for counts in [&[][..], &right.counts[1..], &long, &vec![0; CELLS]] {
        assert_eq!(with_grids(&[DemandGrid { space, counts }], &view, LIGHT), without, "{} counts", counts.len());
    }
}

/// Returns the texel area of the finest window that covers a point.
fn finest(maps: &FittedMaps, point: DVec3) -> f32 {
    let areas = maps.iter().filter(|map| map.projection.texels_to_edge(point).is_some_and(|free| free > 3.0));
    areas.map(|map| map.projection.texel_size.element_product()).fold(f32::MAX, f32::min)
}

/// Two players far apart: with a grid for each, both have fine texels. With a grid for only one, the other
/// reads the last window.
#[test]
fn each_view_is_served_by_its_own_grid() {
    let players = [
        street_view(DVec3::new(-110.0, 1.7, -110.0), Vec3::NEG_Z),
        street_view(DVec3::new(110.0, 1.7, 120.0), Vec3::X),
    ];
    let (world, technique) = (town(), windows(6, 1024));
    let views: Vec<ViewFrustum> = players.iter().map(SceneView::frustum).collect();
    let seen = players.map(|view| hits(&view, DVec3::ZERO, &world.boxes, f64::MAX));
    let needs = [0, 1].map(|i| Demand::of(&players[i], &seen[i], LIGHT, &technique));
    let grids = [needs[0].grid(), needs[1].grid()];
    let mut storage = vec![DVec2::ZERO; Scratch::required(world.boxes.len(), 2)];
    let mut settle = |grids: &[DemandGrid]| {
        let mut fitter = FitState::new();
        let mut maps = FittedMaps::default();
        for _ in 0..40 {
            let input = FitInput { demand: grids, ..world.input(&views, LIGHT, &[]) };
            maps = fitter.fit(&input, &technique, &mut Scratch::new(&mut storage)).unwrap();
        }
        maps
    };
    let (both, first) = (settle(&grids), settle(&grids[..1]));
    // Median over the points of each picture.
    let median = |maps: &FittedMaps, player: usize| {
        let mut all: Vec<f32> = seen[player].iter().map(|hit| finest(maps, players[player].eye + hit.point)).collect();
        all.sort_by(f32::total_cmp);
        all[all.len() / 2]
    };
    for player in 0..2 {
        assert!(median(&both, player) < both[5].projection.texel_size.element_product() / 16.0, "player {player}");
    }
    assert!(median(&both, 1) < median(&first, 1) / 4.0, "{} {}", median(&both, 1), median(&first, 1));
}
