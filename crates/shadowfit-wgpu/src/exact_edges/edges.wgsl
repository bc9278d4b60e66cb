// Shared code of the edge passes: the depth buffer, and the surface at a pixel. The WGSL of the look-up comes
// first, then these constants: DepthTexture is the depth texture's type, SAMPLES its samples per pixel, and
// NORMALS the encoding of the texture of normals (none, -1..1, or 0..1).

const NO_NORMALS: u32 = 0u;
const SIGNED_NORMALS: u32 = 1u;

// A box around casters that the maps or the rays lack.
struct Unknown {
    // Corner relative to the eye, in metres.
    least: vec3<f32>,
    // Bits of the layers of maps that are unreliable in the box's shadow.
    maps: u32,
    most: vec3<f32>,
    // 1 if the filter decides in the box's shadow.
    is_filtered: u32,
}

struct Edges {
    // Matrix from a pixel's column and row, and its depth minus the far plane's, to the homogeneous position
    // relative to the eye.
    world_from_pixel: mat4x4<f32>,
    // Eye relative to the origin of the rays, in metres.
    eye: vec3<f32>,
    far_depth: f32,
    // Unit viewing direction.
    forward: vec3<f32>,
    // Least distance from the surface at which rays start, in metres.
    ray_offset: f32,
    // First pixel of the view, and its width and height.
    corner: vec2<u32>,
    size: vec2<u32>,
    // Rounding bounds of a depth: relative and absolute.
    depth_rounding: vec2<f32>,
    // Greatest distance of a point from the pixel's first sample, across or down, in pixels.
    point_reach: f32,
    // Bits of the layers of maps that are unreliable everywhere.
    unsure_maps: u32,
    // Tangent of the sun's angular radius; 0 for a point.
    sun_tangent: f32,
    // Rounding bound of positions in the largest triangles, in metres.
    vertex_rounding: f32,
    padding_1: u32,
    padding_2: u32,
    // xy: position relative to the pixel's first sample, in pixels; zw: position in the sun's disc, in radii
    // from its centre.
    points: array<vec4<f32>, MAX_POINTS>,
    // Used boxes first, then empty ones.
    unknown: array<Unknown, MAX_UNKNOWN>,
}

@group(1) @binding(0) var<uniform> edges: Edges;
@group(1) @binding(1) var depths: DepthTexture;
@group(1) @binding(2) var normals: texture_2d<f32>;
@group(1) @binding(3) var factors: texture_storage_2d<r32float, write>;

// Bit of a factor that is set if the pixel was traced.
const TRACED_BIT: u32 = 1u;

// Greatest relative difference between the depth changes of neighbours on one plane. The normal of a surface
// with this bend is off by less than a degree.
const BENT: f32 = 0.015625;
// Rounding bound of a difference of two differences, in roundings of a depth.
const ROUNDINGS: f32 = 4.0;
// Greatest movement of corners by the rasteriser, in pixels. GPUs have 256 steps per pixel and round to the
// nearest one. WebGPU does not guarantee this.
const SNAP: f32 = 0.00390625;
// Sine of the rounding angle of stored normals, which have ten bits or more.
const STORED_TILT: f32 = 0.002;
// Relative rounding bound of positions relative to the eye.
const POSITION_ROUNDING: f32 = 4.76837158e-7;

// The surface point that is visible at a pixel.
struct Surface {
    // Position relative to the eye, in metres, and the homogeneous w that it was divided by.
    position: vec3<f32>,
    w: f32,
    // Depth minus the far plane's, and its change per pixel on the surface's plane, across and down.
    depth: f32,
    steps: vec2<f32>,
    // Greatest changes of depth that the surface may have, across and down.
    most_steps: vec2<f32>,
    // Unit normal that faces the eye; zero if there is none.
    normal: vec3<f32>,
    // Whether the normal is known: neighbours lie on one plane, or the texture of normals contains it.
    is_known: bool,
    // Whether the texture of normals contains the normal.
    is_stored: bool,
    // Whether all samples of the pixel lie on the plane.
    is_single: bool,
    // Distance from the position, along the line of sight, within which the surface lies, in metres.
    off: vec3<f32>,
    // Sine of the normal's angular error bound.
    tilt: f32,
}

