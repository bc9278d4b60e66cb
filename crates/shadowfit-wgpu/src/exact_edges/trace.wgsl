// Fourth edge pass: the rays of the pixels on the list.

@group(1) @binding(4) var<storage, read> list: List;

// The triangle of a pixel at its first sample.
struct Triangle {
    // Its place among those of the rays; SHADOWFIT_RAYS_NONE where none was found.
    slot: u32,
    instance: u32,
}

// Whether a pixel lies so near to the plane of another one that rays which start on the plane between them start above the
// surface: by half of their height, since points may lie aside along both axes. step: from the other one.
fn is_on_plane(pixel: vec2<i32>, step: vec2<i32>, surface: Surface) -> bool {
    let found = depth_at(pixel + step);
    let off = found - surface.depth - dot(surface.steps, vec2<f32>(step));
    let beneath = abs(off * dot(moved(edges.world_from_pixel[2], surface), surface.normal)) * edges.point_reach;
    return found != 0.0 && beneath <= 0.5 * height_at(surface.position);
}

// Whether a surface goes on to a neighbour of its pixel as the pixel's plane does. Two pixels are on any plane that follows
// from them, however the surface bends between them: it takes a third one in line.
fn goes_on(pixel: vec2<i32>, axis: vec2<i32>, surface: Surface) -> bool {
    return is_on_plane(pixel, axis, surface)
        && (is_on_plane(pixel, -axis, surface) || is_on_plane(pixel, 2 * axis, surface));
}

// Whether the surface goes on to a place in its pixel, from the first sample, in pixels, as the triangle's plane does. beside: how
// far that plane leaves the pixel's there, in metres.
fn reaches(pixel: vec2<i32>, surface: Surface, place: vec2<f32>, beside: f32) -> bool {
    if beside > 0.5 * height_at(surface.position) {
        return false;
    }
    let across = select(vec2<i32>(-1, 0), vec2<i32>(1, 0), place.x > 0.0);
    let down = select(vec2<i32>(0, -1), vec2<i32>(0, 1), place.y > 0.0);
    return (place.x == 0.0 || goes_on(pixel, across, surface)) && (place.y == 0.0 || goes_on(pixel, down, surface));
}

// By the depth buffer, at the first sample.
fn start_by_depth(surface: Surface) -> Start {
    let height = max(height_at(surface.position), abs(dot(surface.off, surface.normal)));
    return Start(surface.position, surface.normal, height, vec2<f32>(0.0), false);
}

// Where rays from a triangle at the pixel's first sample start. Beside the triangle its plane may lie beneath the neighbour.
fn start_on(met: shadowfit_rays_Met, position: vec3<f32>, surface: Surface) -> Start {
    let least = height_at(position);
    let height = select(max(least, beside_of(surface)), least, met.is_inside);
    return Start(position, met.normal, height, vec2<f32>(0.0), true);
}

// The point that the eye sees at a place in a pixel: on the triangle of the first sample, or on its plane where the surface goes
// on as a plane, and else the first sample's.
fn start_at(pixel: vec2<i32>, surface: Surface, triangle: Triangle, place: vec2<f32>) -> Start {
    if triangle.slot == SHADOWFIT_RAYS_NONE {
        return start_by_depth(surface);
    }
    let sight = sight_at(pixel, surface, place);
    let met = shadowfit_rays_plane(begin_of(sight), sight.direction, triangle.slot, triangle.instance);
    let is_near = met.distance >= 0.0 && met.distance <= 2.0 * sight.reach;
    let is_first = all(place == vec2<f32>(0.0));
    let beside = abs((met.distance - sight.reach) * dot(met.normal, sight.direction));
    if is_near && (is_first || met.is_inside || reaches(pixel, surface, place, beside)) {
        let position = sight.middle + sight.direction * (met.distance - sight.reach);
        if is_first {
            return start_on(met, position, surface);
        }
        return Start(position, met.normal, height_at(position), place, true);
    }
    if is_first {
        return start_by_depth(surface);
    }
    return start_at_first(pixel, surface, triangle);
}

fn start_at_first(pixel: vec2<i32>, surface: Surface, triangle: Triangle) -> Start {
    let sight = sight_at(pixel, surface, vec2<f32>(0.0));
    let met = shadowfit_rays_plane(begin_of(sight), sight.direction, triangle.slot, triangle.instance);
    let along = clamp(met.distance, 0.0, 2.0 * sight.reach) - sight.reach;
    return start_on(met, sight.middle + sight.direction * along, surface);
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
    triangle: Triangle,
    across: Across,
}

fn unsure_at(index: u32) -> Unsure {
    let listed = list.pixels[index];
    let pixel = pixel_of(listed);
    let surface = surface_of(pixel, depth_at(pixel));
    return Unsure(pixel, surface, Triangle(listed.slot, listed.instance), across_light(pixel));
}

// Whether the light reaches a point of a pixel: 1 or 0.
fn lit_at(unsure: Unsure, start: Start, in_sun: vec2<f32>) -> f32 {
    if start.is_exact && dot(start.normal, shadowfit_receiver.to_light) <= 0.0 {
        return 0.0;
    }
    let point = start.position + start.normal * start.height + edges.eye;
    let aside = in_sun * edges.sun_tangent;
    let beside = unsure.across.x * aside.x + unsure.across.y * aside.y;
    let ray = normalize(shadowfit_receiver.to_light + beside);
    // Points of large triangles may lie deeper than their rays start above them.
    let beneath = max(edges.vertex_rounding - start.height, 0.0);
    let reach = beneath / max(dot(start.normal, ray), SHADOWFIT_MIN_COSINE);
    return select(1.0, 0.0, shadowfit_rays_blocked_above(point, ray, start.normal, reach));
}

// What the threads of a workgroup find: of each pixel what the map has in the way, then of each ray whether light reaches its
// point, what the map says of it, its part of what the map says of the whole pixel, and whether the point lies off the plane.
var<workgroup> casters: array<vec2<f32>, PIXELS>;
var<workgroup> found: array<vec4<f32>, TRACE_THREADS>;

// Whether the map cannot be looked up where a ray starts: another point stands for it, or it lies off the pixel's plane.
fn is_off(surface: Surface, start: Start, place: vec2<f32>) -> bool {
    let above = abs(dot(start.position - surface.position, surface.normal));
    let is_other = any(start.place != place);
    return is_other || (any(place != vec2<f32>(0.0)) && above > 0.5 * start.height + abs(dot(surface.off, surface.normal)));
}

fn found_by(unsure: Unsure, at: u32, of_group: u32) -> vec4<f32> {
    let ray = edges.points[at];
    let start = start_at(unsure.pixel, unsure.surface, unsure.triangle, ray.xy);
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
        textureStore(factors, edges.corner + vec2<u32>(unsure.pixel), vec4<f32>(factor, 0.0, 0.0, 0.0));
    }
}
