//! A hierarchy of static boxes. The cost of a frame depends on the boxes nearby, not on the total.
//!
//! A list is read from end to end in each frame, which is fastest for hundreds of boxes. [`StaticBoxes`] are built once
//! and then changed box by box. A fit reads only the boxes that can change it, culling finds the casters of a map in the
//! hierarchy, and the cache asks which boxes have changed.

mod nodes;

use alloc::collections::VecDeque;
use alloc::vec::Vec;

use glam::{DVec3, Vec3};

use crate::base::{Aabb, Boxes, FitError, checks};
use nodes::{NONE, Nodes};

/// Static boxes in world axes, each with a number that it keeps. They receive and cast shadows beside the lists of a
/// frame ([`FitInput::static_boxes`](crate::FitInput::static_boxes)).
///
/// Use them for a thousand static boxes or more. Boxes that move in each frame are cheaper in a list. A change takes
/// about a microsecond for any number of boxes, and no frame rebuilds the hierarchy.
///
/// ```
/// use shadowfit::glam::{DVec3, Vec3};
/// use shadowfit::{Aabb, StaticBoxes, FitInput, PerspectiveCamera, ShadowFitter, Technique};
///
/// let mut world = StaticBoxes::new(DVec3::ZERO);
/// for i in 0..100 {
///     let corner = Vec3::new((i % 10) as f32 * 4.0, 0.0, (i / 10) as f32 * -4.0);
///     world.insert(Aabb::new(corner, corner + 2.0))?;
/// }
/// let fallen = world.insert(Aabb::new(Vec3::ZERO, Vec3::ONE))?; // its number
///
/// let mut fitter = ShadowFitter::new(&Technique::default());
/// # let (forward, up) = (Vec3::NEG_Z, Vec3::Y);
/// # let camera = PerspectiveCamera {
/// #     eye: DVec3::new(0.0, 1.7, 5.0), forward, up, fov_y: 0.8, aspect: 1.6, near: 0.1, far: 200.0
/// # };
/// # let views = [camera.frustum()?];
/// let input = FitInput { static_boxes: Some(&world), ..FitInput::new(&views, Vec3::new(0.3, -0.8, 0.2)) };
/// fitter.fit(&input)?;
/// world.set(fallen, Aabb::new(Vec3::X, Vec3::X + 1.0))?;
/// # Ok::<(), shadowfit::FitError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StaticBoxes {
    origin: DVec3,
    nodes: Nodes,
    /// Whether each number is in use, by a box that may be empty.
    used: Vec<bool>,
    free: Vec<u32>,
    revision: BoxRevision,
    /// The last changes, each with the revision before it.
    log: VecDeque<(BoxRevision, BoxChange)>,
}

/// A state of a [`StaticBoxes`], to ask [what has changed since](StaticBoxes::changes_since).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoxRevision {
    /// Number of changes since the tree was made.
    changes: u64,
    /// Sum of hashes of all boxes, so that states of different trees differ.
    content: u64,
}

/// A change of one box of a [`StaticBoxes`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxChange {
    /// Number of the box.
    pub number: u32,
    /// Where it was, relative to the tree's origin, in metres; empty for one that came.
    pub before: Aabb,
    /// Where it is now; empty for one that is gone.
    pub after: Aabb,
}

impl StaticBoxes {
    /// Changes that are remembered: with more of them between two frames, all counts as changed.
    pub const MAX_CHANGES: usize = 16_384;

    /// A tree without a box. Its boxes are relative to `origin`, a world position in metres, as those of [`Boxes`]: f32
    /// has steps of 8 mm at 100 km from it.
    pub fn new(origin: DVec3) -> Self {
        let content = hash(NONE, &[origin.x, origin.y, origin.z]);
        let revision = BoxRevision { changes: 0, content };
        Self { origin, nodes: Nodes::new(), used: Vec::new(), free: Vec::new(), revision, log: VecDeque::new() }
    }

