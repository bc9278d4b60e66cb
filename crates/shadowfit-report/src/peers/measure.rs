//! Measures the maps of a frame at its visible points.

use glam::{DVec2, DVec3};
use shadowfit_truth::{MIN_FACING, MapGradients, MeasuredMap, OccluderPlace, SelectedMap, pixels_per_texel};

use super::cells::Cells;
use super::scenarios::Frame;
use super::tally::{Shimmer, Tally};
use super::visible::{VisiblePoint, VisiblePoints};

/// Interval of visible points that are compared with the previous frame. It has no common factor with the 320
/// rays of a row, so that the compared points lie in all columns.
const SHIMMER_STEP: u32 = 23;
/// Movement below which a point counts as still, in texels.
const STILL_MOVE: f64 = 0.02;
/// Relative change of a texel's size below which it counts as constant.
const STILL_SCALE: f64 = 1e-4;

/// The maps of a frame and of the previous frame.
#[derive(Clone, Copy, Debug)]
pub struct FrameMaps<'a> {
    /// Maps, in order of their splits.
    pub maps: &'a [MeasuredMap],
    /// The previous frame of the same path. `None` for the first frame of a path, which has no shimmer.
    pub previous: Option<PreviousMaps<'a>>,
    /// Whether the renderer clamps depth, so that casters before the near plane still cast shadows.
    pub depth_clamp: bool,
}

/// The previous frame of the same path.
#[derive(Clone, Copy, Debug)]
pub struct PreviousMaps<'a> {
    /// Camera and light.
    pub frame: &'a Frame,
    /// Maps, in order of their splits.
    pub maps: &'a [MeasuredMap],
}

/// Measures the maps of a frame at the points that its camera sees.
pub fn measure(visible: &VisiblePoints, frame: &FrameMaps) -> Tally {
    let maps = frame.maps;
    let mut tally =
        Tally { frames: 1, maps: maps.len() as u64, facing: visible.points.len() as u64, ..Tally::default() };
    let mut cells: Vec<Option<Cells>> = vec![None; maps.len()];
    for point in &visible.points {
        let Some(choice) = choose(maps, point.view_depth, point.position) else {
            tally.uncovered += 1;
            continue;
        };
        let gradients = choice.map.gradients(&choice.position);
        add_occluders(&mut tally, visible, frame, point, &choice);
        let jacobian = gradients.texels_per_step([point.pixel_right, point.pixel_down]);
        add_pixels_per_texel(&mut tally, point, &choice, jacobian);
        let sides = jacobian.map(|column| column * visible.pixels_per_ray);
        cells[choice.index].get_or_insert_default().mark(choice.map.size, choice.position.texel, sides);
        if let Some(previous) = frame.previous.filter(|_| point.number.is_multiple_of(SHIMMER_STEP)) {
            let moved = movement(point, &choice, &gradients, previous.maps);
            add_shimmer(&mut tally.shimmer, moved);
            if let Some(then) = map_before(point, &previous) {
                tally.kept.points += 1;
                let is_still = moved.is_some_and(|moved| moved.is_still());
                tally.kept.kept += u64::from(then.index == choice.index && is_still);
            }
        }
        tally.depth_range += 1.0 / gradients.depth.dot(visible.to_light).abs();
    }
    tally.used = cells.iter().flatten().map(Cells::share).sum();
    tally
}

fn add_occluders(
    tally: &mut Tally,
    visible: &VisiblePoints,
    frame: &FrameMaps,
    point: &VisiblePoint,
    choice: &SelectedMap,
) {
    if point.occluders.is_empty() {
        return;
    }
    tally.shadowed += 1;
    // Whether any occluder can be drawn, and whether any is behind the near plane.
    let (mut is_drawn, mut is_in) = (false, false);
    for occluder in visible.occluders_of(point) {
        match choice.occluder(occluder) {
            OccluderPlace::Outside => {}
            OccluderPlace::BeforeNear => is_drawn = true,
            OccluderPlace::Inside => {
                (is_drawn, is_in) = (true, true);
                break;
            }
        }
    }
    tally.lost_unclamped += u64::from(!is_in);
    tally.lost += u64::from(!(if frame.depth_clamp { is_drawn } else { is_in }));
}

fn add_pixels_per_texel(tally: &mut Tally, point: &VisiblePoint, choice: &SelectedMap, jacobian: [DVec2; 2]) {
    if point.facing < MIN_FACING {
        return;
    }
    let pixels_per_texel = pixels_per_texel(jacobian);
    tally.pixels_per_texel.add(pixels_per_texel);
    tally.undersampled += u64::from(pixels_per_texel > 1.0 || pixels_per_texel.is_nan());
    // The side of a square map with the same number of texels.
    tally.critical.add(pixels_per_texel * (choice.map.size.x * choice.map.size.y).sqrt());
}

/// Movement of a point in the map that it reads, since the previous frame.
#[derive(Clone, Copy)]
struct Movement {
    /// Movement without whole texels, in texels.
    crawl: f64,
    /// Relative change of a texel's side.
    scale: f64,
}

impl Movement {
    fn is_still(&self) -> bool {
        self.crawl < STILL_MOVE && self.scale < STILL_SCALE
    }
}

/// Returns the movement of a point in the map that it reads, or `None` if that map did not cover it in the
/// previous frame.
fn movement(
    point: &VisiblePoint,
    choice: &SelectedMap,
    gradients: &MapGradients,
    previous: &[MeasuredMap],
) -> Option<Movement> {
    let then = previous.get(choice.index)?;
    let position = then.project(point.position);
    if !then.is_inside(&position) {
        return None;
    }
    let moved = choice.position.texel - position.texel;
    let texels = |gradients: &MapGradients| texel_density(gradients.u, gradients.v);
    let scale = ((texels(gradients) / texels(&then.gradients(&position))).sqrt() - 1.0).abs();
    Some(Movement { crawl: (moved - moved.round()).length(), scale })
}

fn add_shimmer(shimmer: &mut Shimmer, moved: Option<Movement>) {
    let Some(moved) = moved else { return };
    shimmer.points += 1;
    shimmer.moved += moved.crawl;
    shimmer.still += u64::from(moved.is_still());
    shimmer.scaled += moved.scale;
}

/// Returns the map that a point read in the previous frame, if that frame's view contained the point and a
/// map covered it.
fn map_before<'a>(point: &VisiblePoint, previous: &PreviousMaps<'a>) -> Option<SelectedMap<'a>> {
    let view_depth = previous.frame.view_depth(point.position)?;
    choose(previous.maps, view_depth, point.position)
}

/// Selects a map by the rule of fit files: the first map that contains the point, among the maps whose split
/// is beyond its view depth. Returns `None` if no map qualifies.
fn choose(maps: &[MeasuredMap], view_depth: f64, point: DVec3) -> Option<SelectedMap<'_>> {
    maps.iter().enumerate().skip_while(|(_, map)| view_depth >= map.split_far).find_map(|(index, map)| {
        let position = map.project(point);
        map.is_inside(&position).then_some(SelectedMap { index, map, position })
    })
}

/// Returns the number of texels per square metre across the light.
fn texel_density(u: DVec3, v: DVec3) -> f64 {
    u.cross(v).length()
}
