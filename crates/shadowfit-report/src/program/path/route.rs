//! A route through a scene: finds camera positions, links the pairs between which a camera can fly, and takes
//! the longest route through the middle of the largest linked set.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::{Vec2, Vec3, Vec3Swizzles};
use rayon::prelude::*;
use shadowfit::Aabb;

use super::probe::Probe;

/// Number of columns along each horizontal side of the scene: fine enough for doors and streets.
const COLUMNS: usize = 28;
/// Central share of the scene's sides that is searched. A camera at the border sees mostly sky.
const CENTRAL: f32 = 0.9;
/// Position of a column in its cell. It is off the middle, so that vertical rays miss the edges of regular
/// models.
const OFF_MIDDLE: f32 = 0.537;
/// Number of floors of a column that are tried, from the highest down.
const FLOORS: usize = 8;
/// Cosine of the greatest slope of a floor, 60°.
const FLOOR_COSINE: f32 = 0.5;
/// Highest position in the gap below a ceiling, as a share of the gap.
const GAP_SHARE: f32 = 0.6;
/// Greatest rise per metre forward of a flight between columns.
const RISE: f32 = 1.2;

/// Camera positions and the links between them.
pub(super) struct Places {
    eyes: Vec<Vec3>,
    /// Links of each position: the index of the other position and the distance to it, in metres.
    links: Vec<Vec<(usize, f32)>>,
}

/// A route between positions.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Route {
    /// World space, metres.
    pub(super) points: Vec<Vec3>,
    /// Distance along the route of the position nearest to the scene's middle, in metres from the first
    /// point.
    pub(super) middle: f32,
}

impl Places {
    /// Finds positions at `height` above floors within `bounds` (metres), and lower ones under low ceilings.
    pub(super) fn new(probe: &Probe, bounds: Aabb, height: f32) -> Self {
        let columns: Vec<Vec<Vec3>> =
            (0..COLUMNS * COLUMNS).into_par_iter().map(|column| column_eyes(probe, bounds, height, column)).collect();
        let mut eyes = Vec::new();
        let mut of_column = Vec::with_capacity(columns.len());
        for own in columns {
            of_column.push(eyes.len()..eyes.len() + own.len());
            eyes.extend(own);
        }
        let places = |column: usize| of_column[column].clone();
        let between = |(from, to)| places(from).flat_map(move |a| places(to).map(move |b| (a, b)));
        let ways: Vec<(usize, usize)> = neighbours().flat_map(between).collect();
        let open: Vec<_> = ways.into_par_iter().filter(|&(a, b)| is_link(probe, eyes[a], eyes[b])).collect();
        let mut links = vec![Vec::new(); eyes.len()];
        for (a, b) in open {
            let length = eyes[a].distance(eyes[b]);
            links[a].push((b, length));
            links[b].push((a, length));
        }
        Self { eyes, links }
    }

    /// Returns the route between two far ends of the largest linked set, through the position nearest to
    /// `middle`.
    pub(super) fn route(&self, middle: Vec3) -> Option<Route> {
        let largest = self.largest();
        let to_middle = |place: usize| (self.eyes[place].xz() - middle.xz()).length();
        let start = largest.iter().copied().min_by(|&a, &b| to_middle(a).total_cmp(&to_middle(b)))?;
        let (distance, parent) = self.distances(start);
        let farthest =
            |score: &dyn Fn(usize) -> f32| largest.iter().copied().max_by(|&a, &b| score(a).total_cmp(&score(b)));
        let first = farthest(&|place| distance[place])?;
        let direction = |place: usize| (self.eyes[place] - self.eyes[start]).normalize_or_zero();
        // The other end is also far, and on the other side.
        let last = farthest(&|place| distance[place] * (1.0 - direction(place).dot(direction(first))))?;
        let ancestors = |place: usize| std::iter::successors(Some(place), |&place| parent[place]).collect::<Vec<_>>();
        let (mut there, mut back) = (ancestors(first), ancestors(last));
        // The shared part of both routes is a dead end.
        while there.len() > 1 && back.len() > 1 && there[there.len() - 2] == back[back.len() - 2] {
            there.pop();
            back.pop();
        }
        back.pop();
        let middle = distance[first] - distance[*there.last()?];
        let points = there.into_iter().chain(back.into_iter().rev()).map(|place| self.eyes[place]).collect();
        Some(Route { points, middle })
    }

