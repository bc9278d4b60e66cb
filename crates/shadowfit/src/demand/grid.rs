//! How fine a texel the visible points ask for, and where they lie as the light sees them: what
//! [windows](crate::Windows) are placed by.
//!
//! A [`DemandGrid`] has a square of cells around the eye for each octave of texel sizes, in the plane
//! across the light. Cells grow with the octave, as do the distances at which points ask for it:
//!
//! ```text
//!   ┌───┬───┬───┬───┐ level 1, texels of 2 to 4 mm
//!   │   │   │   │   │
//!   ├───┼─┬─┼─┬─┼───┤        each visible point counts in one cell:
//!   │   ├─┼─●─┼─┤   │        by its place and by the texel at which
//!   ├───┼─┼eye┼─┼───┤        it shows one pixel for one texel
//!   │   ├─┼─┼─┼─┤   │
//!   ├───┼─┴─┼─┴─┼───┤
//!   └───┴───┴───┴───┘ level 0, texels of 1 to 2 mm
//! ```
//!
//! It is plain data of a fixed size, which an engine fills from the depth buffer of its last frame
//! (`shadowfit-wgpu` has a compute pass for that), or from any points that it knows to be visible:
//! [`DemandSpace::index`] says in which cell a point counts. A late or wrong grid costs sharpness,
//! never coverage.

use glam::{DVec2, DVec3, Vec2, Vec3};

use crate::base::{FitError, checks};
use crate::light::{LightAxes, grid};
use crate::view::ViewFrustum;

/// Number of octaves of texel sizes.
pub const LEVELS: usize = 16;

/// Cells of a level along each axis; the eye is in the middle.
pub const SIDE: usize = 32;

/// Length of [`DemandGrid::counts`].
pub const CELLS: usize = LEVELS * SIDE * SIDE;

/// Height of the picture in pixels, whatever its resolution: only the ratios of demands matter, so all grids
/// count in pixels of the same size.
pub const PIXELS: f32 = 1080.0;

/// Number of cells in the distance for which a level is made: more are finer, fewer reach farther.
const CELLS_IN_DISTANCE: f64 = 4.0;

/// The least number under a high sun, which meets walls at grazing angles. They ask for much finer texels than their
/// distance does, and where the cells of that level do not reach them they count as coarser.
const CELLS_UNDER_HIGH_SUNS: f64 = 2.0;

/// The number of cells under a sun that meets a wall at a cosine of 1, unlimited. Walls are at most as well lit as the
/// cosine of the sun's elevation, so cells begin to grow above 60 degrees.
const CELLS_PER_COSINE: f64 = 8.0;

/// Lenses that show a height between these two, in metres for each metre of distance, have equal cells. Cells of
/// narrower ones are smaller, since little of a wide cell is in view: down to a quarter, if the coarsest still reach the end
/// of the view. Cells of wider ones are larger: the sides of the picture lie many times as far from the eye as the view
/// depth that their pixels belong to.
const NARROW: f64 = 0.07;
const WIDE: f64 = 2.0;
const LENSES: (f64, f64) = (0.25, 16.0);

/// Points that the light meets at less than this cosine are left out: they are next to dark, and
/// would ask for the finest texels of all.
pub const MIN_FACING: f32 = 0.05;

/// The plane across the light in which demand is counted, and the scale of it.
///
/// The plane is that of the windows for the same light: its second axis is shortened by the ratio of
/// their texels' sides, so that windows are squares in it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DemandSpace {
    /// World position that cells and points are counted from, in metres.
    pub origin: DVec3,
    /// Unit direction of travel of the light, world axes.
    pub direction: Vec3,
    /// Axis along the width of the windows' texels: unit, world axes.
    pub x: Vec3,
    /// Axis along the height of the windows' texels, divided by the ratio of their height to their
    /// width.
    pub y: Vec3,
    /// Least texel of the finest level, in metres: a power of two. Those of the next level are twice as wide.
    pub texel: f32,
    /// Side of a cell of the finest level, in metres. Those of the next level are twice as wide.
    pub cell: f32,
}

/// Counts of visible points by [`DemandSpace::index`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DemandGrid<'a> {
    /// Where the points were counted: the light and the eye of that frame.
    pub space: DemandSpace,
    /// Number of points in each of [`CELLS`] cells: level by level from the finest, each in rows.
    pub counts: &'a [u32],
}

