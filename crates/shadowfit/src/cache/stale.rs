//! Errors of waiting maps: the old and new places of casters that moved since these maps were drawn.

use alloc::vec::Vec;

use super::MapCache;
use super::casters::Casters;
use super::plan::MapReuse;
use super::world_box::WorldBox;

/// A waiting map that shows outdated shadows.
#[derive(Clone, Debug, PartialEq)]
pub struct StaleMap {
    /// Index of the map.
    pub map: usize,
    /// Boxes of the casters that moved since the map was drawn, at their old and new places. `None` if static
    /// casters changed as well.
    pub boxes: Option<Vec<WorldBox>>,
}

impl MapCache {
    /// Writes the errors of the maps that wait in the last [update](Self::update), with that update's
    /// casters. Tracers of exact edges need them.
    pub fn find_stale(&self, casters: &Casters<'_>, stale: &mut Vec<StaleMap>) {
        stale.clear();
        let moves = !self.known.moving.is_empty();
        for (index, reuse) in self.plan.reuse.iter().enumerate() {
            let Some(drawn) = self.maps[index].layers.drawn().filter(|_| *reuse == MapReuse::Waits) else { continue };
            let is_changed = drawn.changed.texels() > 0;
            if !(is_changed || moves || !drawn.moving.is_empty()) {
                continue;
            }
            let boxes = casters.boxes;
            let moving = self.known.moving.iter().filter_map(|number| boxes.boxes.get(*number as usize));
            let now = moving.map(|aabb| WorldBox::new(aabb, boxes.origin));
            let both = drawn.moving.iter().copied().chain(now).filter(|aabb| !aabb.is_empty());
            stale.push(StaleMap { map: index, boxes: (!is_changed).then(|| both.collect()) });
        }
    }
}
