// The engine's shader calls shadowfit_factor_at for every visible point.

struct shadowfit_Map {
    uv_from_world: mat4x4<f32>,
    // Over one texel along u, the depth of a plane changes by dot(this, normal) / dot(normal, to_light), for
    // its unit normal. Zero without receiver-plane bias.
    depth_per_texel_u: vec3<f32>,
    constant_depth: f32,
    // Likewise over one texel along v.
    depth_per_texel_v: vec3<f32>,
    slope_depth: f32,
    // Used texels, from the corner of the layer.
    size: vec2<f32>,
    normal_offset: f32,
    receiver_plane: f32,
    // View depth where the map ends, and view depth where the blend from the previous map begins. Used with
    // selection by view depth.
    far: f32,
    blend_near: f32,
    // Layer that contains the map.
    layer: u32,
    padding_0: u32,
    // Position of the map's first texel in its layer, in texels. The map wraps around from there.
    texel_offset: vec2<f32>,
    // Radii along u and v of the disc of look-ups, in texels. If the disc depends on the caster's distance,
    // these are the greatest radii.
    disc: vec2<f32>,
    // Radii of the penumbra in texels, per unit of stored depth between the caster and its shadow.
    penumbra: vec2<f32>,
    padding_1: u32,
    padding_2: u32,
}

struct shadowfit_Receiver {
    to_light: vec3<f32>,
    map_count: u32,
    // Coefficients of the view depth, dot(xyz, position) + w.
    view: vec4<f32>,
    // View depth where shadows begin to fade, and width of the fade, in metres. A width of 0 makes a hard
    // end.
    fade_near: f32,
    fade_width: f32,
    // Least and greatest radius of discs, in texels.
    least_disc: f32,
    greatest_disc: f32,
    // Shift of the rotation pattern of discs in this frame, in pixels.
    frame_shift: f32,
    // 1 if the light is off.
    is_off: u32,
    padding_0: u32,
    padding_1: u32,
    // Maps in selection order.
    maps: array<shadowfit_Map, MAX_MAPS>,
}

@group(GROUP) @binding(BINDING_0) var<uniform> shadowfit_receiver: shadowfit_Receiver;

// Below this cosine (89.7 degrees from the light) the slope's tangent is clamped, so that grazing surfaces
// have a finite bias. They receive almost no light.
const SHADOWFIT_MIN_COSINE: f32 = 0.005;

// Position of a point in a map, and the map's values that the look-up needs.
struct shadowfit_Projected {
    // Texels from the map's left and top.
    texel: vec2<f32>,
    // Depth, and biased depth.
    surface: f32,
    depth: f32,
    // Depth change of the point's plane over one texel along u and v.
    gradient: vec2<f32>,
    // Fields of the map.
    layer: u32,
    size: vec2<f32>,
    texel_offset: vec2<f32>,
    disc: vec2<f32>,
    penumbra: vec2<f32>,
    // Size of a texel in look-up coordinates.
    unit: vec2<f32>,
}

// Returns whether texture coordinates and depth lie inside the map.
fn shadowfit_inside(uv: vec3<f32>) -> bool {
    return all(uv >= vec3<f32>(0.0)) && all(uv <= vec3<f32>(1.0));
}

// Returns the position of a point in one map. position: world space relative to the origin, metres. normal:
// unit, geometric.
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

// Returns the view depth of a point: its distance from the eye along the view's forward direction, in metres.
// It is negative behind the eye. position: world space relative to the origin, metres.
fn shadowfit_view_depth(position: vec3<f32>) -> f32 {
    return dot(shadowfit_receiver.view.xyz, position) + shadowfit_receiver.view.w;
}

// Returns the texels between a point and the nearest side of a map; -1 if the map is not used or does not
// contain the point. entry: index of the map in the order.
fn shadowfit_free(entry: u32, map: shadowfit_Map, position: vec3<f32>) -> f32 {
    let uv = (map.uv_from_world * vec4<f32>(position, 1.0)).xyz;
    let free = min(uv.xy, vec2<f32>(1.0) - uv.xy) * map.size;
    let is_held = entry < shadowfit_receiver.map_count && shadowfit_inside(uv);
    return select(-1.0, min(free.x, free.y), is_held);
}

// Maps that a point reads, by their index in the order; -1 for none.
struct shadowfit_Selection {
    first: i32,
    // Map that the first one is blended into.
    second: i32,
    // Share of the first map.
    weight: f32,
    // By coverage: the first map that contains the point, but not the filter's footprint around it.
    clamped: i32,
    // By view depth: end of the first map.
    far: f32,
}
