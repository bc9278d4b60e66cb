//! Timber frames: posts beside the windows, rails at floors and sills, braces.
//!
//! Posts, rails and braces protrude by different depths, so that no two faces lie in one plane.

use glam::{Affine3A, Quat, Vec3};

use super::house::{House, INSET};
use super::kit::Kit;
use super::palette::Paint;
use super::roof::Saddle;
use crate::parts::{Solid, plank};

/// Width of a timber, in metres.
const WIDE: f32 = 0.17;
/// Depths by which posts, rails and braces protrude, in metres.
const PROUD: [f32; 3] = [0.03, 0.045, 0.018];

/// Adds the frame of all upper floors.
pub(super) fn beams(kit: &mut Kit, house: &House) {
    let half = house.width / 2.0 - INSET;
    let [post, rail, _] = PROUD;
    let columns = house.columns();
    for floor in 1..house.floors {
        let foot = house.ground + house.storey * (floor - 1) as f32;
        let [low, high] = house.window_heights(floor);
        let head = foot + house.storey;
        for [y, depth] in [[foot + 0.02, rail + 0.05], [high + WIDE, rail]] {
            kit.plank(Paint::Timber, [-half - 0.004, y - WIDE, -0.07], [half + 0.004, y, depth]);
        }
        let ends = [-half + WIDE, half];
        let jambs = columns.iter().flat_map(|&[left, right]| [left + 0.02, right + WIDE - 0.02]);
        for right in jambs.chain(ends) {
            kit.plank(Paint::Timber, [right - WIDE, foot, -0.06], [right, head - 0.1, post]);
        }
        let (outer, inner) = (half - WIDE, WIDE - columns[0][0]);
        if outer - inner > 0.35 {
            for side in [-1.0, 1.0] {
                kit.add(Paint::Timber, brace([side * outer, low], [side * inner, high]));
            }
        }
    }
}

/// Builds a brace between two points of the front.
fn brace([x, y]: [f32; 2], [to_x, to_y]: [f32; 2]) -> Solid {
    let (from, to) = (Vec3::new(x, y, 0.0), Vec3::new(to_x, to_y, 0.0));
    let along = to - from;
    let turn = Quat::from_rotation_z(along.y.atan2(along.x));
    let beam = plank([0.0, -WIDE / 2.0, -0.05], [along.length(), WIDE / 2.0, PROUD[2]]);
    beam.transformed(Affine3A::from_rotation_translation(turn, from))
}

/// Adds the frame of a gable.
pub(super) fn gable_beams(kit: &mut Kit, roof: Saddle) {
    let [post, rail, _] = PROUD;
    let y = roof.eaves + 0.12;
    let inner = |y: f32| (roof.ridge - y) / roof.rise();
    kit.plank(Paint::Timber, [-inner(y), y - WIDE, -0.07], [inner(y), y, rail + 0.02]);
    let y = roof.eaves + 2.35;
    if y < roof.ridge - 0.9 {
        kit.plank(Paint::Timber, [-inner(y), y - WIDE, -0.07], [inner(y), y, rail]);
    }
    for side in [-1.0, 1.0] {
        for share in [0.25, 0.55] {
            let x = side * (0.55 + share * (roof.half - 0.9));
            let head = roof.ridge - roof.rise() * (x.abs() + WIDE / 2.0) - 0.02;
            kit.plank(Paint::Timber, [x - WIDE / 2.0, roof.eaves, -0.06], [x + WIDE / 2.0, head, post]);
        }
    }
}
