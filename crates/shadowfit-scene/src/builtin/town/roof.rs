//! Roofs of houses: slopes with overhangs, ridges, chimneys, dormers, gutters.

use glam::{Affine3A, Vec3};

use super::kit::{Kit, across};
use super::palette::Paint;
use crate::parts::{Solid, gabled, lathe, plank, prism};

/// Thickness of a roof across its slope's vertical, in metres.
const THICK: f32 = 0.15;
/// Depth by which roofs lie in the walls below, in metres, so that no light passes between.
const SUNK: f32 = 0.03;

/// A roof of two slopes with its ridge along z, about x = 0. All lengths are in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Saddle {
    /// Half of the width of the walls below.
    pub(super) half: f32,
    /// Height at which the slopes meet the outer faces of the walls.
    pub(super) eaves: f32,
    /// Height at which the slopes meet.
    pub(super) ridge: f32,
    /// Horizontal overhang beyond the walls.
    pub(super) over: f32,
}

impl Saddle {
    /// Returns the rise of a slope, in metres for each metre.
    pub(super) fn rise(self) -> f32 {
        (self.ridge - self.eaves) / self.half
    }

    /// Returns the height of the lower ends of the slopes.
    pub(super) fn low(self) -> f32 {
        self.eaves - self.over * self.rise()
    }

    /// Builds both slopes, of a length along z.
    pub(super) fn slopes(self, length: f32) -> Solid {
        let reach = self.half + self.over;
        let [low, high] = [self.low() - SUNK, self.ridge - SUNK];
        let outline = [(0.0, high), (reach, low), (reach, low + THICK), (0.0, high + THICK)];
        prism(&outline, length).and_mirrored()
    }

    /// Builds the row of tiles along the ridge.
    pub(super) fn ridge_tiles(self, length: f32) -> Solid {
        let top = self.ridge + THICK - SUNK;
        prism(&[(-0.16, top - 0.1), (0.16, top - 0.1), (0.07, top + 0.07), (-0.07, top + 0.07)], length)
    }
}

/// Turns a shape along z into one along x, and moves it back by `depth` metres.
pub(super) fn sideways(solid: Solid, depth: f32) -> Solid {
    let turn = Affine3A::from_rotation_y(std::f32::consts::FRAC_PI_2);
    solid.transformed(turn).moved(Vec3::Z * -depth)
}

/// Adds a chimney about a place along x and z, from one height to another.
pub(super) fn chimney(kit: &mut Kit, [x, z]: [f32; 2], [low, high]: [f32; 2], paint: Paint) {
    kit.plank(paint, [x - 0.36, low, z - 0.27], [x + 0.36, high, z + 0.27]);
    kit.plank(Paint::Trim, [x - 0.43, high - 0.16, z - 0.34], [x + 0.43, high + 0.02, z + 0.34]);
    let pot = lathe(&[(0.12, high - 0.05), (0.09, high + 0.45)], 6);
    for side in [-0.17, 0.17] {
        kit.add(Paint::Brick, pot.clone().moved([x + side, 0.0, z]));
    }
}

/// Adds a dormer at `x` on the front slope of a roof whose ridge runs along x. The front wall is at z = 0.
pub(super) fn dormer(kit: &mut Kit, x: f32, roof: Saddle, [wall, tiles]: [Paint; 2]) {
    const HALF: f32 = 0.62;
    const BACK: f32 = 0.8;
    let foot = roof.eaves + BACK * roof.rise();
    let small = Saddle { half: HALF, eaves: foot + 1.25, ridge: foot + 1.75, over: 0.14 };
    let length = 1.9 / roof.rise();
    let middle = Vec3::new(x, 0.0, -BACK - length / 2.0);
    kit.add(wall, gabled(HALF, [foot - 0.25, small.eaves, small.ridge], length).moved(middle));
    kit.add(tiles, small.slopes(length + 0.2).moved(middle + Vec3::Z * 0.06));
    let front = -BACK;
    kit.plank(Paint::Frame, [x - 0.42, foot + 0.26, front - 0.05], [x + 0.42, foot + 1.2, front + 0.03]);
    for [left, right] in [[-0.36, -0.03], [0.03, 0.36]] {
        kit.plank(Paint::Glass, [x + left, foot + 0.33, front - 0.03], [x + right, foot + 1.13, front + 0.04]);
    }
    kit.plank(Paint::Trim, [x - 0.5, foot + 0.16, front - 0.05], [x + 0.5, foot + 0.265, front + 0.1]);
}

/// Builds a gutter along x below the eaves, with its rear edge at `z`, and a pipe to the ground at its right end.
pub(super) fn gutter(half: f32, z: f32, height: f32) -> Solid {
    let trough = [(z, height - 0.1), (z + 0.04, height - 0.13), (z + 0.12, height - 0.11), (z + 0.13, height)];
    let trough = across(&[&trough[..], &[(z, height)]].concat(), 2.0 * half - 0.02);
    let x = half - 0.14;
    let pipe = plank([x - 0.045, -0.05, 0.03], [x + 0.045, height - 0.32, 0.12]);
    let bend = across(
        &[(0.03, height - 0.4), (0.12, height - 0.4), (z + 0.12, height - 0.11), (z + 0.03, height - 0.11)],
        0.08,
    );
    trough.with(pipe).with(bend.moved(Vec3::X * x))
}
