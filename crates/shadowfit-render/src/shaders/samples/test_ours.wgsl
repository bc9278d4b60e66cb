// Our test of a lamp's map: the core's bias for perspective maps, and a filter of 3 x 3 look-ups of 2 x 2 texels, one texel
// apart. test: constant bias in depth, bias in depth to be divided by the distance along the light's axis, offset along the
// normal per distance and sine of the angle to the axis, constant offset.

// Where a point is looked up.
fn lifted(point: Point) -> Seen {
    // The row of w is the light's axis: w is the distance along it.
    let matrix = sample.light_from_world;
    let axis = vec3<f32>(matrix[0].w, matrix[1].w, matrix[2].w);
    // The side of the surface that the light sees.
    let normal = point.geometric * sign(dot(point.geometric, point.to_light));
    let sine = length(cross(normal, axis));
    return seen_at(point.position + normal * (sample.test.z * point.seen.w * sine + sample.test.w));
}

fn light_share(point: Point) -> f32 {
    let seen = lifted(point);
    let depth = seen.depth - sample.test.x - sample.test.y / seen.w;
    var sum = 0.0;
    for (var y = -1; y <= 1; y += 1) {
        for (var x = -1; x <= 1; x += 1) {
            sum += compared(seen.uv + vec2<f32>(f32(x), f32(y)) / sample.map_size, depth);
        }
    }
    return mix(sample.lit_outside, sum / 9.0 * light_image_at(point.seen.uv), inside_image(point.seen));
}
