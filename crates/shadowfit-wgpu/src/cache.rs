//! Which parts of the maps can be kept from frame to frame, and which must be drawn.
//!
//! A map on the world's grid moves by whole texels, so its static casters are drawn once. [`MapCache`] decides without
//! a GPU: it compares a frame's maps and casters with those that were drawn, and lists the passes, each with rectangles
//! and casters.
//!
//! ```text
//!   a frame's casters ──▶ 1. take: which of them changed, and where in each map?
//!   and its maps      ──▶ 2. choose: kept, moved, or new? Which of them now?
//!                     ──▶ 3. plan: passes, pieces, casters
//! ```
//!
//! Static casters are drawn into rectangles that came into a map, or in which one of them changed. Where casters move,
//! the static ones have separate layers. The shown layer is restored from them where something moved in the frame
//! before; then moving casters are drawn over it. A map that is drawn as a whole is drawn once, all casters together,
//! into the shown layer; the static casters' own layer follows in the next frame that keeps the map.

mod casters;
#[cfg(any(test, fuzzing))]
mod fixtures;
#[cfg(any(test, fuzzing))]
pub(crate) mod fuzzed;
#[cfg(test)]
mod histories;
mod identity;
#[cfg(any(test, fuzzing))]
mod model;
mod plan;
mod price;
mod schedule;
#[cfg(feature = "rays")]
mod stale;
#[cfg(test)]
mod streams;
mod tiles;

use shadowfit::glam::{DVec3, IVec2, UVec2, Vec3};
use shadowfit::scroll::{Scroll, TexelRect};
use shadowfit::settings::MAX_MAPS;
use shadowfit::{Aabb, BoxTree, CasterVolume, FittedMap};

use casters::{Changes, KnownCasters, WorldBox};
use price::Price;
use schedule::Candidate;
use tiles::ChangedTiles;

pub use casters::Casters;
pub use plan::PassContent;
pub(crate) use plan::{FramePlan, Layer, PassPlan};
pub use schedule::UpdateSchedule;
#[cfg(feature = "rays")]
pub(crate) use stale::StaleMap;

/// A map that was new in this many frames in a row counts as one that cannot be kept: it is then drawn with the casters
/// of one frame alone, which are fewer.
const NEVER_KEPT: u8 = 2;

/// Gone casters that a waiting map remembers; the last one is a box around all others.
const MAX_GONE: usize = 64;

/// Which casters are drawn into maps. Pictures are the same either way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Culling {
    /// Casters that can cast a shadow into view, for maps that are redrawn and for casters that move
    /// ([`caster_volumes`](shadowfit::culling::caster_volumes)); those that the map can store, for maps that are kept.
    /// The default.
    #[default]
    Swept,
    /// Casters that the map can store.
    WholeMap,
    /// All casters, for comparison.
    Off,
}

/// Settings of the cache.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct CacheSettings {
    /// Whether anything is kept.
    pub(crate) caching: bool,
    /// Which casters are drawn.
    pub(crate) culling: Culling,
    /// Whether depth is clamped at the near plane.
    pub(crate) depth_clamp: bool,
    /// Whether points read the maps by coverage.
    pub(crate) by_coverage: bool,
    /// Width and height of the layers, in texels.
    pub(crate) layer: UVec2,
}

/// Remembers what each layer holds.
#[derive(Debug, Default)]
pub(crate) struct MapCache {
    pub(crate) settings: CacheSettings,
    pub(crate) schedule: UpdateSchedule,
    maps: [KeptMap; MAX_MAPS],
    known: KnownCasters,
    frame: u64,
    /// Whether static casters have separate layers: from the first moving caster on.
    is_split: bool,
}

