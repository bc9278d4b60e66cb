//! The casters of a frame, by number, and what changed since the frame before.

use shadowfit::glam::{DVec3, Vec3};
use shadowfit::{Aabb, Boxes};

/// Everything that casts shadows, by number: the index of its box.
///
/// A number may mean another caster in another frame, as long as their boxes differ: a static caster whose box is
/// elsewhere is redrawn where it was and where it is.
///
/// A box may stand for many casters that an engine culls by itself, such as those in a cell of the world: then it holds
/// all of them, and [`invalidate`](crate::SunShadows::invalidate) tells where those that stand still changed within it.
/// Casters that move have boxes of their own, which may hold the same place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Casters<'a> {
    /// A box around each caster. Empty boxes cast nothing.
    pub boxes: Boxes<'a>,
    /// Whether each of them moves, is deformed or changes its shape in any other way; those past the end of the slice
    /// do not. Moving casters are drawn in every frame; static ones are drawn once and kept.
    pub moves: &'a [bool],
}

impl<'a> Casters<'a> {
    /// Casters that all stand still.
    pub const fn fixed(boxes: Boxes<'a>) -> Self {
        Self { boxes, moves: &[] }
    }

    /// Whether a caster moves.
    pub fn moves(&self, number: usize) -> bool {
        self.moves.get(number).copied().unwrap_or(false)
    }
}

/// A box in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WorldBox {
    pub(crate) min: DVec3,
    pub(crate) max: DVec3,
}

/// Rounding of a box's f32 coordinates, as a share of them, by which it may differ where its origin does.
const ROUNDING: f32 = 1.0 / 4_194_304.0;

/// Cosine of the greatest angle that the light turns by while the order along it is kept: a degree.
const SAME_ORDER: f32 = 0.999_85;

impl WorldBox {
    const EMPTY: Self = Self { min: DVec3::MAX, max: DVec3::MIN };

    fn new(aabb: &Aabb, origin: DVec3) -> Self {
        if aabb.is_empty() {
            return Self::EMPTY;
        }
        Self { min: origin + aabb.min.as_dvec3(), max: origin + aabb.max.as_dvec3() }
    }

    pub(crate) fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The box relative to an origin.
    pub(crate) fn relative_to(&self, origin: DVec3) -> Aabb {
        if self.is_empty() {
            return Aabb::EMPTY;
        }
        Aabb::new((self.min - origin).as_vec3(), (self.max - origin).as_vec3())
    }

    /// Whether it equals another one up to the rounding of that one's coordinates.
    fn is_same(&self, other: &Self, rounding: f64) -> bool {
        let near = |a: DVec3, b: DVec3| a == b || (a - b).abs().max_element() <= rounding;
        near(self.min, other.min) && near(self.max, other.max)
    }
}

/// The casters of the last frame, and their order along the light.
#[derive(Debug, Default)]
pub(crate) struct KnownCasters {
    /// Where each static caster stood when it was drawn; empty for those that move.
    drawn: Vec<WorldBox>,
    /// Static casters, and those that move, nearest to the light first.
    pub(crate) fixed: Vec<u32>,
    pub(crate) moving: Vec<u32>,
    /// Distance of each one's nearest point toward the light, in metres.
    heights: Vec<f32>,
    /// Direction toward the light by which they are ordered.
    to_light: Vec3,
}

impl KnownCasters {
    /// Takes the casters of a frame, and adds the boxes in which static ones changed. `direction` is the light's
    /// direction of travel.
    pub(crate) fn update(&mut self, casters: &Casters<'_>, direction: Vec3, changed: &mut Vec<WorldBox>) {
        let Boxes { origin, boxes } = casters.boxes;
        let before = changed.len();
        let count = boxes.len();
        for gone in self.drawn.drain(count.min(self.drawn.len())..) {
            changed.push(gone);
        }
        self.drawn.resize(count, WorldBox::EMPTY);
        let mut is_reordered = false;
        self.moving.clear();
        for (number, (aabb, drawn)) in boxes.iter().zip(&mut self.drawn).enumerate() {
            let mut now = WorldBox::EMPTY;
            if casters.moves(number) {
                self.moving.push(number as u32);
            } else {
                now = WorldBox::new(aabb, origin);
            }
            let coordinates = aabb.min.abs().max(aabb.max.abs()).max_element();
            if !drawn.is_same(&now, f64::from(coordinates * ROUNDING)) {
                changed.extend([*drawn, now]);
                *drawn = now;
                is_reordered = true;
            }
        }
        changed.retain(|changed| !changed.is_empty());
        let to_light = -direction.normalize_or_zero();
        let is_turned = self.to_light.dot(to_light).is_nan() || self.to_light.dot(to_light) < SAME_ORDER;
        if is_reordered || is_turned || changed.len() > before || self.heights.len() != count {
            self.to_light = to_light;
            self.heights.clear();
            self.heights.extend(boxes.iter().map(|aabb| height(aabb, to_light)));
            self.fixed.clear();
            self.fixed.extend((0..count as u32).filter(|number| !self.drawn[*number as usize].is_empty()));
            sort(&mut self.fixed, &self.heights);
        }
        for number in &self.moving {
            self.heights[*number as usize] = height(&boxes[*number as usize], self.to_light);
        }
        sort(&mut self.moving, &self.heights);
    }

