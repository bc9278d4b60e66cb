//! Verdicts of the maps under a sun with a radius: the arithmetic of `soft.wgsl`, with bounds computed from
//! the texels of the maps.

use shadowfit::DepthConvention;
use shadowfit::glam::Vec2;
use shadowfit_wgpu::ShadowMapDescriptor;
use shadowfit_wgpu::uniforms::MapUniform;

use super::{FOOTPRINT, Projected, ROUNDED_TEXEL, Twin, Verdict};

// Constants of the WGSL and of the pyramids.
const BLOCK: u32 = 4;
const COARSEST: u32 = 4;
const FEW_BLOCKS: f32 = 4.0;
const MANY_BLOCKS: f32 = 8.0;
const MOST_GAP: f32 = 1.0;
const NARROW: f32 = 5.0;

/// Nearest and farthest depth of each block of a level, layer by layer and row by row.
struct Level {
    columns: u32,
    rows: u32,
    bounds: Vec<[f32; 2]>,
}

/// All levels, the finest first.
pub(super) struct Pyramid(Vec<Level>);

impl Pyramid {
    pub(super) fn new(descriptor: &ShadowMapDescriptor, stored: &[f32]) -> Self {
        let blocks = descriptor.resolution.map(|side| side.div_ceil(BLOCK));
        let coarser = blocks[0].max(blocks[1]).div_ceil(COARSEST).next_power_of_two().ilog2();
        Self((0..=coarser).map(|level| Level::new(descriptor, stored, BLOCK << level)).collect())
    }
}

impl Level {
    /// Computes a level with blocks of this width, in texels.
    fn new(descriptor: &ShadowMapDescriptor, stored: &[f32], side: u32) -> Self {
        let [width, height] = descriptor.resolution;
        let [columns, rows] = [width.div_ceil(side), height.div_ceil(side)];
        let is_reversed = descriptor.depth == DepthConvention::Reversed;
        let none = if is_reversed { [f32::MIN, f32::MAX] } else { [f32::MAX, f32::MIN] };
        let mut bounds = vec![none; (columns * rows * descriptor.maps) as usize];
        for (index, depth) in (0..).zip(stored) {
            let (x, row) = (index % width, index / width);
            let (y, layer) = (row % height, row / height);
            let [nearest, farthest] = &mut bounds[((layer * rows + y / side) * columns + x / side) as usize];
            let [least, most] = if is_reversed { [farthest, nearest] } else { [nearest, farthest] };
            (*least, *most) = (least.min(*depth), most.max(*depth));
        }
        Self { columns, rows, bounds }
    }
}

/// Blocks around a point.
struct Blocks {
    level: usize,
    side: f32,
    /// Beginning of the first block, and number of blocks across and down.
    begin: Vec2,
    counts: Vec2,
}

impl Twin {
    pub(super) fn soft_footprint(&self, map: &MapUniform, p: &Projected, spread: Vec2, rise: f32) -> Verdict {
        let around = spread + FOOTPRINT;
        let is_reversed = self.descriptor.depth == DepthConvention::Reversed;
        let nearest = if is_reversed { 1.0 } else { 0.0 };
        let mut found = [nearest; 2];
        let mut radius = self.cone(map, p, nearest);
        for _ in 0..3 {
            let Some(blocks) = self.blocks_around(map, p, radius + around, FEW_BLOCKS) else {
                return Verdict::TooWide;
            };
            found = self.bounds_of(map, &blocks);
            radius = self.cone(map, p, found[0]);
        }
        let gap = ((found[1] - found[0]) * Vec2::from(map.penumbra)).abs();
        let is_lid = gap.cmple(Vec2::splat(MOST_GAP * (1.0 + self.slack))).all();
        let verdict = if (radius + around).cmple(Vec2::splat(NARROW)).all() {
            self.footprint(map, p, spread + radius, rise)
        } else {
            self.verdict_of_blocks(map, p, radius, spread)
        };
        if verdict == Verdict::Shadowed && !is_lid { Verdict::Unsure } else { verdict }
    }

    /// Returns the distance in texels around a point within which a caster at a depth may block a ray.
    fn cone(&self, map: &MapUniform, p: &Projected, depth: f32) -> Vec2 {
        ((p.surface - depth) * Vec2::from(map.penumbra)).max(Vec2::ZERO) + self.radius_slack
    }

