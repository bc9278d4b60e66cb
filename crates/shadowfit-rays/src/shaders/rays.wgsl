
struct shadowfit_rays_Instance {
    // Rows of the transform from world to mesh.
    row_x: vec4<f32>,
    row_y: vec4<f32>,
    row_z: vec4<f32>,
    // First node of the mesh, or NONE.
    root: u32,
    // 0 both, 1 front, 2 back.
    sides: u32,
    custom: u32,
    padding: u32,
}

struct shadowfit_rays_CutOut {
    uv_a: vec2<f32>,
    uv_b: vec2<f32>,
    uv_c: vec2<f32>,
    base_alpha: f32,
    cutoff: f32,
    alphas: vec3<f32>,
    // Index of the image's first word, plus 1. 0 for none.
    image: u32,
    wrap: vec2<u32>,
    nearest: u32,
    padding: u32,
}

// A hit of a ray on a triangle.
struct shadowfit_RayHit {
    // Index of the instance.
    instance: u32,
    // The instance's number from the engine.
    custom: u32,
    // Index of the triangle in its mesh.
    triangle: u32,
    // Place of the triangle among all triangles of the scene.
    slot: u32,
    // Weights of the second and third corner.
    weights: vec2<f32>,
    // In metres.
    distance: f32,
}

struct shadowfit_rays_Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
    // 1 / direction, times a factor that does not affect comparisons of distances along one ray.
    inverses: vec3<f32>,
}

// Uploads check that hierarchies do not need a longer stack.
const SHADOWFIT_RAYS_STACK: u32 = NODES_ON_STACKu;
// A packed node has the number of its triangles or instances in the bits above these.
const SHADOWFIT_RAYS_FIRST: u32 = 0x7ffffffu;
const SHADOWFIT_RAYS_COUNT_AT: u32 = 27u;
// Greater than any relevant distance, in metres.
const SHADOWFIT_RAYS_FAR: f32 = 3.0e38;
// Share of the longest component below which a direction counts as parallel to a slab. The inverse of this
// share is still finite after multiplication with a kilometre in micrometres.
const SHADOWFIT_RAYS_PARALLEL: f32 = 1e-29;
// Factor that moves the end of a box outward, for four roundings (T. Ize, "Robust BVH Ray Traversal", 2013).
const SHADOWFIT_RAYS_LATER: f32 = 1.0000005;

// The nodes of the instances, root first, and of the meshes. Each has the bytes of a shadowfit_rays_Node.
// NVIDIA's driver does not join the loads of a structure's members, which makes rays up to a sixth slower.
@group(GROUP) @binding(0) var<storage, read> shadowfit_rays_nodes: array<array<vec4<u32>, 2>>;
@group(GROUP) @binding(1) var<storage, read> shadowfit_rays_instances: array<shadowfit_rays_Instance>;
// Each has the bytes of a shadowfit_rays_Triangle.
@group(GROUP) @binding(2) var<storage, read> shadowfit_rays_triangles: array<array<vec4<u32>, 3>>;
@group(GROUP) @binding(3) var<storage, read> shadowfit_rays_cut_outs: array<shadowfit_rays_CutOut>;
// Width, height and alpha of each image, with four texels per word, the first one in the lowest byte.
@group(GROUP) @binding(4) var<storage, read> shadowfit_rays_images: array<u32>;

fn shadowfit_rays_node(index: u32) -> shadowfit_rays_Node {
    let least = shadowfit_rays_nodes[index][0];
    let most = shadowfit_rays_nodes[index][1];
    return shadowfit_rays_Node(bitcast<vec3<f32>>(least.xyz), least.w, bitcast<vec3<f32>>(most.xyz), most.w);
}

// Returns the triangle at a place among all triangles of the scene.
fn shadowfit_rays_triangle(slot: u32) -> shadowfit_rays_Triangle {
    let a = shadowfit_rays_triangles[slot][0];
    let b = shadowfit_rays_triangles[slot][1];
    let c = shadowfit_rays_triangles[slot][2];
    return shadowfit_rays_Triangle(
        bitcast<vec3<f32>>(a.xyz), a.w, bitcast<vec3<f32>>(b.xyz), b.w, bitcast<vec3<f32>>(c.xyz), c.w);
}

fn shadowfit_rays_ray(origin: vec3<f32>, direction: vec3<f32>) -> shadowfit_rays_Ray {
    let size = abs(direction);
    let scaled = direction / max(max(size.x, size.y), size.z);
    let nearly = vec3<f32>(SHADOWFIT_RAYS_PARALLEL);
    let signed = select(nearly, -nearly, (bitcast<vec3<u32>>(scaled) >> vec3<u32>(31u)) != vec3<u32>(0u));
    return shadowfit_rays_Ray(origin, direction, 1.0 / select(scaled, signed, abs(scaled) < nearly));
}

