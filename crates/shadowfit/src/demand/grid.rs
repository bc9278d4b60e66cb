//! The texel sizes that visible points need, and the points' positions as seen from the light.
//! [Windows](crate::Windows) are placed by them.
//!
//! A [`DemandGrid`] has, for each octave of texel sizes, a square of cells around the eye, in the plane
//! across the light. Coarser octaves have larger cells, because the points that need them are farther away:
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
//! The grid is plain data of a fixed size. An engine fills it from the depth buffer of its last frame
//! (`shadowfit-wgpu` has a compute pass for that), or from any points that it knows to be visible.
//! [`DemandSpace::index`] returns the cell in which a point counts. A late or wrong grid costs sharpness,
//! never coverage.

use glam::{DVec2, DVec3, Vec2, Vec3};

use crate::base::{FitError, checks};
use crate::light::{LightAxes, grid};
use crate::view::ViewFrustum;

/// Number of levels, one for each octave of texel sizes.
pub const LEVELS: usize = 16;

/// Cells of a level along each axis. The eye is in the middle.
pub const SIDE: usize = 32;

/// Length of [`DemandGrid::counts`].
pub const CELLS: usize = LEVELS * SIDE * SIDE;

/// Height, in pixels, of the picture in which demand is counted, at any screen resolution. Only the ratios of
/// demands matter, so all grids count in pixels of the same size.
pub const PIXELS: f32 = 1080.0;

/// Number of cells in the distance that a level is made for. More cells are finer; fewer reach farther.
const CELLS_IN_DISTANCE: f64 = 4.0;

/// Least number of these cells, for a high sun. It meets walls at grazing angles, so they need much finer
/// texels than their distance suggests. Walls beyond the cells of that level count as coarser.
const CELLS_UNDER_HIGH_SUNS: f64 = 2.0;

/// Number of these cells for a sun that meets a wall at a cosine of 1, without limits. Walls are lit by at
/// most the cosine of the sun's elevation, so cells begin to grow above 60 degrees.
const CELLS_PER_COSINE: f64 = 8.0;

/// Limits of the height that a lens shows, in metres per metre of distance. Lenses between the limits have
/// equal cells. Narrower lenses have smaller cells, since little of a wide cell is in view: down to a
/// quarter, if the coarsest cells still reach the end of the view. Wider lenses have larger cells, since the
/// sides of the picture are many times farther from the eye than the view depth of their pixels.
const NARROW: f64 = 0.07;
const WIDE: f64 = 2.0;
const LENSES: (f64, f64) = (0.25, 16.0);

/// Cosine between normal and light below which points are ignored. They are nearly dark, and would need the
/// finest texels of all.
pub const MIN_FACING: f32 = 0.05;

/// The plane across the light in which demand is counted, with its scale.
///
/// It is the plane of the windows for the same light. Coordinates along its second axis are divided by the
/// ratio of a window's texel height to its texel width, so that windows are squares in it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DemandSpace {
    /// World position that cells and points are counted from, in metres.
    pub origin: DVec3,
    /// Unit direction of travel of the light, in world axes.
    pub direction: Vec3,
    /// Axis along the width of the windows' texels: a unit vector in world axes.
    pub x: Vec3,
    /// Axis along the height of the windows' texels: a unit vector in world axes, divided by the ratio of
    /// their height to their width.
    pub y: Vec3,
    /// Width of the smallest texels of the finest level, in metres: a power of two. It doubles with each
    /// level.
    pub texel: f32,
    /// Side of a cell of the finest level, in metres. It doubles with each level.
    pub cell: f32,
}

/// Counts of visible points by [`DemandSpace::index`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DemandGrid<'a> {
    /// Space of the counts, with the light and the eye of that frame.
    pub space: DemandSpace,
    /// Number of points in each of [`CELLS`] cells: level by level from the finest, each level in rows.
    pub counts: &'a [u32],
}

