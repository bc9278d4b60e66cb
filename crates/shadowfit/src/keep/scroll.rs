//! Reuse of the texels of the last frame, so that static casters are drawn only into the new parts of a map.
//!
//! A map on the world's grid ([snapped or held](crate::settings::Stabilise), or the [stable
//! sphere](crate::settings::FitKind::Sphere)) moves by whole texels. [`Scroll::between`] returns the
//! movement, the strips that came into the map, and whether anything else changed:
//!
//! ```text
//!   ┌───────────┬──┐  the map now
//!   │           │▒▒│
//!   │   kept    │▒▒│  ▒ exposed: two rectangles at most
//!   ├───────────┤▒▒│
//!   │▒▒▒▒▒▒▒▒▒▒▒│▒▒│
//!   └───────────┴──┘
//! ```
//!
//! Kept texels stay where they are stored: the map [wraps around](StoredRect) in its layer.
//!
//! A shifted raster is not bit-equal to a fresh one. The map's translation is rounded to f32 in each frame,
//! which moves edges by up to 0.005 of a texel. If that matters, draw [`Tiles`] instead. A tile covers a
//! square of the same grid. Its projection never changes, and is relative to the tile's own origin.
//!
//! Kept texels must have been drawn with all casters over the map
//! ([`CasterVolume::of_map`](crate::CasterVolume::of_map)). A swept volume leaves out casters that cast no
//! shadow into the view of **that** frame.

use core::ops::Range;

use glam::{DVec3, IVec2, UVec2};

use crate::base::{FitError, checks};
use crate::light::grid::MAX_LINE;
use crate::light::{BoundSource, LightAxes, Volume};
use crate::map::FittedMap;
use crate::projection::LightProjection;

pub use crate::keep::texels::StoredRect;
pub use crate::keep::texels::TexelRect;
pub use crate::light::grid::GridPosition;

/// Movement of a map since an earlier frame.
///
/// Texels stay where they are stored, and new texels replace the texels that left the map ([`StoredRect`]):
///
/// ```
/// # use shadowfit::glam::UVec2;
/// # use shadowfit::scroll::{Scroll, StoredRect};
/// # use shadowfit::FittedMap;
/// # fn clear_and_draw_all() {} fn clear_and_draw(_: StoredRect) {}
/// /// Draws the static casters, and returns the texel offset that the look-up adds to its texels.
/// fn draw_static_casters(before: &FittedMap, now: &FittedMap, offset_before: UVec2) -> UVec2 {
///     let scroll = Scroll::between(before, now);
///     let size = now.projection.resolution;
///     let texel_offset = scroll.texel_offset(offset_before, size);
///     if scroll.is_redraw() {
///         clear_and_draw_all();
///     } else {
///         for piece in scroll.exposed().flat_map(|strip| strip.stored(texel_offset, size)) {
///             clear_and_draw(piece); // `stored` is its scissor rectangle, `viewport()` its viewport's corner
///         }
///     }
///     texel_offset
/// }
/// # let texel_offset = draw_static_casters(&FittedMap::default(), &FittedMap::default(), UVec2::ZERO);
/// # assert_eq!(texel_offset, UVec2::ZERO);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Scroll {
    /// Whether no texel of the old map can be kept: the light, the map's angle, texel size or resolution
    /// changed, the maps share no texel, the old map was [empty](LightProjection::is_empty), or one of them
    /// is not on a grid.
    pub is_new: bool,
    /// Whether the near or the far plane moved, so that the old map's depths now mean other distances. The
    /// planes do not move while they hold the content; see [`Stabilise`](crate::settings::Stabilise).
    pub depth_changed: bool,
    /// Movement of the map, in texels, right and down. The content of texel t was at texel t + `shift`
    /// before.
    pub shift: IVec2,
    exposed: [TexelRect; 2],
}

impl Scroll {
    /// Returns the movement of a map since the same map of an earlier frame.
    pub fn between(before: &FittedMap, now: &FittedMap) -> Self {
        shift(before, now).map_or_else(
            || Self::new_map(now.projection.resolution),
            |(by, depth_changed)| Self {
                is_new: false,
                depth_changed,
                shift: by,
                exposed: exposed(by, now.projection.resolution),
            },
        )
    }

    /// Returns whether the whole map must be drawn. Otherwise it is enough to draw static casters into
    /// [`Self::exposed`].
    pub const fn is_redraw(&self) -> bool {
        self.is_new || self.depth_changed
    }

    /// Returns the texels that were not in the old map: no rectangle, one, two that do not overlap, or all of
    /// a new map. A changed depth range does not count here.
    pub fn exposed(&self) -> impl Iterator<Item = TexelRect> {
        self.exposed.into_iter().filter(|rect| rect.size.min_element() > 0)
    }