// Returns the ray in the space of an instance's mesh. Its direction is not of unit length, so that distances
// stay in metres.
fn shadowfit_rays_in_mesh(instance: u32, ray: shadowfit_rays_Ray) -> shadowfit_rays_Ray {
    let x = shadowfit_rays_instances[instance].row_x;
    let y = shadowfit_rays_instances[instance].row_y;
    let z = shadowfit_rays_instances[instance].row_z;
    let at = ray.origin;
    let along = ray.direction;
    return shadowfit_rays_ray(
        vec3<f32>(dot(x.xyz, at) + x.w, dot(y.xyz, at) + y.w, dot(z.xyz, at) + z.w),
        vec3<f32>(dot(x.xyz, along), dot(y.xyz, along), dot(z.xyz, along)),
    );
}

fn shadowfit_rays_meets(least: vec3<f32>, most: vec3<f32>, ray: shadowfit_rays_Ray) -> bool {
    let a = (least - ray.origin) * ray.inverses;
    let b = (most - ray.origin) * ray.inverses;
    let near = min(a, b);
    let far = max(a, b);
    let enter = max(max(near.x, near.y), near.z);
    let leave = min(min(far.x, far.y), far.z);
    return leave * SHADOWFIT_RAYS_LATER >= enter && leave >= 0.0;
}

fn shadowfit_rays_remainder(index: i32, size: i32) -> i32 {
    let rest = index % size;
    return select(rest, rest + size, rest < 0);
}

fn shadowfit_rays_wrapped(index: i32, size: i32, wrap: u32) -> i32 {
    switch wrap {
        case 0u: { return shadowfit_rays_remainder(index, size); }
        case 1u: { return clamp(index, 0, size - 1); }
        default: {
            let folded = shadowfit_rays_remainder(index, size * 2);
            return min(folded, size * 2 - 1 - folded);
        }
    }
}

fn shadowfit_rays_alpha_at(image: u32, wrap: vec2<u32>, corner: vec2<i32>) -> f32 {
    let width = shadowfit_rays_images[image];
    let x = shadowfit_rays_wrapped(corner.x, i32(width), wrap.x);
    let y = shadowfit_rays_wrapped(corner.y, i32(shadowfit_rays_images[image + 1u]), wrap.y);
    let texel = u32(y) * width + u32(x);
    return f32((shadowfit_rays_images[image + 2u + texel / 4u] >> (texel % 4u * 8u)) & 255u) / 255.0;
}

fn shadowfit_rays_alpha(image: u32, wrap: vec2<u32>, nearest: bool, uv: vec2<f32>) -> f32 {
    let size = vec2<f32>(f32(shadowfit_rays_images[image]), f32(shadowfit_rays_images[image + 1u]));
    // Whole numbers of this size and their neighbours fit into i32, and f32 has no fractions at this size.
    let limit = vec2<f32>(1073741824.0);
    let position = clamp(uv * size - 0.5, -limit, limit);
    let weight = position - floor(position);
    let corner = vec2<i32>(floor(position));
    if nearest {
        return shadowfit_rays_alpha_at(image, wrap, corner + vec2<i32>(weight >= vec2<f32>(0.5)));
    }
    let upper = mix(
        shadowfit_rays_alpha_at(image, wrap, corner),
        shadowfit_rays_alpha_at(image, wrap, corner + vec2<i32>(1, 0)),
        weight.x,
    );
    let lower = mix(
        shadowfit_rays_alpha_at(image, wrap, corner + vec2<i32>(0, 1)),
        shadowfit_rays_alpha_at(image, wrap, corner + 1),
        weight.x,
    );
    return mix(upper, lower, weight.y);
}

// Returns whether a triangle with holes is opaque at the given weights of its second and third corner.
fn shadowfit_rays_is_opaque(cut_out: shadowfit_rays_CutOut, second_third: vec2<f32>) -> bool {
    let weights = vec3<f32>(1.0 - second_third.x - second_third.y, second_third);
    var alpha = cut_out.base_alpha * dot(cut_out.alphas, weights);
    if cut_out.image != 0u {
        let uv = cut_out.uv_a * weights.x + cut_out.uv_b * weights.y + cut_out.uv_c * weights.z;
        alpha *= shadowfit_rays_alpha(cut_out.image - 1u, cut_out.wrap, cut_out.nearest != 0u, uv);
    }
    return alpha >= cut_out.cutoff;
}

