//! What the maps that wait for another frame show wrongly: where casters were when they were drawn, and where they are.

use super::casters::WorldBox;
use super::{CacheFrame, Choice, Decision, MapCache};

/// A map that waits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct StaleMap {
    /// Its number.
    pub(crate) map: usize,
    /// Boxes around the casters that moved since it was drawn, where they were and where they are; `None` where static
    /// ones changed as well.
    pub(crate) boxes: Option<Vec<WorldBox>>,
}

impl MapCache {
    /// Finds them, between the choice and the plan of a frame.
    pub(crate) fn find_stale(&self, choice: &Choice, frame: &CacheFrame<'_>, stale: &mut Vec<StaleMap>) {
        stale.clear();
        for (index, decision) in choice.decisions.iter().enumerate() {
            let map = &self.maps[index];
            if *decision != Decision::Wait || (map.changed.texels() == 0 && map.moving.is_empty() && !self.moves()) {
                continue;
            }
            let boxes = frame.casters.boxes;
            let moving = self.known.moving.iter().filter_map(|number| boxes.boxes.get(*number as usize));
            let now = moving.map(|aabb| WorldBox::new(aabb, boxes.origin));
            let both = map.moving.iter().copied().chain(now).filter(|aabb| !aabb.is_empty());
            stale.push(StaleMap { map: index, boxes: (map.changed.texels() == 0).then(|| both.collect()) });
        }
    }

    /// Whether any caster moves.
    fn moves(&self) -> bool {
        !self.known.moving.is_empty()
    }
}
