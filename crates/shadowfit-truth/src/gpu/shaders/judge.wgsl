// Third pass: the edge zone, from the distances along the rows, and the class of each pixel.

@group(1) @binding(3) var classes: texture_storage_2d<r32uint, write>;

const RIGHT: u32 = 1u;
const FALSE_SHADOW: u32 = 2u;
const FALSE_LIGHT: u32 = 3u;
const HOLE: u32 = 4u;
const EDGE: u32 = 5u;

// Encoding of log2(pixels per texel) in the texture: steps per octave, and the step that encodes 1.
const OCTAVE: f32 = 256.0;
const ONE: f32 = 32768.0;
const MAX_STEP: f32 = 65535.0;

fn encode_octaves(value: f32) -> u32 {
    return u32(clamp(round(log2(value) * OCTAVE) + ONE, 0.0, MAX_STEP));
}

fn is_row_near(pixel: vec2<u32>, step: u32, square: f32) -> bool {
    let along = pixels[pixel_index(pixel)].along_row;
    return along != NONE && f32(along * along + step * step) <= square;
}

// Returns whether a transition lies within `width` pixels. Like the CPU, it compares the square of the
// distance in whole pixels with the square of the width less half a pixel.
fn is_near_transition(pixel: vec2<u32>, width: f32) -> bool {
    // No picture has a longer diagonal.
    let reach = min(width - 0.5, 65536.0);
    let square = reach * reach;
    for (var step = 0u; step < judge.size.y && f32(step * step) <= square; step++) {
        if step <= pixel.y && is_row_near(pixel - vec2<u32>(0u, step), step, square) {
            return true;
        }
        if pixel.y + step < judge.size.y && is_row_near(pixel + vec2<u32>(0u, step), step, square) {
            return true;
        }
    }
    return false;
}

// Returns whether no map is read, or the map that is read (its place plus 1) holds none of the point's
// occluders.
fn is_hole(pixel: vec2<u32>, map_plus_1: u32) -> bool {
    if map_plus_1 == 0u {
        return true;
    }
    let drawn = textureLoad(seen, pixel, 0);
    let surface = surface_in(pixel, drawn.x - 1u);
    let map = map_plus_1 - 1u;
    let depth = project(judge.maps[map], surface.position).depth;
    return !is_occluded(surface, Receiver(map, surface.position, depth));
}

fn class_of(pixel: vec2<u32>, flags: u32, is_in_edge_zone: bool) -> u32 {
    let is_lit = (flags & LIT) != 0u;
    let seems_lit = (flags & SEEMS_LIT) != 0u;
    if is_lit == seems_lit {
        return RIGHT;
    }
    if !is_lit && is_hole(pixel, flags >> MAP_SHIFT) {
        return HOLE;
    }
    if is_in_edge_zone {
        return EDGE;
    }
    return select(FALSE_LIGHT, FALSE_SHADOW, is_lit);
}

@compute @workgroup_size(8, 8) fn classify(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= judge.size) {
        return;
    }
    let pixel = pixels[pixel_index(id.xy)];
    var bits = 0u;
    if (pixel.flags & JUDGED) != 0u {
        let map_plus_1 = pixel.flags >> MAP_SHIFT;
        // If no map is read, the zone's width is in pixels.
        let texel_width = select(1.0, max(pixel.pixels_per_texel, 1.0), map_plus_1 != 0u);
        var edge_width = judge.edge_width;
        var index_plus_1 = 0u;
        if map_plus_1 != 0u {
            edge_width = judge.maps[map_plus_1 - 1u].edge_width;
            index_plus_1 = judge.maps[map_plus_1 - 1u].index + 1u;
        }
        let is_in_edge_zone = is_near_transition(id.xy, edge_width * min(texel_width, 1e9));
        bits = class_of(id.xy, pixel.flags, is_in_edge_zone)
            | select(0u, 8u, (pixel.flags & LIT) != 0u)
            | select(0u, 16u, is_in_edge_zone)
            | (index_plus_1 << 8u)
            | (select(u32(MAX_STEP), encode_octaves(pixel.pixels_per_texel), map_plus_1 != 0u) << 16u);
    }
    textureStore(classes, id.xy, vec4<u32>(bits, 0u, 0u, 0u));
}
