//! Class shares for made-up shadow factors: a floor under half a roof, exact to the pixel.

use glam::DVec3;
use shadowfit::selection::MapOrder;
use shadowfit_truth::{
    Class, Crawl, Judged, MapReading, MapsBefore, MeasuredMap, PictureMaps, PictureTally, Tracer, Truth, TruthLight,
    TruthSettings, crawl, judge,
};

use super::scenes::{PlainMap, level, looking_down, map_around, shadow_map};

/// A floor of 40 by 10 pixels of 10 cm, seen from below the roof. The roof covers its left half (x < 0) at a
/// height of 2 m. The light falls straight down.
struct Room {
    tracer: Tracer,
    truth: Truth,
}

const PIXELS: usize = 400;

impl Room {
    fn new() -> Self {
        Self::lit_from(DVec3::Y, |_| ())
    }

    fn lit_from(to_light: DVec3, change: impl Fn(&mut TruthSettings)) -> Self {
        let floor = level(0.0, [-9.0, -9.0], [9.0, 9.7]);
        let roof = level(2.0, [-9.0, -9.0], [0.0, 9.7]);
        let tracer = Tracer::new([floor, roof].concat());
        let camera = looking_down(1.0, 0.1, [40, 10]);
        let seen = Truth::seen_by_rays(&tracer, &camera);
        let mut settings = TruthSettings::new(to_light);
        change(&mut settings);
        let truth = Truth::trace(&tracer, &camera, &settings, &seen);
        Self { tracer, truth }
    }

    /// Judges factors that are given by column.
    fn judge(&self, factor: impl Fn(usize) -> f32, map: MeasuredMap, depth_clamp: bool) -> Judged {
        self.judge_counting(factor, map, depth_clamp, |_| true)
    }

    fn judge_counting(
        &self,
        factor: impl Fn(usize) -> f32,
        map: MeasuredMap,
        depth_clamp: bool,
        counts: impl Fn(u32) -> bool + Sync,
    ) -> Judged {
        let factors: Vec<f32> = (0..PIXELS).map(|pixel| factor(pixel % 40)).collect();
        let maps = PictureMaps { maps: &[map], reading: MapReading::ViewDepth, filter_radius: 0.5, depth_clamp };
        judge(&self.tracer, &self.truth, &maps, &factors, counts)
    }
}

/// Returns a map 8 m wide around the floor, with texels `pixels_per_texel` pixels wide, which starts `top` metres
/// above it.
fn map(pixels_per_texel: u32, top: f64) -> MeasuredMap {
    shadow_map(DVec3::ZERO, DVec3::Y, 8.0, top, 80 / pixels_per_texel)
}

/// Returns false shadow, false light, hole, edge and wrong, in columns of 40.
fn columns(tally: &PictureTally) -> [u64; 5] {
    [tally.all.false_shadow, tally.all.false_light, tally.all.hole, tally.all.edge, tally.all.wrong].map(|count| {
        assert!(count.is_multiple_of(10), "whole columns");
        count / 10
    })
}

fn right_factor(column: usize) -> f32 {
    if column < 20 { 0.0 } else { 1.0 }
}

#[test]
fn a_perfect_map_has_no_wrong_pixel() {
    let tally = Room::new().judge(right_factor, map(1, 9.0), false).tally;
    assert_eq!(
        (tally.frames, tally.all.facing, tally.all.wrong, tally.error, tally.displacement),
        (1, 400, 0, 0.0, 0.0)
    );
    assert_eq!((tally.transitions, tally.edge_zone, tally.uncovered, tally.grazing.facing), (10, 40, 0, 0));
}

#[test]
fn a_map_that_shadows_everything_is_false_shadow_but_for_the_edge_zone() {
    // Half of 40 columns are wrong. The edge zone of 1.5 pixels contains the first (0.5 from the border) and
    // the second (1.5).
    let tally = Room::new().judge(|_| 0.0, map(1, 9.0), false).tally;
    assert_eq!((columns(&tally), tally.error), ([18, 0, 0, 2, 20], 200.0));
    // The map has no edge, so every true one counts as 32 pixels off.
    assert_eq!((tally.transitions, tally.displacement), (10, 320.0));
}

