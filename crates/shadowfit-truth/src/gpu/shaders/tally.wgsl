// Fourth pass: the sums of the judged picture. Each workgroup sums a square of pixels in workgroup memory,
// and then adds its sums to the picture's. Rust inserts the constants BINS and ERROR_ONE.

struct Tally {
    // By class.
    all: array<atomic<u32>, 6>,
    grazing: array<atomic<u32>, 6>,
    lit: atomic<u32>,
    edge_zone: atomic<u32>,
    uncovered: atomic<u32>,
    undersampled: atomic<u32>,
    crawl_compared: atomic<u32>,
    crawl_different: atomic<u32>,
    // In steps of 1 / ERROR_ONE, two words.
    error_low: atomic<u32>,
    error_high: atomic<u32>,
    // Cosines toward the light, in the same steps.
    light_low: atomic<u32>,
    light_high: atomic<u32>,
    // Errors times these cosines, in the same steps.
    light_error_low: atomic<u32>,
    light_error_high: atomic<u32>,
    // By pixels per texel.
    bins: array<atomic<u32>, BINS>,
}

@group(1) @binding(3) var classes: texture_2d<u32>;
@group(1) @binding(4) var<storage, read_write> tally: Tally;
// Like `seen`, drawn with the maps of the previous frame.
@group(1) @binding(5) var seen_before: texture_2d<u32>;

var<workgroup> sums: Tally;

const SIDE: u32 = 16u;
const LANES: u32 = 256u;
const CLASSES: u32 = 6u;
// In the texture of classes: the step that encodes 1 pixel per texel, and the steps per bin, with 32 bins per
// octave.
const ONE: u32 = 32768u;
const BIN_STEPS: u32 = 8u;

// Returns the bin of a pixel's bits in the texture of classes. The first and the last bin hold all values
// beyond them.
fn bin_of(bits: u32) -> u32 {
    let first = ONE - BINS / 2u * BIN_STEPS;
    return min((max(bits >> 16u, first) - first) / BIN_STEPS, BINS - 1u);
}

// Returns a factor from its bits, clamped to 0..=1. NaN becomes 0.
fn factor_of(bits: u32) -> f32 {
    let is_number = (bits & 0x7fffffffu) <= 0x7f800000u;
    return clamp(bitcast<f32>(select(0u, bits, is_number)), 0.0, 1.0);
}

fn steps(value: f32) -> u32 {
    return u32(round(value * f32(ERROR_ONE)));
}

fn add_error(pixel: vec2<u32>, flags: u32, facing: f32) {
    let lit = select(0.0, 1.0, (flags & LIT) != 0u);
    let error = abs(factor_of(textureLoad(seen, pixel, 0).y) - lit);
    let cosine = min(facing, 1.0);
    atomicAdd(&sums.light_low, steps(cosine));
    if error > 0.0 {
        atomicAdd(&sums.error_low, steps(error));
        atomicAdd(&sums.light_error_low, steps(error * cosine));
    }
}

fn add_crawl(pixel: vec2<u32>, flags: u32) {
    atomicAdd(&sums.crawl_compared, 1u);
    let seemed_lit = factor_of(textureLoad(seen_before, pixel, 0).y) >= 0.5;
    if seemed_lit != ((flags & SEEMS_LIT) != 0u) {
        atomicAdd(&sums.crawl_different, 1u);
    }
}

fn add_texels(pixels_per_texel: f32, bits: u32) {
    atomicAdd(&sums.bins[bin_of(bits)], 1u);
    if pixels_per_texel > 1.0 {
        atomicAdd(&sums.undersampled, 1u);
    }
}

fn add(pixel: vec2<u32>) {
    let judged = pixels[pixel_index(pixel)];
    let flags = judged.flags;
    if (flags & JUDGED) == 0u {
        return;
    }
    let bits = textureLoad(classes, pixel, 0).x;
    let is_covered = (flags >> MAP_SHIFT) != 0u;
    let is_in_edge_zone = (bits & 16u) != 0u;
    atomicAdd(&sums.all[bits & 7u], 1u);
    if (flags & LIT) != 0u {
        atomicAdd(&sums.lit, 1u);
    }
    if is_in_edge_zone {
        atomicAdd(&sums.edge_zone, 1u);
    }
    if !is_covered {
        atomicAdd(&sums.uncovered, 1u);
    }
    if (flags & GRAZING) != 0u {
        atomicAdd(&sums.grazing[bits & 7u], 1u);
    } else if is_covered {
        add_texels(judged.pixels_per_texel, bits);
    }
    if is_in_edge_zone && is_covered && (flags & COVERED_BEFORE) != 0u {
        add_crawl(pixel, flags);
    }
    add_error(pixel, flags, judged.facing);
}

// Adds the workgroup's sums to the picture's.
fn add_sums(lane: u32) {
    for (var bin = lane; bin < BINS; bin += LANES) {
        let count = atomicLoad(&sums.bins[bin]);
        if count > 0u {
            atomicAdd(&tally.bins[bin], count);
        }
    }
    if lane < CLASSES {
        atomicAdd(&tally.all[lane], atomicLoad(&sums.all[lane]));
        atomicAdd(&tally.grazing[lane], atomicLoad(&sums.grazing[lane]));
    }
    if lane == 0u {
        atomicAdd(&tally.lit, atomicLoad(&sums.lit));
        atomicAdd(&tally.edge_zone, atomicLoad(&sums.edge_zone));
        atomicAdd(&tally.uncovered, atomicLoad(&sums.uncovered));
        atomicAdd(&tally.undersampled, atomicLoad(&sums.undersampled));
        atomicAdd(&tally.crawl_compared, atomicLoad(&sums.crawl_compared));
        atomicAdd(&tally.crawl_different, atomicLoad(&sums.crawl_different));
        // Each time a low word wraps, exactly one workgroup sees it and carries.
        let error = atomicLoad(&sums.error_low);
        let error_before = atomicAdd(&tally.error_low, error);
        if error_before + error < error_before {
            atomicAdd(&tally.error_high, 1u);
        }
        let light = atomicLoad(&sums.light_low);
        let light_before = atomicAdd(&tally.light_low, light);
        if light_before + light < light_before {
            atomicAdd(&tally.light_high, 1u);
        }
        let light_error = atomicLoad(&sums.light_error_low);
        let light_error_before = atomicAdd(&tally.light_error_low, light_error);
        if light_error_before + light_error < light_error_before {
            atomicAdd(&tally.light_error_high, 1u);
        }
    }
}

@compute @workgroup_size(16, 16) fn sum(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    for (var quarter = 0u; quarter < 4u; quarter++) {
        let square = group.xy * 2u + vec2<u32>(quarter & 1u, quarter >> 1u);
        let pixel = square * SIDE + local.xy;
        if all(pixel < judge.size) {
            add(pixel);
        }
    }
    workgroupBarrier();
    add_sums(lane);
}