impl DemandSpace {
    /// Creates the space for a view and a light.
    ///
    /// `direction` is the light's direction of travel in world axes and `up` the world's
    /// [`up`](crate::settings::MapSettings::up), both of any length. `distance` is the view depth at which
    /// shadows end, in metres; `f32::MAX` means the far plane.
    ///
    /// # Errors
    ///
    /// As [`fit`](crate::fit) for the view, the directions and the distance. [`FitError::NearNotBelowFar`] if
    /// the view begins beyond the distance: it has no shadows, so no point in it needs a texel.
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
        // The picture's rectangle at the end of shadows.
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
        // The cells of the last level reach all visible points.
        let farthest =
            near_corners.into_iter().chain(end).map(|corner| plane.of(plane.axes.project(corner)).abs().max_element());
        let least =
            farthest.fold(0.0, f64::max) / f64::from((SIDE as u32 / 2) << (LEVELS - 1)) * (1.0 + REACH_ROUNDING);
        let cell = (f64::from(texel * distance) / cells).max(least) as f32;
        let least = f32::MIN_POSITIVE;
        checks::within("the texel of a demand grid", f64::from(texel), f64::from(least), f64::from(f32::MAX))?;
        Ok(Self { origin: view.origin, direction: direction.as_vec3(), x, y, texel, cell })
    }

    /// Returns the index into [`DemandGrid::counts`] of a visible point. Returns `None` for a point that does
    /// not count: it faces away from the light, is lit at a cosine below [`MIN_FACING`], or is not finite.
    ///
    /// `position` is relative to [`Self::origin`], in metres. `normal` is the surface's geometric unit normal
    /// on the side of the eye. `right` and `down` are the movements of the visible point on its surface, in
    /// metres, from this pixel to the next one on the right and below. Scale them to a picture in which the
    /// view's frustum is [`PIXELS`] pixels high. All are in world axes.
    pub fn index(&self, position: Vec3, normal: Vec3, right: Vec3, down: Vec3) -> Option<usize> {
        let facing = -dot(normal, self.direction);
        // NaN counts as facing away.
        let is_lit = facing >= MIN_FACING;
        let is_point = is_lit && normal.is_finite() && right.is_finite() && down.is_finite();
        if !is_point {
            return None;
        }
        self.cell_of(self.project(position), needed_texel(self.project(right), self.project(down)))
    }

    /// Returns the index of the cell for a position in the plane, in metres, and the texel that it needs.
    pub(crate) fn cell_of(&self, p: Vec2, texel: f32) -> Option<usize> {
        let mut level = (exponent(texel) - exponent(self.texel)).clamp(0, i32::from(LEVELS as u8 - 1)) as usize;
        // Points too far away for the cells of their level count as coarser.
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

    /// Returns the middle of a cell in the plane, half its side, and the middle of the texel sizes that are
    /// needed in it, in metres.
    pub(crate) fn cell(&self, index: usize) -> (DVec2, f64, f64) {
        let (level, y, x) = (index / (SIDE * SIDE), index / SIDE % SIDE, index % SIDE);
        let scale = f64::from(1_u32 << level);
        let side = f64::from(self.cell) * scale;
        let middle = (DVec2::new(x as f64, y as f64) + 0.5 - (SIDE / 2) as f64) * side;
        (middle, side * 0.5, f64::from(self.texel) * scale * core::f64::consts::SQRT_2)
    }

    /// Returns the coordinates of a vector in the plane.
    fn project(&self, v: Vec3) -> Vec2 {
        Vec2::new(dot(self.x, v), dot(self.y, v))
    }
}

impl DemandGrid<'_> {
    /// Returns whether the grid can be used for a light: its numbers are valid, and it was counted for that
    /// light.
    pub(crate) fn is_for(&self, plane: &Plane) -> bool {
        let DemandSpace { origin, direction, x, y, texel, cell } = self.space;
        let is_finite = origin.is_finite() && x.is_finite() && y.is_finite() && cell > 0.0 && texel > 0.0;
        let far = checks::length(direction.as_dvec3() + plane.axes.z.as_dvec3());
        is_finite && cell.is_finite() && texel.is_finite() && self.counts.len() == CELLS && far <= SAME_LIGHT
    }
}

