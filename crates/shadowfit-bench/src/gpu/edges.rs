//! Movement of shadow edges in a picture from one frame to the next.
//!
//! An edge is a crossing of 0.5 by the factor between two neighbouring pixels of one surface. Linear
//! interpolation gives its position. The movement of an edge is measured along a row (for edges steeper than
//! 45° in the picture) or else along a column, to the crossing with the same direction in the next frame.
//! Multiplied by the cosine of the edge's slant, it is the distance perpendicular to the edge, in pixels.
//! Every fourth row and column is examined. Shadows that appear or disappear have no such crossing, and only
//! count in the change of the factor.

use glam::{Mat4, Vec3};
use shadowfit::{DepthConvention, PerspectiveCamera};

use super::engine::SIZE;

/// Factors as bytes, row by row.
pub(crate) type Factors = Vec<u8>;

const HALF: f32 = 127.5;

/// Least change of the factor per pixel, in 255ths. Softer transitions are not visible as edges.
const LEAST_SLOPE: f32 = 12.0;

/// Greatest movement along a row that counts as one edge's, in pixels. Larger ones are shadows that appear or
/// disappear.
const REACH: f32 = 16.0;

/// Pixels around a pixel that must show the same surface.
const AROUND: isize = 2;

/// Distance between examined rows, and between examined columns, in pixels.
const LINES: usize = 4;

/// Greatest second difference of a plane's reversed depth, as a share of it. It allows for f32 rounding and
/// slight curvature.
const BENT: f32 = 1e-4;

/// Least cosine between a surface's normal and the light's direction. Below it the shading hides the factor.
const LEAST_COSINE: f32 = 0.15;

/// Pixels in which edges are searched: on surfaces that face the light, away from silhouettes.
pub(crate) struct Surfaces(Vec<bool>);

/// Change from one picture to the next.
#[derive(Clone, Copy, Default)]
pub(crate) struct Change {
    /// Greatest movement of an edge, in pixels.
    pub(crate) jump: f32,
    /// Greatest change of a factor.
    pub(crate) factor: f32,
}

impl Change {
    /// Returns the maximum of each field.
    pub(crate) fn max(self, other: Self) -> Self {
        Self { jump: self.jump.max(other.jump), factor: self.factor.max(other.factor) }
    }
}

/// A crossing of 0.5 on a line of pixels.
#[derive(Clone, Copy)]
struct Crossing {
    at: f32,
    is_rising: bool,
    /// Cosine of the angle between the line and the edge's normal.
    cosine: f32,
}

/// A line of pixels: a row if `along` is 0, or a column.
struct Line {
    along: usize,
    number: usize,
    length: usize,
}

const WIDTH: usize = SIZE[0] as usize;
const HEIGHT: usize = SIZE[1] as usize;

/// Neighbours along a row and down a column.
const ALONG: [usize; 2] = [1, WIDTH];

impl Surfaces {
    /// Finds the pixels in a camera's reversed depth buffer, under light that travels in `direction`.
    pub(crate) fn new(depths: &[f32], camera: &PerspectiveCamera, direction: Vec3) -> Self {
        let [width, height] = SIZE.map(|side| side as f32);
        let from_pixel = Mat4::from_cols_array_2d(&[
            [2.0 / width, 0.0, 0.0, 0.0],
            [0.0, -2.0 / height, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [-1.0, 1.0, 0.0, 1.0],
        ]);
        let world_from_pixel = camera.clip_from_world(DepthConvention::Reversed).inverse() * from_pixel;
        let place = |index: usize| {
            let pixel = Vec3::new((index % WIDTH) as f32, (index / WIDTH) as f32, depths[index]);
            world_from_pixel.project_point3(pixel)
        };
        let is_plain = |index: usize| {
            let is_flat = |step: usize| {
                (depths[index - step] + depths[index + step] - 2.0 * depths[index]).abs() < BENT * depths[index]
            };
            let [right, down] = ALONG.map(|step| place(index + step) - place(index));
            let normal = down.cross(right).normalize_or_zero();
            ALONG.into_iter().all(is_flat) && normal.dot(-direction) > LEAST_COSINE
        };
        let inner = |index: usize, border: usize| {
            let (x, y) = (index % WIDTH, index / WIDTH);
            (border..WIDTH - border).contains(&x) && (border..HEIGHT - border).contains(&y)
        };
        let plain: Vec<bool> = (0..depths.len()).map(|index| inner(index, 1) && is_plain(index)).collect();
        let around = |index: usize| {
            let rows = (-AROUND..=AROUND).flat_map(|y| (-AROUND..=AROUND).map(move |x| y * WIDTH.cast_signed() + x));
            rows.map(|offset| index.wrapping_add_signed(offset)).all(|index| plain[index])
        };
        Self((0..depths.len()).map(|index| inner(index, AROUND as usize + 1) && around(index)).collect())
    }

    /// Returns the change between two pictures.
    pub(crate) fn change(&self, before: &Factors, now: &Factors) -> Change {
        if before == now {
            return Change::default();
        }
        let pairs = before.iter().zip(now).zip(&self.0).filter(|(_, is_seen)| **is_seen);
        let factor = pairs.map(|((before, now), _)| before.abs_diff(*now)).max().unwrap_or_default();
        let [mut old, mut new] = [Vec::new(), Vec::new()];
        let mut jump = 0.0_f32;
        for (along, lines, length) in [(0, HEIGHT, WIDTH), (1, WIDTH, HEIGHT)] {
            for line in (0..lines).step_by(LINES) {
                let line = Line { along, number: line, length };
                self.crossings(before, &line, &mut old);
                self.crossings(now, &line, &mut new);
                jump = jump.max(greatest_move(&old, &new));
            }
        }
        Change { jump, factor: f32::from(factor) / 255.0 }
    }

    /// Finds the crossings of a row or a column, in their order.
    fn crossings(&self, factors: &Factors, line: &Line, found: &mut Vec<Crossing>) {
        let Line { along, number, length } = *line;
        found.clear();
        let (step, across) = (ALONG[along], ALONG[1 - along]);
        let value = |index: usize| f32::from(factors[index]);
        for at in 0..length - 1 {
            let index = number * across + at * step;
            let (first, second) = (value(index), value(index + step));
            if (first < HALF) == (second < HALF) || !self.0[index] || !self.0[index + step] {
                continue;
            }
            let slope = second - first;
            let beside = |index: usize| (value(index + across) - value(index - across)) * 0.5;
            let slant = (beside(index) + beside(index + step)) * 0.5;
            if slope.abs() >= LEAST_SLOPE && slope.abs() >= slant.abs() {
                let cosine = slope.abs() / slope.hypot(slant);
                let place = at as f32 + (HALF - first) / slope;
                found.push(Crossing { at: place, is_rising: slope > 0.0, cosine });
            }
        }
    }
}

/// Returns the greatest movement of crossings that are each other's nearest in two frames.
fn greatest_move(old: &[Crossing], new: &[Crossing]) -> f32 {
    let nearest = |of: &Crossing, among: &[Crossing]| {
        let like = among.iter().filter(|other| other.is_rising == of.is_rising);
        like.copied().min_by(|a, b| (a.at - of.at).abs().total_cmp(&(b.at - of.at).abs()))
    };
    let moved = |crossing: &Crossing| {
        let before = nearest(crossing, old)?;
        let back = nearest(&before, new)?;
        let distance = (crossing.at - before.at).abs();
        (back.at == crossing.at && distance <= REACH).then_some(distance * crossing.cosine)
    };
    new.iter().filter_map(moved).fold(0.0, f32::max)
}