#[test]
fn coarse_texels_widen_the_edge_zone_by_their_width_on_screen() {
    // 1.5 texels of 4 pixels: columns up to 6 pixels from the border.
    let judged = Room::new().judge(|_| 0.0, map(4, 9.0), false);
    assert_eq!(columns(&judged.tally), [14, 0, 0, 6, 20]);
    assert!(judged.pixels_per_texel.iter().all(|pixels| (pixels - 4.0).abs() < 1e-4));
    assert_eq!((judged.tally.pixels_per_texel.total(), judged.tally.undersampled), (400, 400));
}

#[test]
fn a_filter_that_reaches_farther_in_a_map_widens_the_edge_zone_there() {
    // 3 + 1 texels of a pixel: columns up to 4 pixels from the border.
    let judged = Room::new().judge(|_| 0.0, map(1, 9.0).with_filter_radius(3.0), false);
    assert_eq!(columns(&judged.tally), [16, 0, 0, 4, 20]);
}

#[test]
fn a_roof_inside_the_map_that_casts_nothing_is_false_light() {
    assert_eq!(columns(&Room::new().judge(|_| 1.0, map(1, 9.0), false).tally), [0, 18, 0, 2, 20]);
}

#[test]
fn a_roof_outside_the_map_is_a_hole_and_nothing_else() {
    assert_eq!(columns(&Room::new().judge(|_| 1.0, map(1, 1.0), false).tally), [0, 0, 20, 0, 20]);
}

#[test]
fn depth_clamp_leaves_no_hole_since_the_map_holds_what_stands_before_it() {
    assert_eq!(columns(&Room::new().judge(|_| 1.0, map(1, 1.0), true).tally), [0, 18, 0, 2, 20]);
}

#[test]
fn points_outside_every_map_are_uncovered_and_holes_where_they_are_shadowed() {
    let beside = shadow_map(DVec3::X * 50.0, DVec3::Y, 8.0, 9.0, 80);
    let judged = Room::new().judge(|_| 1.0, beside, true);
    assert_eq!((columns(&judged.tally), judged.tally.uncovered), ([0, 0, 20, 0, 20], 400));
    assert!(judged.map_index.iter().all(Option::is_none) && judged.pixels_per_texel.iter().all(|p| p.is_infinite()));
    assert_eq!((judged.tally.edge_zone, judged.tally.pixels_per_texel.total()), (40, 0));
}

#[test]
fn points_read_the_first_map_beyond_their_depth_and_classes_name_it() {
    let room = Room::new();
    let far = map_around(DVec3::ZERO, DVec3::Y, 8.0, 9.0, 80);
    let maps = [PlainMap { split_far: 0.5, ..far }, map_around(DVec3::X * 4.0, DVec3::Y, 8.0, 9.0, 80), far]
        .map(|map| map.measured(DVec3::Y));
    let seen = PictureMaps { maps: &maps, reading: MapReading::ViewDepth, filter_radius: 0.5, depth_clamp: false };
    let judged = judge(&room.tracer, &room.truth, &seen, &[1.0; PIXELS], |_| true);
    for (pixel, choice) in judged.map_index.iter().enumerate() {
        assert_eq!(*choice, Some(if pixel % 40 < 20 { 2 } else { 1 }));
    }
}

