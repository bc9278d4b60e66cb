// Second pass: distance of each pixel to the nearest transition in its row. A workgroup handles one row, and
// each of its invocations one part of the row.

const LANES: u32 = 64u;
var<workgroup> first_of: array<u32, LANES>;
var<workgroup> last_of: array<u32, LANES>;

fn differs(here: u32, pixel: vec2<u32>) -> bool {
    let there = pixels[pixel_index(pixel)].flags;
    return (there & JUDGED) != 0u && ((here ^ there) & LIT) != 0u;
}

// Returns whether the verdict of one of the four neighbours differs.
fn is_transition(pixel: vec2<u32>) -> bool {
    let here = pixels[pixel_index(pixel)].flags;
    if (here & JUDGED) == 0u {
        return false;
    }
    return (pixel.x > 0u && differs(here, pixel - vec2<u32>(1u, 0u)))
        || (pixel.x + 1u < judge.size.x && differs(here, pixel + vec2<u32>(1u, 0u)))
        || (pixel.y > 0u && differs(here, pixel - vec2<u32>(0u, 1u)))
        || (pixel.y + 1u < judge.size.y && differs(here, pixel + vec2<u32>(0u, 1u)));
}

@compute @workgroup_size(64) fn rows(
    @builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32,
) {
    let y = group.x;
    let part = (judge.size.x + LANES - 1u) / LANES;
    let begin = min(lane * part, judge.size.x);
    let end = min(begin + part, judge.size.x);
    var first = NONE;
    var last = NONE;
    for (var x = begin; x < end; x++) {
        if is_transition(vec2<u32>(x, y)) {
            first = select(first, x, first == NONE);
            last = x;
        }
    }
    first_of[lane] = first;
    last_of[lane] = last;
    workgroupBarrier();
    // The nearest transitions before and after this part.
    var before = NONE;
    for (var other = 0u; other < lane; other++) {
        before = select(before, last_of[other], last_of[other] != NONE);
    }
    var behind = NONE;
    for (var other = LANES - 1u; other > lane; other--) {
        behind = select(behind, first_of[other], first_of[other] != NONE);
    }
    for (var x = begin; x < end; x++) {
        before = select(before, x, is_transition(vec2<u32>(x, y)));
        pixels[pixel_index(vec2<u32>(x, y))].along_row = select(x - before, NONE, before == NONE);
    }
    for (var x = end; x > begin; x--) {
        let index = pixel_index(vec2<u32>(x - 1u, y));
        behind = select(behind, x - 1u, pixels[index].along_row == 0u);
        let distance = select(behind - (x - 1u), NONE, behind == NONE);
        pixels[index].along_row = min(pixels[index].along_row, distance);
    }
}