    /// The tree of a whole list, which is faster and tighter than one box after the other. Numbers are those of the list;
    /// empty boxes keep theirs.
    ///
    /// # Errors
    ///
    /// [`FitError::NotFinite`] and [`FitError::OutOfRange`] for coordinates that are not numbers or beyond 1e18 m, and for
    /// more than `u32::MAX - 1` boxes.
    pub fn from_boxes(boxes: Boxes<'_>) -> Result<Self, FitError> {
        checks::point("the boxes' origin", boxes.origin)?;
        checks::within("the number of boxes of a tree", boxes.boxes.len() as f64, 0.0, MAX_BOXES)?;
        let mut tree = Self::new(boxes.origin);
        let mut entries = Vec::with_capacity(boxes.boxes.len());
        for (aabb, number) in boxes.boxes.iter().zip(0..) {
            let aabb = checked(aabb)?;
            tree.revision.content = tree.revision.content.wrapping_add(hash_of(number, &aabb));
            if !aabb.is_empty() {
                entries.push((aabb, number));
            }
        }
        tree.used.resize(boxes.boxes.len(), true);
        tree.nodes = Nodes::of(&mut entries, boxes.boxes.len());
        Ok(tree)
    }

    /// World position that the boxes are relative to, in metres.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Number of boxes, empty ones included.
    pub fn len(&self) -> usize {
        self.used.len() - self.free.len()
    }

    /// Whether there is no box.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A box around all, relative to the [origin](Self::origin); empty without one.
    pub fn bounds(&self) -> Aabb {
        self.nodes.bounds()
    }

    /// The box of a number, relative to the [origin](Self::origin); `None` where the number is not in use.
    pub fn get(&self, number: u32) -> Option<Aabb> {
        self.is_used(number).then(|| self.nodes.get(number).unwrap_or(Aabb::EMPTY))
    }

    /// Adds a box, in metres relative to the [origin](Self::origin), and returns its number, which it keeps until it is
    /// [removed](Self::remove). An empty box receives and casts nothing.
    ///
    /// # Errors
    ///
    /// As [`Self::from_boxes`].
    pub fn insert(&mut self, aabb: Aabb) -> Result<u32, FitError> {
        let aabb = checked(&aabb)?;
        let number = self.free.last().copied().unwrap_or(self.used.len() as u32);
        checks::within("the number of boxes of a tree", f64::from(number), 0.0, MAX_BOXES - 1.0)?;
        if self.free.pop().is_none() {
            self.used.push(true);
        }
        self.used[number as usize] = true;
        if !aabb.is_empty() {
            self.nodes.insert(number, aabb);
        }
        self.record(BoxChange { number, before: Aabb::EMPTY, after: aabb });
        Ok(number)
    }

    /// Moves a box. A shadow map that is kept is redrawn where it was and where it is; a box that stays as it is changes
    /// nothing.
    ///
    /// # Errors
    ///
    /// As [`Self::from_boxes`], and [`FitError::OutOfRange`] for a number that is not in use.
    pub fn set(&mut self, number: u32, aabb: Aabb) -> Result<(), FitError> {
        let after = checked(&aabb)?;
        let Some(before) = self.get(number) else {
            let (value, max) = (f64::from(number), self.used.len() as f64 - 1.0);
            return Err(FitError::OutOfRange { input: "the number of a box", value, min: 0.0, max });
        };
        if before == after {
            return Ok(());
        }
        if after.is_empty() {
            self.nodes.remove(number);
        } else {
            self.nodes.set(number, after);
        }
        self.record(BoxChange { number, before, after });
        Ok(())
    }

    /// Removes a box and returns it; `None` where the number is not in use. A later box may get the number.
    pub fn remove(&mut self, number: u32) -> Option<Aabb> {
        let before = self.get(number)?;
        self.nodes.remove(number);
        self.used[number as usize] = false;
        self.free.push(number);
        self.record(BoxChange { number, before, after: Aabb::EMPTY });
        Some(before)
    }

