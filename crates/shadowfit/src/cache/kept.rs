//! The content of a map's layers, and the decision about what a frame draws of it.

use alloc::vec::Vec;
use core::ops::Range;

use glam::{IVec2, UVec2};

use super::casters::Changes;
use super::plan::MapReuse;
use super::price::Price;
use super::settings::CacheSettings;
use super::tiles::ChangedTiles;
use super::world_box::WorldBox;
use crate::FittedMap;
use crate::scroll::{Scroll, TexelRect};

/// A map that was new in this many frames in a row counts as one that cannot be kept: it is then drawn with the casters
/// of one frame alone, which are fewer.
const NEVER_KEPT: u8 = 2;

/// Gone casters that a waiting map remembers; the last one is a box around all others.
const MAX_GONE: usize = 64;

/// The content of a map's layers.
#[derive(Debug, Default)]
pub(super) struct KeptMap {
    /// The map that was fitted last: it decides which parts of the layer can be kept.
    pub(super) fitted: Option<FittedMap>,
    /// The map as it was drawn.
    pub(super) drawn: Option<FittedMap>,
    /// Whether the shown layer holds all static casters over it.
    pub(super) is_kept: bool,
    /// Whether the static casters' own layer holds them too.
    pub(super) is_split: bool,
    /// Where its left top texel is stored.
    pub(super) wrap: UVec2,
    /// Frame in which it was drawn.
    pub(super) frame: u64,
    /// Number of frames in a row in which it was new.
    renewals: u8,
    /// Static casters over it when it was drawn as a whole.
    pub(super) over: usize,
    /// Where static casters changed since, in the map as it was drawn.
    pub(super) changed: ChangedTiles,
    /// Static casters that it shows and that are gone.
    pub(super) gone: Vec<WorldBox>,
    /// Moving casters that the shown layer holds.
    pub(super) moving: Vec<WorldBox>,
}

/// What happens to a map in a frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Decision {
    /// It is read as it was drawn.
    Wait,
    /// Static casters are drawn into some rectangles: a range of those of all maps.
    Keep { wrap: UVec2, shift: IVec2, rects: Range<usize> },
    /// All static casters are drawn, to be kept, together with what moves.
    Renew,
    /// The casters of this frame are drawn, without keeping them.
    DrawAnew,
}

impl Decision {
    /// The decision as the plan tells it.
    pub(super) fn reuse(&self) -> MapReuse {
        match *self {
            Self::Wait => MapReuse::Waits,
            Self::Keep { shift, .. } => MapReuse::Kept { shift },
            Self::Renew => MapReuse::New,
            Self::DrawAnew => MapReuse::OneFrame,
        }
    }

    /// The rectangles that it redraws, of those of all maps.
    pub(super) fn rects<'a>(&self, rects: &'a [TexelRect]) -> &'a [TexelRect] {
        match self {
            Self::Keep { rects: range, .. } => &rects[range.clone()],
            _ => &[],
        }
    }
}

impl KeptMap {
    /// Remembers where static casters changed.
    pub(super) fn change(&mut self, changes: &Changes) {
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

    /// What is drawn of a map that is fitted now, with so many casters in the list. Its rectangles are added to `rects`.
    pub(super) fn decide(
        &mut self,
        now: &FittedMap,
        settings: &CacheSettings,
        casters: usize,
        rects: &mut Vec<TexelRect>,
    ) -> Decision {
        let is_same_grid = self.fitted.is_some_and(|before| !Scroll::between(&before, now).is_new);
        let kept = self.kept_part(now, settings, casters, rects);
        self.renewals = if is_same_grid && kept.is_some() { 0 } else { self.renewals.saturating_add(1) };
        if !settings.caching || now.anchor.is_none() || now.projection.is_empty || self.renewals > NEVER_KEPT {
            return Decision::DrawAnew;
        }
        kept.filter(|_| self.is_kept).unwrap_or(Decision::Renew)
    }

    /// What is drawn of a map if all the rest of it is kept; `None` if that costs no less than all of it.
    fn kept_part(
        &self,
        now: &FittedMap,
        settings: &CacheSettings,
        casters: usize,
        rects: &mut Vec<TexelRect>,
    ) -> Option<Decision> {
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
        let first = rects.len();
        let changed = self.changed.rects(&price).into_iter().map(|rect| moved(rect, scroll.shift, size));
        rects.extend(scroll.exposed().chain(changed).filter(|rect| !rect.is_empty()));
        let is_worth = price.is_worth(&rects[first..], whole(now));
        let (wrap, rects) = (scroll.wrap(self.wrap, size), first..rects.len());
        is_worth.then_some(Decision::Keep { wrap, shift: scroll.shift, rects })
    }

    /// Whether points may read the map as it was drawn, without losing a shadow. `serves_others`: whether another map
    /// holds the points outside it.
    pub(super) fn may_wait(&self, now: &FittedMap, serves_others: bool) -> bool {
        let (Some(drawn), Some(anchor)) = (&self.drawn, now.anchor) else { return false };
        let Some(old) = drawn.anchor else { return false };
        let holds_depth = old.depth[0] <= anchor.depth[0] && old.depth[1] >= anchor.depth[1];
        let is_same_light =
            drawn.projection.direction == now.projection.direction && drawn.projection.depth == now.projection.depth;
        let is_in_place = old == anchor && Scroll::between(drawn, now).shift == IVec2::ZERO;
        let is_empty = drawn.projection.is_empty && !now.projection.is_empty;
        self.is_kept && is_same_light && holds_depth && !is_empty && (serves_others || is_in_place)
    }

    /// Number of texels in which a decision draws static casters. `rects` are those that it redraws.
    pub(super) fn texels(&self, decision: &Decision, rects: &[TexelRect], now: &FittedMap) -> u64 {
        match decision {
            Decision::Wait => 0,
            // Their own layer is made.
            Decision::Keep { .. } if !self.is_split && !self.moving.is_empty() => whole(now),
            Decision::Keep { .. } => rects.iter().map(TexelRect::area).sum(),
            Decision::Renew | Decision::DrawAnew => whole(now),
        }
    }

    /// The map that is read: the fitted one, or the one that was drawn, with its texel offset.
    pub(super) fn shown(&self, fitted: &FittedMap, decision: &Decision) -> FittedMap {
        match (&self.drawn, decision) {
            (Some(drawn), Decision::Wait) => {
                FittedMap { wrap: self.wrap, ..drawn.relative_to(fitted.projection.origin) }
            }
            (_, Decision::Keep { wrap, .. }) => FittedMap { wrap: *wrap, ..*fitted },
            _ => FittedMap { wrap: UVec2::ZERO, ..*fitted },
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
