//! Identity of static casters: finds the casters that two frames' lists share, although casters have no
//! identifiers.
//!
//! Two casters are the same if their boxes are equal and, where both have a key, their keys are equal. Boxes
//! are equal up to rounding, which depends on their origin, so they can be neither hashed nor compared bit by
//! bit. The lists are compared in three steps, each for the casters that the previous step left:
//!
//! 1. Number by number. This finds all casters of an unchanged list.
//! 2. With a look ahead of [`AHEAD`] casters, for lists with insertions or removals.
//! 3. By *sort keys*, for reordered lists. A sort key is a weighted sum of a box's coordinates and of the
//!    caster's key. Equal casters have nearly equal sort keys, and few other casters do. Both lists are
//!    sorted and walked side by side.
//!
//! Example with unit cubes that begin at x = 0 (A), 5 (B), 9 (C) and 20 m (D):
//!
//! ```text
//!   last frame    A  B  C
//!   this frame    C  A  D
//!   1. and 2.     A is not C, but C follows two casters later in the last frame's list: A and B count as gone,
//!                 C is the same. The rest of this frame's list, A and D, counts as come.
//!   3.            gone: A 1.57, B 9.80      come: A 1.57, D 34.48
//!                 Both A have the same sort key and equal boxes: they are a pair.
//!   result        gone: B      come: D      Two places are redrawn. A and C are kept with other numbers.
//! ```

use alloc::vec;
use alloc::vec::Vec;

use super::world_box::WorldBox;

/// A caster of one of the lists.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Caster {
    pub(super) key: Option<u64>,
    pub(super) aabb: WorldBox,
    /// Greatest difference of an equal box, in metres.
    pub(super) rounding: f64,
    pub(super) number: usize,
}

impl Caster {
    /// Returns whether this caster of the last frame is the same as a caster of this frame.
    pub(super) fn is_same(&self, now: &Self) -> bool {
        let has_same_key = self.key.zip(now.key).is_none_or(|(before, now)| before == now);
        has_same_key && self.aabb.is_same(&now.aabb, now.rounding)
    }
}

/// Number of casters to look ahead at a difference of two lists. A greater number finds longer insertions,
/// and costs more in reordered lists.
const AHEAD: usize = 8;

/// Returns the numbers of casters that were removed from a list and inserted into it at the first difference.
/// Returns `None` if the search fails within [`AHEAD`] casters, or if one caster only replaced another one.
/// The functions return the casters of both lists, counted from the difference.
pub(super) fn shift(
    before: impl Fn(usize) -> Option<Caster>,
    now: impl Fn(usize) -> Option<Caster>,
) -> Option<[usize; 2]> {
    let is_same = |[ahead_before, ahead_now]: [usize; 2]| {
        before(ahead_before).zip(now(ahead_now)).is_some_and(|(before, now)| before.is_same(&now))
    };
    if before(0)?.aabb.is_empty() || now(0)?.aabb.is_empty() || is_same([1, 1]) {
        return None;
    }
    let taken_out = (1..=AHEAD).map(|ahead| [ahead, 0]);
    let put_in = (1..=AHEAD).map(|ahead| [0, ahead]);
    taken_out.chain(put_in).find(|ahead| is_same(*ahead))
}

/// Weights of the coordinates in a sort key: fractions of square roots. No two sums of a few weights are
/// equal, so boxes in grids or rows have different sort keys.
const WEIGHTS: [f64; 6] = [1.0, 0.732_050_807, 0.236_067_977, 0.645_751_311, 0.316_624_790, 0.605_551_275];

/// Sum of the weights, rounded up.
const WEIGHT: f64 = 4.0;

/// Rounding of a sort key in f64, as a share of the coordinates.
const SORT_KEY_ROUNDING: f64 = 1e-14;

/// Approximate distance in metres between the sort keys of casters with different keys. It is far greater
/// than a world, and small enough for sort keys to be exact to a hundredth of a millimetre.
const KEY_RANGE: f64 = 1e9;

/// Removes the pairs of the same caster from both lists. Calls `found` with the caster's number in the second
/// list and its box in the first one.
///
/// Two casters with keys are the same if their keys and boxes are equal. If one of them has no key, their
/// boxes decide.
pub(super) fn pair(before: &mut Vec<Caster>, now: &mut Vec<Caster>, mut found: impl FnMut(usize, WorldBox)) {
    let mut pair_of = |of_before: KeyOf, of_now: KeyOf| {
        if !before.is_empty() && !now.is_empty() {
            pair_by_key(before, now, of_before, of_now, &mut found);
        }
    };
    pair_of(Some, Some);
    // One of the two has a key.
    let (keyed, unkeyed): (KeyOf, KeyOf) = (|key| key.map(|_| None), |key| key.is_none().then_some(None));
    pair_of(keyed, unkeyed);
    pair_of(unkeyed, keyed);
}

