// What the maps say about a pixel under a sun with a radius: every texel within the cone of its rays counts. A pyramid of
// nearest and farthest depths bounds them, so that wide cones cost no more than narrow ones.

// x: the depth nearest to the light, y: the farthest one. The finest level has blocks of BLOCK texels a side.
@group(1) @binding(6) var bounds: texture_2d_array<f32>;

// Blocks along a side that are looked at for how high casters may be, and for what they cover.
const FEW_BLOCKS: f32 = 4.0;
const MANY_BLOCKS: f32 = 8.0;
// Texels by which rays may pass between casters of different heights that all cover a point: more than this is unsure.
const MOST_GAP: f32 = 1.0;
// Half the side, in texels, up to which texels are looked at one by one.
const NARROW: f32 = 5.0;

// A square of blocks around a point.
struct Blocks {
    level: i32,
    // Texels of a block's side.
    side: f32,
    // The first texel, and one beyond the last, of the region that is looked at.
    first: vec2<f32>,
    end: vec2<f32>,
    is_whole: bool,
}

// The blocks that hold all texels within a distance of a point, no more than a number of them along a side.
fn blocks_around(p: shadowfit_Projected, reach: vec2<f32>, most: f32) -> Blocks {
    let first = floor(p.texel - reach - 0.5);
    let end = floor(p.texel + reach - 0.5) + 2.0;
    let widest = max(end.x - first.x, end.y - first.y);
    let level = i32(max(ceil(log2(widest / (f32(BLOCK) * (most - 1.0)))), 0.0));
    let last_level = i32(textureNumLevels(bounds)) - 1;
    let side = f32(BLOCK) * exp2(f32(level));
    // Where blocks do not fill a layer, a region must not reach across its seam.
    let fills = all(fract(p.size / side) == vec2<f32>(0.0));
    let stored = first + p.texel_offset;
    let crosses = any(floor(stored / p.size) != floor((stored + end - first - 1.0) / p.size));
    let is_inside = all(first >= vec2<f32>(0.0)) && all(end <= p.size);
    return Blocks(level, side, first, end, is_inside && level <= last_level && (fills || !crosses));
}

// How many blocks a region touches along each axis: the first one counts from where it is stored.
fn block_counts(p: shadowfit_Projected, blocks: Blocks) -> vec2<f32> {
    let stored = (blocks.first + p.texel_offset) % p.size;
    let into = stored % vec2<f32>(blocks.side);
    return ceil((into + blocks.end - blocks.first) / blocks.side);
}

// First texel, in the map, of a block of a region.
fn block_begin(p: shadowfit_Projected, blocks: Blocks, index: vec2<f32>) -> vec2<f32> {
    let stored = (blocks.first + p.texel_offset) % p.size;
    return blocks.first - stored % vec2<f32>(blocks.side) + index * blocks.side;
}

fn load_bounds(p: shadowfit_Projected, blocks: Blocks, begin: vec2<f32>) -> vec2<f32> {
    let stored = (begin + p.texel_offset + p.size) % p.size;
    return textureLoad(bounds, vec2<i32>(stored / blocks.side), i32(p.layer), blocks.level).xy;
}

// The nearer to the light of two depths, and the farther one.
fn nearer(a: f32, b: f32) -> f32 {
    return select(b, a, a COMPARE b);
}

fn farther(a: f32, b: f32) -> f32 {
    return select(a, b, a COMPARE b);
}

// Nearest and farthest depth of all texels of a region.
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

// Texels around a point within which a caster of a depth may stand in the way of a ray.
fn cone(p: shadowfit_Projected, depth: f32) -> vec2<f32> {
    return max((p.surface - depth) * p.penumbra, vec2<f32>(0.0));
}

// By how much the point's plane is nearer to the light within a block than in its middle.
fn rise_in(p: shadowfit_Projected, blocks: Blocks, rounding: f32) -> f32 {
    return TOWARD_LIGHT * dot(abs(p.gradient), vec2<f32>(blocks.side - 1.0) * 0.5) + rounding;
}

// The verdict of the blocks of a region: LIT where nothing that is higher than the plane within its block stands in the way
// of any ray, SHADOWED where all of them cover the point.
fn verdict_of_blocks(p: shadowfit_Projected, blocks: Blocks, around: vec2<f32>, rounding: f32) -> u32 {
    let counts = block_counts(p, blocks);
    // From a block's middle to its outer texels.
    let half = vec2<f32>(blocks.side - 1.0) * 0.5;
    let rise = rise_in(p, blocks, rounding);
    var is_lit = true;
    var is_covered = true;
    for (var y = 0.0; y < counts.y; y += 1.0) {
        for (var x = 0.0; x < counts.x; x += 1.0) {
            let begin = block_begin(p, blocks, vec2<f32>(x, y));
            let found = load_bounds(p, blocks, begin);
            let middle = begin + blocks.side * 0.5;
            // The plane where it is nearest to the light within the block.
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

// The verdict of a map under a sun with a radius: LIT, SHADOWED, UNSURE or TOO_WIDE.
fn soft_footprint(map: shadowfit_Map, p: shadowfit_Projected, spread: vec2<f32>, rise: f32) -> u32 {
    let around = spread + FOOTPRINT;
    // How high casters may be: as high as the map has any, and then as high as those in that cone.
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
            // Casters that are lower than the plane rises within its block, such as ledges of a wall that the light grazes,
            // stand in the way close to the point only, where texels are looked at one by one.
            let low = 2.0 * abs(rise_in(p, blocks, rounding) * p.penumbra);
            let near = footprint(map, p, spread + low, 0.0);
            verdict = select(near, UNSURE, near == SHADOWED);
        }
    }
    return select(verdict, UNSURE, verdict == SHADOWED && !is_lid);
}
