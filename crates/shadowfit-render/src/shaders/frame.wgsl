// Shared by every shader of a frame: the uniform and the sky's colour.

struct Frame {
    clip_from_world: mat4x4<f32>,
    ray_right: vec4<f32>,
    ray_up: vec4<f32>,
    ray_forward: vec4<f32>,
    to_light: vec3<f32>,
    shadows: f32,
    sun: vec3<f32>,
    haze_per_metre: f32,
    zenith: vec4<f32>,
    horizon: vec4<f32>,
    ground: vec4<f32>,
    viewport: vec2<f32>,
    near: f32,
    parallel: f32,
    map_tints: array<vec4<f32>, 8>,
}

@group(0) @binding(0) var<uniform> frame: Frame;

// Returns the linear radiance of the sky along a unit direction, without the sun's disc.
fn sky_radiance(direction: vec3<f32>) -> vec3<f32> {
    let height = direction.y;
    let depth = 1.0 - saturate(height);
    let above = mix(frame.horizon.rgb, frame.zenith.rgb, 1.0 - depth * depth * depth);
    let below = mix(frame.horizon.rgb, frame.ground.rgb, saturate(-height * 4.0));
    let toward_sun = pow8(saturate(dot(direction, frame.to_light)));
    let glow = frame.sun * (0.10 * toward_sun + 0.12 * pow8(toward_sun));
    return select(below, above, height > 0.0) + glow * saturate(1.0 + height * 4.0);
}

// Returns the vector from the eye to a visible point. With an orthographic lens, the vector along the view to
// its depth.
fn line_of_sight(position: vec3<f32>) -> vec3<f32> {
    let forward = frame.ray_forward.xyz;
    return select(position, forward * dot(position, forward), frame.parallel > 0.0);
}

// Fades distant surfaces into the sky behind them.
fn with_haze(radiance: vec3<f32>, position: vec3<f32>) -> vec3<f32> {
    let sight = line_of_sight(position);
    let distance = length(sight);
    let direction = sight / max(distance, 1e-20);
    let level = normalize(vec3<f32>(direction.x, max(direction.y, 0.0) + 0.02, direction.z));
    let haze = 1.0 - exp(-distance * frame.haze_per_metre);
    return mix(radiance, sky_radiance(level), haze * haze);
}
