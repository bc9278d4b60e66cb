// What the edge passes share: the picture's depth buffer, and the surface that a pixel shows. In front of it stands
// the look-up's WGSL, and constants: DepthTexture is the depth texture's type, SAMPLES its samples per pixel, and NORMALS
// what is in the texture of normals: nothing, values in -1..1, or in 0..1.

const NO_NORMALS: u32 = 0u;
const SIGNED_NORMALS: u32 = 1u;

// A box around casters of which the maps, or the rays, know too little.
struct Unknown {
    // Relative to the eye, in metres.
    least: vec3<f32>,
    // Maps, by the bits of their layers, that are not sure under it.
    maps: u32,
    most: vec3<f32>,
    // 1 where the filter decides under it.
    is_filtered: u32,
}

struct Edges {
    // Homogeneous position relative to the eye from a pixel's column and row, and its depth minus the far plane's.
    world_from_pixel: mat4x4<f32>,
    // Eye relative to the origin of the rays, in metres.
    eye: vec3<f32>,
    far_depth: f32,
    // Unit direction of view.
    forward: vec3<f32>,
    // Least distance from the surface at which rays start, in metres.
    ray_offset: f32,
    // First pixel of the picture, and its width and height.
    corner: vec2<u32>,
    size: vec2<u32>,
    // What a depth may be rounded by: a share of it, and a number.
    depth_rounding: vec2<f32>,
    // Greatest distance of a point from the pixel's first sample, across or down, in pixels.
    point_reach: f32,
    // Maps, by the bits of their layers, that are not sure anywhere.
    unsure_maps: u32,
    // Tangent of the sun's angular radius; 0 for a point.
    sun_tangent: f32,
    // What positions in the largest triangles may be rounded by, in metres.
    vertex_rounding: f32,
    padding_1: u32,
    padding_2: u32,
    // xy: from the pixel's first sample, in pixels; zw: from the sun's centre, in its radii.
    points: array<vec4<f32>, MAX_POINTS>,
    // Those in use first; behind them boxes that say nothing.
    unknown: array<Unknown, MAX_UNKNOWN>,
}

@group(1) @binding(0) var<uniform> edges: Edges;
@group(1) @binding(1) var depths: DepthTexture;
@group(1) @binding(2) var normals: texture_2d<f32>;
@group(1) @binding(3) var factors: texture_storage_2d<r32float, write>;

// The lowest bit of a factor says whether the pixel was traced.
const TRACED_BIT: u32 = 1u;

// Neighbours lie on one plane where their depths change by this share of the change more or less. A surface that is bent
// by as little has a normal that is off by less than a degree.
const BENT: f32 = 0.015625;
// What a difference of two differences is rounded by, in roundings of a depth.
const ROUNDINGS: f32 = 4.0;
// Rasterisers move corners by up to this share of a pixel. GPUs have 256 steps in a pixel and round to the nearest one; WebGPU
// promises nothing.
const SNAP: f32 = 0.00390625;
// Sine of the angle by which stored normals are rounded: they have ten bits or more.
const STORED_TILT: f32 = 0.002;
// Positions relative to the eye are rounded by this share of their distance.
const POSITION_ROUNDING: f32 = 4.76837158e-7;

// A point that a pixel shows.
struct Surface {
    // Relative to the eye, in metres, and what it was divided by.
    position: vec3<f32>,
    w: f32,
    // Depth minus the far plane's, and its change on the surface's plane from a pixel to the next, across and down.
    depth: f32,
    steps: vec2<f32>,
    // The greatest changes that the surface may have, across and down.
    most_steps: vec2<f32>,
    // Unit normal on the side of the eye; zero where there is none.
    normal: vec3<f32>,
    // Whether the normal is known: neighbours lie on one plane, or the texture of normals has it.
    is_known: bool,
    // Whether the texture of normals has it.
    is_stored: bool,
    // Whether all samples of the pixel lie on the plane.
    is_single: bool,
    // Distance from the position, along the line of sight, within which the surface lies, in metres.
    off: vec3<f32>,
    // Sine of the angle by which the normal may be off.
    tilt: f32,
}

// Depth of a pixel's first sample minus that of the far plane; 0 where nothing is drawn, and outside the picture.
fn depth_at(pixel: vec2<i32>) -> f32 {
    if any(pixel < vec2<i32>(0)) || any(pixel >= vec2<i32>(edges.size)) {
        return 0.0;
    }
    return textureLoad(depths, vec2<i32>(edges.corner) + pixel, 0) - edges.far_depth;
}

// What a depth may be rounded by.
fn rounding(depth: f32) -> f32 {
    return abs(depth + edges.far_depth) * edges.depth_rounding.x + edges.depth_rounding.y;
}