/// Maps a caster's key to the key that goes into its sort key. The outer `None` skips the caster.
type KeyOf = fn(Option<u64>) -> Option<Option<u64>>;

/// Pairs the casters of both lists that the functions do not skip.
fn pair_by_key(
    before: &mut Vec<Caster>,
    now: &mut Vec<Caster>,
    of_before: KeyOf,
    of_now: KeyOf,
    found: &mut impl FnMut(usize, WorldBox),
) {
    let (sorted, wanted) = (entries(before, of_before), entries(now, of_now));
    if sorted.is_empty() || wanted.is_empty() {
        return;
    }
    let tolerance = now.iter().map(tolerance).fold(0.0, f64::max);
    let (mut taken_before, mut taken_now) = (vec![false; before.len()], vec![false; now.len()]);
    let (mut first, mut untaken) = (0, NextUntaken::new(sorted.len()));
    for entry in &wanted {
        let caster = &now[entry.index as usize];
        let is_low = |low: &Entry| low.sort_key < entry.sort_key - tolerance;
        first += sorted[first..].iter().take_while(|low| is_low(low)).count();
        let mut at = untaken.at_or_after(first);
        while let Some(candidate) = sorted.get(at).filter(|candidate| candidate.sort_key <= entry.sort_key + tolerance)
        {
            let same = &before[candidate.index as usize];
            if of_before(same.key) == of_now(caster.key) && same.aabb.is_same(&caster.aabb, caster.rounding) {
                (taken_before[candidate.index as usize], taken_now[entry.index as usize]) = (true, true);
                untaken.take(at);
                found(caster.number, same.aabb);
                break;
            }
            at = untaken.at_or_after(at + 1);
        }
    }
    keep_untaken(before, &taken_before);
    keep_untaken(now, &taken_now);
}

fn keep_untaken(list: &mut Vec<Caster>, is_taken: &[bool]) {
    let mut is_taken = is_taken.iter();
    list.retain(|_| is_taken.next() == Some(&false));
}

/// A caster's index in its list, with its sort key.
#[derive(Clone, Copy, Debug)]
struct Entry {
    sort_key: f64,
    index: u32,
}

/// Returns the casters that `key_of` does not skip, sorted by sort key.
fn entries(list: &[Caster], key_of: KeyOf) -> Vec<Entry> {
    let entry =
        |(index, caster): (u32, &Caster)| Some(Entry { sort_key: sort_key(caster, key_of(caster.key)?), index });
    let mut entries: Vec<Entry> = (0..).zip(list).filter_map(entry).collect();
    entries.sort_unstable_by(|a, b| a.sort_key.total_cmp(&b.sort_key).then(a.index.cmp(&b.index)));
    entries
}

fn sort_key(caster: &Caster, key: Option<u64>) -> f64 {
    let coordinates = caster.aabb.min.to_array().into_iter().chain(caster.aabb.max.to_array());
    let of_box: f64 = coordinates.zip(WEIGHTS).map(|(coordinate, weight)| coordinate * weight).sum();
    // The golden ratio's fraction spreads consecutive keys far apart.
    let of_key = key.map_or(0, |key| key.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15)) >> 40;
    of_box + of_key as f64 * (KEY_RANGE / f64::from(1 << 24))
}

/// Returns the greatest possible difference between the sort keys of the same caster.
fn tolerance(caster: &Caster) -> f64 {
    let size = caster.aabb.min.abs().max(caster.aabb.max.abs()).max_element();
    WEIGHT * (caster.rounding + (size + KEY_RANGE) * SORT_KEY_ROUNDING)
}

/// The next untaken entry after each entry: a forest whose roots are the untaken entries, with path
/// compression.
struct NextUntaken {
    /// An untaken entry points to itself. A taken one points to a later entry, at most to the next untaken
    /// one.
    next: Vec<u32>,
}

impl NextUntaken {
    fn new(count: usize) -> Self {
        Self { next: (0..=count as u32).collect() }
    }

    /// Returns the first untaken entry from this one on, or the number of entries if there is none.
    fn at_or_after(&mut self, entry: usize) -> usize {
        let mut end = entry.min(self.next.len() - 1);
        while self.next[end] as usize != end {
            end = self.next[end] as usize;
        }
        let mut at = entry;
        while at < end {
            at = core::mem::replace(&mut self.next[at], end as u32) as usize;
        }
        end
    }

    fn take(&mut self, entry: usize) {
        self.next[entry] = entry as u32 + 1;
    }
}
