
// Rays from a point, with an origin relative to the origin of the triangles, and the rule that decides which
// occluders block them. The crate shadowfit-rays traces the rays.

// The point whose occluders are searched, and the map that it reads. Only occluders in the map count. If the
// map is NONE, every occluder counts.
struct Receiver {
    map: u32,
    // Relative to the eye.
    position: vec3<f32>,
    depth: f32,
}

// Receiver of the current ray.
var<private> receiver: Receiver;

// Position in leaf order of each triangle, by the triangle's index.
@group(2) @binding(0) var<storage, read> slots: array<u32>;

// Returns whether the receiver's map holds an occluder at a distance toward the light.
fn shadowfit_rays_counts(hit: shadowfit_RayHit) -> bool {
    if receiver.map == NONE {
        return true;
    }
    let map = judge.maps[receiver.map];
    let at = project(map, receiver.position + judge.to_light * hit.distance);
    return is_within_sides(map, at) && at.depth <= receiver.depth + 1e-6
        && (judge.depth_clamp != 0u || at.depth >= -1e-6);
}

// Returns whether an occluder that the receiver's map holds blocks the ray from a point to the light.
fn is_occluded(surface: Surface, point: Receiver) -> bool {
    receiver = point;
    let origin = judge.eye + surface.position + surface.normal * judge.ray_offset;
    return shadowfit_rays_blocked(origin, judge.to_light);
}

// Returns the visible point of a pixel that shows a triangle, given by the triangle's index.
fn surface_in(pixel: vec2<u32>, triangle: u32) -> Surface {
    let slot = slots[triangle];
    let corners = shadowfit_rays_triangle(slot);
    return surface_of(pixel, corners.a, corners.b, corners.c);
}
