//! The casters of a frame, and their changes since the previous frame.

use alloc::vec::Vec;

use super::identity::{Caster, pair, shift};
use super::world_box::{WorldBox, rounding};
use crate::static_boxes::BoxRevision;
use crate::{Boxes, StaticBoxes};

/// All shadow casters. A caster's number is the index of its box.
///
/// Static casters are identified by their boxes and keys, not by their numbers. Lists may come in any order,
/// sorted or culled, with casters inserted or removed anywhere. The cache redraws places where a caster
/// appeared or disappeared, or where its box or key changed. Identical casters are interchangeable: only
/// their count matters.
///
/// | change of a static caster | what to do |
/// |---|---|
/// | appears, disappears, or has another box | nothing: its old and new places are redrawn |
/// | has another shape in the same box | change its key, or call [`invalidate`](super::MapCache::invalidate) |
/// | has another number | nothing: cheapest if most casters keep their numbers |
///
/// One box may hold many casters that an engine culls by itself, such as all casters in a cell of the world.
/// In this case call [`invalidate`](super::MapCache::invalidate) for the places where static casters changed
/// within the box. Give moving casters separate boxes, which may overlap it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Casters<'a> {
    /// Bounding box of each caster. A caster with an empty box casts no shadow.
    pub boxes: Boxes<'a>,
    /// Whether each caster moves, deforms or changes its shape in any other way. Casters past the end of the
    /// slice are static. Moving casters are drawn in every frame. Static casters are drawn once and kept.
    pub moves: &'a [bool],
    /// A key that identifies each caster's shape: an id of its mesh, level of detail or entity, or a hash of
    /// them. Any number is a valid key, and casters may share one. Casters past the end of the slice have no
    /// key and are identified by their boxes alone. Keys past the end of the boxes are ignored. If a caster
    /// has a key in only one of two successive frames, its box decides.
    pub keys: &'a [u64],
}

impl<'a> Casters<'a> {
    /// Returns a list of static casters.
    pub const fn fixed(boxes: Boxes<'a>) -> Self {
        Self { boxes, moves: &[], keys: &[] }
    }

    /// Returns whether a caster moves.
    pub fn moves(&self, number: usize) -> bool {
        self.moves.get(number).copied().unwrap_or(false)
    }
}

/// Places where static casters changed in a frame, in world space. A caster whose box changed is in both
/// lists.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Changes {
    pub(super) gone: Vec<WorldBox>,
    pub(super) come: Vec<WorldBox>,
    /// Whether anything may have changed.
    pub(super) is_all: bool,
}

/// The casters of the last frame.
#[derive(Debug, Default)]
pub(super) struct KnownCasters {
    /// Box of each static caster when it was drawn. Empty for moving casters.
    drawn: Vec<WorldBox>,
    /// The keys of the casters that had one, from the first caster on.
    keys: Vec<u64>,
    /// The numbers of the moving casters.
    pub(super) moving: Vec<u32>,
    /// The revision of the static boxes.
    static_boxes: Option<BoxRevision>,
}

impl KnownCasters {
    /// Returns whether a caster is static and not empty.
    pub(super) fn is_fixed(&self, number: u32) -> bool {
        self.drawn.get(number as usize).is_some_and(|aabb| !aabb.is_empty())
    }

    /// Records the casters of a frame, and finds the places where static casters changed.
    pub(super) fn update(&mut self, casters: &Casters<'_>, static_boxes: Option<&StaticBoxes>) -> Changes {
        let mut changes = self.update_listed(casters);
        let before = core::mem::replace(&mut self.static_boxes, static_boxes.map(StaticBoxes::revision));
        let Some((before, tree)) = before.zip(static_boxes) else {
            changes.is_all = before.is_some() || static_boxes.is_some();
            return changes;
        };
        let Some(changed) = tree.changes_since(before) else { return Changes { is_all: true, ..changes } };
        for change in changed {
            let [before, after] = [change.before, change.after].map(|aabb| WorldBox::new(&aabb, tree.origin()));
            changes.gone.extend(Some(before).filter(|aabb| !aabb.is_empty()));
            changes.come.extend(Some(after).filter(|aabb| !aabb.is_empty()));
        }
        changes
    }

