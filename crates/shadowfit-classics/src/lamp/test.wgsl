// Our test of a lamp's map: a filter of 3 x 3 look-ups of 2 x 2 texels, one texel apart. Each look-up is
// compared with the receiver plane's depth there, with the core's bias for perspective maps. test: constant
// bias in depth, bias in depth to be divided by the distance along the light's axis, constant offset along
// the normal, receiver-plane bias in texels. further: the rise of a plane's depth along u and v, and 1 if
// points outside of the light's image are lit.

// Least cosine between normal and light in the gradient. Below it the plane's depth gradient stays constant.
const MIN_COSINE: f32 = 0.005;

// Change of the stored depth over a texel along u and along v, on the plane through a point with a normal
// toward the light. Both are constant over a plane. `rise`: change per texel of a plane at unit distance.
fn lamp_gradient(light_from_world: mat4x4<f32>, rise: vec2<f32>, to_light: vec3<f32>, normal: vec3<f32>) -> vec2<f32> {
    // Rows of x and y are the light's axes, scaled by the lens.
    let matrix = light_from_world;
    let right = normalize(vec3<f32>(matrix[0].x, matrix[1].x, matrix[2].x));
    let up = normalize(vec3<f32>(matrix[0].y, matrix[1].y, matrix[2].y));
    let height = max(dot(normal, to_light), MIN_COSINE * length(to_light));
    return rise * vec2<f32>(dot(normal, right), -dot(normal, up)) / height;
}

// Depth that the middle look-up compares. `depth` and `distance` (along the light's axis) belong to the
// offset point.
fn lamp_compared_depth(depth: f32, distance: f32, bias: vec4<f32>, gradient: vec2<f32>) -> f32 {
    let rise = bias.w * (abs(gradient.x) + abs(gradient.y));
    return depth - bias.x - bias.y / distance - rise;
}

fn light_share(point: Point) -> f32 {
    // Normal on the side of the surface that faces the light.
    let normal = select(-point.geometric, point.geometric, dot(point.geometric, point.to_light) > 0.0);
    let to_light = sample.light.xyz - point.position;
    let gradient = lamp_gradient(sample.light_from_world, sample.further.xy, to_light, normal);
    let seen = seen_at(point.position + normal * sample.test.z);
    let depth = lamp_compared_depth(seen.depth, seen.w, sample.test, gradient);
    var sum = 0.0;
    for (var y = -1; y <= 1; y += 1) {
        for (var x = -1; x <= 1; x += 1) {
            let texels = vec2<f32>(f32(x), f32(y));
            sum += compared(seen.uv + texels / sample.map_size, depth + dot(gradient, texels));
        }
    }
    return mix(sample.further.z, sum / 9.0 * light_image_at(point.seen.uv), inside_image(point.seen));
}
