//! The content of a map's layers, and its transitions from frame to frame.

use alloc::vec::Vec;
use core::mem::take;
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

/// Number of successive renewals after which a map counts as one that cannot be kept. It is then drawn with
/// the casters of one frame only, which are fewer.
const NEVER_KEPT: u8 = 2;

/// Greatest number of disappeared casters that a map remembers. The last entry is a box around all further
/// ones.
const MAX_GONE: usize = 64;

/// The content of a map's layers.
///
/// | from | to | by |
/// |---|---|---|
/// | any | [`Self::OneFrame`] | [`Transition::DrawOnce`] |
/// | any | [`Self::Kept`] | [`Transition::Renew`] |
/// | [`Self::Kept`] | [`Self::Kept`], or [`Self::Split`] from the first moving caster on | [`Transition::Update`] |
/// | [`Self::Split`] | [`Self::Split`] | [`Transition::Update`] |
/// | any | [`Self::Nothing`] | a change that may affect everything, or `invalidate_all` |
#[derive(Debug, Default)]
pub(super) enum Layers {
    /// No valid content.
    #[default]
    Nothing,
    /// The casters that one frame needed. Later frames may need others.
    OneFrame(Drawn),
    /// The shown layer holds all static casters over the map.
    Kept(Drawn),
    /// Both the shown layer and the static casters' layer hold all static casters over the map.
    Split(Drawn),
}

/// A drawn map, and the changes since.
#[derive(Debug)]
pub(super) struct Drawn {
    /// The map, with its texel offset.
    pub(super) map: FittedMap,
    /// Places where static casters changed, in texels of this map.
    pub(super) changed: ChangedTiles,
    /// Static casters that have disappeared but are still in the drawn map.
    pub(super) gone: Vec<WorldBox>,
    /// Moving casters in the shown layer, drawn over the static ones.
    pub(super) moving: Vec<WorldBox>,
}

/// State of one map between frames.
#[derive(Debug, Default)]
pub(super) struct MapState {
    pub(super) layers: Layers,
    /// The map that was fitted last.
    pub(super) fitted: Option<FittedMap>,
    /// The last frame that drew the map.
    pub(super) frame: u64,
    /// Number of successive frames that had to redraw the whole map.
    renewals: u8,
    /// Number of static casters over the map when all of them were drawn last. Estimates the cost of its
    /// texels.
    pub(super) over: usize,
}

/// The change of a map's layers in a frame.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Transition {
    /// Draws no caster. Shaders read the layers unchanged.
    Wait,
    /// Draws static casters into a range of the common list of rectangles, then moving casters. Results in
    /// [`Layers::Kept`] or [`Layers::Split`].
    Update { texel_offset: UVec2, shift: IVec2, rects: Range<usize> },
    /// Draws all static casters together with the moving ones. Results in [`Layers::Kept`].
    Renew,
    /// Draws the casters of this frame. Results in [`Layers::OneFrame`].
    DrawOnce,
}

impl Transition {
    /// Returns its equivalent in the plan.
    pub(super) fn reuse(&self) -> MapReuse {
        match *self {
            Self::Wait => MapReuse::Waits,
            Self::Update { shift, .. } => MapReuse::Kept { shift },
            Self::Renew => MapReuse::New,
            Self::DrawOnce => MapReuse::OneFrame,
        }
    }

    /// Returns its range of the common list of rectangles.
    pub(super) fn rects<'a>(&self, rects: &'a [TexelRect]) -> &'a [TexelRect] {
        match self {
            Self::Update { rects: range, .. } => &rects[range.clone()],
            _ => &[],
        }
    }
}

impl Layers {
    /// Returns the drawn map.
    pub(super) fn drawn(&self) -> Option<&Drawn> {
        match self {
            Self::Nothing => None,
            Self::OneFrame(drawn) | Self::Kept(drawn) | Self::Split(drawn) => Some(drawn),
        }
    }

    /// Takes the drawn map out of the layers to draw it again as `map`. Its list of moving casters stays.
    pub(super) fn redraw(&mut self, map: &FittedMap) -> Drawn {
        match take(self) {
            Self::Nothing => {
                Drawn { map: *map, changed: ChangedTiles::default(), gone: Vec::new(), moving: Vec::new() }
            }
            Self::OneFrame(mut drawn) | Self::Kept(mut drawn) | Self::Split(mut drawn) => {
                drawn.map = *map;
                drawn.changed.clear();
                drawn.gone.clear();
                drawn
            }
        }
    }

    /// Returns whether the shown layer holds all static casters over the map.
    pub(super) fn is_kept(&self) -> bool {
        matches!(self, Self::Kept(_) | Self::Split(_))
    }

    /// Returns whether the static casters' layer holds all static casters over the map.
    pub(super) fn is_split(&self) -> bool {
        matches!(self, Self::Split(_))
    }

    /// Records the places where static casters changed.
    pub(super) fn change(&mut self, changes: &Changes) {
        match self {
            Self::OneFrame(_) | Self::Kept(_) | Self::Split(_) if changes.is_all => *self = Self::Nothing,
            Self::OneFrame(drawn) | Self::Kept(drawn) | Self::Split(drawn) => drawn.change(changes),
            Self::Nothing => {}
        }
    }
}

