//! Tests many shapes against several volumes at once.
//!
//! Shapes are stored in lanes (structure of arrays), so that the compiler vectorises every loop over them on
//! any target. A shape's support along a normal does not depend on the plane's distance, and the maps of one
//! light share most of their normals, so it is computed once per normal. Most shapes lie outside all volumes.
//! So they are first tested against a few planes around all volumes, the *screen*. Shapes that pass are
//! collected until the lanes are full.
//!
//! ```text
//!    shapes ──▶ lanes ──▶ screen ──few──▶ collected ──▶ lanes ──▶ planes of each volume ──▶ masks
//!                           └────────────────many─────────────────────▲
//! ```

use glam::{DVec3, Vec3, Vec4};

use super::shapes::{Bounds, LANES, Lane, Lanes};
use super::volume::{CasterVolume, widened};

/// Greatest number of volumes in a call: the bits of a mask.
pub(super) const MAX_VOLUMES: usize = 8;

/// Greatest number of planes of all volumes together.
const MAX_PLANES: usize = MAX_VOLUMES * CasterVolume::MAX_PLANES;

/// Greatest number of planes of the screen: a silhouette has no more edges.
const MAX_SCREEN: usize = 6;

/// Tests shapes against up to eight volumes. Bit i of a shape's mask is set if the shape may cast a shadow
/// into map i. The results equal the tests of `volumes[i].relative_to(origin)` exactly.
///
/// `shapes` are in world axes, in metres, relative to `origin` (for [`Boxes`](crate::Boxes): `cull(volumes,
/// boxes.origin, boxes.boxes, masks)`). Shapes past the length of `masks` and volumes past the eighth are
/// ignored. Masks past the number of shapes stay unchanged.
///
/// A call has a fixed cost of about a microsecond for four volumes, so pass all shapes at once.
pub fn cull<S: Bounds>(volumes: &[CasterVolume], origin: DVec3, shapes: &[S], masks: &mut [u8]) {
    let table = PlaneTable::new(volumes, origin);
    let count = shapes.len().min(masks.len());
    let Some(first) = shapes.first() else { return };
    let mut block = Block::<S>::new(&table);
    let mut waiting = Waiting { shapes: [*first; LANES], indices: [0; LANES], count: 0 };
    let (chunks, rest) = shapes[..count].as_chunks();
    for (chunk, start) in chunks.iter().zip((0..).step_by(LANES)) {
        waiting.pass(&mut block, chunk, start, masks);
    }
    waiting.flush(&mut block, masks);
    // The remaining shapes do not fill the lanes and skip the screen. The unused lanes are never read.
    let start = count - rest.len();
    waiting.shapes[..rest.len()].copy_from_slice(rest);
    for (waiting, index) in waiting.indices.iter_mut().zip(start..count) {
        *waiting = index;
    }
    waiting.count = rest.len();
    waiting.flush(&mut block, masks);
}

/// Shapes that passed the screen, with the indices of their masks.
struct Waiting<S> {
    shapes: [S; LANES],
    indices: [usize; LANES],
    count: usize,
}

impl<S: Bounds> Waiting<S> {
    /// Screens a chunk whose masks begin at `start`. Tests the chunk directly if many shapes pass, otherwise
    /// collects them.
    fn pass(&mut self, block: &mut Block<S>, chunk: &[S; LANES], start: usize, masks: &mut [u8]) {
        block.load(chunk);
        let passed = block.screen();
        let masks_of_chunk = &mut masks[start..start + LANES];
        if passed.count > LANES / 2 {
            block.test();
            masks_of_chunk.copy_from_slice(&block.results());
            return;
        }
        masks_of_chunk.fill(0);
        if self.count + passed.count > LANES {
            self.flush(block, masks);
        }
        for i in passed.lanes[..passed.count].iter().map(|i| usize::from(*i)) {
            self.shapes[self.count] = chunk[i];
            self.indices[self.count] = start + i;
            self.count += 1;
        }
    }

