//! Tests of the measures with values that follow from a drawing: a camera looks straight down on a floor, the
//! light falls straight down, and the maps enclose the visible floor.
//!
//! ```text
//!   eye ▽  height 4          pixels and texels are parallel to x and z,
//!      ╱ ╲   roof, height 2  and of one size everywhere
//!   ──╱───╲── floor, height 0
//! ```

use glam::dcamera::rh::{proj::directx::orthographic, view::look_to_mat4};
use glam::{DMat4, DVec2, DVec3, Vec3};

use super::*;
use shadowfit_truth::{Histogram, MeasuredMap, Tracer};

/// Height of the eye over the floor, in metres.
const EYE: f64 = 4.0;
/// Tangent of half of the vertical field of view. The camera sees 4 m of the floor along z.
const TAN: f64 = 0.5;
/// Width on the floor of a pixel of a screen with 1080 rows, in metres.
const PIXEL: f64 = 2.0 * TAN * EYE / 1080.0;
/// Number of facing points of a frame.
const POINTS: u64 = 320 * 180;

/// Returns a path of frames without movement.
pub(crate) fn scenarios(frames: u32) -> Scenarios {
    let scene = Scene {
        name: "room".to_owned(),
        file: Some("room.glb".to_owned()),
        scale: 1.0,
        ground: None,
        triangles: 2,
        objects: Vec::new(),
        aabb: [0.0; 6],
    };
    let frames = (0..frames).map(|frame| Frame { id: format!("room/90/{frame}"), frame, ..Room::frame() }).collect();
    Scenarios { scenes: vec![scene], frames }
}

/// The floor and the roofs above it. No ray hits the diagonal that two triangles share.
pub(crate) struct Room {
    tracer: Tracer,
}

impl Room {
    /// Creates the floor and a rectangle for each roof: 200 m long, starting at `x`, at a height over the
    /// floor.
    fn new(roofs: &[(f32, f32)]) -> Self {
        let rectangles = std::iter::once(&(-100.0, 0.0)).chain(roofs);
        let triangles = rectangles.flat_map(|(x, height)| {
            let corner = |right: f32, z: f32| Vec3::new(x + right, *height, z);
            let [a, b, c, d] = [corner(0.0, -100.0), corner(0.0, 77.7), corner(200.0, 77.7), corner(200.0, -100.0)];
            [[a, b, c], [a, c, d]]
        });
        Self { tracer: Tracer::new(triangles) }
    }

    fn frame() -> Frame {
        let view = look_to_mat4(DVec3::new(0.0, EYE, 0.0), DVec3::NEG_Y, DVec3::NEG_Z);
        Frame {
            id: String::new(),
            scene: 0,
            elevation_deg: 90.0,
            frame: 0,
            view: view.to_cols_array(),
            fov_y_deg: 2.0 * TAN.atan().to_degrees(),
            aspect: 16.0 / 9.0,
            near: 0.1,
            far: 100.0,
            light_dir: [0.0, -1.0, 0.0],
        }
    }

    fn visible(&self) -> VisiblePoints {
        VisiblePoints::trace(&self.tracer, &Self::frame(), 1)
    }

    /// Returns a map of 1024 texels over 8 m around the origin, from height 8 m down to -8 m.
    pub(crate) fn map() -> FitMap {
        Self::map_around(DVec2::ZERO, 8.0, 8.0)
    }

    /// Returns a map of 1024 texels over `width` metres around (x, z), from height `top` 16 m down.
    fn map_around(centre: DVec2, width: f64, top: f64) -> FitMap {
        let light_from_world = look_to_mat4(DVec3::new(centre.x, top, centre.y), DVec3::NEG_Y, DVec3::NEG_Z);
        let half = width * 0.5;
        let view_proj = orthographic(-half, half, -half, half, 0.0, 16.0) * light_from_world;
        let view_proj = view_proj.to_cols_array();
        FitMap { view_proj, resolution: 1024, resolution_xy: None, split_near: 0.1, split_far: 100.0 }
    }
}

fn prepared(map: &FitMap) -> MeasuredMap {
    map.measured(DVec3::Y)
}

/// Measures maps on the floor under roofs.
fn tally(roofs: &[(f32, f32)], maps: &[FitMap], depth_clamp: bool) -> Tally {
    let maps: Vec<MeasuredMap> = maps.iter().map(prepared).collect();
    measure(&Room::new(roofs).visible(), &FrameMaps { maps: &maps, previous: None, depth_clamp })
}

/// Measures the crawl between two maps.
fn shimmer(then: &FitMap, now: &FitMap) -> Shimmer {
    let frame = FrameMaps {
        maps: &[prepared(now)],
        previous: Some(PreviousMaps { frame: &Room::frame(), maps: &[prepared(then)] }),
        depth_clamp: false,
    };
    measure(&Room::new(&[]).visible(), &frame).shimmer
}

