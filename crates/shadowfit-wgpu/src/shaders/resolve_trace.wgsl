// Third resolve pass: the rays of the pixels on the list.

@group(1) @binding(4) var<storage, read> list: List;

// Where the rays from a pixel's surface start above it, in metres: farther than its depth, or what follows from it, may
// be rounded by.
fn height_of(surface: Surface) -> f32 {
    let step = length(moved(resolve.world_from_pixel[2], surface)) * rounding(surface.depth);
    let distance = length(surface.position) + length(resolve.eye);
    return max(resolve.ray_offset, max(step, POSITION_ROUNDING * distance));
}

// How high a neighbour stands above a pixel's plane, in metres; 0 where it is another surface: farther from the plane
// than the plane itself changes.
fn height_beside(pixel: vec2<i32>, axis: vec2<i32>, surface: Surface, up: f32) -> f32 {
    let found = depth_at(pixel + axis);
    let step = dot(surface.steps, vec2<f32>(axis));
    let off = found - surface.depth - step;
    let ray = moved(resolve.world_from_pixel[2], surface);
    let across = moved(resolve.world_from_pixel[0], surface);
    let is_same = found != 0.0 && abs(off) * length(ray) <= abs(step) * length(ray) + length(across);
    return select(0.0, off * up, is_same);
}

// How high the neighbours to the right, to the left, below and above stand over a pixel's plane, in metres.
fn heights_beside(pixel: vec2<i32>, surface: Surface) -> vec4<f32> {
    if resolve.point_reach == 0.0 {
        return vec4<f32>(0.0);
    }
    let up = dot(moved(resolve.world_from_pixel[2], surface), surface.normal);
    return vec4<f32>(
        height_beside(pixel, vec2<i32>(1, 0), surface, up), height_beside(pixel, vec2<i32>(-1, 0), surface, up),
        height_beside(pixel, vec2<i32>(0, 1), surface, up), height_beside(pixel, vec2<i32>(0, -1), surface, up));
}

// A point of a pixel's surface, from its first sample, in pixels: relative to the eye, in metres.
fn point_of(pixel: vec2<i32>, surface: Surface, place: vec2<f32>) -> vec3<f32> {
    // Seen edge-on, the plane may leave the picture within the pixel.
    let most = 0.5 * abs(surface.depth);
    let depth = surface.depth + clamp(dot(surface.steps, place), -most, most);
    let from_centre = vec2<f32>(pixel) + sample_place(0u) + place;
    let homogeneous = resolve.world_from_pixel * vec4<f32>(from_centre, depth, 1.0);
    return homogeneous.xyz / homogeneous.w;
}

// Directions across the light, of unit length.
struct Across {
    x: vec3<f32>,
    y: vec3<f32>,
}

// Those of a pixel, turned about the light (T. Duff et al., "Building an orthonormal basis, revisited", 2017).
fn across_light(pixel: vec2<i32>) -> Across {
    let n = shadowfit_receiver.to_light;
    let side = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (side + n.z);
    let b = n.x * n.y * a;
    let x = vec3<f32>(1.0 + side * n.x * n.x * a, side * b, -side * n.x);
    let y = vec3<f32>(b, side + n.y * n.y * a, -n.y);
    let turn = shadowfit_turn(vec2<f32>(pixel));
    return Across(x * cos(turn) + y * sin(turn), y * cos(turn) - x * sin(turn));
}

// A factor with the bit that tells it from one that was not traced, still in 0..=1.
fn traced(factor: f32) -> f32 {
    // The least and the greatest with that bit that no device rounds: the lesser ones may be flushed to zero.
    let least = bitcast<f32>(0x00800001u);
    let greatest = bitcast<f32>(0x3f7fffffu);
    return bitcast<f32>(bitcast<u32>(clamp(factor, least, greatest)) | TRACED_BIT);
}

@compute @workgroup_size(TRACE_THREADS)
fn trace(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let index = (group.y * groups.x + group.x) * TRACE_THREADS + thread;
    if index >= list.count {
        return;
    }
    let packed = list.pixels[index];
    let pixel = vec2<i32>(i32(packed & 0xffffu), i32(packed >> 16u));
    let surface = surface_of(pixel, depth_at(pixel));
    let height = height_of(surface);
    let beside = heights_beside(pixel, surface);
    // A surface that leaves the plane on one side may do so before it: a plane through the pixel and a neighbour cuts off
    // what stands out between them, by as much for a pixel as it leaves the surface on the other side.
    let off = abs(beside);
    let rough = vec2<f32>(max(off.x, off.y), max(off.z, off.w));
    let across = across_light(pixel);
    var lit = 0.0;
    for (var at = 0u; at < resolve.point_count; at += 1u) {
        // On a bent surface a point of the plane may lie below: it is lifted toward where neighbours are.
        let place = resolve.points[at].xy;
        let bent = dot(rough, abs(place));
        let above = surface.normal * (height + bent);
        let start = point_of(pixel, surface, place) + above + resolve.eye;
        let aside = resolve.points[at].zw * resolve.sun_tangent;
        let direction = normalize(shadowfit_receiver.to_light + across.x * aside.x + across.y * aside.y);
        lit += select(1.0, 0.0, shadowfit_rays_blocked(start, direction));
    }
    let factor = mix(lit / f32(resolve.point_count), 1.0, shadowfit_faded(surface.position));
    textureStore(factors, resolve.corner + vec2<u32>(pixel), vec4<f32>(traced(factor), 0.0, 0.0, 0.0));
}