    fn update_listed(&mut self, casters: &Casters<'_>) -> Changes {
        let count = casters.boxes.boxes.len();
        self.moving.clear();
        self.moving.extend((0..count as u32).zip(casters.moves).filter(|(_, moves)| **moves).map(|(number, _)| number));
        let list = List { casters, keys: &casters.keys[..casters.keys.len().min(count)] };
        let mut differ = Differences::default();
        let kept = self.compare_in_place(&list, &mut differ);
        self.compare_shifted(&list, kept, &mut differ);
        if self.keys != list.keys {
            self.keys.clear();
            self.keys.extend(list.keys);
        }
        let Differences { mut gone, mut come, .. } = differ;
        gone.retain(|caster| !caster.aabb.is_empty());
        come.retain(|caster| !caster.aabb.is_empty());
        // A caster that is found under another number keeps the box it was drawn with.
        pair(&mut gone, &mut come, |number, aabb| self.drawn[number] = aabb);
        let boxes = |list: Vec<Caster>| list.into_iter().map(|caster| caster.aabb).collect();
        Changes { gone: boxes(gone), come: boxes(come), is_all: false }
    }

    /// Returns a caster of the last frame.
    fn before(&self, number: usize) -> Option<Caster> {
        let aabb = *self.drawn.get(number)?;
        Some(Caster { key: self.keys.get(number).copied(), aabb, rounding: 0.0, number })
    }

    /// Compares the lists number by number, up to the first insertion or removal. Returns that number.
    fn compare_in_place(&mut self, list: &List<'_>, differ: &mut Differences) -> usize {
        let count = list.len().min(self.drawn.len());
        let has_same_keys = self.keys == list.keys;
        for number in 0..count {
            let (aabb, rounding) = list.aabb(number);
            if has_same_keys && self.drawn[number].is_same(&aabb, rounding) {
                continue;
            }
            let (Some(before), Some(now)) = (self.before(number), list.get(number)) else { continue };
            if before.is_same(&now) {
                continue;
            }
            if differ.shift(|ahead| self.before(number + ahead), |ahead| list.get(number + ahead)).is_some() {
                return number;
            }
            differ.gone.push(before);
            differ.come.push(now);
            self.drawn[number] = aabb;
        }
        count
    }

    /// Compares the rest of the lists from a number on, with a search for insertions and removals.
    fn compare_shifted(&mut self, list: &List<'_>, first: usize, differ: &mut Differences) {
        let before: Vec<Caster> = (first..self.drawn.len()).filter_map(|number| self.before(number)).collect();
        self.drawn.truncate(first);
        let mut rest = &before[..];
        while let Some(now) = list.get(self.drawn.len()) {
            let number = self.drawn.len();
            if let Some(same) = rest.first().filter(|before| before.is_same(&now)) {
                self.drawn.push(same.aabb);
                rest = &rest[1..];
                continue;
            }
            let found = differ.shift(|ahead| rest.get(ahead).copied(), |ahead| list.get(number + ahead));
            let [removed, inserted] = found.unwrap_or([1, 1]);
            let (gone, after) = rest.split_at(removed.min(rest.len()));
            differ.gone.extend(gone);
            rest = after;
            for now in (number..number + inserted).filter_map(|number| list.get(number)) {
                self.drawn.push(now.aabb);
                differ.come.push(now);
            }
        }
        differ.gone.extend(rest);
    }
}

/// The casters of a frame, and their keys.
struct List<'a> {
    casters: &'a Casters<'a>,
    keys: &'a [u64],
}

impl List<'_> {
    fn len(&self) -> usize {
        self.casters.boxes.boxes.len()
    }

    /// Returns the box of a caster, empty for a moving one, and the rounding in metres by which the same box
    /// may differ.
    fn aabb(&self, number: usize) -> (WorldBox, f64) {
        let Boxes { origin, boxes } = self.casters.boxes;
        if self.casters.moves(number) {
            return (WorldBox::EMPTY, 0.0);
        }
        (WorldBox::new(&boxes[number], origin), rounding(&boxes[number]))
    }

    fn get(&self, number: usize) -> Option<Caster> {
        (number < self.len()).then(|| {
            let (aabb, rounding) = self.aabb(number);
            Caster { key: self.keys.get(number).copied(), aabb, rounding, number }
        })
    }
}