impl Drawn {
    fn change(&mut self, changes: &Changes) {
        let (projection, size) = (&self.map.projection, self.map.projection.resolution);
        let rect = |changed: &WorldBox| {
            TexelRect::of_box(projection, &changed.relative_to(projection.origin), projection.origin)
        };
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
}

impl MapState {
    /// Returns the transition to the map `now`, which was fitted for this frame. `casters` is the number of
    /// listed casters. Adds the transition's rectangles to `rects`.
    pub(super) fn decide(
        &mut self,
        now: &FittedMap,
        settings: &CacheSettings,
        casters: usize,
        rects: &mut Vec<TexelRect>,
    ) -> Transition {
        let is_same_grid = self.fitted.is_some_and(|before| !Scroll::between(&before, now).is_new);
        let update = self.update(now, settings, casters, rects);
        self.renewals = if is_same_grid && update.is_some() { 0 } else { self.renewals.saturating_add(1) };
        if !settings.caching || now.grid_position.is_none() || now.projection.is_empty || self.renewals > NEVER_KEPT {
            return Transition::DrawOnce;
        }
        update.filter(|_| self.layers.is_kept()).unwrap_or(Transition::Renew)
    }

    /// Returns the transition that keeps the most texels, or `None` if redrawing the whole map is not more
    /// expensive.
    fn update(
        &self,
        now: &FittedMap,
        settings: &CacheSettings,
        casters: usize,
        rects: &mut Vec<TexelRect>,
    ) -> Option<Transition> {
        let Drawn { map, changed, .. } = self.layers.drawn()?;
        let (scroll, size) = (Scroll::between(map, now), now.projection.resolution);
        let is_moved = scroll.shift != IVec2::ZERO;
        if scroll.is_redraw() || (is_moved && size != settings.layer) {
            return None;
        }
        let price = Price::new(casters, self.over, whole(now), self.layers.is_split());
        if !price.may_be_worth(changed.texels(), whole(now)) {
            return None;
        }
        let first = rects.len();
        let changed = changed.rects(&price).into_iter().map(|rect| moved(rect, scroll.shift, size));
        rects.extend(scroll.exposed().chain(changed).filter(|rect| !rect.is_empty()));
        let is_worth = price.is_worth(&rects[first..], whole(now));
        let (texel_offset, rects) = (scroll.texel_offset(map.texel_offset, size), first..rects.len());
        is_worth.then_some(Transition::Update { texel_offset, shift: scroll.shift, rects })
    }

    /// Returns whether shaders may read the drawn map without losing a shadow. `serves_others` says whether
    /// another map covers the points outside it.
    pub(super) fn may_wait(&self, now: &FittedMap, serves_others: bool) -> bool {
        let (Layers::Kept(Drawn { map, .. }) | Layers::Split(Drawn { map, .. })) = &self.layers else { return false };
        let Some((old, grid_position)) = map.grid_position.zip(now.grid_position) else { return false };
        let holds_depth = old.depth[0] <= grid_position.depth[0] && old.depth[1] >= grid_position.depth[1];
        let is_same_light =
            map.projection.direction == now.projection.direction && map.projection.depth == now.projection.depth;
        let is_in_place = old == grid_position && Scroll::between(map, now).shift == IVec2::ZERO;
        let is_empty = map.projection.is_empty && !now.projection.is_empty;
        is_same_light && holds_depth && !is_empty && (serves_others || is_in_place)
    }

    /// Returns the number of texels that a transition redraws with static casters. `rects` are the rectangles
    /// that it redraws.
    pub(super) fn texels(&self, transition: &Transition, rects: &[TexelRect], now: &FittedMap) -> u64 {
        match (transition, &self.layers) {
            (Transition::Wait, _) => 0,
            // The whole static layer is drawn as well.
            (Transition::Update { .. }, Layers::Kept(drawn)) if !drawn.moving.is_empty() => whole(now),
            (Transition::Update { .. }, _) => rects.iter().map(TexelRect::area).sum(),
            (Transition::Renew | Transition::DrawOnce, _) => whole(now),
        }
    }

    /// Returns the map for shaders to read, with its texel offset: the drawn one if it waits, otherwise the
    /// fitted one.
    pub(super) fn shown(&self, fitted: &FittedMap, transition: &Transition) -> FittedMap {
        match (self.layers.drawn(), transition) {
            (Some(drawn), Transition::Wait) => drawn.map.relative_to(fitted.projection.origin),
            (_, Transition::Update { texel_offset, .. }) => FittedMap { texel_offset: *texel_offset, ..*fitted },
            _ => FittedMap { texel_offset: UVec2::ZERO, ..*fitted },
        }
    }
}

/// Returns the number of texels of a map.
fn whole(map: &FittedMap) -> u64 {
    TexelRect::all(map.projection.resolution).area()
}

/// Returns the place of a rectangle after the map has moved by `shift`.
fn moved(rect: TexelRect, shift: IVec2, size: UVec2) -> TexelRect {
    let [min, end] = [rect.min, rect.min + rect.size]
        .map(|corner| (corner.as_ivec2() - shift).clamp(IVec2::ZERO, size.as_ivec2()).as_uvec2());
    TexelRect { min, size: end - min }
}
