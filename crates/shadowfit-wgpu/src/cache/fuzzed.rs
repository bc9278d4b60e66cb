//! The world of the [model](super::model) as the bytes of a fuzzer move it.

#[cfg(test)]
#[path = "../../../../tests/fuzz/src/corpus.rs"]
mod corpus;

use shadowfit::glam::UVec2;

use super::fixtures::SIDE;
use super::model::{Event, SAMPLES, World};
use super::{CacheSettings, Culling, UpdateSchedule};

/// More frames tell nothing new.
const MOST_FRAMES: usize = 200;

/// Draws the frames of a history, each by its plan, and compares what the maps hold with maps drawn anew.
///
/// # Panics
///
/// When a map holds something else.
pub fn cache_plan(data: &[u8]) {
    let mut bytes = Bytes(data);
    let settings = CacheSettings {
        caching: bytes.below(8) > 0,
        culling: [Culling::Swept, Culling::WholeMap, Culling::Off][bytes.below(3)],
        depth_clamp: true,
        by_coverage: true,
        layer: UVec2::splat(SIDE),
    };
    let pitch = (SIDE / SAMPLES) as usize;
    let jitter = [0; 2].map(|_| bytes.below(pitch) as u32);
    let mut world = World::new(settings, UVec2::from(jitter));
    for _ in 0..MOST_FRAMES {
        let Some(event) = bytes.event() else { return };
        world.change(&event);
        world.draw().unwrap_or_else(|wrong| panic!("{wrong}, after {event:?}"));
    }
}

/// Bytes that are read from the front; zeros when they end.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        *first
    }

    /// 0..count.
    fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count
    }

    fn number(&mut self) -> usize {
        self.byte().into()
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        let share = f64::from(u16::from_le_bytes([self.byte(), self.byte()])) / f64::from(u16::MAX);
        low + (high - low) * share
    }

    fn place(&mut self) -> [f64; 3] {
        [self.between(-40.0, 40.0), self.between(0.2, 4.0), self.between(-60.0, 20.0)]
    }

    /// The next event; `None` when there are no bytes left.
    fn event(&mut self) -> Option<Event> {
        let (kind, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(match kind % 23 {
            0 => Event::Nothing,
            1 => Event::Insert(self.number(), self.place()),
            2 => Event::Copy(self.number(), self.number()),
            3 => Event::Remove(self.number()),
            4 => Event::SwapRemove(self.number()),
            5 => Event::RemoveFrom(self.number()),
            6 => Event::Reverse,
            7 => Event::Rotate(self.number()),
            8 => Event::SortByPlace,
            9 => Event::Place(self.number(), self.place()),
            10 => Event::PlaceAll(self.between(0.2, 2.0)),
            11 => Event::Reshape(self.number()),
            12 => Event::Keys(self.below(4)),
            13 => Event::Moves(self.number()),
            14 => Event::Stand(self.number()),
            15 => Event::NewTree,
            16 => Event::Schedule(self.schedule()),
            17 => Event::Light(self.below(3)),
            18 => Event::Distance(self.below(2)),
            19 => Event::Pan([0; 2].map(|_| self.between(-6.0, 6.0))),
            20 => Event::View(self.view()),
            21 => Event::Invalidate(self.number()),
            _ => Event::InvalidateAll,
        })
    }

    fn schedule(&mut self) -> UpdateSchedule {
        match self.below(3) {
            0 => UpdateSchedule::EveryFrame,
            1 => UpdateSchedule::Every([0; 8].map(|_| 1 + self.below(5) as u32)),
            _ => UpdateSchedule::Texels(self.between(0.0, 1e7) as u64),
        }
    }

    fn view(&mut self) -> Option<[f32; 2]> {
        (self.below(5) > 0).then(|| [self.between(0.0, 7.0) as f32, self.between(-30.0, 20.0) as f32])
    }
}

#[test]
fn what_fuzzing_fed_the_cache_leaves_maps_as_full_redraws_do() {
    corpus::replay("cache_plan", cache_plan);
}