    /// Returns the texel offset of the map, given its texel offset before. `size` is the map's width and
    /// height, in texels. Texel t is stored at `t + texel_offset` modulo `size`. The offset is zero if the
    /// whole map must be drawn.
    pub fn texel_offset(&self, before: UVec2, size: UVec2) -> UVec2 {
        if self.is_redraw() || size.min_element() == 0 {
            return UVec2::ZERO;
        }
        let moved = |before: u32, shift: i32, size: u32| {
            (i64::from(before) + i64::from(shift)).rem_euclid(i64::from(size)) as u32
        };
        UVec2::new(moved(before.x, self.shift.x, size.x), moved(before.y, self.shift.y, size.y))
    }

    fn new_map(resolution: UVec2) -> Self {
        let all = TexelRect { min: UVec2::ZERO, size: resolution };
        Self { is_new: true, depth_changed: true, shift: IVec2::ZERO, exposed: [all, TexelRect::default()] }
    }
}

/// Returns the shift in texels from a map to an earlier one and whether the depth range changed, or `None` if
/// they share no texel.
fn shift(before: &FittedMap, now: &FittedMap) -> Option<(IVec2, bool)> {
    let (old, new) = (before.grid_position?, now.grid_position?);
    let axes = |fit: &LightProjection| [0, 1, 2].map(|i| fit.light_from_world.col(i));
    let is_same = axes(&before.projection) == axes(&now.projection)
        && old.texel == new.texel
        && before.projection.resolution == now.projection.resolution
        && before.projection.depth == now.projection.depth;
    if !is_same || before.projection.is_empty {
        return None;
    }
    let right = new.first[0].saturating_sub(old.first[0]);
    // Grid lines count upward, texture rows downward.
    let down = old.first[1].saturating_sub(new.first[1]);
    let resolution = now.projection.resolution;
    if right.unsigned_abs() >= u64::from(resolution.x) || down.unsigned_abs() >= u64::from(resolution.y) {
        return None;
    }
    let by = IVec2::new(i32::try_from(right).ok()?, i32::try_from(down).ok()?);
    Some((by, old.depth != new.depth))
}

/// Returns the columns, then the remaining rows, that a shift brings into a map.
fn exposed(by: IVec2, resolution: UVec2) -> [TexelRect; 2] {
    let count = UVec2::new(by.x.unsigned_abs(), by.y.unsigned_abs()).min(resolution);
    let kept = resolution - count;
    let first = |by: i32, kept: u32| if by > 0 { kept } else { 0 };
    let columns = TexelRect { min: UVec2::new(first(by.x, kept.x), 0), size: UVec2::new(count.x, resolution.y) };
    let left = if by.x > 0 { 0 } else { count.x };
    let rows = TexelRect { min: UVec2::new(left, first(by.y, kept.y)), size: UVec2::new(kept.x, count.y) };
    [columns, rows]
}

/// A square of the world's texel grid, with a projection that does not depend on the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// Index of the square: columns to the right and rows upward along the map's axes, counted from
    /// the world's origin.
    pub index: [i64; 2],
    /// Projection of the tile, with `size` × `size` texels. Its [`LightProjection::origin`] is the middle of
    /// the tile's near plane. Casters must be drawn relative to it. While the light, the map's angle, the
    /// texel size and the depth range do not change, all tiles have matrices with the same bits, and tiles
    /// with the same index have the same origin.
    pub projection: LightProjection,
    /// Position of the tile's visible part in the map.
    pub map: TexelRect,
    /// Texel of the tile at the top left of that part.
    pub from: UVec2,
}

/// Iterator over the tiles that cover a map, row by row from below; see [`tiles`].
#[derive(Clone, Debug)]
pub struct Tiles {
    grid_position: GridPosition,
    resolution: UVec2,
    size: u32,
    axes: LightAxes,
    /// Projection of all tiles, without their origin.
    fit: LightProjection,
    columns: Range<i64>,
    rows: Range<i64>,
    next: [i64; 2],
}