/// The content of a map's layers.
#[derive(Debug, Default)]
struct KeptMap {
    /// The map that was fitted last: it decides which parts of the layer can be kept.
    fitted: Option<FittedMap>,
    /// The map as it was drawn.
    drawn: Option<FittedMap>,
    /// Whether the shown layer holds all static casters over it.
    is_kept: bool,
    /// Whether the static casters' own layer holds them too.
    is_split: bool,
    /// Where its left top texel is stored.
    wrap: UVec2,
    /// Frame in which it was drawn.
    frame: u64,
    /// Number of frames in a row in which it was new.
    renewals: u8,
    /// Static casters over it when it was drawn as a whole.
    over: usize,
    /// Where static casters changed since, in the map as it was drawn.
    changed: ChangedTiles,
    /// Static casters that it shows and that are gone.
    gone: Vec<WorldBox>,
    /// Moving casters that the shown layer holds.
    moving: Vec<WorldBox>,
}

/// What happens to a map in a frame.
#[derive(Clone, Debug, PartialEq)]
enum Decision {
    /// It is read as it was drawn.
    Wait,
    /// Static casters are drawn into some rectangles.
    Keep { wrap: UVec2, rects: Vec<TexelRect> },
    /// All static casters are drawn, to be kept, together with what moves.
    Renew,
    /// The casters of this frame are drawn, without keeping them.
    DrawAnew,
}

/// A frame as the cache takes it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CacheFrame<'a> {
    /// The fitted maps.
    pub(crate) fitted: &'a [FittedMap],
    pub(crate) casters: &'a Casters<'a>,
    /// Static casters beside them.
    pub(crate) standing: Option<&'a BoxTree>,
    /// The map that holds the points outside all others, by coverage.
    pub(crate) coarsest: Option<usize>,
    /// Direction in which the light travels.
    pub(crate) direction: Vec3,
    /// Origin of positions in the shaders, in world space, in metres.
    pub(crate) origin: DVec3,
}

/// The maps that are read in a frame; some of them were drawn in an earlier one.
#[derive(Debug)]
pub(crate) struct Choice {
    decisions: Vec<Decision>,
    pub(crate) maps: Vec<FittedMap>,
}

impl MapCache {
    /// Forgets the content of all layers.
    pub(crate) fn reset(&mut self) {
        for map in &mut self.maps {
            *map = KeptMap::default();
        }
    }

    /// Redraws a part of the world, in metres relative to an origin, in all maps.
    pub(crate) fn invalidate(&mut self, aabb: &Aabb, origin: DVec3) {
        let changed = WorldBox::new(aabb, origin);
        if !changed.is_empty() {
            self.change(&Changes { gone: vec![changed], ..Changes::default() });
        }
    }

    /// Step 1: finds where static casters changed.
    pub(crate) fn take(&mut self, frame: &CacheFrame<'_>) {
        let changes = self.known.update(frame.casters, frame.standing);
        self.change(&changes);
        self.is_split |= self.settings.caching && !self.known.moving.is_empty();
        self.frame += 1;
    }

    fn change(&mut self, changes: &Changes) {
        for map in &mut self.maps {
            map.change(changes);
        }
    }

    /// The maps that show a static caster that is gone, as they were drawn.
    pub(crate) fn outdated(&self) -> impl Iterator<Item = (usize, &FittedMap)> {
        let maps = self.maps.iter().enumerate().filter(|(_, map)| !map.gone.is_empty());
        maps.filter_map(|(index, map)| Some((index, map.drawn.as_ref()?)))
    }

    /// Whether a map shows a static caster that is gone and lies in a volume.
    pub(crate) fn shows_gone(&self, map: usize, volume: &CasterVolume) -> bool {
        let mut gone = self.maps[map].gone.iter().map(|gone| gone.relative_to(volume.origin));
        gone.any(|gone| volume.intersects_aabb(gone.min, gone.max))
    }