    /// All boxes with their numbers, in no particular order; empty ones are left out.
    pub fn for_each(&self, mut visit: impl FnMut(u32, &Aabb)) {
        self.nodes.visit((), &mut (), &|(), (), _| Some(()), &mut |(), (), number, aabb| visit(number, aabb));
    }

    /// The present state.
    pub fn revision(&self) -> BoxRevision {
        self.revision
    }

    /// What has changed since an earlier state, the oldest change first: a box that changed twice comes twice. `None`
    /// where that is not known: more than [`Self::MAX_CHANGES`] have changed since, or it was the state of another tree.
    pub fn changes_since(&self, revision: BoxRevision) -> Option<impl ExactSizeIterator<Item = BoxChange>> {
        let count = usize::try_from(self.revision.changes.checked_sub(revision.changes)?).ok()?;
        let first = self.log.len().checked_sub(count)?;
        let known = self.log.get(first).map_or(self.revision, |(before, _)| *before);
        (known == revision).then(|| self.log.range(first..).map(|(_, change)| *change))
    }

    /// Passes on each box with its number for which `enter` gives something, as it does for all boxes of the hierarchy
    /// around it. Boxes are relative to the tree's origin; what `enter` gives for a box is handed to those inside it.
    pub(crate) fn visit<C: Copy, S>(
        &self,
        context: C,
        state: &mut S,
        enter: impl Fn(&mut S, C, &Aabb) -> Option<C>,
        mut take: impl FnMut(&mut S, C, u32, &Aabb),
    ) {
        self.nodes.visit(context, state, &enter, &mut take);
    }

    /// The same of those that have distances, least and greatest, about the nearest first.
    pub(crate) fn visit_nearest<S>(
        &self,
        state: &mut S,
        distances: impl Fn(&Aabb) -> Option<(f64, f64)>,
        enter: impl Fn(&S, (f64, f64), &Aabb) -> bool,
        mut take: impl FnMut(&mut S, (f64, f64), u32, &Aabb),
    ) {
        self.nodes.visit_nearest(state, &distances, &enter, &mut take);
    }

    fn is_used(&self, number: u32) -> bool {
        self.used.get(number as usize).copied().unwrap_or(false)
    }

    fn record(&mut self, change: BoxChange) {
        let BoxChange { number, before, after } = change;
        if self.log.len() == Self::MAX_CHANGES {
            self.log.pop_front();
        }
        self.log.push_back((self.revision, change));
        let content = self.revision.content.wrapping_sub(hash_of(number, &before));
        self.revision.content = content.wrapping_add(hash_of(number, &after));
        self.revision.changes += 1;
    }
}

/// Most boxes: one number stands for none.
const MAX_BOXES: f64 = u32::MAX as f64 - 1.0;

/// A box whose coordinates are numbers that fits can use, with all empty ones alike.
fn checked(aabb: &Aabb) -> Result<Aabb, FitError> {
    let is_nan = aabb.min.is_nan() || aabb.max.is_nan();
    if aabb.is_empty() && !is_nan {
        return Ok(Aabb::EMPTY);
    }
    checks::point("a corner of a box", aabb.min.as_dvec3())?;
    checks::point("a corner of a box", aabb.max.as_dvec3())?;
    Ok(*aabb)
}

/// A hash of a box and its number; 0 for an empty one.
fn hash_of(number: u32, aabb: &Aabb) -> u64 {
    if aabb.is_empty() {
        return 0;
    }
    let numbers = |v: Vec3| v.to_array().map(f64::from);
    let ([a, b, c], [d, e, f]) = (numbers(aabb.min), numbers(aabb.max));
    hash(number, &[a, b, c, d, e, f])
}

