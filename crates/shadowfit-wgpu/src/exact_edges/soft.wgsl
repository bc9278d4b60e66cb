// Verdicts of the maps for a pixel under a sun with a radius: every texel within the cone of its rays counts.
// A pyramid of nearest and farthest depths bounds the texels, so that wide cones cost no more than narrow
// ones.

// x: depth nearest to the light, y: farthest depth. Blocks of the finest level have BLOCK texels per side.
@group(1) @binding(6) var bounds: texture_2d_array<f32>;

// Blocks per axis that are read to find the height of casters, and to find the area that they cover.
const FEW_BLOCKS: f32 = 4.0;
const MANY_BLOCKS: f32 = 8.0;
// Greatest gap, in texels, through which rays may pass between casters of different heights that all cover a
// point. A wider gap makes the pixel unsure.
const MOST_GAP: f32 = 1.0;
// Greatest radius, in texels, at which texels are read one by one.
const NARROW: f32 = 5.0;

// A square of blocks around a point.
struct Blocks {
    level: i32,
    // Width of a block, in texels.
    side: f32,
    // First texel of the region, and the texel after the last.
    first: vec2<f32>,
    end: vec2<f32>,
    is_whole: bool,
}

// Returns the blocks that contain all texels within a distance of a point, at the finest level that needs at
// most `most` blocks per axis.
fn blocks_around(p: shadowfit_Projected, reach: vec2<f32>, most: f32) -> Blocks {
    let first = floor(p.texel - reach - 0.5);
    let end = floor(p.texel + reach - 0.5) + 2.0;
    let widest = max(end.x - first.x, end.y - first.y);
    let level = i32(max(ceil(log2(widest / (f32(BLOCK) * (most - 1.0)))), 0.0));
    let last_level = i32(textureNumLevels(bounds)) - 1;
    let side = f32(BLOCK) * exp2(f32(level));
    // If blocks do not fill a layer, a region must not cross its seam.
    let fills = all(fract(p.size / side) == vec2<f32>(0.0));
    let stored = first + p.texel_offset;
    let crosses = any(floor(stored / p.size) != floor((stored + end - first - 1.0) / p.size));
    let is_inside = all(first >= vec2<f32>(0.0)) && all(end <= p.size);
    return Blocks(level, side, first, end, is_inside && level <= last_level && (fills || !crosses));
}

// Returns the number of blocks that a region touches along each axis. Blocks are aligned to the stored
// position, not to the map.
fn block_counts(p: shadowfit_Projected, blocks: Blocks) -> vec2<f32> {
    let stored = (blocks.first + p.texel_offset) % p.size;
    let into = stored % vec2<f32>(blocks.side);
    return ceil((into + blocks.end - blocks.first) / blocks.side);
}

// Returns the first texel, in the map, of a block of a region.
fn block_begin(p: shadowfit_Projected, blocks: Blocks, index: vec2<f32>) -> vec2<f32> {
    let stored = (blocks.first + p.texel_offset) % p.size;
    return blocks.first - stored % vec2<f32>(blocks.side) + index * blocks.side;
}

fn load_bounds(p: shadowfit_Projected, blocks: Blocks, begin: vec2<f32>) -> vec2<f32> {
    let stored = (begin + p.texel_offset + p.size) % p.size;
    return textureLoad(bounds, vec2<i32>(stored / blocks.side), i32(p.layer), blocks.level).xy;
}

// Returns the depth that is nearer to the light.
fn nearer(a: f32, b: f32) -> f32 {
    return select(b, a, a COMPARE b);
}

fn farther(a: f32, b: f32) -> f32 {
    return select(a, b, a COMPARE b);
}

// Returns the nearest and farthest depth of all texels of a region.
fn bounds_of(p: shadowfit_Projected, blocks: Blocks) -> vec2<f32> {
    let counts = block_counts(p, blocks);
    var found = load_bounds(p, blocks, block_begin(p, blocks, vec2<f32>(0.0)));
    for (var y = 0.0; y < counts.y; y += 1.0) {
        for (var x = 0.0; x < counts.x; x += 1.0) {
            let one = load_bounds(p, blocks, block_begin(p, blocks, vec2<f32>(x, y)));
            found = vec2<f32>(nearer(found.x, one.x), farther(found.y, one.y));
        }
    }
    return found;
}

