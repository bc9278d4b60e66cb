//! Plan of the town: the lines that houses, streets and the square share, in metres.
//!
//! The main street runs along z on both sides of the square. North is -z, east is +x.

/// Half of the main street's width, from its middle to the fronts.
pub(super) const STREET: f32 = 5.5;
/// Northern edge of the square along z: the fronts of the church and of its neighbour.
pub(super) const NORTH: f32 = -36.0;
/// Southern edge of the square along z.
pub(super) const SOUTH: f32 = 13.0;
/// Southern edge of the garden in the south-western corner of the square along z.
pub(super) const GARDEN: f32 = 27.0;
/// Western edge of the square along x: the front of the town hall.
pub(super) const WEST: f32 = -21.0;
/// Eastern edge of the square along x.
pub(super) const EAST: f32 = 19.0;
/// Southern end of the main street along z.
pub(super) const START: f32 = 62.0;
/// Northern end of the main street along z: the far end of the depth range.
pub(super) const END: f32 = -200.0;
/// Where the gate tower spans the main street along z.
pub(super) const GATE: f32 = -156.0;
/// Half of the gate tower's depth.
pub(super) const GATE_HALF: f32 = 4.0;
/// Half of the width of the cobbled town; meadow lies beyond.
pub(super) const TOWN: f32 = 24.0;
/// Height of the pavement above the cobbles.
pub(super) const KERB: f32 = 0.12;
/// Depth of a house from its front to its rear wall.
pub(super) const DEPTH: f32 = 9.0;

/// A line of house fronts from one corner to another, along x and z in metres. The fronts face right of the way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// Corner where the row begins.
    pub(super) from: [f32; 2],
    /// Corner where the row ends.
    pub(super) to: [f32; 2],
    /// Whether the side wall at each end is in sight and has windows.
    pub(super) flanks: [bool; 2],
    /// Greatest number of floors. Houses between the sun and the street are lower, so that light reaches the cobbles.
    pub(super) floors: usize,
    /// Whether the houses are near the square and have recessed windows.
    pub(super) is_near: bool,
}

const fn row(from: [f32; 2], to: [f32; 2], floors: usize, flanks: [bool; 2], is_near: bool) -> Row {
    Row { from, to, flanks, floors, is_near }
}

/// All rows of houses along the streets and around the square. Gaps between rows are side streets.
pub(super) const ROWS: [Row; 18] = [
    // South of the square, west and east of the street.
    row([-STREET, START], [-STREET, 36.0], 2, [true, false], false),
    row([-STREET, 36.0], [-STREET, GARDEN], 2, [false, true], false),
    row([STREET, SOUTH], [STREET, 25.0], 2, [true, false], true),
    row([STREET, 25.0], [STREET, START], 4, [false, true], false),
    // Around the square: south-west, south-east, west, east, north.
    row([-STREET - DEPTH, GARDEN], [WEST, GARDEN], 2, [false, false], true),
    row([EAST, SOUTH], [STREET + DEPTH, SOUTH], 2, [false, false], true),
    row([WEST, GARDEN], [WEST, 8.3], 2, [false, false], true),
    row([WEST, -22.5], [WEST, NORTH], 3, [true, false], true),
    row([EAST, NORTH], [EAST, -17.0], 4, [false, false], true),
    row([EAST, -12.5], [EAST, SOUTH], 4, [false, false], true),
    row([STREET + DEPTH, NORTH], [STREET + DEPTH + 8.5, NORTH], 4, [false, false], true),
    // North of the square, east of the street.
    row([STREET, -64.0], [STREET, NORTH], 4, [false, true], true),
    row([STREET, -104.0], [STREET, -68.5], 4, [true, false], false),
    row([STREET, GATE + GATE_HALF], [STREET, -108.5], 4, [false, true], false),
    // North of the church, west of the street.
    row([-STREET, -78.0], [-STREET, -115.0], 2, [true, true], false),
    row([-STREET, -119.5], [-STREET, GATE + GATE_HALF], 2, [true, false], false),
    // Beyond the gate.
    row([STREET, END], [STREET, GATE - GATE_HALF], 4, [true, false], false),
    row([-STREET, GATE - GATE_HALF], [-STREET, END], 2, [false, true], false),
];
