// Optional pass after the first two, if a frame has a budget: keeps the pixels whose noise lies below the
// allowed share. The noise is blue, so that pixels are removed evenly. It moves from frame to frame by the
// golden ratio, so that each pixel is traced in turn (void and cluster: R. Ulichney, "The void-and-cluster
// method for dither array generation", 1993).

@group(0) @binding(0) var<storage, read> all: List;
@group(0) @binding(1) var<storage, read_write> kept: KeptList;
// Ranks of a square of NOISE_SIDE by NOISE_SIDE pixels: each number once.
@group(0) @binding(2) var<storage, read> ranks: array<u32>;
@group(0) @binding(3) var<uniform> budget: Budget;

struct KeptList {
    count: atomic<u32>,
    facing: u32,
    filtered: u32,
    unsure: u32,
    pixels: array<Listed>,
}

struct Budget {
    // Number of pixels to trace per frame.
    pixels: u32,
    frame: u32,
    padding_0: u32,
    padding_1: u32,
}

// Returns the noise of a pixel. The ranks have only thousands of steps, so a hash of the square's position
// adds finer ones.
fn noise(pixel: vec2<u32>) -> f32 {
    let at = pixel % NOISE_SIDE;
    let rank = f32(ranks[at.y * NOISE_SIDE + at.x]);
    let square = pixel / NOISE_SIDE;
    let within = f32((square.x * 0x9E3779B9u + square.y * 0x85EBCA6Bu) >> 8u) / 16777216.0;
    let still = (rank + within) / f32(NOISE_SIDE * NOISE_SIDE);
    return fract(still + f32(budget.frame % 1024u) * 0.618033989);
}

@compute @workgroup_size(TRACE_THREADS)
fn select_pixels(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let index = (group.y * groups.x + group.x) * TRACE_THREADS + thread;
    if index == 0u {
        kept.facing = all.facing;
        kept.filtered = all.filtered;
        kept.unsure = all.count;
    }
    if index >= all.count {
        return;
    }
    let packed = all.pixels[index].pixel;
    if noise(vec2<u32>(packed & 0xffffu, packed >> 16u)) * f32(all.count) < f32(budget.pixels) {
        kept.pixels[atomicAdd(&kept.count, 1u)].pixel = packed;
    }
}