    /// Tests the collected shapes.
    fn flush(&mut self, block: &mut Block<S>, masks: &mut [u8]) {
        if self.count > 0 {
            block.load(&self.shapes);
            block.test();
            for (index, mask) in self.indices[..self.count].iter().zip(block.results()) {
                masks[*index] = mask;
            }
            self.count = 0;
        }
    }
}

/// The lanes that pass the screen.
struct Passed {
    lanes: [u8; LANES],
    count: usize,
}

/// Shapes in lanes, with their intermediate results.
struct Block<'a, S: Bounds> {
    table: &'a PlaneTable,
    lanes: S::Lanes,
    slack: Lane,
    reach: Lane,
    /// Least distance to the planes of each volume.
    least: [Lane; MAX_VOLUMES],
    /// Whether all lanes of the last block were outside the screen.
    was_outside: bool,
    /// Index of the screen's plane to test first.
    first_plane: usize,
}

impl<'a, S: Bounds> Block<'a, S> {
    fn new(table: &'a PlaneTable) -> Self {
        let (slack, reach) = ([0.0; LANES], [0.0; LANES]);
        let (lanes, least) = (S::Lanes::default(), [[0.0; LANES]; MAX_VOLUMES]);
        Self { table, lanes, slack, reach, least, was_outside: false, first_plane: 0 }
    }

    /// Loads shapes into the lanes.
    fn load(&mut self, shapes: &[S; LANES]) {
        gather::<S>(shapes, &mut self.lanes);
        slacks::<S>(&self.lanes, &mut self.slack);
    }

    /// Returns the lanes that are inside the screen.
    ///
    /// Neighbours in a list are often neighbours in the world. If a whole block was outside, the next one
    /// starts with the plane that decided the last, and stops as soon as all of it is outside.
    fn screen(&mut self) -> Passed {
        let screen = &self.table.screen[..self.table.screen_count];
        let least = &mut self.least[0];
        least.fill(f32::MAX);
        let (before, after) = screen.split_at(self.first_plane.min(screen.len()));
        for (i, plane) in after.iter().chain(before).enumerate() {
            narrow::<S>(&self.lanes, *plane, least);
            if self.was_outside && are_behind(least, &self.slack) {
                self.first_plane = (self.first_plane + i) % screen.len();
                return Passed { lanes: [0; LANES], count: 0 };
            }
        }
        let mut bits = [0; LANES];
        mark(least, &self.slack, 1, &mut bits);
        let mut passed = Passed { lanes: [0; LANES], count: 0 };
        for (lane, bit) in bits.iter().enumerate() {
            // Written unconditionally and overwritten later, because a branch here would be unpredictable.
            passed.lanes[passed.count] = lane as u8;
            passed.count += usize::from(*bit);
        }
        self.was_outside = passed.count == 0;
        passed
    }

    /// Computes the distances of all lanes to the planes of all volumes.
    fn test(&mut self) {
        let Self { table, lanes, reach, least, .. } = self;
        let volumes = &mut least[..table.volume_count];
        volumes.fill([f32::MAX; LANES]);
        for (normal, offsets) in table.normals[..table.normal_count].iter().zip(&table.offsets) {
            reaches::<S>(lanes, *normal, reach);
            for (least, d) in volumes.iter_mut().zip(offsets) {
                if *d < f32::INFINITY {
                    nearer(reach, *d, least);
                }
            }
        }
    }

    /// Returns the masks of all lanes.
    fn results(&self) -> [u8; LANES] {
        let mut bits = [0; LANES];
        for (volume, least) in self.least[..self.table.volume_count].iter().enumerate() {
            mark(least, &self.slack, 1 << volume, &mut bits);
        }
        bits
    }
}

// The loops over the lanes. Each is a separate function, because the compiler turns them into scalar
// operations when they are inlined into each other.

#[inline(never)]
fn gather<S: Bounds>(shapes: &[S; LANES], lanes: &mut S::Lanes) {
    lanes.gather(shapes);
}