// Returns the depth of a pixel's first sample minus the far plane's depth; 0 where nothing is drawn, and
// outside the view.
fn depth_at(pixel: vec2<i32>) -> f32 {
    if any(pixel < vec2<i32>(0)) || any(pixel >= vec2<i32>(edges.size)) {
        return 0.0;
    }
    return textureLoad(depths, vec2<i32>(edges.corner) + pixel, 0) - edges.far_depth;
}

// Returns the rounding bound of a depth.
fn rounding(depth: f32) -> f32 {
    return abs(depth + edges.far_depth) * edges.depth_rounding.x + edges.depth_rounding.y;
}

// Returns the position of a sample relative to the pixel's centre, in pixels, for WebGPU's pattern of four.
fn sample_place(at: u32) -> vec2<f32> {
    if SAMPLES == 1u {
        return vec2<f32>(0.0);
    }
    switch at {
        case 0u: { return vec2<f32>(-0.125, -0.375); }
        case 1u: { return vec2<f32>(0.375, -0.125); }
        case 2u: { return vec2<f32>(-0.375, 0.125); }
        default: { return vec2<f32>(0.125, 0.375); }
    }
}

// Returns the change of a position per pixel or per depth, from the change of its homogeneous position.
fn moved(change: vec4<f32>, surface: Surface) -> vec3<f32> {
    return (change.xyz - surface.position * change.w) / surface.w;
}

// Returns the change of depth to the next pixel along an axis, the greatest change to one of both neighbours,
// and 1 in z if both lie on one plane with the pixel. If they do not, the change is taken from the neighbour
// that is nearer in depth, so that surfaces behind a silhouette do not count.
fn change(pixel: vec2<i32>, axis: vec2<i32>, depth: f32) -> vec3<f32> {
    let next = depth_at(pixel + axis);
    let previous = depth_at(pixel - axis);
    let after = next - depth;
    let before = depth - previous;
    let rounded = BENT * abs(after + before) + ROUNDINGS * rounding(depth);
    let is_plane = next != 0.0 && previous != 0.0 && abs(after - before) <= rounded;
    let takes_after = previous == 0.0 || (next != 0.0 && abs(after) <= abs(before));
    // A pixel between two empty ones gets the same depth all over.
    let is_alone = next == 0.0 && previous == 0.0;
    let one_side = select(select(before, after, takes_after), 0.0, is_alone);
    let mean = 0.5 * (after + before);
    if is_plane {
        return vec3<f32>(mean, abs(mean), 1.0);
    }
    let most = max(select(0.0, abs(after), next != 0.0), select(0.0, abs(before), previous != 0.0));
    return vec3<f32>(one_side, most, 0.0);
}

// Returns whether the other samples of a pixel lie on the plane of its first one.
fn is_single(pixel: vec2<i32>, depth: f32, steps: vec2<f32>) -> bool {
    var is_on_plane = true;
    for (var at = 1u; at < SAMPLES; at += 1u) {
        let expected = depth + dot(steps, sample_place(at) - sample_place(0u));
        let found = textureLoad(depths, vec2<i32>(edges.corner) + pixel, DEPTH_INDEX) - edges.far_depth;
        let most = BENT * (abs(steps.x) + abs(steps.y)) + ROUNDINGS * rounding(depth);
        is_on_plane = is_on_plane && abs(found - expected) <= most;
    }
    return is_on_plane;
}

// Returns the vector with unit length, or zero.
fn unit(v: vec3<f32>) -> vec3<f32> {
    let squared = dot(v, v);
    return select(vec3<f32>(0.0), v * inverseSqrt(squared), squared > 0.0 && squared < 3e38);
}