    /// Step 2: which maps are drawn, and which are read as they are. `is_due` says which must not wait.
    pub(crate) fn choose(&mut self, frame: &CacheFrame<'_>, is_due: [bool; MAX_MAPS]) -> Choice {
        let has_moving = !self.known.moving.is_empty();
        let mut candidates = Vec::new();
        let mut decisions = Vec::new();
        for (index, (map, fitted)) in self.maps.iter_mut().zip(frame.fitted).enumerate() {
            let listed = frame.casters.boxes.boxes.len();
            let decision = map.decide(fitted, &self.settings, listed, has_moving && !self.is_split);
            let texels = map.texels(&decision, fitted) + u64::from(has_moving);
            if texels > 0 {
                let serves_others = self.settings.by_coverage && frame.coarsest != Some(index);
                let is_due = is_due[index] || !map.may_wait(fitted, serves_others);
                candidates.push(Candidate { map: index, age: self.frame - map.frame, texels, is_due });
            }
            map.fitted = Some(*fitted);
            decisions.push(decision);
        }
        let is_drawn = self.schedule.choose(self.frame, &mut candidates);
        let has_candidate = |index: usize| candidates.iter().any(|candidate| candidate.map == index);
        let mut maps = Vec::with_capacity(decisions.len());
        for (index, (decision, fitted)) in decisions.iter_mut().zip(frame.fitted).enumerate() {
            let map = &mut self.maps[index];
            if has_candidate(index) && !is_drawn[index] {
                *decision = Decision::Wait;
            }
            maps.push(map.shown(fitted, decision));
        }
        Choice { decisions, maps }
    }

    /// Whether static casters have separate layers.
    pub(crate) fn is_split(&self) -> bool {
        self.is_split
    }

    /// Where the left top texel of each map is stored.
    pub(crate) fn wrap(&self, map: usize) -> UVec2 {
        self.maps[map].wrap
    }

    /// Whether the layer of a map holds all static casters over it.
    pub(crate) fn is_cached(&self, map: usize) -> bool {
        self.maps.get(map).is_some_and(|map| map.is_kept)
    }

    /// Moving casters that the layer of a map holds.
    pub(crate) fn moving(&self, map: usize) -> &[WorldBox] {
        self.maps.get(map).map_or(&[], |map| &map.moving)
    }

    /// Whether the passes depend on the views: static casters alone do not.
    pub(crate) fn needs_volumes(&self, choice: &Choice) -> bool {
        let has_moving = !self.known.moving.is_empty();
        choice.decisions.iter().any(|decision| match decision {
            Decision::Wait => false,
            Decision::DrawAnew => true,
            Decision::Keep { .. } | Decision::Renew => has_moving,
        })
    }

    /// Step 3: the passes. `volumes` hold the casters of each map that can shadow something in view, relative to the
    /// maps' origin.
    pub(crate) fn plan(
        &mut self,
        choice: &Choice,
        frame: &CacheFrame<'_>,
        volumes: &[CasterVolume],
        plan: &mut FramePlan,
    ) {
        plan.clear();
        for (index, decision) in choice.decisions.iter().enumerate() {
            let map = &mut self.maps[index];
            let drawing = plan::Drawing {
                index,
                fitted: &choice.maps[index],
                known: &self.known,
                casters: frame.casters,
                standing: frame.standing,
                to_light: -frame.direction.normalize_or_zero(),
                origin: frame.origin,
                in_view: volumes.get(index),
                settings: &self.settings,
            };
            drawing.plan(map, decision, plan);
            if *decision != Decision::Wait {
                map.frame = self.frame;
            }
        }
    }
}

impl KeptMap {
    /// Remembers where static casters changed.
    fn change(&mut self, changes: &Changes) {
        let Some(drawn) = &self.drawn else { return };
        let (origin, size) = (drawn.projection.origin, drawn.projection.resolution);
        if changes.is_all {
            self.is_kept = false;
            self.changed.add(TexelRect::all(size), size);
        }
        let rect = |changed: &WorldBox| TexelRect::of_box(&drawn.projection, &changed.relative_to(origin), origin);
        for come in &changes.come {
            self.changed.add(rect(come), size);
        }
        for gone in &changes.gone {
            let rect = rect(gone);
            self.changed.add(rect, size);
            if rect.is_empty() {
                continue;
            }
            match self.gone.get_mut(MAX_GONE - 1) {
                Some(last) => *last = last.union(gone),
                None => self.gone.push(*gone),
            }
        }
    }