impl DemandSpace {
    /// The space for what a view sees under a light.
    ///
    /// `direction` is the light's direction of travel in world axes and `up` the world's
    /// [`up`](crate::settings::MapSettings::up), both of any length. `distance` is where shadows end, in
    /// metres of view depth; `f32::MAX` for the far plane.
    ///
    /// # Errors
    ///
    /// As [`fit`](crate::fit) for the view, the directions and the distance; [`FitError::NearNotBelowFar`] where the view
    /// begins beyond the distance: it is shown without shadows, so nothing in it asks for a texel.
    pub fn new(view: &ViewFrustum, direction: Vec3, up: Vec3, distance: f32) -> Result<Self, FitError> {
        view.check()?;
        let direction = checks::unit("the light's direction", direction)?;
        let up = checks::unit("the up direction", up)?;
        checks::finite("the maximum shadow distance", f64::from(distance))?;
        let far = distance.min(view.far);
        if view.near >= far {
            return Err(FitError::NearNotBelowFar { near: view.near, far });
        }
        let plane = Plane::new(direction, up);
        // The picture's rectangle where shadows end.
        let share = (f64::from(far) - f64::from(view.near)) / (f64::from(view.far) - f64::from(view.near));
        let [near_corners, far_corners] = [0, 4].map(|first| [0, 1, 2, 3].map(|i| view.corners[first + i].as_dvec3()));
        let end = [0, 1, 2, 3].map(|i| near_corners[i] + (far_corners[i] - near_corners[i]) * share);
        let height = checks::length(end[0] - end[3]);
        let coarsest = (height / f64::from(PIXELS)) as f32;
        let texel = power_of_two(coarsest) * 2.0 / (1_u32 << LEVELS) as f32;
        // Orthographic views may reach farther behind the eye than before it.
        let reach = f64::from(far.max(-view.near));
        let distance = (reach / height * f64::from(PIXELS)) as f32;
        let cells = cells_in_distance(direction.dot(up), height / reach);
        let (x, y) = (plane.axes.x, plane.axes.y * (1.0 / plane.shape as f32));
        // The cells of the last level reach all that is seen.
        let farthest =
            near_corners.into_iter().chain(end).map(|corner| plane.of(plane.axes.project(corner)).abs().max_element());
        let least =
            farthest.fold(0.0, f64::max) / f64::from((SIDE as u32 / 2) << (LEVELS - 1)) * (1.0 + REACH_ROUNDING);
        let cell = (f64::from(texel * distance) / cells).max(least) as f32;
        let least = f32::MIN_POSITIVE;
        checks::within("the texel of a demand grid", f64::from(texel), f64::from(least), f64::from(f32::MAX))?;
        Ok(Self { origin: view.origin, direction: direction.as_vec3(), x, y, texel, cell })
    }

    /// Index into [`DemandGrid::counts`] of a visible point; `None` for one that does not count,
    /// because it is turned away from the light or too near the edge of it, or not finite.
    ///
    /// `position` is relative to [`Self::origin`], in metres; `normal` is the surface's geometric unit
    /// normal on the side of the eye; `right` and `down` are how far the point moves on its surface, in
    /// metres, from one pixel to the next of a picture whose part in the view's frustum is [`PIXELS`] high. All in world
    /// axes.
    pub fn index(&self, position: Vec3, normal: Vec3, right: Vec3, down: Vec3) -> Option<usize> {
        let facing = -dot(normal, self.direction);
        // NaN is turned away too.
        let is_lit = facing >= MIN_FACING;
        let is_point = is_lit && normal.is_finite() && right.is_finite() && down.is_finite();
        if !is_point {
            return None;
        }
        self.cell_of(self.project(position), needed_texel(self.project(right), self.project(down)))
    }

    /// Index of a place in the plane, in metres, and of the texel that is asked for there.
    pub(crate) fn cell_of(&self, p: Vec2, texel: f32) -> Option<usize> {
        let mut level = (exponent(texel) - exponent(self.texel)).clamp(0, i32::from(LEVELS as u8 - 1)) as usize;
        // Points so far away that their level has no cell for them count as coarser.
        while level < LEVELS {
            let cells = p / (self.cell * (1_u32 << level) as f32);
            let half = (SIDE / 2) as f32;
            if cells.abs().max_element() < half {
                let x = (cells.x + half) as usize;
                let y = (cells.y + half) as usize;
                return Some((level * SIDE + y.min(SIDE - 1)) * SIDE + x.min(SIDE - 1));
            }
            level += 1;
        }
        None
    }

    /// Middle of a cell in the plane, half of its side, and the middle of the texels that are asked for in
    /// it, in metres.
    pub(crate) fn cell(&self, index: usize) -> (DVec2, f64, f64) {
        let (level, y, x) = (index / (SIDE * SIDE), index / SIDE % SIDE, index % SIDE);
        let scale = f64::from(1_u32 << level);
        let side = f64::from(self.cell) * scale;
        let middle = (DVec2::new(x as f64, y as f64) + 0.5 - (SIDE / 2) as f64) * side;
        (middle, side * 0.5, f64::from(self.texel) * scale * core::f64::consts::SQRT_2)
    }

    /// Coordinates in the plane.
    fn project(&self, v: Vec3) -> Vec2 {
        Vec2::new(dot(self.x, v), dot(self.y, v))
    }
}

