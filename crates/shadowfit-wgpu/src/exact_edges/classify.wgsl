// First edge pass: finds the pixels that the maps decide, and lists the others for rays. FOOTPRINT is the
// number of texels on each side of a point that must agree, and COARSEST_FOOTPRINT the number in the last
// map.

@group(1) @binding(4) var<storage, read_write> list: List;
@group(1) @binding(5) var texels: sampler;

// Factor in the texture where the filter decides.
const FILTER_DECIDES: f32 = -1.0;
// Greatest footprint that is read in a map, in blocks of 2x2 texels along a side.
const MOST_BLOCKS: f32 = 6.0;

var<workgroup> unsure_count: atomic<u32>;
var<workgroup> facing_count: atomic<u32>;
var<workgroup> filtered_count: atomic<u32>;
var<workgroup> first_slot: u32;

// Part of a texel that bounds the difference between a surface's depth and its plane's depth: the difference
// is at most the plane's depth change over this part. The rasteriser rounds corners to 1/256, and normals
// have ten bits or more.
const ROUNDED_TEXEL: f32 = 0.02;

// Returns how many of the four texels around a corner are not nearer to the light than the point's plane, and
// how many of them shadow it by the technique's bias. rounding: error bound of the plane's depth, toward the
// light. rise: error bound of the point's depth, since the point may lie deeper than its surface.
fn compared(corner: vec2<f32>, projected: shadowfit_Projected, rounding: f32, rise: f32) -> vec2<f32> {
    let stored = stored_around(corner, projected);
    let offset = corner - projected.texel;
    let biased = saturate(projected.depth + rise + dot(projected.gradient, offset));
    let x = projected.gradient.x * 0.5;
    let y = projected.gradient.y * 0.5;
    let around = vec4<f32>(y - x, y + x, x - y, -x - y);
    let plane = saturate(projected.surface + rounding + dot(projected.gradient, offset) + around);
    let is_lit = vec4<bool>(plane COMPARE stored);
    let is_shadowed = !(vec4<f32>(biased) COMPARE stored);
    let counts = select(vec4<f32>(0.0), vec4<f32>(1.0), is_shadowed);
    return vec2<f32>(dot(select(vec4<f32>(0.0), vec4<f32>(1.0), is_lit), vec4<f32>(1.0)), dot(counts, vec4<f32>(1.0)));
}

// Returns the verdict of the texels that the filter reads around the points of a pixel: LIT, SHADOWED, UNSURE
// or TOO_WIDE. spread: greatest distance of the points from the projected one, in texels.
fn footprint(map: shadowfit_Map, projected: shadowfit_Projected, spread: vec2<f32>, rise: f32) -> u32 {
    let first = floor(projected.texel - spread - 0.5) - (FOOTPRINT - 1.0);
    let last = floor(projected.texel + spread - 0.5) + FOOTPRINT;
    let blocks = ceil((last - first + 1.0) * 0.5);
    let is_whole = all(first >= vec2<f32>(0.0)) && all(first + 2.0 * blocks <= projected.size);
    if !(is_whole && all(blocks <= vec2<f32>(MOST_BLOCKS))) {
        return TOO_WIDE;
    }
    let steepness = abs(projected.gradient.x) + abs(projected.gradient.y);
    let rounding = map.constant_depth + TOWARD_LIGHT * ROUNDED_TEXEL * steepness;
    var counts = vec2<f32>(0.0);
    for (var y = 0.0; y < blocks.y; y += 1.0) {
        for (var x = 0.0; x < blocks.x; x += 1.0) {
            counts += compared(first + 1.0 + 2.0 * vec2<f32>(x, y), projected, rounding, rise);
        }
    }
    let read = 4.0 * blocks.x * blocks.y;
    return select(select(UNSURE, LIT, counts.x == read), SHADOWED, counts.y == read);
}

