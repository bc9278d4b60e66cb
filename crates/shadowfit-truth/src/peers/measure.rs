//! The measures of one frame's maps, over the points that its camera sees.

use glam::{DVec2, DVec3};

use super::cells::Cells;
use super::tally::{Shimmer, Tally};
use super::visible::{VisiblePoint, VisiblePoints};
use crate::maps::{MIN_FACING, MapChoice, MapGradients, MeasuredMap, Occluder, choose, pixels_per_texel};

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
    /// Maps of the frame before on the same path; `None` for the first frame of a path, which has no
    /// shimmer.
    pub previous: Option<&'a [MeasuredMap]>,
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
        if point.number.is_multiple_of(SHIMMER_STEP) {
            add_shimmer(&mut tally.shimmer, point, (&choice, &gradients), frame.previous);
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
    choice: &MapChoice,
) {
    if point.occluders.is_empty() {
        return;
    }
    tally.shadowed += 1;
    // Whether any occluder can be drawn, and whether any is behind the near plane.
    let (mut is_drawn, mut is_in) = (false, false);
    for occluder in visible.occluders_of(point) {
        match choice.occluder(occluder) {
            Occluder::Outside => {}
            Occluder::BeforeNear => is_drawn = true,
            Occluder::Inside => {
                (is_drawn, is_in) = (true, true);
                break;
            }
        }
    }
    tally.lost_unclamped += u64::from(!is_in);
    tally.lost += u64::from(!(if frame.depth_clamp { is_drawn } else { is_in }));
}

fn add_pixels_per_texel(tally: &mut Tally, point: &VisiblePoint, choice: &MapChoice, jacobian: [DVec2; 2]) {
    if point.facing < MIN_FACING {
        return;
    }
    let pixels_per_texel = pixels_per_texel(jacobian);
    tally.pixels_per_texel.add(pixels_per_texel);
    tally.undersampled += u64::from(pixels_per_texel > 1.0 || pixels_per_texel.is_nan());
    // The side of a square of as many texels.
    tally.critical.add(pixels_per_texel * (choice.map.size.x * choice.map.size.y).sqrt());
}

fn add_shimmer(
    shimmer: &mut Shimmer,
    point: &VisiblePoint,
    (choice, gradients): (&MapChoice, &MapGradients),
    previous: Option<&[MeasuredMap]>,
) {
    let Some(then) = previous.and_then(|maps| maps.get(choice.index)) else { return };
    let position = then.project(point.position);
    if !then.is_inside(&position) {
        return;
    }
    let moved = choice.position.texel - position.texel;
    let crawl = (moved - moved.round()).length();
    let texels = |gradients: &MapGradients| texel_density(gradients.u, gradients.v);
    let change = ((texels(gradients) / texels(&then.gradients(&position))).sqrt() - 1.0).abs();
    shimmer.points += 1;
    shimmer.moved += crawl;
    shimmer.still += u64::from(crawl < STILL_MOVE && change < STILL_SCALE);
    shimmer.scaled += change;
}

/// Texels in a square metre across the light.
fn texel_density(u: DVec3, v: DVec3) -> f64 {
    u.cross(v).length()
}
