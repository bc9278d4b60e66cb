// Fourth edge pass: traces the rays of the listed pixels.

@group(1) @binding(4) var<storage, read> list: List;

// Triangle of a pixel's first sample.
struct Triangle {
    // Slot among the rays' triangles; SHADOWFIT_RAYS_NONE if none was found.
    slot: u32,
    instance: u32,
}

// Returns whether a pixel lies close to the plane of another one: close enough that rays that start on this
// plane, between both pixels, start above the surface. The tolerance is half of the starts' height, since
// points may be offset along both axes. step: offset from the other pixel.
fn is_on_plane(pixel: vec2<i32>, step: vec2<i32>, surface: Surface) -> bool {
    let found = depth_at(pixel + step);
    let off = found - surface.depth - dot(surface.steps, vec2<f32>(step));
    let beneath = abs(off * dot(moved(edges.world_from_pixel[2], surface), surface.normal)) * edges.point_reach;
    return found != 0.0 && beneath <= 0.5 * height_at(surface.position);
}

// Returns whether a surface continues to a neighbour on the pixel's plane. Two pixels alone always lie on a
// common plane, however the surface bends between them, so a third pixel in line must lie on it, too.
fn goes_on(pixel: vec2<i32>, axis: vec2<i32>, surface: Surface) -> bool {
    return is_on_plane(pixel, axis, surface)
        && (is_on_plane(pixel, -axis, surface) || is_on_plane(pixel, 2 * axis, surface));
}

// Returns whether the surface continues on the triangle's plane to a place in its pixel, relative to the
// first sample, in pixels. beside: distance between that plane and the pixel's plane at this place, in
// metres.
fn reaches(pixel: vec2<i32>, surface: Surface, place: vec2<f32>, beside: f32) -> bool {
    if beside > 0.5 * height_at(surface.position) {
        return false;
    }
    let across = select(vec2<i32>(-1, 0), vec2<i32>(1, 0), place.x > 0.0);
    let down = select(vec2<i32>(0, -1), vec2<i32>(0, 1), place.y > 0.0);
    return (place.x == 0.0 || goes_on(pixel, across, surface)) && (place.y == 0.0 || goes_on(pixel, down, surface));
}

// Returns the start at the first sample from the depth buffer.
fn start_by_depth(surface: Surface) -> Start {
    let height = max(height_at(surface.position), abs(dot(surface.off, surface.normal)));
    return Start(surface.position, surface.normal, height, vec2<f32>(0.0), false);
}

// Returns the start of rays on a triangle at the pixel's first sample. If the ray misses the triangle, its
// plane may lie beneath the neighbouring triangle, so rays start higher.
fn start_on(met: shadowfit_rays_Met, position: vec3<f32>, surface: Surface) -> Start {
    let least = height_at(position);
    let height = select(max(least, beside_of(surface)), least, met.is_inside);
    return Start(position, met.normal, height, vec2<f32>(0.0), true);
}

// Returns the visible point at a place in a pixel. It lies on the triangle of the first sample, or on its
// plane if the surface continues on it. Otherwise it is the point of the first sample.
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

// Unit directions perpendicular to the light.
struct Across {
    x: vec3<f32>,
    y: vec3<f32>,
}

// Returns the directions perpendicular to the light for a pixel, rotated about the light (T. Duff et al.,
// "Building an orthonormal basis, revisited", 2017).
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

// Returns a factor with the bit of traced pixels, still in 0..=1.
fn traced(factor: f32) -> f32 {
    // Least and greatest value with this bit that devices do not round. Smaller ones may be flushed to zero.
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

// Returns whether the light reaches a point of a pixel: 1 or 0.
fn lit_at(unsure: Unsure, start: Start, in_sun: vec2<f32>) -> f32 {
    if start.is_exact && dot(start.normal, shadowfit_receiver.to_light) <= 0.0 {
        return 0.0;
    }
    let point = start.position + start.normal * start.height + edges.eye;
    let aside = in_sun * edges.sun_tangent;
    let beside = unsure.across.x * aside.x + unsure.across.y * aside.y;
    let ray = normalize(shadowfit_receiver.to_light + beside);
    // Positions on large triangles may be deeper than the height of the ray's start.
    let beneath = max(edges.vertex_rounding - start.height, 0.0);
    let reach = beneath / max(dot(start.normal, ray), SHADOWFIT_MIN_COSINE);
    return select(1.0, 0.0, shadowfit_rays_blocked_above(point, ray, start.normal, reach));
}

// Results of a workgroup's threads. Per pixel: the casters that the map contains. Per ray: whether light
// reaches its point, the map's estimate for the ray, the sum of the thread's look-ups over the whole pixel,
// and whether the point is off the plane.
var<workgroup> casters: array<vec2<f32>, PIXELS>;
var<workgroup> found: array<vec4<f32>, TRACE_THREADS>;

// Returns whether the map's estimate is invalid at the start of a ray: another point replaces it, or it lies
// off the pixel's plane.
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

// One thread per ray. Rays of the same pixel are neighbours.
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
        // The mean error of the estimate at the rays' points corrects the estimate for the whole pixel.
        let by_map = sum.z / f32(LOOK_UPS) + (sum.x - sum.y) / f32(POINTS);
        let share = saturate(select(by_map, sum.x / f32(POINTS), sum.w > 0.0));
        let factor = traced(mix(share, 1.0, shadowfit_faded(unsure.surface.position)));
        textureStore(factors, edges.corner + vec2<u32>(unsure.pixel), vec4<f32>(factor, 0.0, 0.0, 0.0));
    }
}
