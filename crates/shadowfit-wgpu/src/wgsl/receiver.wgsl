// The engine's shader calls shadowfit_factor_at for every visible point.

struct shadowfit_Map {
    uv_from_world: mat4x4<f32>,
    // Depth of a plane changes by dot(this, its normal) / cosine over one texel along u; zero without receiver-plane bias.
    depth_per_texel_u: vec3<f32>,
    constant_depth: f32,
    // The same along v.
    depth_per_texel_v: vec3<f32>,
    slope_depth: f32,
    // Texels in use, from the corner of the layer.
    size: vec2<f32>,
    normal_offset: f32,
    receiver_plane: f32,
    // View depth at which the map ends, and from which the map in front is blended into it; by view depth.
    far: f32,
    blend_near: f32,
    // Layer that it is stored in.
    layer: u32,
    padding_0: u32,
    // Where the map's first texel lies in its layer, in texels: the rest follows it, and wraps around.
    texel_offset: vec2<f32>,
    // Radii along u and v of the disc that look-ups are spread over, in texels: the greatest where it follows the caster.
    disc: vec2<f32>,
    // Radii of the penumbra in texels, for each unit of stored depth from the caster to its shadow.
    penumbra: vec2<f32>,
    padding_1: u32,
    padding_2: u32,
}

struct shadowfit_Receiver {
    to_light: vec3<f32>,
    map_count: u32,
    // View depth is dot(xyz, position) + w.
    view: vec4<f32>,
    // View depth from which on shadows fade, in metres, and over how many they do; they end there where that is 0.
    fade_near: f32,
    fade_width: f32,
    // Radii that discs have at least and at most, in texels.
    least_disc: f32,
    greatest_disc: f32,
    // Pixels by which the pattern that turns discs is moved in this frame.
    frame_shift: f32,
    // 1 for a light that gives nothing.
    is_off: u32,
    padding_0: u32,
    padding_1: u32,
    // In the order in which points try them.
    maps: array<shadowfit_Map, MAX_MAPS>,
}

@group(GROUP) @binding(BINDING_0) var<uniform> shadowfit_receiver: shadowfit_Receiver;

// Below this cosine (89.7 degrees from the light) the slope's tangent is held, so that a grazing
// surface gets a finite bias; it receives next to no light anyway.
const SHADOWFIT_MIN_COSINE: f32 = 0.005;

// Where a point is looked up in a map, and what the look-up needs of the map.
struct shadowfit_Projected {
    // Texels from the map's left and top.
    texel: vec2<f32>,
    // Depth, and biased depth.
    surface: f32,
    depth: f32,
    // Change of the depth of the point's plane over one texel along u and v.
    gradient: vec2<f32>,
    // As in the map.
    layer: u32,
    size: vec2<f32>,
    texel_offset: vec2<f32>,
    disc: vec2<f32>,
    penumbra: vec2<f32>,
    // What a texel is in the coordinates of look-ups.
    unit: vec2<f32>,
}

// Whether texture coordinates and depth lie inside the map.
fn shadowfit_inside(uv: vec3<f32>) -> bool {
    return all(uv >= vec3<f32>(0.0)) && all(uv <= vec3<f32>(1.0));
}

// Where a point is looked up in one map.
// position: world space relative to the origin, metres. normal: unit, geometric.
fn shadowfit_project(map: shadowfit_Map, position: vec3<f32>, normal: vec3<f32>) -> shadowfit_Projected {
    let cosine = clamp(dot(normal, shadowfit_receiver.to_light), SHADOWFIT_MIN_COSINE, 1.0);
    let sine = sqrt(1.0 - cosine * cosine);
    let offset = normal * (map.normal_offset * sine);
    let uv = (map.uv_from_world * vec4<f32>(position + offset, 1.0)).xyz;
    let gradient = vec2<f32>(dot(map.depth_per_texel_u, normal), dot(map.depth_per_texel_v, normal)) / cosine;
    let rise = map.receiver_plane * (abs(gradient.x) + abs(gradient.y));
    let depth = uv.z + map.constant_depth + map.slope_depth * sine / cosine + rise;
    return shadowfit_Projected(
        uv.xy * map.size, uv.z, depth, gradient, map.layer, map.size, map.texel_offset, map.disc, map.penumbra, shadowfit_unit());
}

// View depth of a point: its distance from the eye along the view's forward direction, in metres. Negative behind it.
// position: world space relative to the origin, metres.
fn shadowfit_view_depth(position: vec3<f32>) -> f32 {
    return dot(shadowfit_receiver.view.xyz, position) + shadowfit_receiver.view.w;
}

// Texels between a point and the nearest side of a map; -1 where the map is not in use, or does not hold the point.
// entry: its place in the order.
fn shadowfit_free(entry: u32, map: shadowfit_Map, position: vec3<f32>) -> f32 {
    let uv = (map.uv_from_world * vec4<f32>(position, 1.0)).xyz;
    let free = min(uv.xy, vec2<f32>(1.0) - uv.xy) * map.size;
    let is_held = entry < shadowfit_receiver.map_count && shadowfit_inside(uv);
    return select(-1.0, min(free.x, free.y), is_held);
}

// Which maps a point reads, by their places in the order; -1 for none.
struct shadowfit_Selection {
    first: i32,
    // What the first one is blended into.
    second: i32,
    // Share of the first one.
    weight: f32,
    // By coverage: the first map that holds the point without what the filter reads around it.
    clamped: i32,
    // By view depth: where the first map ends.
    far: f32,
}