/// Casters that are in only one of two lists, with their numbers in that list.
#[derive(Default)]
struct Differences {
    gone: Vec<Caster>,
    come: Vec<Caster>,
    /// Number of failed searches ahead.
    missed: usize,
}

/// Number of failed searches ahead after which two lists count as differently ordered.
const MAX_MISSED: usize = 256;

impl Differences {
    /// Calls [`shift`] unless the lists are in different orders.
    fn shift(
        &mut self,
        before: impl Fn(usize) -> Option<Caster>,
        now: impl Fn(usize) -> Option<Caster>,
    ) -> Option<[usize; 2]> {
        let found = if self.missed < MAX_MISSED { shift(before, now) } else { None };
        self.missed += usize::from(found.is_none());
        found
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use glam::{DVec3, Vec3};

    use super::*;
    use crate::Aabb;

    fn cube(x: f32, y: f32) -> Aabb {
        Aabb::new(Vec3::new(x, y, 0.0), Vec3::new(x + 1.0, y + 1.0, 1.0))
    }

    fn row(count: usize) -> Vec<Aabb> {
        (0..count).map(|i| cube(3.0 * i as f32, 0.0)).collect()
    }

    fn world(aabb: Aabb) -> WorldBox {
        WorldBox::new(&aabb, DVec3::ZERO)
    }

    fn take(known: &mut KnownCasters, boxes: &[Aabb], moves: &[bool], keys: &[u64]) -> Changes {
        known.update(&Casters { boxes: Boxes::world(boxes), moves, keys }, None)
    }

    fn changes(gone: &[Aabb], come: &[Aabb]) -> Changes {
        let boxes = |list: &[Aabb]| list.iter().copied().map(world).collect();
        Changes { gone: boxes(gone), come: boxes(come), is_all: false }
    }

    #[test]
    fn static_casters_change_where_they_appear_move_start_to_move_and_vanish() {
        let known = &mut KnownCasters::default();
        let boxes = [cube(0.0, 0.0), cube(5.0, 2.0), cube(9.0, 1.0)];
        assert_eq!(take(known, &boxes, &[], &[]), changes(&[], &boxes));
        assert_eq!(take(known, &boxes, &[], &[]), Changes::default());
        // It starts to move, so its old place changes.
        assert_eq!(take(known, &boxes, &[false, true], &[]), changes(&[boxes[1]], &[]));
        assert_eq!([0, 1, 2].map(|number| known.is_fixed(number)), [true, false, true]);
        assert_eq!(known.moving, [1]);
        // Moving casters do not change the kept content.
        let moved = [boxes[0], cube(5.0, 7.0), boxes[2]];
        assert_eq!(take(known, &moved, &[false, true], &[]), Changes::default());
        // The moving caster comes to rest elsewhere, a static one is placed elsewhere, and the last one
        // disappears.
        let rest = [cube(0.5, 0.0), moved[1]];
        assert_eq!(take(known, &rest, &[], &[]), changes(&[boxes[0], boxes[2]], &rest));
        assert_eq!(take(known, &[], &[], &[]), changes(&rest, &[]));
    }

    #[test]
    fn lists_in_another_order_change_only_where_a_caster_came_or_went() {
        let boxes = row(100);
        let after = |change: &dyn Fn(&mut Vec<Aabb>)| -> Changes {
            let known = &mut KnownCasters::default();
            take(known, &boxes, &[], &[]);
            let mut other = boxes.clone();
            change(&mut other);
            let found = take(known, &other, &[], &[]);
            assert_eq!(take(known, &other, &[], &[]), Changes::default());
            found
        };
        assert_eq!(after(&|list| list.reverse()), Changes::default());
        assert_eq!(after(&|list| list.rotate_left(37)), Changes::default());
        assert_eq!(after(&|list| list.retain(|aabb| *aabb != boxes[40])), changes(&[boxes[40]], &[]));
        assert_eq!(after(&|list| list[40] = list.pop().unwrap_or(Aabb::EMPTY)), changes(&[boxes[40]], &[]));
        assert_eq!(after(&|list| list.insert(0, cube(-9.0, 4.0))), changes(&[], &[cube(-9.0, 4.0)]));
        let culled = after(&|list| list.retain(|aabb| aabb.min.x < 270.0));
        assert_eq!(culled, changes(&boxes[90..], &[]));
    }

    #[test]
    fn of_equal_casters_only_the_count_matters() {
        let known = &mut KnownCasters::default();
        let [a, b] = [cube(0.0, 0.0), cube(5.0, 0.0)];
        take(known, &[a, a, b, a], &[], &[]);
        assert_eq!(take(known, &[b, a, a, a], &[], &[]), Changes::default());
        assert_eq!(take(known, &[a, b, a], &[], &[]), changes(&[a], &[]));
        assert_eq!(take(known, &[b, a, a, b, b], &[], &[]), changes(&[], &[b, b]));
        // One key for all casters has the same effect as no keys.
        assert_eq!(take(known, &[b, b, a, a, b], &[], &[7; 5]), Changes::default());
        assert_eq!(take(known, &[b, a, b, a, b], &[], &[7; 5]), Changes::default());
        assert_eq!(take(known, &[a, b, a], &[], &[7; 3]).gone, [world(b), world(b)]);
    }

    #[test]
    fn another_key_redraws_the_same_box() {
        let known = &mut KnownCasters::default();
        let boxes = row(4);
        take(known, &boxes, &[], &[1, 2, 3, 4]);
        assert_eq!(take(known, &boxes, &[], &[1, 2, 30, 4]), changes(&[boxes[2]], &[boxes[2]]));
        // Keys and boxes reordered together are the same casters. Keys reordered alone are not.
        let turned = [boxes[3], boxes[2], boxes[1], boxes[0]];
        assert_eq!(take(known, &turned, &[], &[4, 30, 2, 1]), Changes::default());
        let swapped = take(known, &turned, &[], &[4, 30, 1, 2]);
        assert_eq!(swapped, changes(&[boxes[1], boxes[0]], &[boxes[1], boxes[0]]));
        // The box moves and the key stays.
        let moved = [turned[0], turned[1], cube(3.0, 8.0), turned[3]];
        assert_eq!(take(known, &moved, &[], &[4, 30, 1, 2]), changes(&[boxes[1]], &[moved[2]]));
    }

    #[test]
    fn where_a_caster_has_no_key_its_box_decides() {
        let known = &mut KnownCasters::default();
        let boxes = row(4);
        take(known, &boxes, &[], &[1, 2]);
        assert_eq!(take(known, &boxes, &[], &[1, 2, 3, 4, 5, 6]), Changes::default(), "keys of no caster are ignored");
        let turned = [boxes[3], boxes[2], boxes[1], boxes[0]];
        assert_eq!(take(known, &turned, &[], &[]), Changes::default());
        assert_eq!(take(known, &boxes, &[], &[9, 8]), Changes::default());
        assert_eq!(take(known, &boxes, &[], &[9, 7]), changes(&[boxes[1]], &[boxes[1]]));
    }

    #[test]
    fn boxes_relative_to_a_moving_origin_do_not_change_by_its_rounding_in_any_order() {
        let known = &mut KnownCasters::default();
        let place = DVec3::new(51_234.567, 3.0, -20_000.1);
        let relative = |eye: DVec3| {
            let aabb = |x: f64| {
                let min = (place + DVec3::new(x, 0.0, 0.0) - eye).as_vec3();
                Aabb::new(min, min + 1.0)
            };
            [aabb(0.0), aabb(80.0), aabb(80.1)]
        };
        let eye = place + DVec3::new(30.0, 1.7, 50.0);
        let mut take = |origin, boxes: &[Aabb]| known.update(&Casters::fixed(Boxes { origin, boxes }), None);
        assert_eq!(take(eye, &relative(eye)).come.len(), 3);
        for step in 1..200_u32 {
            let eye = eye + DVec3::new(0.013, 0.001, -0.027) * f64::from(step);
            let mut boxes = relative(eye);
            boxes.rotate_left(step as usize % 3);
            assert_eq!(take(eye, &boxes), Changes::default(), "{step}");
        }
    }

    #[test]
    fn boxes_that_are_not_numbers_cast_nothing_and_do_not_change() {
        let known = &mut KnownCasters::default();
        let boxes = [Aabb::new(Vec3::NAN, Vec3::ONE), Aabb::EMPTY];
        assert_eq!(take(known, &boxes, &[], &[]), Changes::default());
        assert!(!known.is_fixed(0) && !known.is_fixed(1));
    }
}
