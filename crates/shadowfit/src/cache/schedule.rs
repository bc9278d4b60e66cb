//! The choice of the maps to draw in a frame. The others wait.

use crate::settings::MAX_MAPS;

/// Schedule of the maps that may wait, because waiting only delays their shadows.
///
/// A waiting map keeps its content and its matrices. On any schedule, a map is drawn at once if waiting would
/// lose a receiver or a caster:
///
/// - The light has turned.
/// - The map's depth range no longer holds its receivers and casters.
/// - The map serves the points outside all other maps, and it has moved.
/// - The map shows a static caster in view that has moved or disappeared. New casters may appear late.
/// - The map is not kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UpdateSchedule {
    /// Draws every map in every frame. The default.
    #[default]
    EveryFrame,
    /// Draws map i in every n-th frame, with n at index i. 0 counts as 1.
    Every([u32; MAX_MAPS]),
    /// Texel budget per frame. Draws the map that has waited longest first, and at least one map.
    Texels(u64),
}

/// A map with something to draw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Candidate {
    pub(super) map: usize,
    /// Number of frames since the map was drawn.
    pub(super) age: u64,
    /// Number of texels to draw.
    pub(super) texels: u64,
    /// Whether it must be drawn.
    pub(super) is_due: bool,
}

impl UpdateSchedule {
    /// Returns for each map whether it is drawn in this frame.
    pub(super) fn choose(self, frame: u64, candidates: &mut [Candidate]) -> [bool; MAX_MAPS] {
        let mut drawn = [false; MAX_MAPS];
        let mut spent = 0;
        for due in candidates.iter().filter(|candidate| candidate.is_due) {
            drawn[due.map] = true;
            spent += due.texels;
        }
        candidates.sort_unstable_by_key(|candidate| (core::cmp::Reverse(candidate.age), candidate.map));
        let mut is_first = true;
        for candidate in candidates.iter().filter(|candidate| !candidate.is_due) {
            let is_chosen = match self {
                Self::EveryFrame => true,
                // Maps with the same interval take turns.
                Self::Every(frames) => {
                    let interval = u64::from(frames[candidate.map].max(1));
                    candidate.age >= interval || (frame + candidate.map as u64).is_multiple_of(interval)
                }
                Self::Texels(budget) => (is_first && spent == 0) || spent + candidate.texels <= budget,
            };
            if is_chosen {
                drawn[candidate.map] = true;
                spent += candidate.texels;
                is_first = false;
            }
        }
        drawn
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;

    fn candidate(map: usize, age: u64, texels: u64) -> Candidate {
        Candidate { map, age, texels, is_due: false }
    }

    #[test]
    fn what_must_be_drawn_is_drawn_whatever_the_schedule() {
        let mut candidates = [candidate(0, 1, 10), Candidate { is_due: true, ..candidate(3, 1, 1000) }];
        for schedule in [UpdateSchedule::Every([9; MAX_MAPS]), UpdateSchedule::Texels(5)] {
            assert!(schedule.choose(1, &mut candidates)[3], "{schedule:?}");
        }
        assert!(!UpdateSchedule::Texels(5).choose(1, &mut candidates)[0], "the budget is spent");
    }

    #[test]
    fn every_map_has_its_turn() {
        let schedules =
            [UpdateSchedule::Every([1, 2, 3, 5, 0, 7, 1, 1]), UpdateSchedule::Texels(15), UpdateSchedule::Texels(0)];
        for schedule in schedules {
            let (mut ages, mut longest) = ([1_u64; 4], [0; 4]);
            for frame in 0..100 {
                let mut candidates: Vec<Candidate> = (0..4).map(|map| candidate(map, ages[map], 10)).collect();
                let drawn = schedule.choose(frame, &mut candidates);
                for map in 0..4 {
                    longest[map] = longest[map].max(ages[map]);
                    ages[map] = if drawn[map] { 1 } else { ages[map] + 1 };
                }
            }
            let expected: [u64; 4] = if let UpdateSchedule::Every(_) = schedule { [1, 2, 3, 5] } else { [4; 4] };
            assert_eq!(longest, expected, "{schedule:?}");
        }
    }
}
