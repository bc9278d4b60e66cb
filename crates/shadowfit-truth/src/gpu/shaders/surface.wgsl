// The visible point of a pixel, and positions of points in shadow maps. Positions are relative to the eye.

struct Surface {
    position: vec3<f32>,
    // Unit geometric normal on the eye's side.
    normal: vec3<f32>,
    // Direction of the line of sight through the pixel's centre. Its component along the view is 1.
    ray: vec3<f32>,
    facing: f32,
    view_depth: f32,
}

struct MapPosition {
    texel: vec2<f32>,
    // 0 is nearest to the light.
    depth: f32,
    ndc: vec3<f32>,
    w: f32,
}

// The line of sight through a pixel's centre.
struct Sight {
    // The point of view depth 0.
    origin: vec3<f32>,
    // The component along the view is 1.
    ray: vec3<f32>,
}

fn sight_of(pixel: vec2<u32>) -> Sight {
    let share = (2.0 * (vec2<f32>(pixel) + 0.5) / vec2<f32>(judge.size) - 1.0) * judge.half_size;
    let aside = judge.right * share.x - judge.up * share.y;
    let is_parallel = judge.is_orthographic != 0u;
    let nothing = vec3<f32>(0.0);
    return Sight(select(nothing, aside, is_parallel), judge.forward + select(aside, nothing, is_parallel));
}