    /// Returns the largest linked set of positions, or the first of several.
    fn largest(&self) -> Vec<usize> {
        let mut seen = vec![false; self.eyes.len()];
        let mut largest = Vec::new();
        for start in 0..self.eyes.len() {
            let mut set = Vec::new();
            let mut waiting = vec![start];
            while let Some(place) = waiting.pop() {
                if !std::mem::replace(&mut seen[place], true) {
                    set.push(place);
                    waiting.extend(self.links[place].iter().map(|(next, _)| next));
                }
            }
            if set.len() > largest.len() {
                largest = set;
            }
        }
        largest.sort_unstable();
        largest
    }

    /// Returns the lengths of the shortest routes from a position, and the previous position on each
    /// (Dijkstra 1959).
    fn distances(&self, start: usize) -> (Vec<f32>, Vec<Option<usize>>) {
        let mut distance = vec![f32::INFINITY; self.eyes.len()];
        let mut parent = vec![None; self.eyes.len()];
        distance[start] = 0.0;
        // The nearest comes first: the bits of non-negative floats have the order of the floats.
        let mut waiting = BinaryHeap::from([Reverse((0.0_f32.to_bits(), start))]);
        while let Some(Reverse((so_far, place))) = waiting.pop() {
            let so_far = f32::from_bits(so_far);
            if so_far > distance[place] {
                continue;
            }
            for &(next, length) in &self.links[place] {
                let there = so_far + length;
                if there < distance[next] {
                    (distance[next], parent[next]) = (there, Some(place));
                    waiting.push(Reverse((there.to_bits(), next)));
                }
            }
        }
        (distance, parent)
    }
}

impl Route {
    pub(super) fn length(&self) -> f32 {
        self.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    }

    /// Returns `count` evenly spaced points on the part of the route around its middle that is `share` of its
    /// length.
    pub(super) fn samples(&self, count: usize, share: f32) -> Vec<Vec3> {
        let length = self.length();
        let start = (self.middle - 0.5 * share * length).clamp(0.0, (1.0 - share) * length);
        let place = |index: usize| start + share * length * index as f32 / (count - 1) as f32;
        (0..count).map(|index| self.at(place(index))).collect()
    }

    /// Returns the point at a distance along the route, in metres.
    fn at(&self, mut distance: f32) -> Vec3 {
        for pair in self.points.windows(2) {
            let step = pair[0].distance(pair[1]);
            if distance <= step {
                return pair[0].lerp(pair[1], distance / step);
            }
            distance -= step;
        }
        *self.points.last().expect("a route has points")
    }
}

/// Returns pairs of neighbouring columns, including diagonal ones, each pair once.
fn neighbours() -> impl Iterator<Item = (usize, usize)> {
    // Only steps to the right and down, straight and diagonal: the opposite steps give the same pairs.
    let steps = [(1, 1), (0, 2), (1, 2), (1, 0)];
    (0..COLUMNS * COLUMNS).flat_map(move |column| {
        let (x, z) = (column % COLUMNS, column / COLUMNS);
        // Rows are counted from the row above, so that no step is negative.
        let beside = steps.map(|(dx, dz)| (x + dx, (z + dz).wrapping_sub(1)));
        let inside = beside.into_iter().filter(|&(x, z)| x < COLUMNS && z < COLUMNS);
        inside.map(move |(x, z)| (column, z * COLUMNS + x))
    })
}

