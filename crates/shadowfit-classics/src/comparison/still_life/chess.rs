//! The chess board and its pieces, large enough to walk on.

use glam::Vec3;
use shadowfit_scene::Primitive;
use shadowfit_scene::parts::{Builder, CRISP, Solid, block, ellipsoid, lathe, rounded_box};

use super::SUNK;
use super::knight;
use super::palette::Paint;
use super::textures::SQUARES_METRES;

/// Side of a square, in metres.
const SQUARE: f32 = SQUARES_METRES / 2.0;
/// Height of the squares above the floor, in metres.
const TOP: f32 = 0.12;
/// Half of the width of all squares, in metres.
const HALF: f32 = SQUARE * 3.0;
/// Middle of the board, in metres, and its turn.
const BOARD: (Vec3, f32) = (Vec3::new(-1.85, 0.0, 1.55), 0.18);
/// Crease angle of turned wood, in radians. Sharper edges are hard.
const TURNED: f32 = 0.7;

/// Adds board and pieces.
pub(super) fn build(builder: &mut Builder, group: usize) {
    let primitives =
        vec![squares().primitive(Paint::Squares.into(), CRISP), frame().primitive(Paint::Frame.into(), CRISP)];
    let board = builder.mesh("chess board", primitives);
    let board = builder.place(group, board, BOARD.0, BOARD.1);
    let mut piece = |name: &str, primitive: Primitive, [file, rank]: [f32; 2], yaw: f32| {
        let mesh = builder.mesh(name, vec![primitive]);
        let at = Vec3::new((file - 2.5) * SQUARE, TOP - SUNK, (rank - 2.5) * SQUARE);
        builder.place(board, mesh, at, yaw);
    };
    let (ivory, ebony) = (Paint::Ivory.into(), Paint::Ebony.into());
    piece("king", king().primitive(ivory, TURNED), [1.0, 1.0], 0.25);
    piece("knight", knight::solid(&foot(1.05)).primitive(ebony, 1.0), [3.0, 2.0], 1.0);
    piece("rook", rook().primitive(ebony, TURNED), [4.0, 0.0], 0.1);
    let pawn = pawn();
    for (index, square) in [[0.0, 3.0], [2.0, 4.0], [5.0, 5.0]].into_iter().enumerate() {
        piece(["pawn", "second pawn", "third pawn"][index], pawn.primitive(ivory, TURNED), square, 0.0);
    }
    piece("black pawn", pawn.primitive(ebony, TURNED), [5.0, 3.0], 0.0);
}

/// Builds six by six squares, a part of a board.
fn squares() -> Solid {
    block([-HALF, -SUNK, -HALF], [HALF, TOP, HALF], 0.005)
}

/// Builds the rim around the squares.
fn frame() -> Solid {
    let (inner, outer, high) = (HALF - 0.01, HALF + 0.13, TOP + 0.03);
    let long = |sign: f32| {
        let [a, b] = [inner * sign, outer * sign];
        block(Vec3::new(-outer, -SUNK, a.min(b)), Vec3::new(outer, high, a.max(b)), 0.02)
    };
    let short = |sign: f32| {
        let [a, b] = [inner * sign, outer * sign];
        block(Vec3::new(a.min(b), -SUNK * 1.5, -inner - 0.02), Vec3::new(a.max(b), high - 0.002, inner + 0.02), 0.02)
    };
    long(1.0).with(long(-1.0)).with(short(1.0)).with(short(-1.0))
}

/// Returns the profile of a piece's turned foot, upwards to its neck, scaled.
fn foot(size: f32) -> Vec<(f32, f32)> {
    let profile = [
        (0.205, 0.0),
        (0.215, 0.02),
        (0.215, 0.055),
        (0.20, 0.075),
        (0.175, 0.09),
        (0.18, 0.115),
        (0.165, 0.145),
        (0.135, 0.17),
        (0.13, 0.185),
    ];
    profile.map(|(radius, height)| (radius * size, height * size)).to_vec()
}

/// Builds a king, with a cross on his crown.
fn king() -> Solid {
    let stem = [(0.112, 0.28), (0.094, 0.42), (0.082, 0.58), (0.08, 0.72), (0.088, 0.80)];
    let collar =
        [(0.15, 0.815), (0.155, 0.83), (0.14, 0.85), (0.105, 0.86), (0.125, 0.875), (0.125, 0.89), (0.088, 0.90)];
    let crown =
        [(0.088, 0.94), (0.115, 1.06), (0.15, 1.17), (0.155, 1.19), (0.14, 1.205), (0.075, 1.25), (0.04, 1.265)];
    let knob = [(0.052, 1.285), (0.05, 1.31), (0.03, 1.325), (0.0, 1.328)];
    let turned = lathe(&[&foot(1.0)[..], &stem, &collar, &crown, &knob].concat(), 40);
    let bar = |half: Vec3, y: f32| rounded_box(half, 0.012, 2).moved(Vec3::Y * y);
    turned.with(bar(Vec3::new(0.026, 0.10, 0.022), 1.40)).with(bar(Vec3::new(0.075, 0.025, 0.0215), 1.425))
}

/// Builds a rook with six merlons.
fn rook() -> Solid {
    let tower = [(0.12, 0.26), (0.108, 0.42), (0.108, 0.56), (0.12, 0.62)];
    let top = [
        (0.15, 0.64),
        (0.155, 0.66),
        (0.14, 0.675),
        (0.165, 0.73),
        (0.165, 0.775),
        (0.115, 0.775),
        (0.11, 0.73),
        (0.0, 0.725),
    ];
    let merlon = block([-0.045, 0.755, 0.112], [0.045, 0.845, 0.163], 0.008);
    lathe(&[&foot(0.98)[..], &tower, &top].concat(), 40).with(merlon.around(6))
}

/// Builds a pawn.
fn pawn() -> Solid {
    let stem = [
        (0.085, 0.24),
        (0.066, 0.34),
        (0.058, 0.44),
        (0.062, 0.48),
        (0.11, 0.50),
        (0.115, 0.515),
        (0.10, 0.53),
        (0.055, 0.54),
    ];
    let neck = [(0.05, 0.56), (0.06, 0.60)];
    let head = ellipsoid(Vec3::splat(0.112), 28, 18).moved(Vec3::Y * 0.65);
    lathe(&[&foot(0.8)[..], &stem, &neck].concat(), 32).with(head)
}
