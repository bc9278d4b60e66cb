//! Grounds of 10 m to 100 km in one box, and casters 20 km away: a plane never shadows itself, for any sun,
//! preset and map format.

use std::collections::BTreeMap;
use std::num::NonZero;
use std::sync::Mutex;

use shadowfit::glam::Vec3;
use shadowfit::settings::{MapFormat, MapSettings};
use shadowfit::{PRESETS, Preset, Technique};
use shadowfit_testing::pairs::{all_pairs, full_product};
use shadowfit_testing::require_large_triangles;

use super::shapes::{Arrangement, floor, solid};
use crate::support::test_gpu;

/// Sides of the ground, in metres.
const GROUNDS: [f32; 6] = [10.0, 100.0, 1e3, 1e4, 3e4, 1e5];
/// Distances from the eye to a wall, in metres.
const WALLS: [f32; 4] = [0.2, 2.0, 10.0, 50.0];
/// Elevations of the sun, in degrees.
const SUNS: [f32; 6] = [0.3, 2.0, 10.0, 30.0, 60.0, 90.0];

/// One combination of the sweep.
struct Cell {
    ground: f32,
    wall: f32,
    sun: f32,
    preset: &'static Preset,
    format: MapFormat,
}

impl Cell {
    fn of(row: &[usize]) -> Self {
        let [ground, wall, sun, preset, format] = *row else { unreachable!("five columns") };
        Self {
            ground: GROUNDS[ground],
            wall: WALLS[wall],
            sun: SUNS[sun],
            preset: &PRESETS[preset],
            format: MapFormat::ALL[format],
        }
    }

    fn name(&self) -> String {
        let Self { ground, wall, sun, preset, format } = self;
        format!("ground {ground} m, wall at {wall} m, sun at {sun}°, {}, {format:?}", preset.name)
    }

    fn technique(&self) -> Technique {
        let technique = self.preset.technique().with_format(self.format);
        let map = MapSettings { max_distance: 400.0, ..technique.fit };
        technique.with_fit(map).with_resolution(1024, 1024)
    }

    /// Returns the ground next to the end of a wall that floats over it, so that all edges of its shadow are
    /// visible. The sun is behind the wall: only ground is lit, and the filter reads no other surface than
    /// the plane that it shades.
    fn arrangement(&self) -> Arrangement {
        // Rounding must not put a vertical sun in front of the wall.
        let (sin, cos) = if self.sun == 90.0 { (1.0, 0.0) } else { self.sun.to_radians().sin_cos() };
        let direction = Vec3::new(0.6 * cos, -sin, 0.8 * cos);
        let wall = solid(Vec3::new(-0.45 * self.ground.min(20.0), 0.5, -0.3), Vec3::new(0.0, 3.0, 0.0));
        let eye = Vec3::new(0.1, self.wall.clamp(0.3, 1.7), self.wall.min(0.4 * self.ground));
        let target = Vec3::new(0.4, 0.0, -0.5 - 0.5 * eye.z);
        let mut seen = Arrangement::new(vec![floor(self.ground * 0.5), wall], eye, target, direction);
        (seen.camera.near, seen.camera.far) = (0.02, 400.0);
        seen
    }
}

/// Number of pixels that may be at an edge of a shadow outside the picture, which the judge does not
/// recognise as an edge. `aabb-1`, which has the widest texels, has 9 in one picture.
const UNSEEN_EDGES: u64 = 9;

/// Number of values of each property of a cell.
const COUNTS: [usize; 5] = [GROUNDS.len(), WALLS.len(), SUNS.len(), PRESETS.len(), MapFormat::ALL.len()];

#[test]
fn no_plane_shadows_itself_on_grounds_of_any_size() {
    assert_no_false_shadow(&all_pairs(&COUNTS));
}

/// Rays that start too close to the ground hit it. Rays that start higher above it move the edges of shadows.
#[test]
fn exact_edges_are_right_on_a_ground_of_100_km() {
    let of = |value: f32, all: &[f32]| all.iter().position(|other| *other == value).expect("a value of the sweep");
    let exact = PRESETS.iter().position(|preset| preset.name == "exact-4").expect("a preset");
    let cell = |sun: f32| vec![of(1e5, &GROUNDS), of(2.0, &WALLS), of(sun, &SUNS), exact, 0];
    assert_no_false_shadow(&[30.0, 60.0, 90.0].map(cell));
}