    /// Returns the blocks around a point, or `None` if they reach outside the map or are too many.
    fn blocks_around(&self, map: &MapUniform, p: &Projected, reach: Vec2, most: f32) -> Option<Blocks> {
        let first = (p.texel - reach - 0.5).floor();
        let end = (p.texel + reach - 0.5).floor() + 2.0;
        let widest = (end - first).max_element();
        let level = (widest / (BLOCK as f32 * (most - 1.0))).log2().ceil().max(0.0) as usize;
        let side = (BLOCK << level.min(24)) as f32;
        let [size, texel_offset] = [map.size, map.texel_offset].map(Vec2::from);
        let fills = (size % side) == Vec2::ZERO;
        let stored = first + texel_offset;
        let crosses = (stored / size).floor() != ((stored + end - first - 1.0) / size).floor();
        let is_inside = first.cmpge(Vec2::ZERO).all() && end.cmple(size).all();
        if !is_inside || level >= self.pyramid.as_ref()?.0.len() || (!fills && crosses) {
            return None;
        }
        let into = (stored % size) % side;
        Some(Blocks { level, side, begin: first - into, counts: ((into + end - first) / side).ceil() })
    }

    /// Returns the beginning of each block in the map, with its bounds.
    fn each<'a>(&'a self, map: &'a MapUniform, blocks: &'a Blocks) -> impl Iterator<Item = (Vec2, [f32; 2])> + 'a {
        let [across, down] = blocks.counts.to_array().map(|count| count as u32);
        let places = (0..down).flat_map(move |y| (0..across).map(move |x| Vec2::new(x as f32, y as f32)));
        places.map(|place| {
            let begin = blocks.begin + place * blocks.side;
            let size = Vec2::from(map.size);
            let stored = (begin + Vec2::from(map.texel_offset) + size) % size;
            let [x, y] = (stored / blocks.side).to_array().map(|place| place as u32);
            let level = &self.pyramid.as_ref().expect("a soft filter").0[blocks.level];
            (begin, level.bounds[((map.layer * level.rows + y) * level.columns + x) as usize])
        })
    }

    fn bounds_of(&self, map: &MapUniform, blocks: &Blocks) -> [f32; 2] {
        let all = self.each(map, blocks).map(|(_, bounds)| bounds);
        let nearer = |a: f32, b: f32| if self.is_nearer(a, b) { a } else { b };
        let farther = |a: f32, b: f32| if self.is_nearer(a, b) { b } else { a };
        all.reduce(|a, b| [nearer(a[0], b[0]), farther(a[1], b[1])]).expect("a block at least")
    }

    fn verdict_of_blocks(&self, map: &MapUniform, p: &Projected, radius: Vec2, spread: Vec2) -> Verdict {
        let around = spread + FOOTPRINT;
        let Some(blocks) = self.blocks_around(map, p, radius + around, MANY_BLOCKS) else { return Verdict::Unsure };
        let is_reversed = self.descriptor.depth == DepthConvention::Reversed;
        let toward_light = if is_reversed { 1.0 } else { -1.0 };
        let steepness = p.gradient.x.abs() + p.gradient.y.abs();
        let rounding = map.constant_depth + toward_light * ROUNDED_TEXEL * steepness;
        let half = Vec2::splat(blocks.side - 1.0) * 0.5;
        let rise = toward_light * (p.gradient.x.abs() * half.x + p.gradient.y.abs() * half.y) + rounding;
        let moved = self.depth_slack(steepness);
        let [mut is_lit, mut is_covered] = [true; 2];
        for (begin, [nearest, farthest]) in self.each(map, &blocks) {
            let aside = begin + blocks.side * 0.5 - p.texel;
            let change = p.gradient.x * aside.x + p.gradient.y * aside.y;
            let plane = (p.surface + change + rise).clamp(0.0, 1.0) + moved;
            let distance = (aside.abs() - half).max(Vec2::ZERO);
            let is_within = distance.cmple(self.cone(map, p, nearest) + around).all();
            is_lit &= !is_within || self.is_nearer(plane, nearest);
            is_covered &= !self.is_nearer(plane, farthest);
        }
        let low = 2.0 * (rise * Vec2::from(map.penumbra)).abs() + self.radius_slack;
        match (is_lit, is_covered) {
            // Casters lower than the plane within a block.
            (true, _) => match self.footprint(map, p, spread + low, 0.0) {
                Verdict::Shadowed => Verdict::Unsure,
                near => near,
            },
            (false, true) => Verdict::Shadowed,
            _ => Verdict::Unsure,
        }
    }
}
