// Third resolve pass: the rays of the pixels on the list.

@group(1) @binding(4) var<storage, read> list: List;

// The least that Vulkan and Direct3D allow: 16 steps in a pixel.
const MOST_SNAP: f32 = 0.03125;
// Share of the way to another point of a pixel by which its depth may differ from that of the pixel's plane.
const BEND: f32 = 0.5;

// A point of a pixel's surface.
struct Start {
    // Relative to the eye, in metres.
    position: vec3<f32>,
    // Unit geometric normal on the side of the eye.
    normal: vec3<f32>,
    // Distance above the surface at which rays start, in metres.
    height: f32,
    // Where it lies in the pixel, from its first sample, in pixels.
    place: vec2<f32>,
    // The triangle: its place among those of the rays, and its instance; SHADOWFIT_RAYS_NONE where none was found.
    slot: u32,
    instance: u32,
}

fn is_exact(start: Start) -> bool {
    return start.slot != SHADOWFIT_RAYS_NONE;
}

// Relative to the eye, in metres. at: in pixels. depth: minus the far plane's.
fn position_at(at: vec2<f32>, depth: f32) -> vec3<f32> {
    let homogeneous = resolve.world_from_pixel * vec4<f32>(at, depth, 1.0);
    return homogeneous.xyz / homogeneous.w;
}

// A part of a line of sight on which the surface lies.
struct Sight {
    // By the depth buffer, relative to the eye, in metres.
    middle: vec3<f32>,
    // Unit direction away from the eye.
    direction: vec3<f32>,
    // How far the surface may lie before and behind the middle, in metres.
    reach: f32,
}

// Of a place in a pixel. Depths are rounded, and belong to triangles whose corners were moved.
fn sight_at(pixel: vec2<i32>, surface: Surface, place: vec2<f32>) -> Sight {
    // Beyond half the depth there is the far plane.
    let farthest = 0.5 * abs(surface.depth);
    let depth = surface.depth + clamp(dot(surface.steps, place), -farthest, farthest);
    let steps = surface.most_steps;
    let off = ROUNDINGS * rounding(depth) + MOST_SNAP * (steps.x + steps.y) + BEND * dot(steps, abs(place));
    let least = min(off, 0.5 * abs(depth));
    let at = vec2<f32>(pixel) + sample_place(0u) + place;
    let middle = position_at(at, depth);
    let one = position_at(at, depth - least);
    let other = position_at(at, depth + least);
    let is_near = dot(other - one, resolve.forward) > 0.0;
    let before = select(other, one, is_near);
    let reach = length(middle - before) + POSITION_ROUNDING * (length(middle) + length(resolve.eye));
    return Sight(middle, normalize(select(one - other, other - one, is_near)), reach);
}

// Where a line of sight begins, relative to the origin of the rays.
fn begin_of(sight: Sight) -> vec3<f32> {
    return sight.middle - sight.direction * sight.reach + resolve.eye;
}

fn start_on(sight: Sight, met: shadowfit_RaySurface, place: vec2<f32>) -> Start {
    let position = sight.middle + sight.direction * (met.distance - sight.reach);
    return Start(position, met.normal, height_at(position), place, met.slot, met.instance);
}

// The point that the eye sees at a place in a pixel. By the depth buffer, at the first sample, where there is no triangle.
fn start_at(pixel: vec2<i32>, surface: Surface, place: vec2<f32>) -> Start {
    let sight = sight_at(pixel, surface, place);
    let met = shadowfit_rays_surface(begin_of(sight), sight.direction, 2.0 * sight.reach);
    if met.slot != SHADOWFIT_RAYS_NONE {
        return start_on(sight, met, place);
    }
    let height = max(height_at(surface.position), abs(dot(surface.off, surface.normal)));
    return Start(surface.position, surface.normal, height, vec2<f32>(0.0), met.slot, met.instance);
}