/// The bits of numbers, mixed by multiplication with a prime and shifts.
fn hash(number: u32, values: &[f64]) -> u64 {
    values.iter().fold(u64::from(number) + 1, |hash, value| {
        let mixed = (hash ^ value.to_bits()).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        mixed ^ (mixed >> 29)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(x: f32) -> Aabb {
        Aabb::new(Vec3::splat(x), Vec3::splat(x + 1.0))
    }

    fn changes(tree: &StaticBoxes, since: BoxRevision) -> Option<Vec<(u32, Aabb, Aabb)>> {
        let changes = tree.changes_since(since)?;
        Some(changes.map(|change| (change.number, change.before, change.after)).collect())
    }

    #[test]
    fn numbers_are_kept_and_those_of_removed_boxes_are_given_again() {
        let mut tree = StaticBoxes::from_boxes(Boxes::world(&[cube(0.0), Aabb::EMPTY, cube(2.0)])).expect("good boxes");
        assert_eq!((tree.len(), tree.get(1), tree.get(2)), (3, Some(Aabb::EMPTY), Some(cube(2.0))));
        assert_eq!(tree.insert(cube(3.0)), Ok(3));
        assert_eq!(tree.remove(0), Some(cube(0.0)));
        assert_eq!((tree.remove(0), tree.get(0), tree.len()), (None, None, 3));
        assert_eq!(tree.insert(cube(9.0)), Ok(0));
        tree.set(1, cube(5.0)).expect("it is in use");
        tree.set(2, Aabb::EMPTY).expect("it is in use");
        let mut all = Vec::new();
        tree.for_each(|number, aabb| all.push((number, *aabb)));
        all.sort_by_key(|(number, _)| *number);
        assert_eq!(all, [(0, cube(9.0)), (1, cube(5.0)), (3, cube(3.0))]);
        assert_eq!(tree.bounds(), Aabb::new(Vec3::splat(3.0), Vec3::splat(10.0)));
    }

    #[test]
    fn what_has_changed_is_told_from_any_state_that_is_remembered() {
        let mut tree = StaticBoxes::new(DVec3::ZERO);
        let first = tree.revision();
        let a = tree.insert(cube(0.0)).expect("a box");
        let second = tree.revision();
        tree.set(a, cube(4.0)).expect("it is in use");
        tree.set(a, cube(4.0)).expect("it is in use");
        tree.remove(a);
        let [empty, old, new] = [Aabb::EMPTY, cube(0.0), cube(4.0)];
        assert_eq!(changes(&tree, first), Some([(a, empty, old), (a, old, new), (a, new, empty)].to_vec()));
        assert_eq!(changes(&tree, second), Some([(a, old, new), (a, new, empty)].to_vec()));
        assert_eq!(changes(&tree, tree.revision()), Some(Vec::new()));
        for i in 0..StaticBoxes::MAX_CHANGES {
            tree.insert(cube(i as f32)).expect("a box");
        }
        assert_eq!(changes(&tree, second), None, "it is forgotten");
    }

    #[test]
    fn states_of_another_tree_are_not_taken_for_this_one() {
        let tree = |origin: f64, x: f32| {
            let mut tree = StaticBoxes::new(DVec3::splat(origin));
            tree.insert(cube(x)).expect("a box");
            tree
        };
        let one = tree(0.0, 1.0);
        assert!(one.changes_since(tree(0.0, 2.0).revision()).is_none());
        assert!(one.changes_since(tree(1.0, 1.0).revision()).is_none());
        assert!(one.changes_since(tree(0.0, 1.0).revision()).is_some_and(|changes| changes.len() == 0));
    }

    #[test]
    fn bad_boxes_and_numbers_are_refused_and_change_nothing() {
        let mut tree = StaticBoxes::new(DVec3::ZERO);
        let number = tree.insert(cube(0.0)).expect("a box");
        let before = tree.clone();
        for bad in [f32::NAN, f32::INFINITY, 2e18] {
            let aabb = Aabb::new(Vec3::ZERO, Vec3::new(1.0, bad, 1.0));
            tree.insert(aabb).expect_err("a bad box");
            tree.set(number, aabb).expect_err("a bad box");
            StaticBoxes::from_boxes(Boxes::world(&[aabb])).expect_err("a bad box");
        }
        let unknown = tree.set(7, cube(0.0));
        assert!(matches!(unknown, Err(FitError::OutOfRange { value: 7.0, max: 0.0, .. })), "{unknown:?}");
        assert_eq!(tree, before);
    }
}