// Returns the distance in texels around a point within which a caster at a depth may block a ray.
fn cone(p: shadowfit_Projected, depth: f32) -> vec2<f32> {
    return max((p.surface - depth) * p.penumbra, vec2<f32>(0.0));
}

// Returns how much nearer to the light the point's plane is within a block than at its centre.
fn rise_in(p: shadowfit_Projected, blocks: Blocks, rounding: f32) -> f32 {
    return TOWARD_LIGHT * dot(abs(p.gradient), vec2<f32>(blocks.side - 1.0) * 0.5) + rounding;
}

// Returns the verdict of the blocks of a region. It is LIT if no caster above the plane within its block may
// block a ray, and SHADOWED if the casters of all blocks cover the point.
fn verdict_of_blocks(p: shadowfit_Projected, blocks: Blocks, around: vec2<f32>, rounding: f32) -> u32 {
    let counts = block_counts(p, blocks);
    // Distance from a block's centre to its outer texels.
    let half = vec2<f32>(blocks.side - 1.0) * 0.5;
    let rise = rise_in(p, blocks, rounding);
    var is_lit = true;
    var is_covered = true;
    for (var y = 0.0; y < counts.y; y += 1.0) {
        for (var x = 0.0; x < counts.x; x += 1.0) {
            let begin = block_begin(p, blocks, vec2<f32>(x, y));
            let found = load_bounds(p, blocks, begin);
            let middle = begin + blocks.side * 0.5;
            // Depth of the plane where it is nearest to the light within the block.
            let plane = saturate(p.surface + dot(p.gradient, middle - p.texel) + rise);
            let distance = max(abs(middle - p.texel) - half, vec2<f32>(0.0));
            let reach = cone(p, found.x) + around;
            let is_higher = !(plane COMPARE found.x);
            is_lit = is_lit && !(is_higher && all(distance <= reach));
            is_covered = is_covered && !(plane COMPARE found.y);
        }
    }
    return select(select(UNSURE, SHADOWED, is_covered), LIT, is_lit);
}

// Returns the verdict of a map under a sun with a radius: LIT, SHADOWED, UNSURE or TOO_WIDE.
fn soft_footprint(map: shadowfit_Map, p: shadowfit_Projected, spread: vec2<f32>, rise: f32) -> u32 {
    let around = spread + FOOTPRINT;
    // Find the greatest height of casters: first of the whole map, then repeatedly of the cone for that
    // height.
    var found = vec2<f32>(NEAREST);
    var radius = cone(p, NEAREST);
    for (var round = 0; round < 3; round += 1) {
        let blocks = blocks_around(p, radius + around, FEW_BLOCKS);
        if !blocks.is_whole {
            return TOO_WIDE;
        }
        found = bounds_of(p, blocks);
        radius = cone(p, found.x);
    }
    let gap = abs((found.y - found.x) * p.penumbra);
    let is_lid = all(gap <= vec2<f32>(MOST_GAP));
    var verdict = UNSURE;
    if all(radius + around <= vec2<f32>(NARROW)) {
        verdict = footprint(map, p, spread + radius, rise);
    } else {
        let steepness = abs(p.gradient.x) + abs(p.gradient.y);
        let rounding = map.constant_depth + TOWARD_LIGHT * ROUNDED_TEXEL * steepness;
        let blocks = blocks_around(p, radius + around, MANY_BLOCKS);
        verdict = verdict_of_blocks(p, blocks, around, rounding);
        if verdict == LIT {
            // Casters lower than the plane's rise within its block, such as ledges of a wall at grazing
            // light, block rays only close to the point. There, texels are read one by one.
            let low = 2.0 * abs(rise_in(p, blocks, rounding) * p.penumbra);
            let near = footprint(map, p, spread + low, 0.0);
            verdict = select(near, UNSURE, near == SHADOWED);
        }
    }
    return select(verdict, UNSURE, verdict == SHADOWED && !is_lid);
}