// Returns the greatest distance between the starts of a pixel's rays and its first sample in a map, in
// texels. The starts are different points of the pixel, and lie above the surface. The distance is larger in
// the coarsest map, where most casters thinner than a texel are read.
fn spread_in(entry: i32, map: shadowfit_Map, surface: Surface) -> vec2<f32> {
    let texels = texels_per_pixel(map, surface);
    let above = (map.uv_from_world * vec4<f32>(surface.normal * height_at(surface.position), 0.0)).xy * map.size;
    let along = (map.uv_from_world * vec4<f32>(surface.off, 0.0)).xy * map.size;
    let is_coarsest = entry + 1 == i32(shadowfit_receiver.map_count);
    let beside = select(0.0, COARSEST_FOOTPRINT - FOOTPRINT, is_coarsest);
    return edges.point_reach * (abs(texels[0]) + abs(texels[1])) + abs(above) + abs(along) + beside;
}

// Returns how much nearer to the light a point's plane may be in depth, because the surface may be nearer to
// the eye.
fn rise_in_map(map: shadowfit_Map, surface: Surface) -> f32 {
    let m = map.uv_from_world;
    let to_light = shadowfit_receiver.to_light;
    let depth = dot(vec3<f32>(m[0].z, m[1].z, m[2].z), to_light);
    let cosine = max(dot(surface.normal, to_light), SHADOWFIT_MIN_COSINE);
    return depth * abs(dot(surface.off, surface.normal)) / cosine;
}

// Returns whether a ray toward the light intersects a box.
fn meets(unknown: Unknown, position: vec3<f32>) -> bool {
    let to_light = shadowfit_receiver.to_light;
    // Avoids a division by zero for a direction along an axis.
    let inverse = 1.0 / select(vec3<f32>(1e-30), to_light, abs(to_light) > vec3<f32>(1e-30));
    let a = (unknown.least - position) * inverse;
    let b = (unknown.most - position) * inverse;
    let near = min(a, b);
    let far = max(a, b);
    return min(min(far.x, far.y), far.z) >= max(max(max(near.x, near.y), near.z), 0.0);
}

// Returns the bits of the maps that are unreliable at a point. If the filter decides, the highest bit is set.
fn unsure_maps(position: vec3<f32>) -> u32 {
    var maps = edges.unsure_maps;
    // The loop ends at the first empty box, not at a box count in the uniform: software rasterisers compile a
    // shader for each dispatch if a uniform alone ends a loop.
    for (var box = 0u; box < MAX_UNKNOWNu; box += 1u) {
        let under = edges.unknown[box].maps | (edges.unknown[box].is_filtered << 31u);
        if under == 0u {
            break;
        }
        if meets(edges.unknown[box], position) {
            maps |= under;
        }
    }
    return maps;
}

// Returns the verdict of a map in x: LIT, SHADOWED, UNSURE or TOO_WIDE. y is the same verdict, unless the
// cone of a sun with a radius is too wide. Then y is the verdict of the texels directly around the pixel.
// entry: index of the map in the order.
fn verdict_of_map(entry: i32, surface: Surface, unsure: u32) -> vec2<u32> {
    let map = shadowfit_entry(entry);
    if (unsure & (1u << map.layer)) != 0u {
        return vec2<u32>(UNSURE);
    }
    let projected = shadowfit_project(map, surface.position, surface.normal);
    let spread = spread_in(entry, map, surface);
    let rise = rise_in_map(map, surface);
    var verdict = TOO_WIDE;
    if IS_SOFT {
        verdict = soft_footprint(map, projected, spread, rise);
        if verdict != TOO_WIDE {
            return vec2<u32>(verdict);
        }
    }
    let near = footprint(map, projected, spread, rise);
    return vec2<u32>(select(near, verdict, IS_SOFT), near);
}

