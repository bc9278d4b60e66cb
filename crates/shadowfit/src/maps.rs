//! The maps of one frame.

use core::ops::Deref;

use crate::settings::MAX_MAPS;
use crate::{Bias, GridAnchor, LightFit};

/// One of several maps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FittedMap {
    /// The map's matrices and box.
    pub fit: LightFit,
    /// The technique's biases for this map's texels and depth range.
    pub bias: Bias,
    /// View depth from which points choose this map, in metres.
    pub near: f32,
    /// View depth up to which points choose this map, in metres: they take the first map that ends
    /// beyond them. The last one has no end. Where splits coincide there is no range: such maps end
    /// at `f32::MIN` before all others, and begin at `f32::MAX` after them.
    pub far: f32,
    /// View depth from which this map covers what is seen, in metres: before `near` where the
    /// maps overlap.
    pub covered_near: f32,
    /// Where the map lies on the world's grid, if it does: what [`Scroll`](crate::Scroll) and
    /// [tiles](crate::scroll::tiles) are made from.
    pub anchor: Option<GridAnchor>,
}

/// The maps of one frame, nearest first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FittedMaps {
    maps: [FittedMap; MAX_MAPS],
    count: usize,
}

impl FittedMaps {
    /// The maps of a number of ranges, to be written.
    pub(crate) fn take(&mut self, count: usize) -> &mut [FittedMap] {
        self.count = count;
        &mut self.maps[..count]
    }
}

impl Deref for FittedMaps {
    type Target = [FittedMap];

    fn deref(&self) -> &[FittedMap] {
        // A number that was read from a file may be any.
        &self.maps[..self.count.min(MAX_MAPS)]
    }
}

/// Keeps maps without a range from being chosen, by rounded depths too: those before all others end
/// nowhere, those after them begin nowhere, and the last one with a range has no end.
pub(crate) fn set_empty_ranges_apart(maps: &mut [FittedMap]) {
    for map in maps.iter_mut().take_while(|map| map.near >= map.far) {
        map.far = f32::MIN;
    }
    for map in maps.iter_mut().rev() {
        if map.near < map.far {
            map.far = f32::MAX;
            break;
        }
        (map.near, map.covered_near) = (f32::MAX, f32::MAX);
    }
}
