// Our test of a lamp's map: a filter of 3 x 3 look-ups of 2 x 2 texels, one texel apart, each compared with the receiver
// plane's own depth there, and the core's bias for perspective maps. test: constant bias in depth, bias in depth to be
// divided by the distance along the light's axis, constant offset along the normal, receiver-plane bias in texels.
// ours: the rise of a plane's depth along u and v, and 1 where points outside of the light's image are lit.

// Below this cosine between normal and light the plane's depth rises no more.
const MIN_COSINE: f32 = 0.01;

// Change of the stored depth over a texel along u and along v, on the plane through a point with a normal toward the light.
// Both are the same everywhere on a plane.
fn depth_gradient(point: Point, normal: vec3<f32>) -> vec2<f32> {
    // Rows of x and y are the light's axes, as long as the lens makes them.
    let matrix = sample.light_from_world;
    let right = normalize(vec3<f32>(matrix[0].x, matrix[1].x, matrix[2].x));
    let up = normalize(vec3<f32>(matrix[0].y, matrix[1].y, matrix[2].y));
    let to_light = sample.light.xyz - point.position;
    let height = max(dot(normal, to_light), MIN_COSINE * length(to_light));
    return sample.ours.xy * vec2<f32>(dot(normal, right), -dot(normal, up)) / height;
}

fn light_share(point: Point) -> f32 {
    // The side of the surface that the light sees.
    let normal = select(-point.geometric, point.geometric, dot(point.geometric, point.to_light) > 0.0);
    let gradient = depth_gradient(point, normal);
    let seen = seen_at(point.position + normal * sample.test.z);
    let rise = sample.test.w * (abs(gradient.x) + abs(gradient.y));
    let depth = seen.depth - sample.test.x - sample.test.y / seen.w - rise;
    var sum = 0.0;
    for (var y = -1; y <= 1; y += 1) {
        for (var x = -1; x <= 1; x += 1) {
            let texels = vec2<f32>(f32(x), f32(y));
            sum += compared(seen.uv + texels / sample.map_size, depth + dot(gradient, texels));
        }
    }
    return mix(sample.ours.z, sum / 9.0 * light_image_at(point.seen.uv), inside_image(point.seen));
}
