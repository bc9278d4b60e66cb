//! Which casters of two lists are the same: those with the same key and the same box.
//!
//! Lists are compared number by number, with a look ahead where something was put in or taken out. What is left is
//! paired wherever it is. Boxes are the same up to rounding, so they can be neither hashed nor compared as text. Each has a *mark*, a weighted
//! sum of its coordinates and its key: what is the same has nearly the same mark, and few others have. Both lists are
//! sorted by their marks, and gone through side by side.

use alloc::vec;
use alloc::vec::Vec;

use super::world_box::WorldBox;

/// A caster, as it is looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Caster {
    pub(super) key: Option<u64>,
    pub(super) aabb: WorldBox,
    /// Metres by which the same box may differ.
    pub(super) rounding: f64,
    pub(super) number: usize,
}

impl Caster {
    /// Whether one of the frame before is the same as one of this frame: its box is, and its key, where both have one.
    pub(super) fn is_same(&self, now: &Self) -> bool {
        let has_same_key = self.key.zip(now.key).is_none_or(|(before, now)| before == now);
        has_same_key && self.aabb.is_same(&now.aabb, now.rounding)
    }
}

/// Casters that are looked ahead for where two lists differ.
const AHEAD: usize = 8;

/// How many casters were taken out of a list, or put in, before it goes on as it did; `None` where neither is found, or
/// where one only took another one's place. The functions give the casters of both lists from where they differ.
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

/// Weights of a mark. No sums of a few of them are equal, so that neither grids of boxes nor boxes in a row share marks.
const WEIGHTS: [f64; 6] = [1.0, 0.732_050_807, 0.236_067_977, 0.645_751_311, 0.316_624_790, 0.605_551_275];

/// Sum of the weights, rounded up.
const WEIGHT: f64 = 4.0;

/// Rounding of a mark in f64, as a share of the coordinates.
const MARK_ROUNDING: f64 = 1e-14;

/// Metres that lie between the marks of casters with different keys, about: far more than a world, and few enough for
/// the marks to be exact to a hundredth of a millimetre.
const KEY_RANGE: f64 = 1e9;

/// Takes the pairs of the same caster out of both lists. `found` gets the number that each had in the second list, and
/// its box in the first one.
///
/// Two casters with keys are the same if their keys and boxes are; where one has none, their boxes decide.
pub(super) fn pair(before: &mut Vec<Caster>, now: &mut Vec<Caster>, mut found: impl FnMut(usize, WorldBox)) {
    let mut pair_of = |of_before: KeyOf, of_now: KeyOf| {
        if !before.is_empty() && !now.is_empty() {
            pair_by_key(before, now, [of_before, of_now], &mut found);
        }
    };
    pair_of(Some, Some);
    // Keys that only one of the two has.
    let (known, unknown): (KeyOf, KeyOf) = (|key| key.map(|_| None), |key| key.is_none().then_some(None));
    pair_of(known, unknown);
    pair_of(unknown, known);
}

/// The key by which a caster is looked for, if it is.
type KeyOf = fn(Option<u64>) -> Option<Option<u64>>;

fn pair_by_key(
    before: &mut Vec<Caster>,
    now: &mut Vec<Caster>,
    [of_before, of_now]: [KeyOf; 2],
    found: &mut impl FnMut(usize, WorldBox),
) {
    let (sorted, wanted) = (entries(before, of_before), entries(now, of_now));
    if sorted.is_empty() || wanted.is_empty() {
        return;
    }
    let reach = now.iter().map(reach).fold(0.0, f64::max);
    let (mut taken_before, mut taken_now) = (vec![false; before.len()], vec![false; now.len()]);
    let (mut first, mut free) = (0, Free::new(sorted.len()));
    for entry in &wanted {
        let caster = &now[entry.index as usize];
        let is_low = |low: &Entry| low.mark < entry.mark - reach;
        first += sorted[first..].iter().take_while(|low| is_low(low)).count();
        let mut at = free.from(first);
        while let Some(candidate) = sorted.get(at).filter(|candidate| candidate.mark <= entry.mark + reach) {
            let same = &before[candidate.index as usize];
            if of_before(same.key) == of_now(caster.key) && same.aabb.is_same(&caster.aabb, caster.rounding) {
                (taken_before[candidate.index as usize], taken_now[entry.index as usize]) = (true, true);
                free.take(at);
                found(caster.number, same.aabb);
                break;
            }
            at = free.from(at + 1);
        }
    }
    keep_untaken(before, &taken_before);
    keep_untaken(now, &taken_now);
}

fn keep_untaken(list: &mut Vec<Caster>, is_taken: &[bool]) {
    let mut is_taken = is_taken.iter();
    list.retain(|_| is_taken.next() == Some(&false));
}

/// A caster of a list, by its mark.
#[derive(Clone, Copy, Debug)]
struct Entry {
    mark: f64,
    index: u32,
}

/// The casters that are looked for, in the order of their marks.
fn entries(list: &[Caster], key_of: KeyOf) -> Vec<Entry> {
    let entry = |(index, caster): (u32, &Caster)| Some(Entry { mark: mark(caster, key_of(caster.key)?), index });
    let mut entries: Vec<Entry> = (0..).zip(list).filter_map(entry).collect();
    entries.sort_unstable_by(|a, b| a.mark.total_cmp(&b.mark).then(a.index.cmp(&b.index)));
    entries
}

fn mark(caster: &Caster, key: Option<u64>) -> f64 {
    let coordinates = caster.aabb.min.to_array().into_iter().chain(caster.aabb.max.to_array());
    let of_box: f64 = coordinates.zip(WEIGHTS).map(|(coordinate, weight)| coordinate * weight).sum();
    // The fraction of the golden ratio spreads keys in a row far from each other.
    let of_key = key.map_or(0, |key| key.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15)) >> 40;
    of_box + of_key as f64 * (KEY_RANGE / f64::from(1 << 24))
}

/// How far apart the marks of the same casters may be.
fn reach(caster: &Caster) -> f64 {
    let size = caster.aabb.min.abs().max(caster.aabb.max.abs()).max_element();
    WEIGHT * (caster.rounding + (size + KEY_RANGE) * MARK_ROUNDING)
}

/// Which entries are not taken yet.
struct Free {
    /// For each the first at or after it that is not taken, as far as that is known.
    next: Vec<u32>,
}

impl Free {
    fn new(count: usize) -> Self {
        Self { next: (0..=count as u32).collect() }
    }

    /// The first entry at or after this one that is not taken.
    fn from(&mut self, from: usize) -> usize {
        let mut end = from.min(self.next.len() - 1);
        while self.next[end] as usize != end {
            end = self.next[end] as usize;
        }
        let mut at = from;
        while at < end {
            at = core::mem::replace(&mut self.next[at], end as u32) as usize;
        }
        end
    }

    fn take(&mut self, entry: usize) {
        self.next[entry] = entry as u32 + 1;
    }
}
