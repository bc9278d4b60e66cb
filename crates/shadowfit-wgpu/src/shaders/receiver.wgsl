// The engine's fragment shader calls shadowfit_factor for every visible point.

struct shadowfit_Map {
    uv_from_world: mat4x4<f32>,
    constant_depth: f32,
    slope_depth: f32,
    normal_offset: f32,
    padding: f32,
}

struct shadowfit_Receiver {
    to_light: vec3<f32>,
    map_count: u32,
    maps: array<shadowfit_Map, MAX_MAPS>,
}

@group(GROUP) @binding(0) var<uniform> shadowfit_receiver: shadowfit_Receiver;

// Below this cosine (89.4 degrees from the light) the slope's tangent is held, so that a grazing
// surface gets a finite bias; it receives next to no light anyway.
const SHADOWFIT_MIN_COSINE: f32 = 0.01;

// Whether texture coordinates and depth lie inside the map.
fn shadowfit_inside(uv: vec3<f32>) -> bool {
    return all(uv >= vec3<f32>(0.0)) && all(uv <= vec3<f32>(1.0));
}

// Texture coordinates (x right, y down) and biased depth of a point in one map.
// position: world space relative to the origin, metres. normal: unit, geometric.
fn shadowfit_project(map: shadowfit_Map, position: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    let cosine = clamp(dot(normal, shadowfit_receiver.to_light), SHADOWFIT_MIN_COSINE, 1.0);
    let sine = sqrt(1.0 - cosine * cosine);
    let offset = normal * (map.normal_offset * sine);
    let uv = (map.uv_from_world * vec4<f32>(position + offset, 1.0)).xyz;
    return vec3<f32>(uv.xy, uv.z + map.constant_depth + map.slope_depth * sine / cosine);
}

// Whether a map is in use and covers a point.
fn shadowfit_covers(index: u32, map: shadowfit_Map, position: vec3<f32>) -> bool {
    let uv = (map.uv_from_world * vec4<f32>(position, 1.0)).xyz;
    return index < shadowfit_receiver.map_count && shadowfit_inside(uv);
}
