
// Passes that fit a mesh's hierarchy to moved vertices: one for its triangles, then one for each level of its
// nodes, deepest first.

struct shadowfit_rays_Refit {
    // First node of the level, or first triangle.
    first: u32,
    count: u32,
    // Start of the first position, in words.
    offset: u32,
    // Distance from one position to the next, in words.
    stride: u32,
}

@group(0) @binding(0) var<uniform> refit: shadowfit_rays_Refit;
@group(0) @binding(1) var<storage, read> vertices: array<u32>;
// Three vertex indices per triangle, in leaf order.
@group(0) @binding(2) var<storage, read> indices: array<u32>;
@group(0) @binding(3) var<storage, read_write> triangles: array<shadowfit_rays_Triangle>;
@group(0) @binding(4) var<storage, read_write> nodes: array<shadowfit_rays_Node>;

// Returns the number of a thread in a dispatch with more than one row.
fn number(group: vec3<u32>, groups: vec3<u32>, local: u32) -> u32 {
    return (group.y * groups.x + group.x) * 256u + local;
}

fn position(index: u32) -> vec3<u32> {
    let at = refit.offset + indices[index] * refit.stride;
    return vec3<u32>(vertices[at], vertices[at + 1u], vertices[at + 2u]);
}

// Tests the bits, because shaders may assume that no number is infinite.
fn is_finite(bits: vec3<u32>) -> bool {
    let exponent = vec3<u32>(0x7f800000u);
    return all((bits & exponent) != exponent);
}

@compute @workgroup_size(256) fn move_triangles(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let triangle = number(group, groups, local);
    if triangle >= refit.count {
        return;
    }
    let a = position(triangle * 3u);
    let b = position(triangle * 3u + 1u);
    let c = position(triangle * 3u + 2u);
    let slot = refit.first + triangle;
    // A triangle that is not finite becomes a point, which rays never hit.
    if is_finite(a) && is_finite(b) && is_finite(c) {
        triangles[slot].a = bitcast<vec3<f32>>(a);
        triangles[slot].b = bitcast<vec3<f32>>(b);
        triangles[slot].c = bitcast<vec3<f32>>(c);
    } else {
        triangles[slot].a = vec3<f32>(0.0);
        triangles[slot].b = vec3<f32>(0.0);
        triangles[slot].c = vec3<f32>(0.0);
    }
}

@compute @workgroup_size(256) fn fit_level(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let place = number(group, groups, local);
    if place >= refit.count {
        return;
    }
    let node = refit.first + place;
    let first = nodes[node].first;
    let count = nodes[node].count;
    if first == SHADOWFIT_RAYS_NONE {
        return;
    }
    if count == 0u {
        var around = nodes[first];
        for (var child = first + 1u; child < first + SHADOWFIT_RAYS_WIDTH; child++) {
            if nodes[child].first != SHADOWFIT_RAYS_NONE {
                around.least = min(around.least, nodes[child].least);
                around.most = max(around.most, nodes[child].most);
            }
        }
        nodes[node].least = around.least;
        nodes[node].most = around.most;
        return;
    }
    var least = triangles[first].a;
    var most = least;
    for (var slot = first; slot < first + count; slot++) {
        let triangle = triangles[slot];
        least = min(least, min(triangle.a, min(triangle.b, triangle.c)));
        most = max(most, max(triangle.a, max(triangle.b, triangle.c)));
    }
    nodes[node].least = least;
    nodes[node].most = most;
}
