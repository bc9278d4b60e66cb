//! Which parts of the maps can be kept from frame to frame, and which must be drawn.
//!
//! A map on the world's grid moves by whole texels, so its static casters are drawn once. [`MapCache`] decides without
//! a GPU: it compares a frame's maps and casters with those that were drawn, and lists the passes, each with rectangles
//! and casters.
//!
//! ```text
//!   a frame's maps ──▶ 1. decide: kept, moved, or new? ──▶ 2. schedule: which of them now?
//!   and casters              by Scroll, and what changed        ──▶ 3. plan: passes, pieces, casters
//! ```
//!
//! Static casters are drawn into rectangles that came into a map, or in which one of them changed. Where casters move,
//! the static ones have separate layers. The shown layer is restored from them where something moved in the frame
//! before; then moving casters are drawn over it.

mod casters;
mod plan;
mod schedule;

use shadowfit::glam::{DVec3, IVec2, UVec2, Vec3};
use shadowfit::scroll::{Scroll, TexelRect};
use shadowfit::settings::MAX_MAPS;
use shadowfit::{Aabb, CasterVolume, FittedMap};

use casters::{KnownCasters, WorldBox};
use schedule::Candidate;

pub use casters::Casters;
pub use plan::PassContent;
pub(crate) use plan::{FramePlan, Layer, PassPlan};
pub use schedule::UpdateSchedule;

/// Most rectangles of a map that are drawn separately in a frame; more are merged into one that holds them.
const MAX_RECTS: usize = 8;

/// Changed boxes that a map remembers while it waits; with more, all of it counts as changed.
const MAX_CHANGES: usize = 64;

/// A map that was new in this many frames in a row counts as one that cannot be kept: it is then drawn with the casters
/// of one frame alone, which are fewer.
const NEVER_KEPT: u8 = 2;

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
#[expect(clippy::struct_excessive_bools, reason = "each is a property of its own")]
pub(crate) struct CacheSettings {
    /// Whether anything is kept.
    pub(crate) caching: bool,
    /// Whether static casters can have separate layers.
    pub(crate) can_mend: bool,
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

/// The content of a map's layer.
#[derive(Debug, Default)]
struct KeptMap {
    /// The map that was fitted last: it decides which parts of the layer can be kept.
    fitted: Option<FittedMap>,
    /// The map as it was drawn.
    drawn: Option<FittedMap>,
    /// Whether all static casters over it are in its layer.
    is_kept: bool,
    /// Where its left top texel is stored.
    wrap: UVec2,
    /// Frame in which it was drawn.
    frame: u64,
    /// Number of frames in a row in which it was new.
    renewals: u8,
    /// Where static casters changed since.
    changed: Vec<WorldBox>,
    /// Moving casters that the shown layer holds.
    moving: Vec<WorldBox>,
    /// Whether the shown layer holds the static casters too.
    is_shown: bool,
}

/// What happens to a map in a frame.
#[derive(Clone, Debug, PartialEq)]
enum Decision {
    /// It is read as it was drawn.
    Wait,
    /// Static casters are drawn into some rectangles.
    Keep { wrap: UVec2, rects: Vec<TexelRect> },
    /// All static casters are drawn, to be kept.
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
        let changed = WorldBox { min: origin + aabb.min.as_dvec3(), max: origin + aabb.max.as_dvec3() };
        for map in self.maps.iter_mut().filter(|map| map.changed.len() <= MAX_CHANGES) {
            map.changed.push(changed);
        }
    }

    /// Steps 1 and 2: which maps are drawn, and which are read as they are.
    pub(crate) fn choose(&mut self, frame: &CacheFrame<'_>) -> Choice {
        let mut changed = Vec::new();
        self.known.update(frame.casters, frame.direction, &mut changed);
        let splits = self.settings.can_mend && self.settings.caching && !self.known.moving.is_empty();
        if splits && !self.is_split {
            self.is_split = true;
            // The layers of the static casters are empty.
            self.maps.iter_mut().for_each(|map| map.is_kept = false);
        }
        self.frame += 1;
        let has_moving = !self.known.moving.is_empty();
        let mut candidates = Vec::new();
        let mut decisions = Vec::new();
        for (index, (map, fitted)) in self.maps.iter_mut().zip(frame.fitted).enumerate() {
            map.changed.extend(&changed);
            let decision = map.decide(fitted, &self.settings, has_moving && !self.is_split);
            let texels = decision.texels(fitted) + u64::from(has_moving);
            if texels > 0 {
                let is_due = !map.may_wait(fitted, self.settings.by_coverage && frame.coarsest != Some(index));
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
        let has_moving = self.is_split && !self.known.moving.is_empty();
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
                origin: frame.origin,
                in_view: volumes.get(index),
                settings: &self.settings,
                is_split: self.is_split,
            };
            drawing.plan(map, decision, plan);
            if *decision != Decision::Wait {
                map.frame = self.frame;
            }
        }
    }
}

impl KeptMap {
    /// What is drawn of a map that is fitted now. Where casters move and static ones have no separate layer, nothing is
    /// kept.
    fn decide(&mut self, now: &FittedMap, settings: &CacheSettings, has_moving: bool) -> Decision {
        let fits_layer = now.projection.resolution == settings.layer;
        let is_same_grid = self.fitted.is_some_and(|before| !Scroll::between(&before, now).is_new);
        self.renewals = if is_same_grid { 0 } else { self.renewals.saturating_add(1) };
        if !settings.caching
            || now.anchor.is_none()
            || now.projection.is_empty
            || has_moving
            || self.renewals > NEVER_KEPT
        {
            return Decision::DrawAnew;
        }
        let (Some(drawn), true) = (&self.drawn, self.is_kept) else { return Decision::Renew };
        let scroll = Scroll::between(drawn, now);
        let is_moved = scroll.shift != IVec2::ZERO;
        if scroll.is_redraw() || (is_moved && !fits_layer) || self.changed.len() > MAX_CHANGES {
            return Decision::Renew;
        }
        let changes = self.changed.iter().map(|changed| {
            let origin = now.projection.origin;
            TexelRect::of_box(&now.projection, &changed.relative_to(origin), origin)
        });
        let mut rects: Vec<TexelRect> = scroll.exposed().chain(changes).filter(|rect| !rect.is_empty()).collect();
        if rects.len() > MAX_RECTS {
            rects = rects.into_iter().reduce(TexelRect::union).into_iter().collect();
        }
        if rects.iter().map(TexelRect::area).sum::<u64>() * 2 > TexelRect::all(now.projection.resolution).area() {
            return Decision::Renew;
        }
        Decision::Keep { wrap: scroll.wrap(self.wrap, now.projection.resolution), rects }
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

    /// The map that is read: the fitted one, or the one that was drawn.
    fn shown(&self, fitted: &FittedMap, decision: &Decision) -> FittedMap {
        match (&self.drawn, decision) {
            (Some(drawn), Decision::Wait) => {
                FittedMap { projection: drawn.projection.relative_to(fitted.projection.origin), ..*drawn }
            }
            _ => *fitted,
        }
    }
}

impl Decision {
    /// Number of texels in which static casters are drawn.
    fn texels(&self, map: &FittedMap) -> u64 {
        match self {
            Self::Wait => 0,
            Self::Keep { rects, .. } => rects.iter().map(TexelRect::area).sum(),
            Self::Renew | Self::DrawAnew => TexelRect::all(map.projection.resolution).area(),
        }
    }
}
