//! The ground: cobbles in the streets, pavements with kerbs, paving of the square, meadow and hills around.

use glam::Vec3;

use super::palette::Paint;
use super::plan::{EAST, END, GARDEN, GATE, GATE_HALF, KERB, NORTH, ROWS, Row, SOUTH, START, STREET, TOWN, WEST};
use crate::Primitive;
use crate::parts::{Builder, CRISP, SMOOTH, Solid, ease, graded, ground, lathe, plank};

/// Half of the land's width, in metres.
const HALF: f32 = 150.0;
/// Distance of the cobbles beyond the ends of the main street, in metres.
const BEYOND: f32 = 6.0;
/// Width of a pavement, in metres.
const PAVEMENT: f32 = 1.9;
/// Width of a kerb stone, in metres.
const STONE: f32 = 0.18;
/// Depth of the meadow below the cobbles, in metres.
const LOWER: f32 = 0.04;

/// Adds the ground.
pub(super) fn build(builder: &mut Builder) {
    builder.lay("cobbles", cobbles());
    builder.lay("meadow", meadow());
    let group = builder.group("pavements", Vec3::ZERO, 0.0);
    let strips = || ROWS.iter().enumerate().filter(|(_, row)| has_pavement(row));
    let slabs: Solid = strips().map(|(_, row)| strip(row, [STONE, PAVEMENT], KERB)).collect();
    let kerbs: Solid = strips().map(|(_, row)| strip(row, [0.0, STONE], KERB + 0.015)).collect();
    builder.fix(group, "slabs", &slabs, Paint::Slab, CRISP);
    builder.fix(group, "kerbs", &kerbs, Paint::Granite, CRISP);
    let ring = lathe(&[(3.9, -0.1), (3.9, 0.02), (0.0, 0.02)], 48);
    let bands = lathe(&[(6.3, -0.1), (6.3, 0.012), (5.9, 0.012), (5.9, -0.1)], 64);
    builder.fix(group, "paving", &ring, Paint::Slab, CRISP);
    builder.fix(group, "paving band", &bands, Paint::Granite, CRISP);
    let lawn = plank([-19.6, -0.1, SOUTH + 0.75], [-6.2, 0.05, GARDEN - 0.4]);
    builder.fix(group, "lawn", &lawn, Paint::Lawn, CRISP);
    builder.fix(group, "gutters", &gutters(), Paint::Granite, SMOOTH);
}

/// Returns whether a row of houses has a pavement along its fronts.
fn has_pavement(row: &Row) -> bool {
    row.from[0] == row.to[0]
}

/// Builds a strip along the fronts of a row, between two distances from the pavement's outer edge, up to a height.
fn strip(row: &Row, [from, to]: [f32; 2], height: f32) -> Solid {
    let x = row.from[0];
    // Fronts that follow -z face east.
    let side = if row.to[1] < row.from[1] { 1.0 } else { -1.0 };
    let ends = [PAVEMENT - from, PAVEMENT - to - 0.05].map(|out| x + side * out);
    let (low, high) = (row.from[1].min(row.to[1]), row.from[1].max(row.to[1]));
    plank([ends[0].min(ends[1]), -0.1, low], [ends[0].max(ends[1]), height, high])
}

/// Builds two lines of flat stones along the main street, where rain runs off.
fn gutters() -> Solid {
    let line = |[from, to]: [f32; 2]| plank([2.4, -0.1, from], [2.75, 0.012, to]).and_mirrored();
    [[SOUTH, START], [GATE + GATE_HALF + 1.0, NORTH], [END, GATE - GATE_HALF - 1.0]].into_iter().map(line).collect()
}

/// Builds the cobbles: level, a little darker where carts pass less.
fn cobbles() -> Primitive {
    let xs: Vec<f32> = [-1.0, -0.9, 0.9, 1.0].map(|share| share * TOWN).to_vec();
    let xs = [xs[0], WEST, -STREET, 0.0, STREET, EAST, xs[3]];
    let count = 54;
    let zs: Vec<f32> =
        (0..=count).map(|row| END - BEYOND + (START + 2.0 * BEYOND - END) * row as f32 / count as f32).collect();
    ground(
        Paint::Cobble.into(),
        [&xs, &zs],
        |_, _| 0.0,
        |at| {
            let worn = 0.06 * (0.21 * at.z).sin() * (0.13 * at.x + 0.4).cos();
            Vec3::new(0.94, 0.93, 0.92) + worn - if at.x.abs() > STREET + 1.0 && at.z < NORTH { 0.2 } else { 0.0 }
        },
    )
}

/// Returns the height of the meadow and the hills at a place, in metres.
pub(super) fn height(x: f32, z: f32) -> f32 {
    let (north, south) = (END - BEYOND - 8.0, START + BEYOND + 8.0);
    let out = ease(x.abs(), 62.0, HALF) + ease(north - z, 0.0, 110.0) + ease(z - south, 0.0, 70.0);
    out * (10.0 + 4.0 * (0.035 * z + 0.02 * x).sin() + 2.0 * (0.05 * x - 0.02 * z).cos()) - LOWER
}

/// Builds meadow and hills on all sides of the cobbles.
fn meadow() -> Primitive {
    let outer = graded(HALF, 12, 0.4);
    let middle = [-TOWN, TOWN];
    let mut xs: Vec<f32> = outer.into_iter().filter(|x| x.abs() > TOWN + 1.0).chain(middle).collect();
    xs.sort_by(f32::total_cmp);
    let (north, south) = (END - BEYOND, START + BEYOND);
    let mut zs: Vec<f32> = (0..24).map(|step| -320.0 + 20.0 * step as f32).chain([north, south]).collect();
    zs.sort_by(f32::total_cmp);
    let tint = |at: Vec3| {
        let dry = 0.5 + 0.5 * (0.06 * at.x + 0.045 * at.z).sin();
        Vec3::new(0.85, 0.95, 0.8).lerp(Vec3::new(1.15, 1.0, 0.75), dry)
    };
    let mut meadow = ground(Paint::Meadow.into(), [&xs, &zs], height, tint);
    let is_outside = |triangle: &[u32]| {
        let middle = triangle.iter().map(|&index| meadow.positions[index as usize]).sum::<Vec3>() / 3.0;
        middle.x.abs() > TOWN || middle.z < north || middle.z > south
    };
    meadow.indices =
        meadow.indices.chunks_exact(3).filter(|triangle| is_outside(triangle)).flatten().copied().collect();
    meadow
}