#[test]
fn of_two_maps_the_one_that_weighs_more_names_the_texels_and_the_occluders() {
    let room = Room::new();
    // The finer map ends at x = 0.7 and is below the roof. The coarser one has texels of two pixels.
    let fine = shadow_map(DVec3::X * -3.3, DVec3::Y, 8.0, 1.0, 80);
    let maps = [map(2, 9.0), fine];
    let order = MapOrder::by_area([Some(4.0), Some(1.0)]);
    for (blend, columns) in [(0.0, 22), (8.0, 18)] {
        let reading = MapReading::Coverage { order, blend };
        let seen = PictureMaps { maps: &maps, reading, filter_radius: 5.0, depth_clamp: false };
        let judged = judge(&room.tracer, &room.truth, &seen, &[1.0; PIXELS], |_| true);
        for pixel in 0..PIXELS {
            // From this column on, the point is less than 5 texels from the finer map's border, or less than
            // 5 and half of the blend.
            let is_fine = pixel % 40 < columns;
            assert_eq!(judged.map_index[pixel], Some(u8::from(is_fine)), "column {}, blend {blend}", pixel % 40);
            let texel = if is_fine { 1.0 } else { 2.0 };
            assert!((judged.pixels_per_texel[pixel] / texel - 1.0).abs() < 1e-3);
            // The roof is above the finer map.
            assert_eq!(judged.classes[pixel] == Class::Hole, is_fine && pixel % 40 < 20, "column {}", pixel % 40);
        }
    }
}

#[test]
fn surfaces_that_face_away_or_lie_beyond_the_shadow_distance_are_not_judged() {
    let below = Room::lit_from(DVec3::NEG_Y, |_| ()).judge(|_| 0.0, map(1, 9.0), false);
    let beyond = Room::lit_from(DVec3::Y, |settings| settings.max_distance = 0.9).judge(|_| 0.0, map(1, 9.0), false);
    for judged in [below, beyond] {
        assert!(judged.classes.iter().all(|class| *class == Class::NotJudged));
        assert!(judged.pixels_per_texel.iter().all(|pixels| pixels.is_nan()));
        assert_eq!(judged.tally, PictureTally { frames: 1, ..PictureTally::default() });
        assert!(judged.tally.is_empty() && judged.tally.figures().is_none());
    }
}

#[test]
fn triangles_that_do_not_count_are_judged_and_in_no_sum() {
    let room = Room::new();
    let one = room.truth.points[0].expect("the floor").triangle;
    let counted = room.judge_counting(|_| 0.0, map(1, 9.0), false, |triangle| triangle == one);
    let all = room.judge(|_| 0.0, map(1, 9.0), false);
    assert_eq!(counted.classes, all.classes);
    let of_triangle = room.truth.points.iter().flatten().filter(|point| point.triangle == one).count();
    assert!((1..400).contains(&of_triangle));
    assert_eq!(counted.tally.all.facing, of_triangle as u64);
}

#[test]
fn grazing_pixels_count_in_all_and_are_listed_apart_but_have_no_texels() {
    let to_light = DVec3::new(1.0, 0.04, 0.0).normalize();
    let room = Room::lit_from(to_light, |_| ());
    let map = shadow_map(DVec3::ZERO, to_light, 16.0, 20.0, 64);
    let tally = room.judge(|_| 0.0, map, false).tally;
    assert_eq!((tally.all.facing, tally.grazing.facing, tally.pixels_per_texel.total()), (400, 400, 0));
    assert!(tally.all.wrong > 0 && tally.grazing.wrong == tally.all.wrong);
    assert_eq!(tally.grazing.false_shadow, tally.all.false_shadow);
}

#[test]
fn an_edge_that_is_shifted_by_three_pixels_is_displaced_by_three() {
    let shifted = |column: usize| if column < 23 { 0.0 } else { 1.0 };
    let tally = Room::new().judge(shifted, map(1, 9.0), false).tally;
    assert_eq!((tally.displacement, tally.transitions, tally.all.wrong), (30.0, 10, 30));
    let figures = tally.figures().expect("a picture of the floor");
    assert_eq!((figures.edge_distance, figures.wrong, figures.crawl), (Some(3.0), 7.5, None));
}