/// Returns the same map with reversed depth.
fn reversed(map: &FitMap) -> FitMap {
    let turn = DMat4::from_translation(DVec3::Z) * DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
    FitMap { view_proj: (turn * map.clip_from_world()).to_cols_array(), ..map.clone() }
}

fn close(found: f64, wanted: f64) -> bool {
    (found - wanted).abs() <= 1e-9 * wanted.abs().max(1e-3)
}

#[test]
fn every_ray_meets_the_floor_at_the_middle_of_its_6_by_6_pixels() {
    let visible = Room::new(&[]).visible();
    assert_eq!((visible.visible, visible.points.len() as u64, visible.pixels_per_ray), (57_600, POINTS, 6.0));
    for (number, point) in visible.points.iter().enumerate() {
        let [x, y] = [number % 320, number / 320].map(|index| index as f64);
        let wanted = DVec3::new((x - 159.5) * 6.0 * PIXEL, 0.0, (y - 89.5) * 6.0 * PIXEL);
        assert!(point.position.abs_diff_eq(wanted, 1e-12), "{} {wanted}", point.position);
        assert!(point.normal == DVec3::Y && close(point.view_depth, EYE) && point.number as usize == number);
        assert!(point.pixel_right.abs_diff_eq(DVec3::X * PIXEL, 1e-12));
        assert!(point.pixel_down.abs_diff_eq(DVec3::Z * PIXEL, 1e-12));
        assert!(point.occluders.is_empty());
    }
}

#[test]
fn every_occluder_of_a_point_is_kept_whichever_way_it_faces() {
    let room = Room::new(&[(0.0, 6.0), (-100.0, 9.0)]);
    let visible = room.visible();
    for point in &visible.points {
        let mut heights: Vec<f64> = visible.occluders_of(point).map(|occluder| occluder.y).collect();
        heights.sort_by(f64::total_cmp);
        // Distances are measured from 1 mm above the point.
        let wanted: &[f64] = if point.position.x > 0.0 { &[5.999, 8.999] } else { &[8.999] };
        assert!(heights.len() == wanted.len() && heights.iter().zip(wanted).all(|(a, b)| close(*a, *b)), "{heights:?}");
    }
}

#[test]
fn points_out_of_range_are_no_points_and_those_that_face_away_are_only_counted() {
    let room = Room::new(&[]);
    let trace = |change: fn(&mut Frame)| {
        let mut frame = Room::frame();
        change(&mut frame);
        let visible = VisiblePoints::trace(&room.tracer, &frame, 1);
        (u64::from(visible.visible), visible.points.len() as u64)
    };
    assert_eq!(trace(|frame| frame.far = EYE - 0.01), (0, 0));
    assert_eq!(trace(|frame| frame.near = EYE + 0.01), (0, 0));
    assert_eq!(trace(|frame| frame.light_dir = [0.0, 1.0, 0.0]), (POINTS, 0));
    assert_eq!(trace(|frame| frame.light_dir = [1.0, 0.0, 0.0]), (POINTS, 0));
    let strided = VisiblePoints::trace(&room.tracer, &Room::frame(), 4);
    assert_eq!((strided.points.len(), strided.pixels_per_ray), (80 * 45, 24.0));
}

#[test]
fn errors_are_pixels_per_texel_and_the_critical_resolution_is_pixels_per_map() {
    let tally = tally(&[], &[Room::map()], false);
    let texel = 8.0 / 1024.0;
    let half_a_bin = 0.5 / 128.0;
    for q in [0.01, 0.5, 0.99] {
        let found = tally.pixels_per_texel.log2_quantile(q).expect("points");
        assert!((found - (texel / PIXEL).log2()).abs() <= half_a_bin);
        let found = tally.critical.log2_quantile(q).expect("points");
        assert!((found - (8.0 / PIXEL).log2()).abs() <= half_a_bin);
    }
    assert_eq!((tally.pixels_per_texel.total(), tally.undersampled, tally.uncovered), (POINTS, POINTS, 0));
}

#[test]
fn one_pixel_per_texel_is_not_undersampled_and_the_worse_axis_counts_in_maps_that_are_not_square() {
    let fine = FitMap { resolution: 4096, ..Room::map() };
    assert_eq!(tally(&[], &[fine], false).undersampled, 0);
    let wide = FitMap { resolution_xy: Some([4096, 1024]), ..Room::map() };
    let tally = tally(&[], &[wide], false);
    let error = (8.0 / 1024.0 / PIXEL).log2();
    let found = |histogram: &Histogram| histogram.log2_quantile(0.5).expect("points");
    assert!((found(&tally.pixels_per_texel) - error).abs() <= 0.5 / 128.0);
    // The map has the texel count of a square of 2048.
    assert!((found(&tally.critical) - (error + 11.0)).abs() <= 0.5 / 128.0);
}