// Returns the normal of a pixel's triangle from the texture of normals; zero if it has none.
fn stored_normal(pixel: vec2<i32>) -> vec3<f32> {
    if NORMALS == NO_NORMALS {
        return vec3<f32>(0.0);
    }
    let stored = textureLoad(normals, vec2<i32>(edges.corner) + pixel, 0).xyz;
    // Zero means no normal in either encoding.
    let is_none = all(stored == vec3<f32>(0.0));
    return select(unit(select(stored * 2.0 - 1.0, stored, NORMALS == SIGNED_NORMALS)), stored, is_none);
}

// Returns the surface at a pixel. depth: its depth, not 0.
fn surface_of(pixel: vec2<i32>, depth: f32) -> Surface {
    let m = edges.world_from_pixel;
    let homogeneous = m * vec4<f32>(vec2<f32>(pixel) + sample_place(0u), depth, 1.0);
    var surface: Surface;
    surface.w = homogeneous.w;
    surface.position = homogeneous.xyz / homogeneous.w;
    surface.depth = depth;
    // Direction away from the eye, through the same pixel.
    let ray = moved(m[2], surface);
    let away = select(-ray, ray, dot(ray, edges.forward) > 0.0);
    let normal = stored_normal(pixel);
    // A rounded normal of a surface seen edge-on may point either way. A zero normal has no direction.
    if abs(dot(normal, away)) > STORED_TILT * length(away) {
        surface.normal = select(normal, -normal, dot(normal, away) > 0.0);
        // Along the pixels, the depth changes so that the points stay on the plane.
        let across = dot(normal, moved(m[0], surface));
        let down = dot(normal, moved(m[1], surface));
        surface.steps = -vec2<f32>(across, down) / dot(normal, ray);
        surface.most_steps = abs(surface.steps);
        surface.is_known = true;
        surface.is_stored = true;
        surface.tilt = STORED_TILT;
    } else {
        let across = change(pixel, vec2<i32>(1, 0), depth);
        let down = change(pixel, vec2<i32>(0, 1), depth);
        surface.steps = vec2<f32>(across.x, down.x);
        surface.most_steps = vec2<f32>(across.y, down.y);
        let right = moved(m[0] + m[2] * across.x, surface);
        let below = moved(m[1] + m[2] * down.x, surface);
        let crossed = unit(cross(right, below));
        surface.normal = select(crossed, -crossed, dot(crossed, away) > 0.0);
        surface.is_known = across.z * down.z > 0.0 && any(crossed != vec3<f32>(0.0));
        // Central differences of two depths have the rounding of one depth.
        let rise = abs(dot(ray, crossed)) * rounding(depth);
        surface.tilt = BENT + rise * (inverseSqrt(dot(right, right)) + inverseSqrt(dot(below, below)));
    }
    surface.off = ray * (ROUNDINGS * rounding(depth) + SNAP * (surface.most_steps.x + surface.most_steps.y));
    surface.is_single = is_single(pixel, depth, surface.steps);
    return surface;
}

// Returns the distance above the surface at which rays from a point start, in metres. It is greater than the
// rounding of positions.
fn height_at(position: vec3<f32>) -> f32 {
    return max(edges.ray_offset, POSITION_ROUNDING * (length(position) + length(edges.eye)));
}

// Returns the distances in a map from a pixel to the next on its plane, in texels, across and down.
fn texels_per_pixel(map: shadowfit_Map, surface: Surface) -> array<vec2<f32>, 2> {
    let m = edges.world_from_pixel;
    let right = moved(m[0] + m[2] * surface.steps.x, surface);
    let down = moved(m[1] + m[2] * surface.steps.y, surface);
    return array<vec2<f32>, 2>(
        (map.uv_from_world * vec4<f32>(right, 0.0)).xy * map.size, (map.uv_from_world * vec4<f32>(down, 0.0)).xy * map.size);
}