// Where a sample lies, from the pixel's centre, in pixels: WebGPU's pattern of four.
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

// Change of a position per pixel, or per depth, from that of its homogeneous one.
fn moved(change: vec4<f32>, surface: Surface) -> vec3<f32> {
    return (change.xyz - surface.position * change.w) / surface.w;
}

// Change of depth to the next pixel along an axis, and the greatest change to one of both neighbours; z is 1 where these lie on
// one plane with the pixel. Where they do not, the first is taken from the neighbour that is nearer in depth, so that what lies
// behind a silhouette does not count.
fn change(pixel: vec2<i32>, axis: vec2<i32>, depth: f32) -> vec3<f32> {
    let next = depth_at(pixel + axis);
    let previous = depth_at(pixel - axis);
    let after = next - depth;
    let before = depth - previous;
    let rounded = BENT * abs(after + before) + ROUNDINGS * rounding(depth);
    let is_plane = next != 0.0 && previous != 0.0 && abs(after - before) <= rounded;
    let takes_after = previous == 0.0 || (next != 0.0 && abs(after) <= abs(before));
    // A pixel between two that show nothing is taken to be as deep all over.
    let is_alone = next == 0.0 && previous == 0.0;
    let one_side = select(select(before, after, takes_after), 0.0, is_alone);
    let mean = 0.5 * (after + before);
    if is_plane {
        return vec3<f32>(mean, abs(mean), 1.0);
    }
    let most = max(select(0.0, abs(after), next != 0.0), select(0.0, abs(before), previous != 0.0));
    return vec3<f32>(one_side, most, 0.0);
}

// Whether the other samples of a pixel lie on the plane of its first one.
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

// Unit length, or zero.
fn unit(v: vec3<f32>) -> vec3<f32> {
    let squared = dot(v, v);
    return select(vec3<f32>(0.0), v * inverseSqrt(squared), squared > 0.0 && squared < 3e38);
}

// The normal of a pixel's triangle in the texture of normals; zero where it has none.
fn stored_normal(pixel: vec2<i32>) -> vec3<f32> {
    if NORMALS == NO_NORMALS {
        return vec3<f32>(0.0);
    }
    let stored = textureLoad(normals, vec2<i32>(edges.corner) + pixel, 0).xyz;
    // Zero stands for no normal in either encoding.
    let is_none = all(stored == vec3<f32>(0.0));
    return select(unit(select(stored * 2.0 - 1.0, stored, NORMALS == SIGNED_NORMALS)), stored, is_none);
}

// What a pixel shows. depth: its depth, not 0.
fn surface_of(pixel: vec2<i32>, depth: f32) -> Surface {
    let m = edges.world_from_pixel;
    let homogeneous = m * vec4<f32>(vec2<f32>(pixel) + sample_place(0u), depth, 1.0);
    var surface: Surface;
    surface.w = homogeneous.w;
    surface.position = homogeneous.xyz / homogeneous.w;
    surface.depth = depth;
    // Away from the eye, through the same pixel.
    let ray = moved(m[2], surface);
    let away = select(-ray, ray, dot(ray, edges.forward) > 0.0);
    let normal = stored_normal(pixel);
    // A rounded normal of a surface that is seen edge on may point either way. Zero points nowhere.
    if abs(dot(normal, away)) > STORED_TILT * length(away) {
        surface.normal = select(normal, -normal, dot(normal, away) > 0.0);
        // A plane's depth changes so that its points stay on it.
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
        // The central differences of two depths are rounded as a depth is.
        let rise = abs(dot(ray, crossed)) * rounding(depth);
        surface.tilt = BENT + rise * (inverseSqrt(dot(right, right)) + inverseSqrt(dot(below, below)));
    }
    surface.off = ray * (ROUNDINGS * rounding(depth) + SNAP * (surface.most_steps.x + surface.most_steps.y));
    surface.is_single = is_single(pixel, depth, surface.steps);
    return surface;
}

// Where rays from a point start above its surface, in metres: farther than positions are rounded by.
fn height_at(position: vec3<f32>) -> f32 {
    return max(edges.ray_offset, POSITION_ROUNDING * (length(position) + length(edges.eye)));
}

// Texels of a map from a pixel to the next on its plane, across and down.
fn texels_per_pixel(map: shadowfit_Map, surface: Surface) -> array<vec2<f32>, 2> {
    let m = edges.world_from_pixel;
    let right = moved(m[0] + m[2] * surface.steps.x, surface);
    let down = moved(m[1] + m[2] * surface.steps.y, surface);
    return array<vec2<f32>, 2>(
        (map.uv_from_world * vec4<f32>(right, 0.0)).xy * map.size, (map.uv_from_world * vec4<f32>(down, 0.0)).xy * map.size);
}
