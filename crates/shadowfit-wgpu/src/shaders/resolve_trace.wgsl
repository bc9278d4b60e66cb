// Third resolve pass: the rays of the pixels on the list.

@group(1) @binding(4) var<storage, read> list: List;

// Whether a pixel lies so near to the plane of another one that rays which start on the plane between them start above the
// surface: by half of their height, since points may lie aside along both axes. step: from the other one.
fn is_on_plane(pixel: vec2<i32>, step: vec2<i32>, surface: Surface) -> bool {
    let found = depth_at(pixel + step);
    let off = found - surface.depth - dot(surface.steps, vec2<f32>(step));
    let beneath = abs(off * dot(moved(resolve.world_from_pixel[2], surface), surface.normal)) * resolve.point_reach;
    return found != 0.0 && beneath <= 0.5 * height_of(surface);
}

// Whether a surface goes on to a neighbour of its pixel as the pixel's plane does. Two pixels are on any plane that follows
// from them, however the surface bends between them: it takes a third one in line.
fn goes_on(pixel: vec2<i32>, axis: vec2<i32>, surface: Surface) -> bool {
    return is_on_plane(pixel, axis, surface)
        && (is_on_plane(pixel, -axis, surface) || is_on_plane(pixel, 2 * axis, surface));
}

// How far points may lie from a pixel's first sample, in pixels: up to the right and down, up to the left and above.
fn sides_of(pixel: vec2<i32>, surface: Surface) -> array<vec2<f32>, 2> {
    // A constant and no uniform: software rasterisers build a shader for each dispatch where uniforms alone decide one.
    if !HAS_SIDES {
        return array<vec2<f32>, 2>(vec2<f32>(0.0), vec2<f32>(0.0));
    }
    let far = vec4<bool>(
        goes_on(pixel, vec2<i32>(1, 0), surface), goes_on(pixel, vec2<i32>(0, 1), surface),
        goes_on(pixel, vec2<i32>(-1, 0), surface), goes_on(pixel, vec2<i32>(0, -1), surface));
    let most = select(vec4<f32>(0.0), vec4<f32>(resolve.point_reach), far);
    return array<vec2<f32>, 2>(most.xy, -most.zw);
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

// A pixel of the list.
struct Unsure {
    pixel: vec2<i32>,
    surface: Surface,
    // How far points may lie.
    sides: array<vec2<f32>, 2>,
    across: Across,
}

fn unsure_at(index: u32) -> Unsure {
    let packed = list.pixels[index];
    let pixel = vec2<i32>(i32(packed & 0xffffu), i32(packed >> 16u));
    let surface = surface_of(pixel, depth_at(pixel));
    return Unsure(pixel, surface, sides_of(pixel, surface), across_light(pixel));
}

// Whether the light reaches a point of a pixel: 1 or 0.
fn lit_at(unsure: Unsure, place: vec2<f32>, in_sun: vec2<f32>) -> f32 {
    let height = height_of(unsure.surface);
    let point = point_of(unsure.pixel, unsure.surface, place) + unsure.surface.normal * height + resolve.eye;
    let aside = in_sun * resolve.sun_tangent;
    let beside = unsure.across.x * aside.x + unsure.across.y * aside.y;
    let ray = normalize(shadowfit_receiver.to_light + beside);
    // Farther than large triangles are rounded by, along the ray: this moves no edge of a shadow.
    let farther = max(resolve.vertex_rounding - height, 0.0) / max(dot(unsure.surface.normal, ray), SHADOWFIT_MIN_COSINE);
    return select(1.0, 0.0, shadowfit_rays_blocked(point + ray * farther, ray));
}

// What the threads of a workgroup find: of each pixel what the map has in the way, then for each ray how much more light it
// lets through than the map says, and its part of what the map says of the whole pixel.
var<workgroup> casters: array<vec2<f32>, TRACE_THREADS>;
var<workgroup> found: array<vec2<f32>, TRACE_THREADS>;

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
        let place = clamp(resolve.points[at].xy, unsure.sides[1], unsure.sides[0]);
        let in_sun = resolve.points[at].zw;
        let map = estimate_of(unsure, casters[of_group]);
        let more = lit_at(unsure, place, in_sun) - estimate_at(map, place, in_sun);
        var part = 0.0;
        for (var look_up = at; map.is_known && look_up < LOOK_UPS; look_up += POINTS) {
            part += estimate_part(map, unsure.sides, look_up);
        }
        found[thread] = vec2<f32>(more, part);
    }
    workgroupBarrier();
    if is_ray && at == 0u {
        var sum = vec2<f32>(0.0);
        for (var ray = 0u; ray < POINTS; ray += 1u) {
            sum += found[thread + ray];
        }
        // Rays say what the map is wrong by where they are: by as much it is taken to be wrong as a whole.
        let share = saturate(sum.y / f32(LOOK_UPS) + sum.x / f32(POINTS));
        let factor = traced(mix(share, 1.0, shadowfit_faded(unsure.surface.position)));
        textureStore(factors, resolve.corner + vec2<u32>(unsure.pixel), vec4<f32>(factor, 0.0, 0.0, 0.0));
    }
}
