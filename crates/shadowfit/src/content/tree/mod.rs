//! A hierarchy of static boxes. The cost of a frame depends on the boxes nearby, not on the total.
//!
//! A list is read completely in each frame, which is fastest for hundreds of boxes. [`StaticBoxes`] are built
//! once and then changed box by box. A fit reads only the boxes that can change it, culling finds the casters
//! of a map in the hierarchy, and the cache reads the changes.

mod nodes;

use alloc::collections::VecDeque;
use alloc::vec::Vec;

use glam::{DVec3, Vec3};

use crate::base::{Aabb, Boxes, FitError, checks};
use nodes::{NONE, Nodes};

/// Static boxes in world axes, each with a permanent number. They receive and cast shadows in addition to the
/// lists of a frame ([`FitInput::static_boxes`](crate::FitInput::static_boxes)).
///
/// Use them for a thousand static boxes or more. Boxes that move in each frame are cheaper in a list. A
/// change takes about a microsecond for any number of boxes. Frames do not rebuild the hierarchy.
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
    /// Whether each number is in use. Its box may be empty.
    used: Vec<bool>,
    free: Vec<u32>,
    revision: BoxRevision,
    /// The last changes, each with the revision before it.
    log: VecDeque<(BoxRevision, BoxChange)>,
}

/// A state of a [`StaticBoxes`], for [`StaticBoxes::changes_since`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoxRevision {
    /// Number of changes since the tree was created.
    changes: u64,
    /// Sum of hashes of all boxes. It tells states of different trees apart.
    content: u64,
}

/// A change of one box of a [`StaticBoxes`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxChange {
    /// Number of the box.
    pub number: u32,
    /// Old box relative to the tree's origin, in metres. Empty for a new box.
    pub before: Aabb,
    /// New box. Empty for a removed box.
    pub after: Aabb,
}

impl StaticBoxes {
    /// Number of recorded changes. After more changes between two frames, all boxes count as changed.
    pub const MAX_CHANGES: usize = 16_384;

    /// Returns a tree without boxes. Boxes are relative to `origin`, a world position in metres, as in
    /// [`Boxes`]. At 100 km from it, f32 has steps of 8 mm.
    pub fn new(origin: DVec3) -> Self {
        let content = hash(NONE, &[origin.x, origin.y, origin.z]);
        let revision = BoxRevision { changes: 0, content };
        Self { origin, nodes: Nodes::new(), used: Vec::new(), free: Vec::new(), revision, log: VecDeque::new() }
    }

    /// Builds the tree of a whole list, faster and tighter than by inserting single boxes. Numbers are the
    /// indices in the list. Empty boxes have numbers as well.
    ///
    /// # Errors
    ///
    /// Returns [`FitError::NotFinite`] and [`FitError::OutOfRange`] for coordinates that are not numbers or
    /// beyond 1e18 m, and for more than `u32::MAX - 1` boxes.
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

    /// Returns the world position that the boxes are relative to, in metres.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Returns the number of boxes, including empty ones.
    pub fn len(&self) -> usize {
        self.used.len() - self.free.len()
    }

    /// Returns whether there are no boxes.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns a box around all boxes, relative to the [origin](Self::origin). Empty if there are none.
    pub fn bounds(&self) -> Aabb {
        self.nodes.bounds()
    }

    /// Returns the box with a number, relative to the [origin](Self::origin). `None` if the number is not in
    /// use.
    pub fn get(&self, number: u32) -> Option<Aabb> {
        self.is_used(number).then(|| self.nodes.get(number).unwrap_or(Aabb::EMPTY))
    }

    /// Adds a box, in metres relative to the [origin](Self::origin). Returns its number, which it keeps until
    /// it is [removed](Self::remove). An empty box receives and casts no shadow.
    ///
    /// # Errors
    ///
    /// Returns the same errors as [`Self::from_boxes`].
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

    /// Moves a box. Kept shadow maps are redrawn at its old and new place. An unchanged box has no effect.
    ///
    /// # Errors
    ///
    /// Returns the same errors as [`Self::from_boxes`], and [`FitError::OutOfRange`] for a number that is not
    /// in use.
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

    /// Removes a box and returns it. `None` if the number is not in use. A later box may get the number.
    pub fn remove(&mut self, number: u32) -> Option<Aabb> {
        let before = self.get(number)?;
        self.nodes.remove(number);
        self.used[number as usize] = false;
        self.free.push(number);
        self.record(BoxChange { number, before, after: Aabb::EMPTY });
        Some(before)
    }

    /// Calls `visit` for all boxes and their numbers, in no particular order. Skips empty boxes.
    pub fn for_each(&self, mut visit: impl FnMut(u32, &Aabb)) {
        self.nodes.visit((), &mut (), &|(), (), _| Some(()), &mut |(), (), number, aabb| visit(number, aabb));
    }

    /// Returns the current state.
    pub fn revision(&self) -> BoxRevision {
        self.revision
    }

    /// Returns the changes since an earlier state, oldest first. A box that changed twice comes twice. `None`
    /// if the changes are unknown: there were more than [`Self::MAX_CHANGES`] since, or the state belongs to
    /// another tree.
    pub fn changes_since(&self, revision: BoxRevision) -> Option<impl ExactSizeIterator<Item = BoxChange>> {
        let count = usize::try_from(self.revision.changes.checked_sub(revision.changes)?).ok()?;
        let first = self.log.len().checked_sub(count)?;
        let known = self.log.get(first).map_or(self.revision, |(before, _)| *before);
        (known == revision).then(|| self.log.range(first..).map(|(_, change)| *change))
    }

    /// Visits boxes from the root down, relative to the tree's origin. `enter` gets a box and the context of
    /// its parent, and returns the context of the box or `None` to skip it. `take` gets each reached box of a
    /// leaf with its number and context.
    pub(crate) fn visit<C: Copy, S>(
        &self,
        context: C,
        state: &mut S,
        enter: impl Fn(&mut S, C, &Aabb) -> Option<C>,
        mut take: impl FnMut(&mut S, C, u32, &Aabb),
    ) {
        self.nodes.visit(context, state, &enter, &mut take);
    }

    /// Visits boxes as [`Self::visit`] does, roughly nearest first. `distances` returns a box's least and
    /// greatest distance, or `None` to skip it.
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

/// Greatest number of boxes. One number is reserved for "none".
const MAX_BOXES: f64 = u32::MAX as f64 - 1.0;

/// Returns the box if its coordinates are numbers that fits can use. All empty boxes become [`Aabb::EMPTY`].
fn checked(aabb: &Aabb) -> Result<Aabb, FitError> {
    let is_nan = aabb.min.is_nan() || aabb.max.is_nan();
    if aabb.is_empty() && !is_nan {
        return Ok(Aabb::EMPTY);
    }
    checks::point("a corner of a box", aabb.min.as_dvec3())?;
    checks::point("a corner of a box", aabb.max.as_dvec3())?;
    Ok(*aabb)
}

/// Returns a hash of a box and its number. 0 for an empty box.
fn hash_of(number: u32, aabb: &Aabb) -> u64 {
    if aabb.is_empty() {
        return 0;
    }
    let numbers = |v: Vec3| v.to_array().map(f64::from);
    let ([a, b, c], [d, e, f]) = (numbers(aabb.min), numbers(aabb.max));
    hash(number, &[a, b, c, d, e, f])
}

/// Returns a hash of numbers, mixed by multiplication with a prime and shifts.
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
        assert_eq!(changes(&tree, second), None, "more changes than are recorded");
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
