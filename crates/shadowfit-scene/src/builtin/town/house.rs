//! Plan of a house, drawn by dice.
//!
//! A house is modelled with its front at z = 0, which faces +z, its middle at x = 0 and the pavement at y = 0.

use super::front::Finish;
use super::palette::Paint;
use super::plan::DEPTH;
use super::roof::Saddle;
use crate::parts::Dice;

/// Foot of the walls, in metres below the pavement: deep enough without a pavement too.
pub(super) const FOOT: f32 = -0.3;
/// Distance of trim from the ends of a front, in metres, so that its ends do not lie in the side walls.
pub(super) const INSET: f32 = 0.01;

/// Shape of a house's top as seen from the street.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Top {
    /// The ridge follows the street.
    Eaves,
    /// The ridge meets the street in a gable below the roof's overhang.
    Gable,
    /// The gable rises above the roof in steps.
    Steps,
}

/// Use of a ground floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ground {
    /// A door among windows.
    Home,
    /// A shop window with an awning, and a door.
    Shop,
}

/// Level of detail of a house, by its distance from the square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Detail {
    /// Recessed windows, a panelled door, gutters.
    Near,
    /// Raised windows with sills.
    Street,
    /// Raised windows alone, behind the rows.
    Back,
}

/// Plan of a house. All lengths are in metres.
#[derive(Clone, Debug)]
pub(super) struct House {
    /// Width of the front.
    pub(super) width: f32,
    /// Floors below the eaves, 2 to 4.
    pub(super) floors: usize,
    /// Height of the ground floor.
    pub(super) ground: f32,
    /// Height of each other floor.
    pub(super) storey: f32,
    /// Slope of the roof, in radians.
    pub(super) pitch: f32,
    /// Shape of the top.
    pub(super) top: Top,
    /// Use of the ground floor.
    pub(super) shop: Ground,
    /// Finish of the upper windows.
    pub(super) finish: Finish,
    /// Paint of the walls.
    pub(super) wall: Paint,
    /// Paint of the roof.
    pub(super) tiles: Paint,
    /// Paint of doors, shutters and signs.
    pub(super) leaf: Paint,
    /// Whether a balcony is below a first-floor window.
    pub(super) has_balcony: bool,
    /// Whether the left and the right wall have windows.
    pub(super) flanks: [bool; 2],
    /// Place of the chimney and the dormers along the front, as a share of half the width.
    pub(super) shift: f32,
    /// Level of detail.
    pub(super) detail: Detail,
}

impl House {
    /// Returns the height at which the front meets the roof.
    pub(super) fn eaves(&self) -> f32 {
        self.ground + self.storey * (self.floors - 1) as f32 + 0.1
    }

    /// Returns the roof, about its own ridge.
    pub(super) fn saddle(&self) -> Saddle {
        let (half, over) = match self.top {
            Top::Eaves => (DEPTH / 2.0, 0.42),
            Top::Gable => (self.width / 2.0, 0.16),
            Top::Steps => (self.width / 2.0, 0.08),
        };
        let eaves = self.eaves();
        Saddle { half, eaves, ridge: eaves + half * self.pitch.tan(), over }
    }

    /// Returns the lower and the upper end of the windows of a floor. Floor 0 is the ground floor.
    pub(super) fn window_heights(&self, floor: usize) -> [f32; 2] {
        if floor == 0 {
            return [0.95, 2.5];
        }
        let foot = self.ground + self.storey * (floor - 1) as f32;
        [foot + 0.85, foot + self.storey - 0.5]
    }

    /// Returns the left and right ends of the windows of each upper floor.
    pub(super) fn columns(&self) -> Vec<[f32; 2]> {
        let count = (self.width / 2.25).floor().max(2.0);
        let (step, half) = (self.width / count, 0.47);
        let column = |index: usize| (index as f32 + 0.5) * step - self.width / 2.0;
        (0..count as usize).map(column).map(|x| [x - half, x + half]).collect()
    }
}

/// Paints of walls, from which no two neighbours take the same.
const WALLS: [Paint; 7] = [Paint::Cream, Paint::Rose, Paint::Lime, Paint::Ochre, Paint::Sage, Paint::Sky, Paint::Brick];
/// Paints of doors and shutters.
const LEAVES: [Paint; 4] = [Paint::Green, Paint::Blue, Paint::Oxblood, Paint::Oak];

/// Draws the plan of a house of a width; `wall` is the number of its wall's paint.
pub(super) fn roll(dice: &mut Dice, width: f32, wall: usize) -> House {
    let mut pick = |chances: &[f32]| {
        let roll = dice.roll();
        chances.iter().position(|&chance| roll < chance).unwrap_or(chances.len())
    };
    let top = [Top::Eaves, Top::Gable, Top::Steps][pick(&[0.5, 0.82])];
    let floors = 2 + pick(&[0.25, 0.8]);
    let shop = [Ground::Shop, Ground::Home][pick(&[0.45])];
    let leaf = LEAVES[pick(&[0.3, 0.55, 0.8])];
    let tiles = [Paint::Tile, Paint::OldTile, Paint::Slate][pick(&[0.55, 0.9])];
    let finish = [Finish::Surround, Finish::Shutters(leaf), Finish::Timbers][pick(&[0.45, 0.75])];
    let finish = if top == Top::Steps { Finish::Surround } else { finish };
    let has_balcony = pick(&[0.28]) == 0 && shop == Ground::Home && finish != Finish::Timbers;
    let wall =
        if finish == Finish::Timbers { [Paint::Lime, Paint::Cream][wall % 2] } else { WALLS[wall % WALLS.len()] };
    let pitch = if top == Top::Eaves { dice.between(0.68, 0.82) } else { dice.between(0.84, 1.0) };
    House {
        width,
        floors: if top == Top::Eaves { floors } else { floors.min(3) },
        ground: dice.between(3.25, 3.6),
        storey: dice.between(2.7, 3.05),
        pitch,
        top,
        shop,
        finish,
        wall,
        tiles,
        leaf,
        has_balcony,
        flanks: [false; 2],
        shift: dice.between(-1.0, 1.0),
        detail: Detail::Near,
    }
}