// Returns the verdict of all maps: LIT, SHADOWED or UNSURE. It comes from the finest map whose footprint is
// inside it and not too wide. With selection by view depth, only the first map decides, because other maps
// may lack the point's casters. If the cone of a sun with a radius is too wide for finer maps, the finest map
// must agree: close to the pixel it contains casters and gaps that are narrower than a coarse texel.
fn verdict_of_maps(surface: Surface, unsure: u32) -> u32 {
    let selection = shadowfit_select(surface.position);
    if selection.first < 0 || selection.first == selection.clamped {
        return UNSURE;
    }
    let finest = verdict_of_map(selection.first, surface, unsure);
    var verdict = finest.x;
    for (var entry = selection.first + 1; IS_BY_COVERAGE && verdict == TOO_WIDE; entry += 1) {
        if entry >= i32(shadowfit_receiver.map_count) {
            break;
        }
        if shadowfit_free(u32(entry), shadowfit_entry(entry), surface.position) >= 0.0 {
            verdict = verdict_of_map(entry, surface, unsure).x;
        }
    }
    let is_contrary = IS_SOFT && finest.y != TOO_WIDE && finest.y != verdict;
    return select(verdict, UNSURE, verdict == TOO_WIDE || is_contrary);
}

// A pixel's verdict, and its factor in the texture.
struct Classified {
    verdict: u32,
    factor: f32,
}

fn classified(pixel: vec2<i32>) -> Classified {
    let depth = depth_at(pixel);
    if depth == 0.0 {
        return Classified(NO_SURFACE, FILTER_DECIDES);
    }
    let surface = surface_of(pixel, depth);
    let faded = shadowfit_faded(surface.position);
    if faded >= 1.0 {
        return Classified(BEYOND, 1.0);
    }
    let facing = dot(surface.normal, shadowfit_receiver.to_light);
    if surface.is_known && surface.is_single && facing <= -surface.tilt {
        return Classified(FACES_AWAY, 0.0);
    }
    let unsure = unsure_maps(surface.position);
    if !surface.is_single || (unsure >> 31u) != 0u {
        return Classified(FILTERED, FILTER_DECIDES);
    }
    if !surface.is_known || facing < surface.tilt {
        return Classified(UNSURE, FILTER_DECIDES);
    }
    let verdict = verdict_of_maps(surface, unsure);
    let factor = mix(select(0.0, 1.0, verdict == LIT), 1.0, faded);
    return Classified(verdict, select(factor, FILTER_DECIDES, verdict == UNSURE));
}

// Adds the counts of a workgroup to the list's counts, and reserves places on the list. Additions of 0 are
// skipped, because all workgroups add to the same words one after the other.
fn add_counts() {
    let unsure = atomicLoad(&unsure_count);
    if unsure != 0u {
        first_slot = atomicAdd(&list.count, unsure);
    }
    let facing = atomicLoad(&facing_count);
    if facing != 0u {
        atomicAdd(&list.facing, facing);
    }
    let filtered = atomicLoad(&filtered_count);
    if filtered != 0u {
        atomicAdd(&list.filtered, filtered);
    }
}

@compute @workgroup_size(8, 8)
fn classify(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_index) thread: u32) {
    var verdict = NO_SURFACE;
    if all(id.xy < edges.size) {
        let found = classified(vec2<i32>(id.xy));
        verdict = found.verdict;
        let untraced = bitcast<f32>(bitcast<u32>(found.factor) & ~TRACED_BIT);
        textureStore(factors, edges.corner + id.xy, vec4<f32>(untraced, 0.0, 0.0, 0.0));
    }
    // Reserve the places of neighbouring pixels together.
    var slot = 0u;
    if verdict == UNSURE {
        slot = atomicAdd(&unsure_count, 1u);
    }
    if verdict <= FILTERED {
        atomicAdd(&facing_count, 1u);
    }
    if verdict == FILTERED {
        atomicAdd(&filtered_count, 1u);
    }
    workgroupBarrier();
    if thread == 0u {
        add_counts();
    }
    workgroupBarrier();
    if verdict == UNSURE {
        list.pixels[first_slot + slot].pixel = id.x | (id.y << 16u);
    }
}