impl DemandGrid<'_> {
    /// Whether it can be used for a light: it was counted for that light, and in cells.
    pub(crate) fn is_for(&self, plane: &Plane) -> bool {
        let DemandSpace { origin, direction, x, y, texel, cell } = self.space;
        let is_finite = origin.is_finite() && x.is_finite() && y.is_finite() && cell > 0.0 && texel > 0.0;
        let far = checks::length(direction.as_dvec3() + plane.axes.z.as_dvec3());
        is_finite && cell.is_finite() && texel.is_finite() && self.counts.len() == CELLS && far <= SAME_LIGHT
    }
}

/// Share of the farthest cells that is left for the rounding of positions.
const REACH_ROUNDING: f64 = 1e-5;

/// Number of cells in the distance for which a level is made, from the sine of the sun's elevation and the height of the
/// picture for each metre of distance.
fn cells_in_distance(sine: f64, height: f64) -> f64 {
    let cosine = libm::sqrt((1.0 - sine * sine).max(0.0));
    let narrow = (height / NARROW).clamp(LENSES.0, 1.0);
    let wide = (height / WIDE).clamp(1.0, LENSES.1);
    (CELLS_PER_COSINE * cosine).clamp(CELLS_UNDER_HIGH_SUNS, CELLS_IN_DISTANCE) / (narrow * wide)
}

/// Length of the difference of two unit directions up to which demand under the one serves for the
/// other: a moving sun steps by less, and at two degrees they hardly differ.
const SAME_LIGHT: f64 = 0.035;

/// Side of the widest square texel with which a point shows no more than one pixel per texel, from how far it moves
/// in the plane for a pixel to the right and one down: the least singular value. In f32, as shaders count;
/// [`histogram::needed_texel`](crate::demand::needed_texel) is the same in f64 for movements in the world.
pub(crate) fn needed_texel(a: Vec2, b: Vec2) -> f32 {
    let (aa, bb, ab) = (a.x * a.x + a.y * a.y, b.x * b.x + b.y * b.y, a.x * b.x + a.y * b.y);
    let det = a.x * b.y - a.y * b.x;
    let (half, difference) = ((aa + bb) * 0.5, (aa - bb) * 0.5);
    let greatest = half + libm::sqrtf(difference * difference + ab * ab);
    if greatest > 0.0 { det.abs() / libm::sqrtf(greatest) } else { 0.0 }
}

/// The exponent of the power of two at or below a positive normal number; that of zero is far below all.
fn exponent(x: f32) -> i32 {
    ((x.to_bits() >> 23) & 0xff).cast_signed()
}

/// The power of two at or below a positive number.
fn power_of_two(x: f32) -> f32 {
    f32::from_bits(x.to_bits() & f32::INFINITY.to_bits())
}

fn dot(a: Vec3, b: Vec3) -> f32 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

/// The plane across a light in which windows are squares.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Plane {
    pub(crate) axes: LightAxes,
    /// Height of a window's texels over their width.
    pub(crate) shape: f64,
}

/// Power of the sine of the light's elevation by which texels are finer up the light's plane: ground
/// is foreshortened by the sine itself, walls are not.
const SHAPE_POWER: f64 = 0.55;

/// Tangent of the angle by which texels that are not square are turned away from the horizon, over their height by their
/// width. Shadows of upright edges run up the light's plane. Along a column of texels such an edge is moved as a whole, by
/// up to half a texel; across columns the filter evens that out:
///
/// ```text
///   not turned                turned
///   ┌──┬▒▒┬▒▒┐               ┌──┬▒▒┬▒▒┐
///   ├──┼▒▒┼▒▒┤ always to      ├──┼──┼▒▒┤ in one row too far,
///   ├──┼▒▒┼▒▒┤ the same side  ├──┼▒▒┼▒▒┤ in the next not far
///   └──┴▒▒┴▒▒┘               └──┴──┴▒▒┘ enough
/// ```
///
/// Counted in texels, level edges across the light then rise by 0.45 rows for each column. The lower the light is and
/// the flatter the texels are, the less may they be turned: what they are flat for is the ground.
const TURN: f64 = 0.45;

/// Least height of a texel over its width.
const LEAST_SHAPE: f64 = 0.25;

impl Plane {
    /// Coordinates in the plane, from those along the axes.
    pub(crate) fn of(&self, p: DVec3) -> DVec2 {
        DVec2::new(p.x, p.y / self.shape)
    }

    /// The plane across a light; both directions are unit vectors.
    pub(crate) fn new(direction: DVec3, up: DVec3) -> Self {
        let sine = direction.dot(up).abs().max(f64::MIN_POSITIVE);
        let shape = libm::pow(sine, SHAPE_POWER).clamp(LEAST_SHAPE, 1.0);
        let steps = libm::round(libm::log2(shape) * 8.0);
        let shape = grid::eighths(steps as i32);
        let axes = if steps == 0.0 {
            LightAxes::shortest_arc(direction, up)
        } else {
            let turned = DVec2::new(1.0, TURN * shape);
            LightAxes::look_at(direction, up).turned(turned / libm::sqrt(turned.dot(turned)))
        };
        Self { axes, shape }
    }
}
