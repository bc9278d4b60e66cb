// Counts the visible points of a depth buffer by position perpendicular to the light, needed texel size and
// view depth. The GPU version of `DemandSpace::index` and `DepthHistogram::bin`. Rust inserts the constants
// CELLS, LEVELS, SIDE, DEPTHS, CLASSES and MIN_FACING in front, and DepthTexture, the depth texture's type.

struct Demand {
    // Matrix from a pixel's column and row, and its depth minus the far plane's, to the homogeneous position
    // relative to the eye.
    world_from_pixel: mat4x4<f32>,
    // Coefficients of the view depth: for a position relative to the eye it is dot(xyz, position) + w, in
    // metres.
    view: vec4<f32>,
    direction: vec3<f32>,
    far_depth: f32,
    x: vec3<f32>,
    cell: f32,
    y: vec3<f32>,
    // The length of y is one over this.
    shape: f32,
    // First pixel of the view, and its width and height.
    corner: vec2<u32>,
    size: vec2<u32>,
    // Pixels from one point to the next, across and down.
    step: u32,
    // Pixels of this view per pixel of a view with the reference height, along a side.
    pixels: f32,
    // Exponent of the finest level's texel.
    exponent: i32,
    // View depths of the histogram's ends, in metres, and bins per factor of two.
    near: f32,
    far: f32,
    bins_per_octave: f32,
    // Width of a pixel that faces the eye, in metres: at the eye, and its growth per metre of view depth.
    pixel_width: vec2<f32>,
}

@group(0) @binding(0) var<uniform> demand: Demand;
@group(0) @binding(1) var depths: DepthTexture;
// Cells of the grid, then bins of the histogram.
@group(0) @binding(2) var<storage, read_write> counts: array<atomic<u32>, CELLS + DEPTHS * CLASSES>;

// Threads along a side of a workgroup. Each thread counts PARTS² points.
const THREADS: u32 = 16u;
const PARTS: u32 = 2u;

// Neighbouring points mostly belong to a few cells, so a workgroup counts them first: in slots, with the
// index plus 1 as key.
const SLOTS: u32 = THREADS * THREADS;
const SLOT_BITS: u32 = 8u;
var<workgroup> keys: array<atomic<u32>, SLOTS>;
var<workgroup> tallies: array<atomic<u32>, SLOTS>;

// Greater than any difference of depths.
const NOTHING: f32 = 2.0;

fn count(index: u32) {
    // Multiplicative hashing: 2³² divided by the golden ratio spreads neighbours evenly.
    let slot = (index * 0x9E3779B9u) >> (32u - SLOT_BITS);
    let found = atomicCompareExchangeWeak(&keys[slot], 0u, index + 1u);
    if found.exchanged || found.old_value == index + 1u {
        atomicAdd(&tallies[slot], 1u);
    } else {
        atomicAdd(&counts[index], 1u);
    }
}

// Returns the depth of a pixel minus the far plane's depth; 0 where nothing is drawn, and outside the view.
fn depth_at(pixel: vec2<i32>) -> f32 {
    if any(pixel < vec2<i32>(0)) || any(pixel >= vec2<i32>(demand.size)) {
        return 0.0;
    }
    return textureLoad(depths, vec2<i32>(demand.corner) + pixel, 0) - demand.far_depth;
}

// Returns the change of depth from a pixel to the next along an axis on its surface, which is constant on a
// plane. It is taken from the neighbour that is nearer in depth, so that surfaces behind a silhouette do not
// count.
fn change(pixel: vec2<i32>, axis: vec2<i32>, depth: f32) -> f32 {
    let next = depth_at(pixel + axis);
    let previous = depth_at(pixel - axis);
    let after = select(NOTHING, next - depth, next != 0.0);
    let before = select(NOTHING, depth - previous, previous != 0.0);
    return select(before, after, abs(after) <= abs(before));
}

fn exponent(x: f32) -> i32 {
    return i32((bitcast<u32>(x) >> 23u) & 0xffu);
}

fn power_of_two(power: i32) -> f32 {
    return bitcast<f32>(u32(power + 127) << 23u);
}

// Returns the width of the widest square texel that gives a point at most one pixel per texel: the least
// singular value.
fn needed_texel(a: vec2<f32>, b: vec2<f32>) -> f32 {
    let half_sum = (dot(a, a) + dot(b, b)) * 0.5;
    let difference = (dot(a, a) - dot(b, b)) * 0.5;
    let ab = dot(a, b);
    let greatest = half_sum + sqrt(difference * difference + ab * ab);
    if greatest > 0.0 {
        return abs(a.x * b.y - a.y * b.x) / sqrt(greatest);
    }
    return 0.0;
}