/// Returns the world-anchored tiles of `size` × `size` texels that cover a map on the grid.
///
/// ```
/// # use shadowfit::glam::{DVec2, DVec3, Vec3};
/// # use shadowfit::scroll::tiles;
/// # use shadowfit::*;
/// # let camera = PerspectiveCamera {
/// #     eye: DVec3::new(0.0, 1.7, 5.0),
/// #     forward: Vec3::NEG_Z,
/// #     up: Vec3::Y,
/// #     fov_y: 0.8,
/// #     aspect: 16.0 / 9.0,
/// #     near: 0.1,
/// #     far: 200.0,
/// # };
/// # let views = [camera.frustum()?];
/// # let input = FitInput::new(&views, Vec3::new(0.3, -0.8, 0.2));
/// # let mut storage = [DVec2::ZERO; Scratch::required(0, 1)];
/// let maps = FitState::new().fit(&input, &Technique::default(), &mut Scratch::new(&mut storage))?;
/// let mut texels = 0;
/// for tile in tiles(&maps[0], 256)? {
///     // Draw tile.index with tile.projection unless it is cached. Copy it to tile.map, beginning at tile.from.
///     texels += tile.map.size.x * tile.map.size.y;
/// }
/// assert_eq!(texels, 2048 * 2048); // together they cover the map
/// # Ok::<(), FitError>(())
/// ```
///
/// Draw and cache tiles by their index. Copy them into the map, or look them up directly. A tile that is
/// drawn again has the same bits for any camera, if its casters have not changed. Its depths are the map's
/// depths.
///
/// # Errors
///
/// [`FitError::NotOnGrid`] for a map that is not snapped, not held and not a sphere's.
/// [`FitError::OutOfRange`] for a size of 0 or above 65 536 texels, and for an invalid grid position or fit.
pub fn tiles(map: &FittedMap, size: u32) -> Result<Tiles, FitError> {
    checks::within("the size of a tile", f64::from(size), 1.0, f64::from(MAX_TILE))?;
    let grid_position = map.grid_position.ok_or(FitError::NotOnGrid)?;
    let axes = LightAxes::of_matrix(&map.projection.light_from_world)?;
    for line in grid_position.first {
        checks::within("a grid line of the map", line as f64, -MAX_LINE, MAX_LINE)?;
    }
    let side = i64::from(size);
    let cover = |first: i64, texels: u32| {
        first.div_euclid(side)..(first + i64::from(texels) - 1).div_euclid(side).saturating_add(1)
    };
    let (columns, rows) = (
        cover(grid_position.first[0], map.projection.resolution.x),
        cover(grid_position.first[1], map.projection.resolution.y),
    );
    let next = [columns.start, rows.start];
    let fit = tile_fit(&axes, &grid_position, size, map)?;
    Ok(Tiles { grid_position, resolution: map.projection.resolution, size, axes, fit, columns, rows, next })
}

/// Greatest side of a tile, in texels. No texture is larger.
const MAX_TILE: u32 = 65_536;

/// Returns the projection of a tile whose origin is in the middle of its near plane.
fn tile_fit(
    axes: &LightAxes,
    grid_position: &GridPosition,
    size: u32,
    map: &FittedMap,
) -> Result<LightProjection, FitError> {
    let half = grid_position.texel * (f64::from(size) * 0.5);
    let depth_range = grid_position.depth[1] - grid_position.depth[0];
    let (min, max) = ((-half).extend(-depth_range), half.extend(0.0));
    let mut volume = Volume::covering(*axes, min, max, [BoundSource::Held; 6], false);
    volume.light_at_near_plane();
    LightProjection::from_volume(DVec3::ZERO, &volume, UVec2::splat(size), map.projection.depth)
}

impl Tiles {
    fn tile(&self, index: [i64; 2]) -> Tile {
        let side = i64::from(self.size);
        let middle = [0, 1].map(|i| (index[i] as f64 + 0.5) * f64::from(self.size) * self.grid_position.texel[i]);
        let origin = self.axes.unproject(DVec3::new(middle[0], middle[1], self.grid_position.depth[1]));
        // Left top of the tile in the map, where rows count downward.
        let left = index[0] * side - self.grid_position.first[0];
        let top = self.grid_position.first[1] + i64::from(self.resolution.y) - (index[1] + 1) * side;
        let ([x, width, from_x], [y, height, from_y]) =
            (overlap(left, side, self.resolution.x), overlap(top, side, self.resolution.y));
        Tile {
            index,
            projection: LightProjection { origin, ..self.fit },
            map: TexelRect { min: UVec2::new(x, y), size: UVec2::new(width, height) },
            from: UVec2::new(from_x, from_y),
        }
    }
}

/// Returns the start and length of the part of a run of texels inside a map, and the start of that part in
/// the run.
fn overlap(start: i64, length: i64, resolution: u32) -> [u32; 3] {
    let (first, end) = (start.max(0), (start + length).min(i64::from(resolution)));
    [first, (end - first).max(0), first - start].map(|texels| texels as u32)
}

impl Iterator for Tiles {
    type Item = Tile;

    fn next(&mut self) -> Option<Tile> {
        let [column, row] = self.next;
        if row >= self.rows.end {
            return None;
        }
        self.next = if column + 1 < self.columns.end { [column + 1, row] } else { [self.columns.start, row + 1] };
        Some(self.tile([column, row]))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let width = self.columns.end - self.columns.start;
        let passed = (self.next[1] - self.rows.start) * width + self.next[0] - self.columns.start;
        let left = (self.rows.end - self.rows.start) * width - passed;
        (left as usize, Some(left as usize))
    }
}

impl ExactSizeIterator for Tiles {}
