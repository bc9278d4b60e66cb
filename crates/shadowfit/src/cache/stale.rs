//! The errors of maps that wait for another frame: where casters were when they were drawn, and where they are.

use alloc::vec::Vec;

use super::MapCache;
use super::casters::Casters;
use super::plan::MapReuse;
use super::world_box::WorldBox;

/// A map that waits for another frame and shows something wrongly.
#[derive(Clone, Debug, PartialEq)]
pub struct StaleMap {
    /// Index of the map.
    pub map: usize,
    /// Boxes around the casters that moved since it was drawn, where they were and where they are; `None` where static
    /// casters changed as well.
    pub boxes: Option<Vec<WorldBox>>,
}

impl MapCache {
    /// Writes the errors of the maps that wait in the last [update](Self::update), whose casters these are. Tracers of
    /// exact edges need them.
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
