//! The measures of one frame's maps, over the points that its camera sees.

use glam::{DVec2, DVec3};

use super::cells::Cells;
use super::scenarios::Frame;
use super::tally::{Kept, Shimmer, Tally};
use super::visible::{VisiblePoint, VisiblePoints};
use crate::maps::{MIN_FACING, MapGradients, MapSelection, MeasuredMap, OccluderPlace, choose, pixels_per_texel};

/// Every 23rd visible point is looked up in the frame before. It shares no factor with the 320 rays of
/// a row, so that points in all columns are.
const SHIMMER_STEP: u32 = 23;
/// Points that move by less than this, in texels, stand still.
const STILL_MOVE: f64 = 0.02;
/// Texels whose size changes by a smaller share than this keep their size.
const STILL_SCALE: f64 = 1e-4;

/// The maps of one frame and of the frame before.
#[derive(Clone, Copy, Debug)]
pub struct FrameMaps<'a> {
    /// Maps, in order of their splits.
    pub maps: &'a [MeasuredMap],
    /// The frame before on the same path, and its maps; `None` for the first frame of a path, which has no
    /// shimmer.
    pub previous: Option<(&'a Frame, &'a [MeasuredMap])>,
    /// Whether the renderer clamps depth, so that casters before the near plane still cast shadows.
    pub depth_clamp: bool,
}

/// Measures one frame's maps on the points that its camera sees.
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
        if let Some((camera, maps)) = frame.previous.filter(|_| point.number.is_multiple_of(SHIMMER_STEP)) {
            let moved = movement(point, (&choice, &gradients), maps);
            add_shimmer(&mut tally.shimmer, moved);
            add_kept(&mut tally.kept, point, (choice.index, moved), (camera, maps));
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
    choice: &MapSelection,
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

fn add_pixels_per_texel(tally: &mut Tally, point: &VisiblePoint, choice: &MapSelection, jacobian: [DVec2; 2]) {
    if point.facing < MIN_FACING {
        return;
    }
    let pixels_per_texel = pixels_per_texel(jacobian);
    tally.pixels_per_texel.add(pixels_per_texel);
    tally.undersampled += u64::from(pixels_per_texel > 1.0 || pixels_per_texel.is_nan());
    // The side of a square of as many texels.
    tally.critical.add(pixels_per_texel * (choice.map.size.x * choice.map.size.y).sqrt());
}

/// How a point moved in the map that it reads, since the frame before.
#[derive(Clone, Copy)]
struct Movement {
    /// Beyond whole texels, in texels.
    crawl: f64,
    /// Relative change of a texel's side.
    scale: f64,
}

impl Movement {
    fn is_still(&self) -> bool {
        self.crawl < STILL_MOVE && self.scale < STILL_SCALE
    }
}

/// How a point moved in the map that it reads; `None` where that map did not hold it in the frame before.
fn movement(
    point: &VisiblePoint,
    (choice, gradients): (&MapSelection, &MapGradients),
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

/// Counts whether a point reads the same texels as in the frame before, if it had a map in that frame's view.
fn add_kept(
    kept: &mut Kept,
    point: &VisiblePoint,
    (index, moved): (usize, Option<Movement>),
    (camera, previous): (&Frame, &[MeasuredMap]),
) {
    let Some(view_depth) = camera.view_depth(point.position) else { return };
    let Some(then) = choose(previous, view_depth, point.position) else { return };
    kept.points += 1;
    kept.kept += u64::from(then.index == index && moved.is_some_and(|moved| moved.is_still()));
}

/// Texels in a square metre across the light.
fn texel_density(u: DVec3, v: DVec3) -> f64 {
    u.cross(v).length()
}
