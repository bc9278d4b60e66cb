// Rays through the hierarchy: the arithmetic of the CPU's rays, with their rule that a weight of minus zero misses.
// Origins are relative to the origin of the triangles.

// The hierarchy's depth is compared with this before it is uploaded.
const STACK: u32 = 64u;
const EPSILON: f32 = 1.1920929e-7;

// The point whose occluders are looked for, and the map that it reads: only those in the map count. Without a map,
// NONE, every occluder counts.
struct Receiver {
    map: u32,
    // Relative to the eye.
    position: vec3<f32>,
    depth: f32,
}

fn inverse(value: f32) -> f32 {
    if abs(value) <= EPSILON {
        return select(1.0, -1.0, (bitcast<u32>(value) >> 31u) != 0u) / EPSILON;
    }
    return 1.0 / value;
}

fn meets_box(node: Node, origin: vec3<f32>, inverses: vec3<f32>) -> bool {
    let a = (node.least - origin) * inverses;
    let b = (node.most - origin) * inverses;
    let near = min(a, b);
    let far = max(a, b);
    let enter = max(max(near.x, near.y), near.z);
    let leave = min(min(far.x, far.y), far.z);
    return leave >= enter && leave >= 0.0;
}

// Distance to a triangle (T. Möller, B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997, in
// the form of the obvhs crate), FAR for a miss.
fn distance_to(triangle: Triangle, origin: vec3<f32>, direction: vec3<f32>) -> f32 {
    let e1 = triangle.a - triangle.b;
    let e2 = triangle.c - triangle.a;
    let n = cross(e1, e2);
    let c = triangle.a - origin;
    let r = cross(direction, c);
    let determinant = dot(n, direction);
    if determinant == 0.0 {
        return FAR;
    }
    let inverse_determinant = 1.0 / determinant;
    let u = dot(r, e2) * inverse_determinant;
    let v = dot(r, e1) * inverse_determinant;
    let w = 1.0 - u - v;
    let signs = (bitcast<u32>(u) | bitcast<u32>(v) | bitcast<u32>(w)) & 0x80000000u;
    let distance = dot(n, c) * inverse_determinant;
    return select(FAR, distance, signs == 0u && distance >= 0.0 && distance < FAR);
}

fn remainder(index: i32, size: i32) -> i32 {
    let rest = index % size;
    return select(rest, rest + size, rest < 0);
}

fn wrapped(index: i32, size: i32, wrap: u32) -> i32 {
    switch wrap {
        case 0u: { return remainder(index, size); }
        case 1u: { return clamp(index, 0, size - 1); }
        default: {
            let folded = remainder(index, size * 2);
            return min(folded, size * 2 - 1 - folded);
        }
    }
}

fn alpha_at(image: Image, cut_out: CutOut, corner: vec2<i32>) -> f32 {
    let x = wrapped(corner.x, image.width, cut_out.wrap.x);
    let y = wrapped(corner.y, image.height, cut_out.wrap.y);
    let texel = image.first + u32(y) * u32(image.width) + u32(x);
    return f32((alphas[texel / 4u] >> (texel % 4u * 8u)) & 255u) / 255.0;
}

fn sample_alpha(image: Image, cut_out: CutOut, uv: vec2<f32>) -> f32 {
    let limit = vec2<f32>(1073741824.0);
    let position = clamp(uv * vec2<f32>(f32(image.width), f32(image.height)) - 0.5, -limit, limit);
    let weight = position - floor(position);
    let corner = vec2<i32>(floor(position));
    if cut_out.nearest != 0u {
        return alpha_at(image, cut_out, corner + vec2<i32>(weight >= vec2<f32>(0.5)));
    }
    let upper = mix(
        alpha_at(image, cut_out, corner), alpha_at(image, cut_out, corner + vec2<i32>(1, 0)), weight.x);
    let lower = mix(
        alpha_at(image, cut_out, corner + vec2<i32>(0, 1)), alpha_at(image, cut_out, corner + 1), weight.x);
    return mix(upper, lower, weight.y);
}

// Whether a triangle with holes is opaque at a point.
fn is_opaque(triangle: Triangle, point: vec3<f32>) -> bool {
    let cut_out = cut_outs[triangle.cut_out - 1u];
    let edge1 = triangle.b - triangle.a;
    let edge2 = triangle.c - triangle.a;
    let to_point = point - triangle.a;
    let normal = cross(edge1, edge2);
    let area = dot(normal, normal);
    let second = dot(cross(to_point, edge2), normal) / area;
    let third = dot(cross(edge1, to_point), normal) / area;
    let weights = vec3<f32>(1.0 - second - third, second, third);
    var alpha = cut_out.base_alpha * dot(cut_out.alphas, weights);
    if cut_out.image != 0u {
        let uv = cut_out.uv_a * weights.x + cut_out.uv_b * weights.y + cut_out.uv_c * weights.z;
        alpha *= sample_alpha(images[cut_out.image - 1u], cut_out, uv);
    }
    return alpha >= cut_out.cutoff;
}

// Whether the receiver's map holds an occluder at a distance toward the light.
fn holds(receiver: Receiver, direction: vec3<f32>, distance: f32) -> bool {
    if receiver.map == NONE {
        return true;
    }
    let map = judge.maps[receiver.map];
    let at = project(map, receiver.position + direction * distance);
    return is_within_sides(map, at) && at.depth <= receiver.depth + 1e-6
        && (judge.depth_clamp != 0u || at.depth >= -1e-6);
}

fn is_occluder(triangle: Triangle, origin: vec3<f32>, direction: vec3<f32>, receiver: Receiver) -> bool {
    let distance = distance_to(triangle, origin, direction);
    if distance >= FAR {
        return false;
    }
    if triangle.cut_out != 0u && !is_opaque(triangle, origin + direction * distance) {
        return false;
    }
    return holds(receiver, direction, distance);
}

// Whether a ray meets an occluder that the receiver's map holds.
fn is_occluded(origin: vec3<f32>, direction: vec3<f32>, receiver: Receiver) -> bool {
    let inverses = vec3<f32>(inverse(direction.x), inverse(direction.y), inverse(direction.z));
    if !meets_box(nodes[0], origin, inverses) {
        return false;
    }
    var stack: array<u32, STACK>;
    var height = 0u;
    var current = 0u;
    loop {
        let first = nodes[current].first;
        let count = nodes[current].count;
        for (var slot = first; slot < first + count; slot++) {
            if is_occluder(triangles[slot], origin, direction, receiver) {
                return true;
            }
        }
        let goes_left = count == 0u && meets_box(nodes[first], origin, inverses);
        let goes_right = count == 0u && meets_box(nodes[first + 1u], origin, inverses);
        if goes_left && goes_right {
            stack[height] = first + 1u;
            height++;
        }
        if goes_left || goes_right {
            current = select(first + 1u, first, goes_left);
        } else if height > 0u {
            height--;
            current = stack[height];
        } else {
            return false;
        }
    }
    return false;
}

// Where the shadow ray of a point starts.
fn ray_origin(surface: Surface) -> vec3<f32> {
    return judge.eye + surface.position + surface.normal * judge.ray_offset;
}
