//! Everything on a house's front: windows, doors, shops, awnings, balconies, cornices.

use super::front::{Finish, door, far_window, flower_box, shop_window, window};
use super::house::{Detail, FOOT, Ground, House, INSET, Top};
use super::kit::{Kit, across};
use super::palette::Paint;
use crate::parts::Solid;

/// Half of a door's width, in metres.
const DOOR: f32 = 0.55;
/// Height of the sill of a shop window, in metres.
const SHOP_SILL: f32 = 0.6;
/// Reach of awnings over the pavement, in metres.
const AWNING: f32 = 1.35;

/// Returns the left and right ends of the openings of the ground floor, the door's last for shops.
pub(super) fn ground_gaps(house: &House) -> Vec<[f32; 2]> {
    let half = house.width / 2.0;
    if house.shop == Ground::Shop {
        let door = half - 0.95;
        return vec![[-half + 0.5, door - DOOR - 0.5], [door - DOOR, door + DOOR]];
    }
    let mut columns = house.columns();
    let index = door_column(house);
    let middle = f32::midpoint(columns[index][0], columns[index][1]);
    columns[index] = [middle - DOOR, middle + DOOR];
    columns
}

/// Returns the number of the opening that is the door.
fn door_column(house: &House) -> usize {
    let last = house.columns().len() - 1;
    match house.shop {
        Ground::Shop => 1,
        Ground::Home if house.shift < 0.0 => 0,
        Ground::Home => last,
    }
}

/// Returns the left and right ends of the plinth's parts: everything but the door.
pub(super) fn plinth_parts(house: &House) -> [[f32; 2]; 2] {
    let half = house.width / 2.0 - INSET;
    let [left, right] = ground_gaps(house)[door_column(house)];
    [[-half, left - 0.2], [right + 0.2, half]]
}

/// Returns the places of dormers along the front.
pub(super) fn dormer_places(house: &House) -> Vec<f32> {
    let count = if house.pitch < 0.72 || house.detail != Detail::Near { 0 } else { (house.width / 3.2) as usize };
    let step = house.width / count.max(1) as f32;
    (0..count).map(|index| (index as f32 + 0.5) * step - house.width / 2.0).collect()
}

/// Adds everything to the front.
pub(super) fn dress(kit: &mut Kit, house: &House) {
    if house.detail == Detail::Near {
        ground_floor(kit, house);
    } else {
        flat_ground_floor(kit, house);
    }
    for floor in 1..house.floors {
        for gap in house.columns() {
            if house.detail == Detail::Near {
                let heights = house.window_heights(floor);
                window(kit, gap, heights, house.finish);
                if floor == 1 && matches!(house.finish, Finish::Shutters(_)) && !house.has_balcony {
                    flower_box(kit, gap, heights[0]);
                }
            } else {
                far_window(kit, gap, house.window_heights(floor), house.detail == Detail::Street);
            }
        }
    }
    let half = house.width / 2.0 - INSET;
    if house.finish != Finish::Timbers && house.detail != Detail::Back {
        let y = house.ground - 0.1;
        kit.plank(Paint::Trim, [-half, y, -0.07], [half, y + 0.16, 0.07]);
        if house.top == Top::Eaves {
            let eaves = house.eaves() - 0.36;
            kit.plank(Paint::Trim, [-half, eaves - 0.14, -0.08], [half, eaves, 0.1]);
            kit.plank(Paint::Trim, [-half, eaves - 0.01, -0.09], [half, eaves + 0.16, 0.2]);
        }
    }
    if house.shop == Ground::Shop {
        let [left, right] = ground_gaps(house)[0];
        kit.add(Paint::Stripe, awning([left - 0.1, right + 0.1], house.ground - 0.22));
    } else if house.has_balcony {
        balcony(kit, house);
    }
}