#[test]
fn grazing_surfaces_are_left_out_of_pixels_per_texel_alone() {
    let mut frame = Room::frame();
    let grazing = DVec3::new(1.0, 0.04, 0.0).normalize();
    frame.light_dir = (-grazing).to_array();
    let visible = VisiblePoints::trace(&Room::new(&[]).tracer, &frame, 1);
    let maps = [Room::map().measured(grazing)];
    let tally = measure(
        &visible,
        &FrameMaps {
            maps: &maps,
            previous: Some(PreviousMaps { frame: &Room::frame(), maps: &maps }),
            depth_clamp: false,
        },
    );
    assert_eq!((tally.facing, tally.pixels_per_texel.total(), tally.undersampled), (POINTS, 0, 0));
    assert!(tally.shimmer.points > 0 && tally.used > 0.0);
}

#[test]
fn points_beside_every_map_are_uncovered_and_left_out_of_the_rest() {
    // The left border of this map goes through the middle of the picture.
    let half = Room::map_around(DVec2::new(4.0, 0.0), 8.0, 8.0);
    let tally = tally(&[(-100.0, 6.0)], &[half], false);
    assert_eq!((tally.uncovered, tally.covered()), (POINTS / 2, POINTS / 2));
    assert_eq!((tally.pixels_per_texel.total(), tally.shadowed, tally.lost), (POINTS / 2, POINTS / 2, 0));
}

#[test]
fn a_point_reads_the_first_map_beyond_its_depth_that_holds_it() {
    let coarse = FitMap { resolution: 512, ..Room::map() };
    let fine_half = Room::map_around(DVec2::new(4.0, 0.0), 8.0, 8.0);
    let octaves = |tally: &Tally, q: f64| tally.pixels_per_texel.log2_quantile(q).expect("points").round();
    // The near map ends before the floor: only the far one is read.
    let too_near = FitMap { split_far: EYE - 0.01, ..Room::map() };
    let alone = tally(&[], std::slice::from_ref(&coarse), false);
    assert_eq!(tally(&[], &[too_near, coarse.clone()], false).pixels_per_texel, alone.pixels_per_texel);
    // The near map covers half of the points. The others read the far map.
    let mixed = tally(&[], &[fine_half, coarse], false);
    assert_eq!((octaves(&mixed, 0.5), octaves(&mixed, 0.51), mixed.uncovered), (1.0, 2.0, 0));
    // No map ends beyond the floor.
    let none = tally(&[], &[FitMap { split_far: EYE - 0.01, ..Room::map() }], false);
    assert_eq!(none.uncovered, POINTS);
}

#[test]
fn a_caster_before_the_near_plane_is_lost_unless_the_renderer_clamps_depth() {
    let under_roof = Room::map_around(DVec2::ZERO, 8.0, 5.0);
    for map in [reversed(&under_roof), under_roof] {
        let map = std::slice::from_ref(&map);
        let lost = |depth_clamp| {
            let tally = tally(&[(0.0, 6.0)], map, depth_clamp);
            (tally.shadowed, tally.lost, tally.lost_unclamped)
        };
        assert_eq!(lost(false), (POINTS / 2, POINTS / 2, POINTS / 2));
        assert_eq!(lost(true), (POINTS / 2, 0, POINTS / 2));
        // A second roof below the near plane still casts.
        assert_eq!(tally(&[(0.0, 6.0), (-100.0, 4.5)], map, false).lost, 0);
    }
    assert_eq!(tally(&[(0.0, 6.0)], &[Room::map()], false).lost, 0);
}

#[test]
fn a_map_is_used_where_the_picture_is() {
    // The picture covers 160×90 of the map's 256×256 cells.
    let width = 4.0 / 90.0 * 256.0;
    let tally = tally(&[], &[Room::map_around(DVec2::ZERO, width, 8.0), Room::map()], false);
    assert!(close(tally.used, 160.0 * 90.0 / 65536.0), "{}", tally.used);
    assert_eq!(tally.maps, 2);
}

#[test]
fn only_moves_by_parts_of_a_texel_are_crawl() {
    let texel = 8.0 / 1024.0;
    let moved = |x: f64, z: f64| shimmer(&Room::map(), &Room::map_around(DVec2::new(x, z) * texel, 8.0, 8.0));
    let whole = moved(3.0, -7.0);
    assert_eq!((whole.points, whole.still), (POINTS.div_ceil(23), whole.points));
    assert!(whole.moved / (whole.points as f64) < 1e-9 && whole.scaled < 1e-9);
    let part = moved(0.3, -1.6);
    assert_eq!(part.still, 0);
    assert!(close(part.moved / part.points as f64, 0.5), "{part:?}");
}