    /// All casters of two lists, each nearest to the light first, in that order.
    pub(crate) fn merged<'a>(
        &'a self,
        fixed: impl Iterator<Item = u32> + 'a,
        moving: impl Iterator<Item = u32> + 'a,
    ) -> impl Iterator<Item = u32> + 'a {
        let (mut fixed, mut moving) = (fixed.peekable(), moving.peekable());
        let height = |number: u32| self.heights[number as usize];
        core::iter::from_fn(move || match (fixed.peek(), moving.peek()) {
            (Some(a), Some(b)) if height(*b) > height(*a) => moving.next(),
            (Some(_), _) => fixed.next(),
            (None, _) => moving.next(),
        })
    }
}

/// Where a box begins as seen from the light, in metres along the direction toward it.
fn height(aabb: &Aabb, to_light: Vec3) -> f32 {
    if aabb.is_empty() {
        f32::MIN
    } else {
        aabb.max.max(aabb.min).dot(to_light.max(Vec3::ZERO)) + aabb.min.dot(to_light.min(Vec3::ZERO))
    }
}

fn sort(numbers: &mut [u32], heights: &[f32]) {
    numbers.sort_unstable_by(|a, b| {
        let [near, far] = [*a, *b].map(|number| heights[number as usize]);
        far.total_cmp(&near).then(a.cmp(b))
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(x: f32, y: f32) -> Aabb {
        Aabb::new(Vec3::new(x, y, 0.0), Vec3::new(x + 1.0, y + 1.0, 1.0))
    }

    fn update(known: &mut KnownCasters, origin: DVec3, boxes: &[Aabb], moves: &[bool]) -> Vec<WorldBox> {
        let mut changed = Vec::new();
        known.update(&Casters { boxes: Boxes { origin, boxes }, moves }, Vec3::NEG_Y, &mut changed);
        changed
    }

    #[test]
    fn static_casters_change_where_they_appear_move_start_to_move_and_vanish() {
        let mut known = KnownCasters::default();
        let world = |aabb: Aabb| WorldBox::new(&aabb, DVec3::ZERO);
        let boxes = [cube(0.0, 0.0), cube(5.0, 2.0), cube(9.0, 1.0)];
        assert_eq!(update(&mut known, DVec3::ZERO, &boxes, &[]), boxes.map(world));
        assert_eq!(known.fixed, [1, 2, 0], "nearest to the light first");
        assert_eq!(update(&mut known, DVec3::ZERO, &boxes, &[]), []);
        // It starts to move: it is no longer where it was.
        assert_eq!(update(&mut known, DVec3::ZERO, &boxes, &[false, true]), [world(boxes[1])]);
        assert_eq!((known.fixed.as_slice(), known.moving.as_slice()), ([2, 0].as_slice(), [1].as_slice()));
        // Moving casters change nothing that is kept.
        let moved = [boxes[0], cube(5.0, 7.0), boxes[2]];
        assert_eq!(update(&mut known, DVec3::ZERO, &moved, &[false, true]), []);
        // It comes to rest, elsewhere; a static one is set elsewhere; the last one is gone.
        let rest = [cube(0.5, 0.0), moved[1]];
        assert_eq!(
            update(&mut known, DVec3::ZERO, &rest, &[]),
            [world(boxes[2]), world(boxes[0]), world(rest[0]), world(rest[1])]
        );
        assert_eq!(update(&mut known, DVec3::ZERO, &[], &[]), rest.map(world));
    }

    #[test]
    fn boxes_relative_to_a_moving_origin_do_not_change_by_its_rounding() {
        let mut known = KnownCasters::default();
        let place = DVec3::new(51_234.567, 3.0, -20_000.1);
        let relative = |eye: DVec3| {
            let aabb = |x: f64| {
                let min = (place + DVec3::new(x, 0.0, 0.0) - eye).as_vec3();
                Aabb::new(min, min + 1.0)
            };
            [aabb(0.0), aabb(80.0)]
        };
        let eye = place + DVec3::new(30.0, 1.7, 50.0);
        assert_eq!(update(&mut known, eye, &relative(eye), &[]).len(), 2);
        for step in 1..200 {
            let eye = eye + DVec3::new(0.013, 0.001, -0.027) * f64::from(step);
            assert_eq!(update(&mut known, eye, &relative(eye), &[]), [], "{step}");
        }
    }

    #[test]
    fn casters_of_both_kinds_are_merged_nearest_to_the_light_first() {
        let mut known = KnownCasters::default();
        let boxes = [cube(0.0, 4.0), cube(0.0, 3.0), cube(0.0, 9.0), cube(0.0, 1.0)];
        update(&mut known, DVec3::ZERO, &boxes, &[false, true, true, false]);
        let merged: Vec<u32> = known.merged(known.fixed.iter().copied(), known.moving.iter().copied()).collect();
        assert_eq!(merged, [2, 0, 1, 3]);
    }

    #[test]
    fn boxes_that_are_not_numbers_cast_nothing_and_do_not_change() {
        let mut known = KnownCasters::default();
        let boxes = [Aabb::new(Vec3::NAN, Vec3::ONE), Aabb::EMPTY];
        assert_eq!(update(&mut known, DVec3::ZERO, &boxes, &[]), []);
        assert_eq!(known.fixed, [] as [u32; 0]);
    }
}
