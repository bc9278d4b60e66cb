//! The measures of one frame's maps, over the points that its camera sees.

use glam::{DVec2, DVec3};

use super::cells::Cells;
use super::choice::{Choice, LEAST_FACING, Occluder, choose, pixels_per_texel};
use super::shadow_map::{Gradients, ShadowMap};
use super::tally::{Shimmer, Tally};
use super::visible::{VisiblePoint, VisiblePoints};

/// Every so many visible points one is followed into the frame before.
const SHIMMER_STEP: u32 = 23;
/// Points that move by less, in texels, stand still.
const STILL_MOVE: f64 = 0.02;
/// Texels whose relative size changes by less keep it.
const STILL_SCALE: f64 = 1e-4;

/// The maps of one frame, and what is known beside them.
#[derive(Clone, Copy, Debug)]
pub struct FrameMaps<'a> {
    /// Maps, in order of their splits.
    pub maps: &'a [ShadowMap],
    /// Maps of the frame before on the same path.
    pub previous: Option<&'a [ShadowMap]>,
    /// Whether the renderer clamps depth, so that casters before the near plane still shade.
    pub pancake: bool,
}

/// Measures one frame's maps.
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
        let gradients = choice.map.gradients(&choice.place);
        add_occluders(&mut tally, visible, frame, point, &choice);
        let jacobian = gradients.texels_per_step([point.pixel_right, point.pixel_down]);
        add_error(&mut tally, point, &choice, jacobian);
        let footprint = jacobian.map(|column| column * visible.pixels_per_ray);
        cells[choice.index].get_or_insert_default().mark(choice.map.size, choice.place.texel, footprint);
        if point.number.is_multiple_of(SHIMMER_STEP) {
            add_shimmer(&mut tally.shimmer, point, (&choice, &gradients), frame.previous);
        }
        tally.depth_range += 1.0 / gradients.depth.dot(visible.to_light).abs();
    }
    tally.used = cells.iter().flatten().map(Cells::share).sum();
    tally
}

fn add_occluders(tally: &mut Tally, visible: &VisiblePoints, frame: &FrameMaps, point: &VisiblePoint, choice: &Choice) {
    if point.occluders.is_empty() {
        return;
    }
    tally.shadowed += 1;
    // Whether any occluder can be drawn, and whether any is behind the near plane.
    let (mut is_drawn, mut is_in) = (false, false);
    for occluder in visible.occluders_of(point) {
        match choice.occluder(occluder) {
            Occluder::Out => {}
            Occluder::BeforeNear => is_drawn = true,
            Occluder::In => {
                (is_drawn, is_in) = (true, true);
                break;
            }
        }
    }
    tally.lost_unclamped += u64::from(!is_in);
    tally.lost += u64::from(!(if frame.pancake { is_drawn } else { is_in }));
}

fn add_error(tally: &mut Tally, point: &VisiblePoint, choice: &Choice, jacobian: [DVec2; 2]) {
    if point.facing < LEAST_FACING {
        return;
    }
    let error = pixels_per_texel(jacobian);
    tally.error.add(error);
    tally.under += u64::from(error > 1.0 || error.is_nan());
    // The side of a square of as many texels.
    tally.critical.add(error * (choice.map.size.x * choice.map.size.y).sqrt());
}

fn add_shimmer(
    shimmer: &mut Shimmer,
    point: &VisiblePoint,
    (choice, gradients): (&Choice, &Gradients),
    previous: Option<&[ShadowMap]>,
) {
    let Some(then) = previous.and_then(|maps| maps.get(choice.index)) else { return };
    let place = then.place(point.position);
    if !then.is_inside(&place) {
        return;
    }
    let moved = choice.place.texel - place.texel;
    let crawl = (moved - moved.round()).length();
    let texels = |gradients: &Gradients| texel_density(gradients.u, gradients.v);
    let change = ((texels(gradients) / texels(&then.gradients(&place))).sqrt() - 1.0).abs();
    shimmer.points += 1;
    shimmer.moved += crawl;
    shimmer.still += u64::from(crawl < STILL_MOVE && change < STILL_SCALE);
    shimmer.scaled += change;
}

/// Texels in a square metre across the light.
fn texel_density(u: DVec3, v: DVec3) -> f64 {
    u.cross(v).length()
}
