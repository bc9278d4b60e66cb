//! Which casters of two lists are the same: those with the same key and the same box.
//!
//! Boxes are the same up to rounding, so they can be neither hashed nor compared as text. Each has a *mark*, a weighted
//! sum of its coordinates: what is the same has nearly the same mark, and few others have. One list is sorted by key
//! and mark, and the other is looked up in it.

use super::casters::WorldBox;

/// A caster, as it is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Caster {
    pub(super) key: Option<u64>,
    pub(super) aabb: WorldBox,
    /// Metres by which the same box may differ.
    pub(super) rounding: f64,
    pub(super) number: usize,
}

/// Weights of a mark. No sums of a few of them are equal, so that neither grids of boxes nor boxes in a row share marks.
const WEIGHTS: [f64; 6] = [1.0, 0.732_050_807, 0.236_067_977, 0.645_751_311, 0.316_624_790, 0.605_551_275];

/// Sum of the weights, rounded up.
const WEIGHT: f64 = 4.0;

/// Rounding of a mark in f64, as a share of the coordinates.
const MARK_ROUNDING: f64 = 1e-14;

/// Takes the pairs of the same caster out of both lists. `found` gets the number that each had in the second list, and
/// its box in the first one.
///
/// Two casters with keys are the same if their keys and boxes are; where one has none, their boxes decide.
pub(super) fn pair(before: &mut Vec<Caster>, now: &mut Vec<Caster>, mut found: impl FnMut(usize, WorldBox)) {
    if before.is_empty() || now.is_empty() {
        return;
    }
    pair_where(before, now, |key| Some(key), |key| Some(key), &mut found);
    // Keys that only one of the two has.
    let (known, unknown) = (|key: Option<u64>| key.map(|_| None), |key: Option<u64>| key.is_none().then_some(None));
    pair_where(before, now, known, unknown, &mut found);
    pair_where(before, now, unknown, known, &mut found);
}

/// As [`pair`], of the casters for which the functions give a key to look for.
fn pair_where(
    before: &mut Vec<Caster>,
    now: &mut Vec<Caster>,
    key_before: impl Fn(Option<u64>) -> Option<Option<u64>>,
    key_now: impl Fn(Option<u64>) -> Option<Option<u64>>,
    found: &mut impl FnMut(usize, WorldBox),
) {
    let is_wanted = |caster: &Caster| key_now(caster.key).is_some();
    if !now.iter().any(is_wanted) {
        return;
    }
    let mut sorted = Sorted::new(before.iter().enumerate().filter_map(|(i, caster)| {
        let key = key_before(caster.key)?;
        Some(Entry { key, mark: mark(&caster.aabb), index: i as u32 })
    }));
    if sorted.entries.is_empty() {
        return;
    }
    let mut is_paired = vec![false; before.len()];
    now.retain(|caster| {
        let taken = key_now(caster.key).and_then(|key| sorted.take(caster, key, before));
        if let Some(index) = taken {
            is_paired[index] = true;
            found(caster.number, before[index].aabb);
        }
        taken.is_none()
    });
    let mut is_paired = is_paired.into_iter();
    before.retain(|_| !is_paired.next().unwrap_or(false));
}

/// A caster of the list that is looked up in.
#[derive(Clone, Copy, Debug)]
struct Entry {
    key: Option<u64>,
    mark: f64,
    index: u32,
}

/// Casters in the order of their keys and marks.
struct Sorted {
    entries: Vec<Entry>,
    /// For each the first at or after it that is not taken, as far as that is known.
    next: Vec<u32>,
}

impl Sorted {
    fn new(entries: impl Iterator<Item = Entry>) -> Self {
        let mut entries: Vec<Entry> = entries.collect();
        entries.sort_unstable_by(|a, b| a.key.cmp(&b.key).then(a.mark.total_cmp(&b.mark)).then(a.index.cmp(&b.index)));
        let next = (0..=entries.len() as u32).collect();
        Self { entries, next }
    }

    /// Takes the first caster that is the same, and returns its index in its list.
    fn take(&mut self, caster: &Caster, key: Option<u64>, list: &[Caster]) -> Option<usize> {
        let (mark, size) = (mark(&caster.aabb), caster.aabb.min.abs().max(caster.aabb.max.abs()).max_element());
        let reach = WEIGHT * (caster.rounding + size * MARK_ROUNDING);
        let is_before = |entry: &Entry| entry.key < key || (entry.key == key && entry.mark < mark - reach);
        let mut at = self.entries.partition_point(is_before);
        loop {
            at = self.free(at);
            let entry = self.entries.get(at)?;
            if entry.key != key || entry.mark > mark + reach {
                return None;
            }
            let index = entry.index as usize;
            if list[index].aabb.is_same(&caster.aabb, caster.rounding) {
                self.next[at] = at as u32 + 1;
                return Some(index);
            }
            at += 1;
        }
    }

    /// The first entry at or after this one that is not taken.
    fn free(&mut self, from: usize) -> usize {
        let mut end = from;
        while self.next[end] as usize != end {
            end = self.next[end] as usize;
        }
        let mut at = from;
        while at != end {
            at = core::mem::replace(&mut self.next[at], end as u32) as usize;
        }
        end
    }
}

fn mark(aabb: &WorldBox) -> f64 {
    let coordinates = aabb.min.to_array().into_iter().chain(aabb.max.to_array());
    coordinates.zip(WEIGHTS).map(|(coordinate, weight)| coordinate * weight).sum()
}