// Returns the weights of the second and third corner at a point of a triangle, computed from areas.
fn shadowfit_rays_weights(triangle: shadowfit_rays_Triangle, point: vec3<f32>) -> vec2<f32> {
    let edge1 = triangle.b - triangle.a;
    let edge2 = triangle.c - triangle.a;
    let to_point = point - triangle.a;
    let normal = cross(edge1, edge2);
    let area = dot(normal, normal);
    return vec2<f32>(dot(cross(to_point, edge2), normal), dot(cross(edge1, to_point), normal)) / area;
}

// Returns whether a ray in the space of a mesh ends at a point of a triangle. It does not end in a hole, nor
// if the engine's own test ignores the hit.
fn shadowfit_rays_ends(slot: u32, instance: u32, ray: shadowfit_rays_Ray, distance: f32) -> bool {
    let triangle = shadowfit_rays_triangle(slot);
    let weights = shadowfit_rays_weights(triangle, ray.origin + ray.direction * distance);
    if triangle.cut_out != 0u && !shadowfit_rays_is_opaque(shadowfit_rays_cut_outs[triangle.cut_out - 1u], weights) {
        return false;
    }
    let custom = shadowfit_rays_instances[instance].custom;
    return shadowfit_rays_counts(shadowfit_RayHit(instance, custom, triangle.index, slot, weights, distance));
}

// The surface that a ray starts on. Triangles in its plane do not count at less than `reach` metres.
struct shadowfit_rays_Start {
    // Unit normal, in world space.
    normal: vec3<f32>,
    reach: f32,
}

// Start of the ray that is being traced.
var<private> shadowfit_rays_start: shadowfit_rays_Start;

// Cosine of the greatest angle between the normals of triangles that count as coplanar.
const SHADOWFIT_RAYS_SAME_PLANE: f32 = 0.9999;

// Returns the unit normal in world space, against a ray, of an instance's triangle. `normal` is in mesh
// space, of any length.
fn shadowfit_rays_normal(normal: vec3<f32>, instance: u32, direction: vec3<f32>) -> vec3<f32> {
    let placed = shadowfit_rays_instances[instance];
    let world = placed.row_x.xyz * normal.x + placed.row_y.xyz * normal.y + placed.row_z.xyz * normal.z;
    // Scaled first, because the squared areas of small triangles are too small for f32.
    let unit = normalize(world / max(max(abs(world.x), abs(world.y)), abs(world.z)));
    return select(unit, -unit, dot(unit, direction) > 0.0);
}

// Returns whether a triangle that was hit at a distance belongs to the surface that the ray starts on.
// `normal` is in mesh space, of any length.
fn shadowfit_rays_is_start(normal: vec3<f32>, instance: u32, distance: f32) -> bool {
    let start = shadowfit_rays_start;
    if distance >= start.reach {
        return false;
    }
    return dot(shadowfit_rays_normal(normal, instance, -start.normal), start.normal) > SHADOWFIT_RAYS_SAME_PLANE;
}

// Returns whether a triangle blocks a ray in the space of its mesh (T. Möller, B. Trumbore, "Fast, Minimum
// Storage Ray/Triangle Intersection", 1997, in the form of the obvhs crate, where a weight of minus zero
// misses).
fn shadowfit_rays_blocks(slot: u32, instance: u32, ray: shadowfit_rays_Ray) -> bool {
    let triangle = shadowfit_rays_triangle(slot);
    let e1 = triangle.a - triangle.b;
    let e2 = triangle.c - triangle.a;
    // Opposite to the normal of the front.
    let n = cross(e1, e2);
    let c = triangle.a - ray.origin;
    let r = cross(ray.direction, c);
    let determinant = dot(n, ray.direction);
    if determinant == 0.0 {
        return false;
    }
    let inverse_determinant = 1.0 / determinant;
    let u = dot(r, e2) * inverse_determinant;
    let v = dot(r, e1) * inverse_determinant;
    let w = 1.0 - u - v;
    let signs = (bitcast<u32>(u) | bitcast<u32>(v) | bitcast<u32>(w)) & 0x80000000u;
    let distance = dot(n, c) * inverse_determinant;
    if signs != 0u || !(distance >= 0.0 && distance < SHADOWFIT_RAYS_FAR) {
        return false;
    }
    if shadowfit_rays_is_start(n, instance, distance) {
        return false;
    }
    // Rays go toward the light, so the light sees the front if the front's normal points along the ray.
    let sides = shadowfit_rays_instances[instance].sides;
    if sides != 0u && (determinant > 0.0) == (sides == 1u) {
        return false;
    }
    return shadowfit_rays_ends(slot, instance, ray, distance);
}