fn is_link(probe: &Probe, from: Vec3, to: Vec3) -> bool {
    let across = from.xz().distance(to.xz());
    (from.y - to.y).abs() <= RISE * across && probe.is_way(from, to)
}

/// Returns the positions above the floors of a column, highest first.
fn column_eyes(probe: &Probe, bounds: Aabb, height: f32, column: usize) -> Vec<Vec3> {
    let share = |index: usize| 0.5 + CENTRAL * ((index as f32 + OFF_MIDDLE) / COLUMNS as f32 - 0.5);
    let shares = Vec2::new(share(column % COLUMNS), share(column / COLUMNS));
    let foot = bounds.min.xz() + bounds.size().xz() * shares;
    let top = bounds.max.y + height.max(bounds.size().y);
    let mut surfaces: Vec<(f32, bool)> = Vec::new();
    probe.tracer.for_each_hit(Vec3::new(foot.x, top, foot.y), Vec3::NEG_Y, |hit| {
        surfaces.push((top - hit.distance, probe.tracer.normal(hit.triangle).y >= FLOOR_COSINE));
    });
    surfaces.sort_by(|a, b| b.0.total_cmp(&a.0));
    let is_thick = |&(above, _): &&(f32, bool), floor: f32| above - floor > probe.clearance;
    let eye = |(index, &(floor, _)): (usize, &(f32, bool))| {
        let ceiling =
            surfaces[..index].iter().rev().find(|above| is_thick(above, floor)).map_or(f32::INFINITY, |s| s.0);
        let rise = height.min((ceiling - floor) * GAP_SHARE);
        let eye = Vec3::new(foot.x, floor + rise, foot.y);
        (rise > 2.0 * probe.clearance && probe.is_open(eye)).then_some(eye)
    };
    surfaces.iter().enumerate().filter(|(_, surface)| surface.1).take(FLOORS).filter_map(eye).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns positions in a row, with a branch at the second one.
    fn branched() -> Places {
        let eyes = vec![Vec3::ZERO, Vec3::X, Vec3::X * 2.0, Vec3::X * 3.0, Vec3::new(1.0, 0.0, 0.5), Vec3::splat(9.0)];
        let mut links = vec![Vec::new(); eyes.len()];
        for (a, b) in [(0, 1), (1, 2), (2, 3), (1, 4)] {
            links[a].push((b, 1.0));
            links[b].push((a, 1.0));
        }
        Places { eyes, links }
    }

    #[test]
    fn a_route_joins_far_ends_past_the_middle_without_its_dead_end() {
        let route = branched().route(Vec3::new(1.0, 0.0, 0.6)).expect("a route");
        assert_eq!(route.points, [Vec3::X * 3.0, Vec3::X * 2.0, Vec3::X, Vec3::ZERO]);
        assert_eq!((route.length(), route.middle), (3.0, 2.0));
        assert!(Places { eyes: Vec::new(), links: Vec::new() }.route(Vec3::ZERO).is_none());
    }

    #[test]
    fn samples_are_even_and_stay_around_the_middle_within_the_route() {
        let route = Route { points: vec![Vec3::ZERO, Vec3::X, Vec3::X * 4.0], middle: 1.0 };
        let xs = |share: f32| route.samples(3, share).iter().map(|point| point.x).collect::<Vec<_>>();
        assert_eq!((xs(1.0), xs(0.5), xs(0.25)), (vec![0.0, 2.0, 4.0], vec![0.0, 1.0, 2.0], vec![0.5, 1.0, 1.5]));
    }

    #[test]
    fn every_pair_of_columns_side_by_side_is_there_once() {
        let mut pairs: Vec<_> = neighbours().map(|(a, b)| (a.min(b), a.max(b))).collect();
        let count = pairs.len();
        pairs.sort_unstable();
        pairs.dedup();
        assert_eq!((pairs.len(), count), (2 * COLUMNS * (COLUMNS - 1) + 2 * (COLUMNS - 1) * (COLUMNS - 1), count));
    }
}