#[test]
fn a_map_that_grows_changes_its_texels_size() {
    let grown = shimmer(&Room::map(), &Room::map_around(DVec2::ZERO, 8.0 / 1.01, 8.0));
    assert!(close(grown.scaled / grown.points as f64, 0.01), "{grown:?}");
    assert_eq!(grown.still, 0);
}

#[test]
fn crawl_needs_the_point_in_the_same_map_of_the_frame_before() {
    let beside = Room::map_around(DVec2::new(40.0, 0.0), 8.0, 8.0);
    assert_eq!(shimmer(&beside, &Room::map()).points, 0);
    let frame = FrameMaps {
        maps: &[prepared(&Room::map())],
        previous: Some(PreviousMaps { frame: &Room::frame(), maps: &[] }),
        depth_clamp: false,
    };
    assert_eq!(measure(&Room::new(&[]).visible(), &frame).shimmer, Shimmer::default());
}

#[test]
fn points_are_kept_that_read_the_same_texels_of_the_same_map_as_before() {
    let texel = 8.0 / 1024.0;
    let small = || FitMap { split_far: 1e9, ..Room::map_around(DVec2::X * texel, 2.0, 8.0) };
    let kept = |now: &[FitMap], then: &[FitMap], camera: &Frame| {
        let [now, then] = [now, then].map(|maps| maps.iter().map(prepared).collect::<Vec<_>>());
        let frame =
            FrameMaps { maps: &now, previous: Some(PreviousMaps { frame: camera, maps: &then }), depth_clamp: false };
        measure(&Room::new(&[]).visible(), &frame).kept
    };
    let (all, camera) = (POINTS.div_ceil(23), Room::frame());
    let moved = |x: f64| [Room::map_around(DVec2::X * x * texel, 8.0, 8.0)];
    assert_eq!(kept(&moved(3.0), &moved(0.0), &camera), Kept { points: all, kept: all });
    assert_eq!(kept(&moved(0.3), &moved(0.0), &camera), Kept { points: all, kept: 0 });
    // Points that change from one map to another are not kept, although no map moved.
    let both = kept(&[small(), Room::map()], &[small(), Room::map()], &camera);
    let entered = kept(&[small(), Room::map()], &[Room::map_around(DVec2::X * 50.0, 2.0, 8.0), Room::map()], &camera);
    assert_eq!((both.points, both.kept, entered.points), (all, all, all));
    assert!(entered.kept > 0 && entered.kept < all, "{entered:?}");
    // Points that were not in view, or had no map, are not counted.
    assert_eq!(kept(&moved(0.0), &moved(0.0), &Frame { far: 1.0, ..Room::frame() }).points, 0);
    assert_eq!(kept(&moved(0.0), &[], &camera).points, 0);
}

#[test]
fn the_depth_range_is_the_maps_depth_plain_or_reversed() {
    for map in [Room::map(), reversed(&Room::map())] {
        let tally = tally(&[], &[map], false);
        assert!(close(tally.depth_range / POINTS as f64, 16.0));
        assert!(close(Row::of(&tally, &shadowfit_truth::PictureTally::default()).depth, 16e6 / f64::from(1 << 24)));
    }
}

#[test]
fn a_ranking_measures_each_fit_on_each_frame_and_follows_the_path() {
    let scenarios = scenarios(3);
    let fit = |step: f64| {
        let map = |frame: u32| Room::map_around(DVec2::X * (f64::from(frame) * step * 8.0 / 1024.0), 8.0, 8.0);
        let frames = (0..3).rev().map(|frame| FitFrame { id: format!("room/90/{frame}"), maps: vec![map(frame)] });
        FitFile { peer: format!("step {step}"), frames: frames.collect(), ..FitFile::default() }
    };
    let mut ranking = Ranking::new(scenarios);
    for step in [1.0, 0.25] {
        ranking.add(&fit(step), std::path::Path::new("fit.json")).expect("all frames");
    }
    let done = std::sync::atomic::AtomicU32::new(0);
    let count = || _ = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    ranking.measure_scene(0, &Room::new(&[(0.0, 6.0)]).tracer, 2, &count);
    let tables = ranking.tables();
    assert_eq!((tables[0].peer.as_str(), tables[1].peer.as_str(), done.into_inner()), ("step 1", "step 0.25", 3));
    assert_eq!((tables[0].overall.still, tables[1].overall.still), (100.0, 0.0));
    assert!(close(tables[1].overall.shimmer, 0.25));
    assert_eq!((tables[0].overall.lost, tables[0].groups[0].0.as_str()), (0.0, "room/90"));
}
