//! The land: a brow at the start view, a plain with fields below, hills on the horizon.

use glam::Vec3;

use super::palette::Paint;
use crate::parts::{Builder, ease, graded, ground, hash};

/// Half of the land's side, in metres.
const HALF: f32 = 1000.0;
/// Cells along a side of the land.
const CELLS: usize = 84;
/// Exponent by which cells grow from the start view to the edge: from 1.7 m to 120 m.
const GROWTH: f32 = 4.9;
/// Height of the brow above the plain, in metres: enough to look down on shadows 150 m away.
const BROW: f32 = 13.0;

/// Returns the height of the land, in metres.
pub(super) fn height(x: f32, z: f32) -> f32 {
    let brow =
        BROW * (1.0 - ease(-z + 0.10 * x, -3.0, 46.0)) * (-(x / 170.0).powi(2)).exp() * (1.0 - ease(z, 60.0, 260.0));
    let away = x.hypot(z);
    let waves = 1.3 * (0.019 * x + 0.9).sin() * (0.023 * z).cos() + 0.45 * (0.061 * x + 0.043 * z).sin();
    let bumps = 0.06 * (0.9 * x + 0.3).sin() * (0.7 * z).cos() + 0.025 * (2.3 * x - 1.7 * z).sin();
    let turn = x.atan2(-z);
    let ridge = 0.55 + 0.30 * (3.0 * turn + 0.5).sin() + 0.15 * (8.0 * turn + 2.0).sin();
    let hills = 46.0 * ease(away, 420.0, 950.0) * ridge;
    brow + waves * ease(away, 10.0, 90.0) + bumps + hills
}

/// Returns a point on the land. Never inlined: the compiler may fold sines of constants to values that differ
/// in the last bit from the sines at run time. The scene would then depend on how the crate is split for
/// compilation.
#[inline(never)]
pub(super) fn on_land(x: f32, z: f32) -> Vec3 {
    Vec3::new(x, height(x, z), z)
}

/// Returns the position of the path along x, in metres.
pub(super) fn path(z: f32) -> f32 {
    -0.35 + 1.5 * (0.085 * (z - 2.0)).sin() + 0.0042 * z * z.min(0.0)
}

/// Adds the land.
pub(super) fn build(builder: &mut Builder) {
    let lines = graded(HALF, CELLS, GROWTH);
    let sheet = ground(Paint::Land.into(), [&lines, &lines], height, color);
    builder.lay("land", sheet);
}

/// Returns the colour of the land: turf on the brow, fields below, woods on the hills.
fn color(at: Vec3) -> Vec3 {
    let turf =
        Vec3::new(0.40, 0.42, 0.15).lerp(Vec3::new(0.62, 0.50, 0.24), 0.5 + 0.5 * (0.35 * at.x + 0.21 * at.z).sin());
    let fields = field(at.x, at.z);
    let woods = Vec3::new(0.20, 0.27, 0.12);
    let away = at.x.hypot(at.z);
    let below = ease(away, 26.0, 44.0) * ease(-at.z, -20.0, 36.0);
    let trodden = (1.0 - (at.x - path(at.z)).abs() / 1.3).max(0.0) * (1.0 - ease(-at.z, 25.0, 45.0));
    let bare = Vec3::new(0.60, 0.50, 0.34);
    turf.lerp(fields, below.max(ease(away, 90.0, 160.0))).lerp(woods, ease(away, 450.0, 800.0)).lerp(bare, trodden)
}

/// Returns the colour of the field at a place. Strips of crops follow the axes, like the cells, so that their
/// edges are straight.
fn field(x: f32, z: f32) -> Vec3 {
    let strip = ((z + HALF) / 52.0) as u32;
    let plot = ((x + HALF) / (70.0 + 60.0 * hash(strip, 8))) as u32;
    match (2 * plot + 3 * strip) % 5 {
        0 => Vec3::new(0.80, 0.62, 0.26),
        1 => Vec3::new(0.36, 0.44, 0.13),
        2 => Vec3::new(0.56, 0.43, 0.28),
        3 => Vec3::new(0.66, 0.60, 0.28),
        _ => Vec3::new(0.47, 0.48, 0.18),
    }
}