// Returns the intersection of the pixel's ray with a triangle's plane. Its view depth is clamped to the
// corners' range.
fn surface_of(pixel: vec2<u32>, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> Surface {
    let sight = sight_of(pixel);
    let ray = sight.ray;
    let area = cross(b - a, c - a);
    // Scales first, because f32 cannot hold the squares of small triangles' areas.
    let largest = max(max(abs(area.x), abs(area.y)), abs(area.z));
    var normal = vec3<f32>(0.0);
    if largest > 0.0 {
        normal = normalize(area / largest);
    }
    let corner = a - judge.eye;
    let depths = vec3<f32>(
        dot(corner, judge.forward),
        dot(b - judge.eye, judge.forward),
        dot(c - judge.eye, judge.forward),
    );
    let nearest = max(min(min(depths.x, depths.y), depths.z), judge.near);
    let farthest = min(max(max(depths.x, depths.y), depths.z), judge.far);
    let along = dot(normal, ray);
    var view_depth = nearest;
    if along != 0.0 {
        view_depth = min(max(dot(normal, corner - sight.origin) / along, nearest), farthest);
    }
    let position = sight.origin + ray * view_depth;
    if along > 0.0 {
        normal = -normal;
    }
    return Surface(position, normal, ray, dot(normal, judge.to_light), view_depth);
}

fn project(map: Map, position: vec3<f32>) -> MapPosition {
    let point = vec4<f32>(position, 1.0);
    let w = dot(map.row_w, point);
    let ndc = vec3<f32>(dot(map.row_x, point), dot(map.row_y, point), dot(map.row_z, point)) / w;
    let texel = (0.5 + ndc.xy * vec2<f32>(0.5, -0.5)) * map.size;
    return MapPosition(texel, select(ndc.z, 1.0 - ndc.z, map.is_reversed != 0u), ndc, w);
}

fn is_within_sides(map: Map, at: MapPosition) -> bool {
    let tolerance = map.size * 1e-5;
    return at.w > 0.0 && all(at.texel >= -tolerance) && all(at.texel <= map.size + tolerance);
}

fn is_inside(map: Map, at: MapPosition) -> bool {
    return is_within_sides(map, at) && at.depth >= -1e-5 && at.depth <= 1.0 + 1e-5;
}

// Returns whether the map at a place in the order holds a point.
fn is_in_map(place: u32, position: vec3<f32>) -> bool {
    return is_inside(judge.maps[place], project(judge.maps[place], position));
}

// Selects by view depth: the first map whose split is beyond the point, or the next later one that holds the
// point. If this map is blended into the next one, and the next one has the greater weight, returns the next
// one. NONE if no map holds the point.
fn choose_by_view_depth(view_depth: f32, position: vec3<f32>) -> u32 {
    var is_reached = false;
    for (var place = 0u; place < judge.map_count; place++) {
        let far = judge.maps[place].split_far;
        is_reached = is_reached || view_depth < far;
        if is_reached && is_in_map(place, position) {
            let next = place + 1u;
            if next < judge.map_count {
                let near = judge.maps[next].blend_near;
                if near < far && view_depth - near > 0.5 * (far - near) && is_in_map(next, position) {
                    return next;
                }
            }
            return place;
        }
    }
    return NONE;
}

// Selects by coverage: the first map that holds the point with the filter's footprint, or the next such map
// if that one has the greater blend weight. If there is none, the first map that holds the point. NONE
// without one.
fn choose_by_coverage(position: vec3<f32>) -> u32 {
    var first = NONE;
    var clamped = NONE;
    for (var place = 0u; place < judge.map_count; place++) {
        let map = judge.maps[place];
        let at = project(map, position);
        if !is_inside(map, at) {
            continue;
        }
        let free = min(at.texel, map.size - at.texel);
        let beyond = min(free.x, free.y) - judge.reach;
        if beyond >= 0.0 {
            // The first map is read alone or weighs at least as much as the next one; or this is the next
            // one.
            if first != NONE || beyond >= 0.5 * judge.blend {
                return place;
            }
            first = place;
        } else if clamped == NONE {
            clamped = place;
        }
    }
    return select(first, clamped, first == NONE);
}

// Returns the place in the order of the map with the greatest weight among the maps that a point reads, or
// NONE.
fn choose(surface: Surface) -> u32 {
    if judge.by_coverage != 0u {
        return choose_by_coverage(surface.position);
    }
    return choose_by_view_depth(surface.view_depth, surface.position);
}

// Returns whether a map that the point would have read in the previous frame covers it.
fn is_covered_before(position: vec3<f32>) -> bool {
    let view_depth = dot(position, judge.before.forward) + judge.before.eye_depth;
    for (var place = 0u; place < judge.before.map_count; place++) {
        let map = judge.before.maps[place];
        if (judge.before.by_coverage != 0u || view_depth < map.split_far) && is_inside(map, project(map, position)) {
            return true;
        }
    }
    return false;
}

// Returns how far a point moves on its tangent plane when its line of sight is moved by `across`, in metres;
// for a perspective, at a view depth of 1 m.
fn slide(surface: Surface, across: vec3<f32>) -> vec3<f32> {
    let along = dot(across, surface.normal) / dot(surface.ray, surface.normal);
    return (across - surface.ray * along) * select(surface.view_depth, 1.0, judge.is_orthographic != 0u);
}

// Returns pixels per texel along the worse axis: one over the smaller singular value of texels per pixel.
fn pixels_per_texel(surface: Surface, map: Map) -> f32 {
    let at = project(map, surface.position);
    let u = (map.row_x.xyz - map.row_w.xyz * at.ndc.x) * (0.5 * map.size.x / at.w);
    let v = (map.row_y.xyz - map.row_w.xyz * at.ndc.y) * (-0.5 * map.size.y / at.w);
    let pixel = 2.0 * judge.half_size / vec2<f32>(judge.size);
    let to_right = slide(surface, judge.right * pixel.x);
    let to_down = slide(surface, -judge.up * pixel.y);
    let right = vec2<f32>(dot(u, to_right), dot(v, to_right));
    let down = vec2<f32>(dot(u, to_down), dot(v, to_down));
    let sum = length(vec2<f32>(right.x + down.y, right.y - down.x));
    let difference = length(vec2<f32>(right.x - down.y, right.y + down.x));
    let area = abs(right.x * down.y - right.y * down.x);
    if !(area > 0.0) {
        return FAR;
    }
    return min(0.5 * (sum + difference) / area, FAR);
}