// The same of another point of the pixel: mostly it lies on the same triangle, and where there is none it is the same point.
fn start_beside(pixel: vec2<i32>, surface: Surface, place: vec2<f32>, first: Start) -> Start {
    let sight = sight_at(pixel, surface, place);
    let begin = begin_of(sight);
    var met = shadowfit_rays_no_surface();
    if is_exact(first) {
        met = shadowfit_rays_same_surface(begin, sight.direction, 2.0 * sight.reach, first.slot, first.instance);
    }
    if met.slot == SHADOWFIT_RAYS_NONE {
        met = shadowfit_rays_surface(begin, sight.direction, 2.0 * sight.reach);
    }
    if met.slot == SHADOWFIT_RAYS_NONE {
        return first;
    }
    return start_on(sight, met, place);
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

// A pixel of the list.
struct Unsure {
    pixel: vec2<i32>,
    surface: Surface,
    across: Across,
}

fn unsure_at(index: u32) -> Unsure {
    let packed = list.pixels[index];
    let pixel = vec2<i32>(i32(packed & 0xffffu), i32(packed >> 16u));
    let surface = surface_of(pixel, depth_at(pixel));
    return Unsure(pixel, surface, across_light(pixel));
}

// Whether the light reaches a point of a pixel: 1 or 0.
fn lit_at(unsure: Unsure, start: Start, in_sun: vec2<f32>) -> f32 {
    if is_exact(start) && dot(start.normal, shadowfit_receiver.to_light) <= 0.0 {
        return 0.0;
    }
    let point = start.position + start.normal * start.height + resolve.eye;
    let aside = in_sun * resolve.sun_tangent;
    let beside = unsure.across.x * aside.x + unsure.across.y * aside.y;
    let ray = normalize(shadowfit_receiver.to_light + beside);
    // Points of large triangles may lie deeper than their rays start above them.
    let beneath = max(resolve.vertex_rounding - start.height, 0.0);
    let reach = beneath / max(dot(start.normal, ray), SHADOWFIT_MIN_COSINE);
    return select(1.0, 0.0, shadowfit_rays_blocked_above(point, ray, start.normal, reach));
}

// What the threads of a workgroup find: of each pixel the start of its first ray and what the map has in the way, then of each
// ray whether light reaches its point, what the map says of it, its part of what the map says of the whole pixel, and whether
// the point lies off the plane.
var<workgroup> starts: array<Start, PIXELS>;
var<workgroup> casters: array<vec2<f32>, PIXELS>;
var<workgroup> found: array<vec4<f32>, TRACE_THREADS>;

// Whether the map cannot be looked up where a ray starts: another point stands for it, or it lies off the pixel's plane.
fn is_off(surface: Surface, start: Start, place: vec2<f32>) -> bool {
    let above = abs(dot(start.position - surface.position, surface.normal));
    let is_other = any(start.place != place);
    return is_other || (any(place != vec2<f32>(0.0)) && above > 0.5 * start.height + abs(dot(surface.off, surface.normal)));
}

fn found_by(unsure: Unsure, at: u32, of_group: u32) -> vec4<f32> {
    let ray = resolve.points[at];
    var start = starts[of_group];
    if at != 0u {
        start = start_beside(unsure.pixel, unsure.surface, ray.xy, start);
    }
    let map = estimate_of(unsure, casters[of_group]);
    var part = 0.0;
    for (var look_up = at; map.is_known && look_up < LOOK_UPS; look_up += POINTS) {
        part += estimate_part(map, look_up);
    }
    let expected = estimate_at(map, start.place, ray.zw);
    return vec4<f32>(lit_at(unsure, start, ray.zw), expected, part, select(0.0, 1.0, is_off(unsure.surface, start, ray.xy)));
}

// A thread for each ray: those of a pixel are neighbours.
@compute @workgroup_size(TRACE_THREADS)
fn trace(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let of_group = thread / POINTS;
    let at = thread % POINTS;
    let index = (group.y * groups.x + group.x) * PIXELS + of_group;
    let is_ray = of_group < PIXELS && index < list.count;
    var unsure: Unsure;
    if is_ray {
        unsure = unsure_at(index);
        if at == 0u {
            starts[of_group] = start_at(unsure.pixel, unsure.surface, resolve.points[0].xy);
            casters[of_group] = casters_of(unsure);
        }
    }
    workgroupBarrier();
    if is_ray {
        found[thread] = found_by(unsure, at, of_group);
    }
    workgroupBarrier();
    if is_ray && at == 0u {
        var sum = vec4<f32>(0.0);
        for (var ray = 0u; ray < POINTS; ray += 1u) {
            sum += found[thread + ray];
        }
        // Rays say what the map is wrong by where they are: by as much it is taken to be wrong as a whole.
        let by_map = sum.z / f32(LOOK_UPS) + (sum.x - sum.y) / f32(POINTS);
        let share = saturate(select(by_map, sum.x / f32(POINTS), sum.w > 0.0));
        let factor = traced(mix(share, 1.0, shadowfit_faded(unsure.surface.position)));
        textureStore(factors, resolve.corner + vec2<u32>(unsure.pixel), vec4<f32>(factor, 0.0, 0.0, 0.0));
    }
}