// Returns the index of the cell for a place perpendicular to the light and the texel size needed there; CELLS
// if there is none.
fn cell_of(place: vec2<f32>, texel: f32) -> u32 {
    let half_side = f32(SIDE / 2u);
    let cells = place / demand.cell;
    let reach = max(abs(cells.x), abs(cells.y)) / half_side;
    // Points too far away for a cell of their level count at a coarser level that contains them.
    let asked = clamp(exponent(texel) - demand.exponent, 0, LEVELS - 1);
    let level = max(asked, exponent(reach) - 126);
    if level >= LEVELS {
        return CELLS;
    }
    let at = min(vec2<u32>(cells * power_of_two(-level) + half_side), vec2<u32>(SIDE - 1u));
    return (u32(level) * SIDE + at.y) * SIDE + at.x;
}

// Returns the index of the bin for a view depth and the texel size needed there, perpendicular to the light.
fn bin_of(depth: f32, texel: f32) -> u32 {
    let bin = min(u32(log2(depth / demand.near) * demand.bins_per_octave), DEPTHS - 1u);
    // The octave is rounded to the nearest one.
    let finer = (demand.pixel_width.x + demand.pixel_width.y * depth) / texel;
    let class_index = clamp(exponent(finer * sqrt(2.0)) - 127, 0, i32(CLASSES) - 1);
    return u32(class_index) * DEPTHS + bin;
}

fn see(pixel: vec2<i32>) {
    let depth = depth_at(pixel);
    if depth == 0.0 {
        return;
    }
    let across = change(pixel, vec2<i32>(1, 0), depth);
    let along = change(pixel, vec2<i32>(0, 1), depth);
    if across == NOTHING || along == NOTHING {
        return;
    }
    let m = demand.world_from_pixel;
    let homogeneous = m * vec4<f32>(vec2<f32>(pixel), depth, 1.0);
    let position = homogeneous.xyz / homogeneous.w;
    let view_depth = dot(demand.view.xyz, position) + demand.view.w;
    // Shadows end at this view depth.
    if !(view_depth < demand.far) {
        return;
    }
    // Derivatives of the position on the surface's plane, for one pixel right and one down, and along the
    // ray.
    let scale = demand.pixels / homogeneous.w;
    let right_change = m[0] + m[2] * across;
    let down_change = m[1] + m[2] * along;
    let right = (right_change.xyz - position * right_change.w) * scale;
    let down = (down_change.xyz - position * down_change.w) * scale;
    let ray = (m[2].xyz - position * m[2].w) / homogeneous.w;

    // The sign makes the normal face the eye.
    let perpendicular = cross(right, down);
    let is_behind = dot(perpendicular, ray) * dot(ray, demand.view.xyz) > 0.0;
    let facing = select(-1.0, 1.0, is_behind) * dot(perpendicular, demand.direction);
    let length = length(perpendicular);
    if !(facing > 0.0) || !(length > 0.0) {
        return;
    }
    let a = vec2<f32>(dot(demand.x, right), dot(demand.y, right));
    let b = vec2<f32>(dot(demand.x, down), dot(demand.y, down));
    if view_depth >= demand.near {
        let stretch = vec2<f32>(1.0, demand.shape);
        count(CELLS + bin_of(view_depth, needed_texel(a * stretch, b * stretch)));
    }
    if facing >= MIN_FACING * length {
        let index = cell_of(vec2<f32>(dot(demand.x, position), dot(demand.y, position)), needed_texel(a, b));
        if index < CELLS {
            count(index);
        }
    }
}

@compute @workgroup_size(THREADS, THREADS)
fn count_demand(
    @builtin(workgroup_id) square: vec3<u32>,
    @builtin(local_invocation_id) thread: vec3<u32>,
    @builtin(local_invocation_index) slot: u32,
) {
    for (var part = 0u; part < PARTS * PARTS; part += 1u) {
        let within = vec2<u32>(part % PARTS, part / PARTS) * THREADS + thread.xy;
        let pixel = (square.xy * (THREADS * PARTS) + within) * demand.step + demand.step / 2u;
        if all(pixel < demand.size) {
            see(vec2<i32>(pixel));
        }
    }
    workgroupBarrier();
    let tally = atomicLoad(&tallies[slot]);
    if tally > 0u {
        atomicAdd(&counts[atomicLoad(&keys[slot]) - 1u], tally);
    }
}