fn shadowfit_rays_blocks_any(first: u32, count: u32, instance: u32, ray: shadowfit_rays_Ray) -> bool {
    for (var slot = first; slot < first + count; slot++) {
        if shadowfit_rays_blocks(slot, instance, ray) {
            return true;
        }
    }
    return false;
}

// Packs a node into a word. NONE for no node.
fn shadowfit_rays_packed(node: shadowfit_rays_Node) -> u32 {
    return node.first | (node.count << SHADOWFIT_RAYS_COUNT_AT);
}

// Returns a packed node, or NONE if the ray misses it.
fn shadowfit_rays_child(node: u32, ray: shadowfit_rays_Ray) -> u32 {
    let child = shadowfit_rays_node(node);
    let meets = shadowfit_rays_meets(child.least, child.most, ray);
    return select(SHADOWFIT_RAYS_NONE, shadowfit_rays_packed(child), meets);
}

// Returns whether a triangle blocks the ray from a point, in metres relative to the scene's origin, along a
// unit direction.
fn shadowfit_rays_blocked(origin: vec3<f32>, direction: vec3<f32>) -> bool {
    let world = shadowfit_rays_ray(origin, direction);
    var ray = world;
    var stack: array<u32, SHADOWFIT_RAYS_STACK>;
    var height = 0u;
    // The instance whose mesh the ray is in, and the height of the stack at its entry.
    var instance = SHADOWFIT_RAYS_NONE;
    var entered = 0u;
    var current = shadowfit_rays_packed(shadowfit_rays_node(0));
    loop {
        // Descends to a leaf first, so that the rays of a subgroup test triangles together.
        while current >> SHADOWFIT_RAYS_COUNT_AT == 0u {
            let first = current;
            let met = vec4<u32>(
                shadowfit_rays_child(first, ray), shadowfit_rays_child(first + 1u, ray),
                shadowfit_rays_child(first + 2u, ray), shadowfit_rays_child(first + 3u, ray));
            var next = met.w;
            if met.z != SHADOWFIT_RAYS_NONE {
                if next != SHADOWFIT_RAYS_NONE {
                    stack[height] = next;
                    height++;
                }
                next = met.z;
            }
            if met.y != SHADOWFIT_RAYS_NONE {
                if next != SHADOWFIT_RAYS_NONE {
                    stack[height] = next;
                    height++;
                }
                next = met.y;
            }
            if met.x != SHADOWFIT_RAYS_NONE {
                if next != SHADOWFIT_RAYS_NONE {
                    stack[height] = next;
                    height++;
                }
                next = met.x;
            }
            if next == SHADOWFIT_RAYS_NONE {
                if height == 0u {
                    return false;
                }
                if instance != SHADOWFIT_RAYS_NONE && height == entered {
                    instance = SHADOWFIT_RAYS_NONE;
                    ray = world;
                }
                height--;
                next = stack[height];
            }
            current = next;
        }
        let first = current & SHADOWFIT_RAYS_FIRST;
        var next = SHADOWFIT_RAYS_NONE;
        if instance == SHADOWFIT_RAYS_NONE {
            let root = shadowfit_rays_instances[first].root;
            if root != SHADOWFIT_RAYS_NONE {
                ray = shadowfit_rays_in_mesh(first, world);
                instance = first;
                entered = height;
                next = root;
            }
        } else if shadowfit_rays_blocks_any(first, current >> SHADOWFIT_RAYS_COUNT_AT, instance, ray) {
            return true;
        }
        if next == SHADOWFIT_RAYS_NONE {
            if height == 0u {
                return false;
            }
            if instance != SHADOWFIT_RAYS_NONE && height == entered {
                instance = SHADOWFIT_RAYS_NONE;
                ray = world;
            }
            height--;
            next = stack[height];
        }
        current = next;
    }
    return false;
}

// Returns whether a triangle blocks a ray that starts on a surface, or below it because of rounding.
// Triangles with the unit normal `normal` or its opposite do not block it at less than `reach` metres.
fn shadowfit_rays_blocked_above(
    origin: vec3<f32>, direction: vec3<f32>, normal: vec3<f32>, reach: f32) -> bool {
    shadowfit_rays_start = shadowfit_rays_Start(normal, reach);
    let is_blocked = shadowfit_rays_blocked(origin, direction);
    shadowfit_rays_start.reach = 0.0;
    return is_blocked;
}