    /// What is drawn of a map that is fitted now, with so many casters in the list. Where casters move and static ones
    /// have no separate layer, nothing is kept.
    fn decide(&mut self, now: &FittedMap, settings: &CacheSettings, casters: usize, has_moving: bool) -> Decision {
        let is_same_grid = self.fitted.is_some_and(|before| !Scroll::between(&before, now).is_new);
        let kept = self.kept_part(now, settings, casters);
        self.renewals = if is_same_grid && kept.is_some() { 0 } else { self.renewals.saturating_add(1) };
        if !settings.caching
            || now.anchor.is_none()
            || now.projection.is_empty
            || has_moving
            || self.renewals > NEVER_KEPT
        {
            return Decision::DrawAnew;
        }
        kept.filter(|_| self.is_kept).unwrap_or(Decision::Renew)
    }

    /// What is drawn of a map if all the rest of it is kept; `None` if that costs no less than all of it.
    fn kept_part(&self, now: &FittedMap, settings: &CacheSettings, casters: usize) -> Option<Decision> {
        let drawn = self.drawn.as_ref()?;
        let (scroll, size) = (Scroll::between(drawn, now), now.projection.resolution);
        let is_moved = scroll.shift != IVec2::ZERO;
        if scroll.is_redraw() || (is_moved && size != settings.layer) {
            return None;
        }
        let price = Price::new(casters, self.over, whole(now), self.is_split);
        if !price.may_be_worth(self.changed.texels(), whole(now)) {
            return None;
        }
        let changed = self.changed.rects(&price).into_iter().map(|rect| moved(rect, scroll.shift, size));
        let rects: Vec<TexelRect> = scroll.exposed().chain(changed).filter(|rect| !rect.is_empty()).collect();
        let is_worth = price.is_worth(&rects, whole(now));
        is_worth.then(|| Decision::Keep { wrap: scroll.wrap(self.wrap, size), rects })
    }

    /// Whether points may read the map as it was drawn, without losing a shadow. `serves_others`: whether another map
    /// holds the points outside it.
    fn may_wait(&self, now: &FittedMap, serves_others: bool) -> bool {
        let (Some(drawn), Some(anchor)) = (&self.drawn, now.anchor) else { return false };
        let Some(old) = drawn.anchor else { return false };
        let holds_depth = old.depth[0] <= anchor.depth[0] && old.depth[1] >= anchor.depth[1];
        let is_same_light =
            drawn.projection.direction == now.projection.direction && drawn.projection.depth == now.projection.depth;
        let is_in_place = old == anchor && Scroll::between(drawn, now).shift == IVec2::ZERO;
        let is_empty = drawn.projection.is_empty && !now.projection.is_empty;
        self.is_kept && is_same_light && holds_depth && !is_empty && (serves_others || is_in_place)
    }

    /// Number of texels in which a decision draws static casters.
    fn texels(&self, decision: &Decision, now: &FittedMap) -> u64 {
        match decision {
            Decision::Wait => 0,
            // Their own layer is made.
            Decision::Keep { .. } if !self.is_split && !self.moving.is_empty() => whole(now),
            Decision::Keep { rects, .. } => rects.iter().map(TexelRect::area).sum(),
            Decision::Renew | Decision::DrawAnew => whole(now),
        }
    }

    /// The map that is read: the fitted one, or the one that was drawn.
    fn shown(&self, fitted: &FittedMap, decision: &Decision) -> FittedMap {
        match (&self.drawn, decision) {
            (Some(drawn), Decision::Wait) => drawn.relative_to(fitted.projection.origin),
            _ => *fitted,
        }
    }
}

/// Number of texels of a map.
fn whole(map: &FittedMap) -> u64 {
    TexelRect::all(map.projection.resolution).area()
}

/// Where a rectangle of a map lies in the same map after a shift.
fn moved(rect: TexelRect, shift: IVec2, size: UVec2) -> TexelRect {
    let [min, end] = [rect.min, rect.min + rect.size]
        .map(|corner| (corner.as_ivec2() - shift).clamp(IVec2::ZERO, size.as_ivec2()).as_uvec2());
    TexelRect { min, size: end - min }
}