/// Adds the recessed openings of the ground floor, with the wall below its windows.
fn ground_floor(kit: &mut Kit, house: &House) {
    let is_door = |index: usize| index == door_column(house);
    for (index, gap) in ground_gaps(house).into_iter().enumerate() {
        let [left, right] = gap;
        if is_door(index) {
            door(kit, gap, 2.6, house.leaf);
            continue;
        }
        let sill = if house.shop == Ground::Shop { SHOP_SILL } else { 0.95 };
        kit.plank(house.wall, [left, 0.0, -super::front::WALL], [right, sill, 0.0]);
        if house.shop == Ground::Shop {
            shop_window(kit, gap, [sill, 2.6], house.leaf);
        } else {
            let finish = if house.finish == Finish::Timbers { Finish::Surround } else { house.finish };
            window(kit, gap, [sill, 2.6], finish);
        }
    }
}

/// Adds the ground floor of a far house, without recesses.
fn flat_ground_floor(kit: &mut Kit, house: &House) {
    for (index, [left, right]) in ground_gaps(house).into_iter().enumerate() {
        if index == door_column(house) {
            kit.plank(house.leaf, [left, FOOT, -0.04], [right, 2.3, 0.04]);
            kit.plank(Paint::Trim, [left - 0.2, 2.29, -0.05], [right + 0.2, 2.5, 0.12]);
        } else {
            far_window(kit, [left, right], [0.9, 2.5], house.detail == Detail::Street);
        }
    }
}

/// Builds a striped awning between two ends along the front, from a height.
fn awning([left, right]: [f32; 2], height: f32) -> Solid {
    let drop = 0.52;
    let cloth = [(0.05, height - 0.04), (AWNING, height - drop - 0.03), (AWNING, height - drop), (0.05, height)];
    let edge = height - drop;
    let hem =
        [(AWNING - 0.001, edge - 0.28), (AWNING + 0.02, edge - 0.28), (AWNING + 0.02, edge), (AWNING - 0.001, edge)];
    let middle = [f32::midpoint(left, right), 0.0, 0.0];
    across(&cloth, right - left).with(across(&hem, right - left)).moved(middle)
}

/// Adds a balcony with a railing below the first floor's middle windows.
fn balcony(kit: &mut Kit, house: &House) {
    let columns = house.columns();
    let first = columns[(columns.len() - 1) / 2];
    let last = columns[columns.len() / 2];
    let (left, right, deep) = (first[0] - 0.5, last[1] + 0.5, 0.95);
    let floor = house.ground + 0.12;
    kit.plank(Paint::Trim, [left, floor, -0.1], [right, floor + 0.13, deep]);
    for x in [left + 0.35, right - 0.55] {
        kit.plank(Paint::Trim, [x, floor - 0.36, -0.05], [x + 0.2, floor + 0.01, 0.55]);
    }
    let [foot, head] = [floor + 0.13, floor + 1.05];
    let (low, high) = ([left + 0.04, 0.0], [right - 0.04, deep - 0.05]);
    for y in [foot + 0.07, head] {
        kit.plank(Paint::Iron, [low[0], y - 0.02, high[1] - 0.02], [high[0], y + 0.02, high[1] + 0.02]);
        for x in [low[0], high[0]] {
            kit.plank(Paint::Iron, [x - 0.018, y - 0.018, -0.03], [x + 0.018, y + 0.018, high[1]]);
        }
    }
    let bar = |kit: &mut Kit, x: f32, z: f32| {
        kit.plank(Paint::Iron, [x - 0.009, foot - 0.02, z - 0.009], [x + 0.009, head, z + 0.009]);
    };
    let spacing = if house.detail == Detail::Near { 0.13 } else { 0.3 };
    let count = ((high[0] - low[0]) / spacing) as usize;
    for index in 0..=count {
        bar(kit, low[0] + (high[0] - low[0]) * index as f32 / count as f32, high[1]);
    }
    let deep_count = (0.84 / spacing) as usize;
    for index in 0..deep_count {
        for x in [low[0], high[0]] {
            bar(kit, x, 0.06 + spacing * index as f32);
        }
    }
}