#[inline(never)]
fn slacks<S: Bounds>(lanes: &S::Lanes, slack: &mut Lane) {
    lanes.slack(|i, value| slack[i] = value);
}

#[inline(never)]
fn reaches<S: Bounds>(lanes: &S::Lanes, normal: Vec3, reach: &mut Lane) {
    lanes.support(normal, |i, value| reach[i] = value);
}

#[inline(never)]
fn narrow<S: Bounds>(lanes: &S::Lanes, plane: Vec4, least: &mut Lane) {
    lanes.support(plane.truncate(), |i, value| least[i] = lesser(least[i], value + plane.w));
}

#[inline(never)]
fn nearer(reach: &Lane, d: f32, least: &mut Lane) {
    for (least, reach) in least.iter_mut().zip(reach) {
        *least = lesser(*least, *reach + d);
    }
}

/// Sets a bit for lanes that are not behind a plane.
#[inline(never)]
fn mark(least: &Lane, slack: &Lane, bit: u8, bits: &mut [u8; LANES]) {
    for ((bits, least), slack) in bits.iter_mut().zip(least).zip(slack) {
        *bits |= if *least < -*slack { 0 } else { bit };
    }
}

/// Returns whether all lanes are behind a plane.
#[inline(never)]
fn are_behind(least: &Lane, slack: &Lane) -> bool {
    // Counts all lanes, because an early exit would prevent vectorisation.
    least.iter().zip(slack).map(|(least, slack)| u32::from(*least < -*slack)).sum::<u32>() == LANES as u32
}

/// Returns the lesser of two distances. Ignores NaN, so that shapes with NaN count as touching.
fn lesser(least: f32, distance: f32) -> f32 {
    if distance < least { distance } else { least }
}

/// The planes of all volumes, grouped by normal.
struct PlaneTable {
    normals: [Vec3; MAX_PLANES],
    normal_count: usize,
    /// The planes' d for each normal and volume. Infinite if a volume has no such plane.
    offsets: [[f32; MAX_VOLUMES]; MAX_PLANES],
    volume_count: usize,
    /// Planes around all volumes.
    screen: [Vec4; MAX_SCREEN],
    screen_count: usize,
}

impl PlaneTable {
    fn new(volumes: &[CasterVolume], origin: DVec3) -> Self {
        let mut table = Self {
            normals: [Vec3::ZERO; MAX_PLANES],
            normal_count: 0,
            offsets: [[f32::INFINITY; MAX_VOLUMES]; MAX_PLANES],
            volume_count: volumes.len().min(MAX_VOLUMES),
            screen: [Vec4::ZERO; MAX_SCREEN],
            screen_count: 0,
        };
        for (i, volume) in volumes.iter().take(MAX_VOLUMES).enumerate() {
            for plane in volume.relative_to(origin).active_planes() {
                let normal = table.normal_index(plane.truncate());
                let d = &mut table.offsets[normal][i];
                *d = lesser(*d, widened(plane.w));
            }
        }
        table.find_screen();
        table
    }

    /// Returns the index of a normal in the list. Adds it if it is new.
    fn normal_index(&mut self, normal: Vec3) -> usize {
        let known = self.normals[..self.normal_count].iter().position(|known| *known == normal);
        known.unwrap_or_else(|| {
            self.normals[self.normal_count] = normal;
            self.normal_count += 1;
            self.normal_count - 1
        })
    }

    /// Selects the first normals that all volumes share.
    fn find_screen(&mut self) {
        for (normal, offsets) in self.normals[..self.normal_count].iter().zip(&self.offsets) {
            let farthest = offsets[..self.volume_count].iter().fold(f32::MIN, |d, other| d.max(*other));
            if farthest < f32::INFINITY && self.screen_count < MAX_SCREEN {
                self.screen[self.screen_count] = normal.extend(farthest);
                self.screen_count += 1;
            }
        }
    }
}
