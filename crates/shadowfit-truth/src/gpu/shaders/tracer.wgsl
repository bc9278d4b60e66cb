
// Rays from a point, whose origin is relative to that of the triangles, and which occluders end them. The rays
// themselves are those of another crate.

// The point whose occluders are looked for, and the map that it reads: only those in the map count. Without a map,
// NONE, every occluder counts.
struct Receiver {
    map: u32,
    // Relative to the eye.
    position: vec3<f32>,
    depth: f32,
}

// Of the ray that is being traced.
var<private> receiver: Receiver;

// Place in leaf order of each triangle by its own index.
@group(2) @binding(0) var<storage, read> slots: array<u32>;

// Whether the receiver's map holds an occluder at a distance toward the light.
fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool {
    if receiver.map == NONE {
        return true;
    }
    let map = judge.maps[receiver.map];
    let at = project(map, receiver.position + judge.to_light * hit.distance);
    return is_within_sides(map, at) && at.depth <= receiver.depth + 1e-6
        && (judge.depth_clamp != 0u || at.depth >= -1e-6);
}

// Whether the light's way to a point is blocked by an occluder that the receiver's map holds.
fn is_occluded(surface: Surface, point: Receiver) -> bool {
    receiver = point;
    let origin = judge.eye + surface.position + surface.normal * judge.ray_offset;
    return shadowfit_rays_blocked(origin, judge.to_light);
}

// The visible point of a pixel that shows a triangle, given by its own index.
fn surface_in(pixel: vec2<u32>, triangle: u32) -> Surface {
    let slot = slots[triangle];
    let corners = shadowfit_rays_triangle(slot);
    return surface_of(pixel, corners.a, corners.b, corners.c);
}
