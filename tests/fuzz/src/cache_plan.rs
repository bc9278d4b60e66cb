//! Fuzz target: histories of casters for the cache of maps. The bytes control the world of the core's model.

#[path = "../../../crates/shadowfit/tests/suite/cache/fixtures.rs"]
mod fixtures;
#[path = "../../../crates/shadowfit/tests/suite/cache/model.rs"]
mod model;

use shadowfit::cache::{Culling, UpdateSchedule};
use shadowfit::glam::UVec2;

use super::bytes::Bytes;
use fixtures::{SIDE, settings};
use model::{Event, SAMPLES, World};

/// Limit of frames. More frames show nothing new.
const MOST_FRAMES: usize = 200;

/// Draws the frames of a history by their plans, and compares the content of the maps with redrawn maps.
///
/// # Panics
///
/// If a map has other content.
pub fn cache_plan(data: &[u8]) {
    let bytes = &mut Bytes(data);
    let caching = bytes.below(8) > 0;
    let culling = bytes.pick(&[Culling::Swept, Culling::WholeMap, Culling::Off]);
    let pitch = (SIDE / SAMPLES) as usize;
    let jitter = [0; 2].map(|_| bytes.below(pitch) as u32);
    let mut world = World::new(settings(caching, culling), UVec2::from(jitter));
    for _ in 0..MOST_FRAMES {
        let Some(event) = event(bytes) else { return };
        world.change(&event);
        world.draw().unwrap_or_else(|wrong| panic!("{wrong}, after {event:?}"));
    }
}

/// Returns the next event, or `None` at the end of the bytes.
fn event(bytes: &mut Bytes<'_>) -> Option<Event> {
    if bytes.0.is_empty() {
        return None;
    }
    Some(match bytes.byte() % 23 {
        0 => Event::Nothing,
        1 => Event::Insert(number(bytes), place(bytes)),
        2 => Event::Copy(number(bytes), number(bytes)),
        3 => Event::Remove(number(bytes)),
        4 => Event::SwapRemove(number(bytes)),
        5 => Event::RemoveFrom(number(bytes)),
        6 => Event::Reverse,
        7 => Event::Rotate(number(bytes)),
        8 => Event::SortByPlace,
        9 => Event::Place(number(bytes), place(bytes)),
        10 => Event::PlaceAll(between(bytes, 0.2, 2.0)),
        11 => Event::Reshape(number(bytes)),
        12 => Event::Keys(bytes.below(4)),
        13 => Event::Moves(number(bytes)),
        14 => Event::Stand(number(bytes)),
        15 => Event::NewTree,
        16 => Event::Schedule(schedule(bytes)),
        17 => Event::Light(bytes.below(3)),
        18 => Event::Distance(bytes.below(2)),
        19 => Event::Pan([0; 2].map(|_| between(bytes, -6.0, 6.0))),
        20 => Event::View(view(bytes)),
        21 => Event::Invalidate(number(bytes)),
        _ => Event::InvalidateAll,
    })
}

fn number(bytes: &mut Bytes<'_>) -> usize {
    bytes.byte().into()
}

fn between(bytes: &mut Bytes<'_>, low: f64, high: f64) -> f64 {
    let share = f64::from(u16::from_le_bytes([bytes.byte(), bytes.byte()])) / f64::from(u16::MAX);
    low + (high - low) * share
}

fn place(bytes: &mut Bytes<'_>) -> [f64; 3] {
    [between(bytes, -40.0, 40.0), between(bytes, 0.2, 4.0), between(bytes, -60.0, 20.0)]
}

fn schedule(bytes: &mut Bytes<'_>) -> UpdateSchedule {
    match bytes.below(3) {
        0 => UpdateSchedule::EveryFrame,
        1 => UpdateSchedule::Every([0; 8].map(|_| 1 + bytes.below(5) as u32)),
        _ => UpdateSchedule::Texels(between(bytes, 0.0, 1e7) as u64),
    }
}

fn view(bytes: &mut Bytes<'_>) -> Option<[f32; 2]> {
    (bytes.below(5) > 0).then(|| [between(bytes, 0.0, 7.0) as f32, between(bytes, -30.0, 20.0) as f32])
}
