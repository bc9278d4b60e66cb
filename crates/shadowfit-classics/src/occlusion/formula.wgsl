// The formulas of screen-space ambient occlusion. formula.rs has the same in Rust and names the sources.

// Occlusion of a point by a neighbour, both in view space, before the intensity.
fn occlusion_term(normal: vec3<f32>, position: vec3<f32>, neighbour: vec3<f32>, scale: f32, bias: f32) -> f32 {
    let difference = neighbour - position;
    let distance = length(difference);
    let cosine = dot(normal, difference) / max(distance, 1e-6);
    return max(cosine - bias, 0.0) / (1.0 + distance * scale);
}

// Number of a pixel's random vector: a dither matrix of 4x4 pixels.
fn occlusion_order(pixel: vec2<u32>) -> f32 {
    var order = array<u32, 16>(0u, 8u, 2u, 10u, 12u, 4u, 14u, 6u, 3u, 11u, 1u, 9u, 15u, 7u, 13u, 5u);
    return f32(order[(pixel.y % 4u) * 4u + pixel.x % 4u]);
}

// Unit vector that reflects a pixel's directions.
fn occlusion_random(pixel: vec2<u32>) -> vec2<f32> {
    let angle = occlusion_order(pixel) * 0.834485757;
    return vec2<f32>(cos(angle), sin(angle));
}

// Unit vector of a height and a number of golden angles.
fn occlusion_spiral(z: f32, turns: f32) -> vec3<f32> {
    let angle = turns * 2.3999632;
    return vec3<f32>(vec2<f32>(cos(angle), sin(angle)) * sqrt(1.0 - z * z), z);
}

// Unit vector that reflects the sphere's points.
fn occlusion_random_3d(pixel: vec2<u32>) -> vec3<f32> {
    let index = occlusion_order(pixel);
    return occlusion_spiral(1.0 - (index + 0.5) / 8.0, index);
}

// One of six directions in texture coordinates. Only the level of detail uses the diagonals.
fn occlusion_direction(index: u32) -> vec2<f32> {
    var directions = array<vec2<f32>, 6>(
        vec2<f32>(1.0, 0.0), vec2<f32>(-1.0, 0.0), vec2<f32>(0.0, 1.0), vec2<f32>(0.0, -1.0),
        vec2<f32>(0.70710678, 0.70710678), vec2<f32>(-0.70710678, -0.70710678));
    return directions[index];
}

// The step of a direction in texture coordinates.
fn occlusion_step(direction: vec2<f32>, random: vec2<f32>, radius: f32, view_depth: f32) -> vec2<f32> {
    return reflect(direction, random) * (radius / view_depth);
}

// Offset of a neighbour, 0 to 3, in texture coordinates. back: 1 for back faces, else 0.
fn occlusion_offset(step: vec2<f32>, neighbour: u32, back: f32) -> vec2<f32> {
    let turned = vec2<f32>(step.x - step.y, step.x + step.y) * 0.70710678;
    let share = 0.25 * f32(neighbour + 1u) + 0.125 * back;
    return share * select(turned, step, neighbour % 2u == 0u);
}

// Number of directions at a view depth. detail: 1 with level of detail, else 0.
fn occlusion_directions(view_depth: f32, far: f32, detail: f32) -> u32 {
    let count = 6.0 - 4.0 * saturate(view_depth / far);
    return u32(mix(4.0, trunc(count), detail));
}

// Occlusion from the sums of the terms of both position buffers.
fn occlusion_sum(front: f32, back: f32, intensity: f32, directions: u32) -> f32 {
    return saturate((front * intensity + back) / f32(4u * directions));
}

// A point in the unit sphere, 0 to 15. An odd point is opposite to the previous one.
fn occlusion_sphere(index: u32) -> vec3<f32> {
    let pair = index / 2u;
    let length = (f32(pair * 5u % 8u) + 0.5) / 8.0;
    let point = occlusion_spiral(1.0 - (f32(pair) + 0.5) / 4.0, f32(pair)) * pow(length, 1.0 / 3.0);
    return point * select(-1.0, 1.0, index % 2u == 0u);
}

// Occlusion by the visible surface at a point of the sphere, by their view depths.
fn occlusion_behind(point_depth: f32, surface_depth: f32, radius: f32) -> f32 {
    let nearer = point_depth - surface_depth;
    return select(0.0, saturate(2.0 - nearer / radius), nearer > 0.0);
}