#[test]
fn soft_truth_counts_as_it_is_and_is_lit_from_one_half_on() {
    let sun = TruthLight::Sun { to_light: DVec3::Y, radius: 0.2, rays: 64 };
    let room = Room::lit_from(DVec3::Y, |settings| settings.light = sun);
    let factors: Vec<f32> = room.truth.points.iter().map(|point| point.expect("the floor").lit).collect();
    assert!(factors.iter().any(|factor| (0.1..0.9).contains(factor)));
    let maps =
        PictureMaps { maps: &[map(1, 9.0)], reading: MapReading::ViewDepth, filter_radius: 0.5, depth_clamp: false };
    let tally = judge(&room.tracer, &room.truth, &maps, &factors, |_| true).tally;
    assert_eq!((tally.all.wrong, tally.error), (0, 0.0));
    // A pixel is a hole even if only some of the rays are blocked.
    let low = PictureMaps { maps: &[map(1, 1.0)], ..maps };
    let judged = judge(&room.tracer, &room.truth, &low, &[1.0; PIXELS], |_| true);
    assert_eq!((judged.tally.all.hole, judged.tally.all.wrong), (200, 200));
}

#[test]
fn merged_tallies_are_those_of_both_pictures() {
    let room = Room::new();
    let mut merged = room.judge(|_| 0.0, map(1, 9.0), false).tally;
    merged.merge(&room.judge(|_| 1.0, map(4, 1.0), false).tally);
    merged.add_crawl(&Crawl { different: 3, compared: 12, ..Crawl::default() });
    assert_eq!(
        (merged.frames, merged.all.facing, merged.all.wrong, merged.all.hole, merged.all.false_shadow),
        (2, 800, 400, 200, 180)
    );
    let figures = merged.figures().expect("two pictures of the floor");
    assert_eq!(
        (figures.wrong, figures.hole, figures.crawl, figures.edge_distance),
        (50.0, 25.0, Some(25.0), Some(32.0))
    );
    let [p50, p95, _] = figures.pixels_per_texel.expect("texels");
    assert!((p95 - 4.0).abs() < 4.0 * 0.005 && (p50 - 1.0).abs() < 0.005, "{p50} {p95}");
}

/// Returns maps that are selected by view depth and read with one tap.
fn by_view_depth(maps: &[MeasuredMap]) -> PictureMaps<'_> {
    PictureMaps { maps, reading: MapReading::ViewDepth, filter_radius: 0.5, depth_clamp: false }
}

#[test]
fn crawl_compares_edge_pixels_that_the_maps_of_both_frames_hold() {
    let room = Room::new();
    let judged = room.judge(right_factor, map(1, 9.0), false);
    let now: Vec<f32> = (0..PIXELS).map(|pixel| right_factor(pixel % 40)).collect();
    // In the previous frame, one of the four columns in the edge zone was lit, and one column far from it.
    let then: Vec<f32> = (0..PIXELS).map(|p| if [19, 3].contains(&(p % 40)) { 1.0 } else { now[p] }).collect();
    let maps = [map(1, 9.0)];
    let before = MapsBefore { maps: by_view_depth(&maps), eye: DVec3::Y * 2.0, forward: DVec3::NEG_Y, factors: &then };
    let compared = |maps: &[MeasuredMap]| {
        let crawl = crawl(&room.truth, &judged, &now, &MapsBefore { maps: by_view_depth(maps), ..before });
        ([crawl.different, crawl.compared], crawl.change, crawl.change_compared)
    };
    // The factors of the column far from the edge also differ, and enter the sum over all pixels.
    assert_eq!(compared(&maps), ([10, 40], 20.0, 400));
    // Two columns of the edge zone are outside the previous frame's maps.
    let beside = [shadow_map(DVec3::X * -4.0, DVec3::Y, 8.0, 9.0, 80)];
    assert_eq!(compared(&beside).0, [10, 20]);
    // All points lie beyond its last split.
    let short = PlainMap { split_far: 1.9, ..map_around(DVec3::ZERO, DVec3::Y, 8.0, 9.0, 80) };
    assert_eq!(compared(&[short.measured(DVec3::Y)]), ([0, 0], 0.0, 0));
}