/// Share of the farthest cells that is reserved for the rounding of positions.
const REACH_ROUNDING: f64 = 1e-5;

/// Returns the number of cells in the distance that a level is made for, from the sine of the sun's elevation
/// and the height of the picture per metre of distance.
fn cells_in_distance(sine: f64, height: f64) -> f64 {
    let cosine = libm::sqrt((1.0 - sine * sine).max(0.0));
    let narrow = (height / NARROW).clamp(LENSES.0, 1.0);
    let wide = (height / WIDE).clamp(1.0, LENSES.1);
    (CELLS_PER_COSINE * cosine).clamp(CELLS_UNDER_HIGH_SUNS, CELLS_IN_DISTANCE) / (narrow * wide)
}

/// Greatest difference of two unit directions at which demand for one light is used for the other. A moving
/// sun steps by less, and demands that are two degrees apart hardly differ.
const SAME_LIGHT: f64 = 0.035;

/// Returns the side of the widest square texel at which a point shows at most one pixel per texel. `a` and
/// `b` are the movements of the point in the plane for one pixel to the right and one down; the result is
/// their least singular value. It is computed in f32, as in shaders.
/// [`histogram::needed_texel`](crate::demand::needed_texel) computes the same in f64 for movements in the
/// world.
pub(crate) fn needed_texel(a: Vec2, b: Vec2) -> f32 {
    let (aa, bb, ab) = (a.x * a.x + a.y * a.y, b.x * b.x + b.y * b.y, a.x * b.x + a.y * b.y);
    let det = a.x * b.y - a.y * b.x;
    let (half, difference) = ((aa + bb) * 0.5, (aa - bb) * 0.5);
    let greatest = half + libm::sqrtf(difference * difference + ab * ab);
    if greatest > 0.0 { det.abs() / libm::sqrtf(greatest) } else { 0.0 }
}

/// Returns the exponent of the power of two at or below a positive normal number. For zero it is far below
/// all others.
fn exponent(x: f32) -> i32 {
    ((x.to_bits() >> 23) & 0xff).cast_signed()
}

/// Returns the power of two at or below a positive number.
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
    /// Ratio of the height of a window's texels to their width.
    pub(crate) shape: f64,
}

/// Power of the sine of the light's elevation that makes texels finer up the light's plane. Ground is
/// foreshortened by the sine itself, walls are not.
const SHAPE_POWER: f64 = 0.55;

/// Tangent of the angle between non-square texels and the horizon, divided by the ratio of their height to
/// their width. Shadows of upright edges run up the light's plane. Along a column of texels, the whole of
/// such an edge is shifted by up to half a texel. Across columns, the filter evens the shift out:
///
/// ```text
///   not turned                turned
///   ┌──┬▒▒┬▒▒┐               ┌──┬▒▒┬▒▒┐
///   ├──┼▒▒┼▒▒┤ always to      ├──┼──┼▒▒┤ in one row too far,
///   ├──┼▒▒┼▒▒┤ the same side  ├──┼▒▒┼▒▒┤ in the next not far
///   └──┴▒▒┴▒▒┘               └──┴──┴▒▒┘ enough
/// ```
///
/// In texels, level edges across the light then rise by 0.45 rows for each column. The lower the light and
/// the flatter the texels, the less they may be turned, since they are flat to suit the ground.
const TURN: f64 = 0.45;

/// Least ratio of a texel's height to its width.
const LEAST_SHAPE: f64 = 0.25;

impl Plane {
    /// Converts coordinates along the axes to coordinates in the plane.
    pub(crate) fn of(&self, p: DVec3) -> DVec2 {
        DVec2::new(p.x, p.y / self.shape)
    }

    /// Creates the plane across a light. Both directions are unit vectors.
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