#[test]
#[ignore = "the full product of grounds, walls, suns, presets and formats: cargo xtask test --all"]
fn no_plane_shadows_itself_in_the_full_product_of_grounds_walls_suns_presets_and_formats() {
    assert_no_false_shadow(&full_product(&COUNTS));
}

/// Asserts that the pictures of cells have no false shadow away from edges. Prints the most by preset and
/// ground.
fn assert_no_false_shadow(rows: &[Vec<usize>]) {
    require_large_triangles(&test_gpu().adapter.get_info());
    let most = Mutex::new(BTreeMap::<_, BTreeMap<u32, (f64, usize)>>::new());
    let judge = |row: &Vec<usize>| {
        let cell = Cell::of(row);
        let tally = cell.arrangement().judged(&cell.technique());
        assert!(tally.all.facing > 10_000, "{}: {} pixels face the sun", cell.name(), tally.all.facing);
        let false_shadow = tally.all.false_shadow.saturating_sub(UNSEEN_EDGES);
        let share = 100.0 * false_shadow as f64 / tally.all.facing as f64;
        let mut most = most.lock().expect("no other thread panics");
        let (worst, count) = most.entry(cell.preset.name).or_default().entry(cell.ground as u32).or_default();
        (*worst, *count) = (worst.max(share), *count + 1);
        if share > 0.0 {
            println!("{}: {share:.3}% in false shadow", cell.name());
        }
    };
    // Each thread opens its own device.
    let threads = std::thread::available_parallelism().map_or(1, NonZero::get).min(rows.len());
    std::thread::scope(|scope| {
        for thread in 0..threads {
            scope.spawn(move || rows.iter().skip(thread).step_by(threads).for_each(judge));
        }
    });
    let most = most.into_inner().expect("no thread panics");
    for (preset, grounds) in &most {
        let line = grounds.iter().map(|(ground, (share, count))| format!("{share:.3}% of {count} at {ground} m"));
        println!("{preset}: {}", line.collect::<Vec<_>>().join(", "));
    }
    assert!(most.values().flat_map(BTreeMap::values).all(|(share, _)| *share == 0.0), "{most:?}");
}

/// Each preset once, and each format.
#[test]
fn a_far_mountain_shadows_half_of_the_ground_and_the_ground_does_not_shadow_itself() {
    assert_right_beside_a_mountain(PRESETS.iter().zip(MapFormat::ALL.into_iter().cycle()));
}

#[test]
#[ignore = "all presets with all formats: cargo xtask test --all"]
fn a_far_mountain_shadows_half_of_the_ground_with_all_presets_and_formats() {
    assert_right_beside_a_mountain(PRESETS.iter().flat_map(|preset| MapFormat::ALL.map(|format| (preset, format))));
}

/// Asserts that pictures of a ground are right. A mountain is 20 km away toward the sun, and its shadow ends
/// along a line through the picture. The depth ranges of all maps are then also 20 km, so the bias must be
/// large.
fn assert_right_beside_a_mountain(techniques: impl Iterator<Item = (&'static Preset, MapFormat)>) {
    require_large_triangles(&test_gpu().adapter.get_info());
    let (away, height) = (20e3, 3e3);
    let mountain = solid(Vec3::new(-8e3, 0.0, away), Vec3::new(0.0, height, away + 1e3));
    let (sin, cos) = 4.0_f32.to_radians().sin_cos();
    let direction = Vec3::new(0.0, -sin, -cos);
    let mut seen = Arrangement::new(vec![floor(40e3), mountain], Vec3::new(0.0, 1.7, 4.0), Vec3::ZERO, direction);
    (seen.camera.near, seen.camera.far) = (0.02, 400.0);
    for (preset, format) in techniques {
        let technique = preset.technique().with_format(format);
        let fit = MapSettings { max_distance: 400.0, ..technique.fit };
        let tally = seen.judged(&technique.with_fit(fit).with_resolution(1024, 1024));
        let name = format!("{}, {format:?}", preset.name);
        assert!(tally.all.facing > 10_000 && tally.edge_zone > 100, "{name}: the shadow's end is in view: {tally:?}");
        assert!(tally.all.false_shadow <= UNSEEN_EDGES, "{name}: {tally:?}");
        // The XNA sample's map has no casters beyond the view.
        let missing = tally.all.false_light + tally.all.hole;
        assert!(missing <= UNSEEN_EDGES || preset.name == "xna-1", "{name}: {tally:?}");
    }
}
