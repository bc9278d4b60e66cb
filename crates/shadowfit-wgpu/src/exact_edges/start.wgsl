// Starts of a pixel's rays, shared by the passes that find its triangle and trace its rays.

// Greatest movement of corners that Vulkan and Direct3D allow: 16 steps per pixel.
const MOST_SNAP: f32 = 0.03125;
// Relative deviation of the depth from the pixel's plane that is allowed on the way to another point of the
// pixel.
const BEND: f32 = 0.5;

// A point of a pixel's surface.
struct Start {
    // Position relative to the eye, in metres.
    position: vec3<f32>,
    // Unit geometric normal that faces the eye.
    normal: vec3<f32>,
    // Distance above the surface at which rays start, in metres.
    height: f32,
    // Position in the pixel relative to its first sample, in pixels.
    place: vec2<f32>,
    // Whether the point lies on a triangle of the rays.
    is_exact: bool,
}

// Returns a position relative to the eye, in metres. at: position in pixels. depth: depth minus the far
// plane's.
fn position_at(at: vec2<f32>, depth: f32) -> vec3<f32> {
    let homogeneous = edges.world_from_pixel * vec4<f32>(at, depth, 1.0);
    return homogeneous.xyz / homogeneous.w;
}

// A segment of a line of sight that contains the surface.
struct Sight {
    // Middle by the depth buffer, relative to the eye, in metres.
    middle: vec3<f32>,
    // Unit direction away from the eye.
    direction: vec3<f32>,
    // Greatest distance of the surface before and behind the middle, in metres.
    reach: f32,
    // Greatest distance on rasterisers that move corners by SNAP at most.
    sure: f32,
}

// Returns the segment for a place in a pixel, relative to its first sample, in pixels. It allows for the
// rounding of depths, and for triangles whose corners were moved.
fn sight_at(pixel: vec2<i32>, surface: Surface, place: vec2<f32>) -> Sight {
    // At more than half of the depth the segment could reach the far plane.
    let farthest = 0.5 * abs(surface.depth);
    let depth = surface.depth + clamp(dot(surface.steps, place), -farthest, farthest);
    let steps = surface.most_steps;
    let likely = ROUNDINGS * rounding(depth) + SNAP * (steps.x + steps.y) + BEND * dot(steps, abs(place));
    let off = likely + (MOST_SNAP - SNAP) * (steps.x + steps.y);
    let least = min(off, 0.5 * abs(depth));
    let at = vec2<f32>(pixel) + sample_place(0u) + place;
    let middle = position_at(at, depth);
    let one = position_at(at, depth - least);
    let other = position_at(at, depth + least);
    let is_near = dot(other - one, edges.forward) > 0.0;
    let before = select(other, one, is_near);
    let rounded = POSITION_ROUNDING * (length(middle) + length(edges.eye));
    let reach = length(middle - before);
    let direction = normalize(select(one - other, other - one, is_near));
    return Sight(middle, direction, reach + rounded, reach * (likely / off) + rounded);
}

// Returns how far the ray from the eye may miss the drawn triangle, because its corners were rounded, in
// metres.
fn beside_of(surface: Surface) -> f32 {
    let m = edges.world_from_pixel;
    return SNAP * max(length(moved(m[0], surface)), length(moved(m[1], surface)));
}

// Returns the beginning of a segment, relative to the origin of the rays.
fn begin_of(sight: Sight) -> vec3<f32> {
    return sight.middle - sight.direction * sight.reach + edges.eye;
}
