// Our test of a lamp's map: the core's bias, and a filter of 3 x 3 look-ups of 2 x 2 texels, one texel apart. test.x: constant
// bias in depth, test.y: offset along the normal times the distance along the light's axis, test.z: 1 where points outside of
// the light's image are lit.

fn light_share(point: Point) -> f32 {
    let cosine = saturate(dot(point.geometric, point.to_light));
    let sine = sqrt(1.0 - cosine * cosine);
    let seen = seen_at(point.position + point.geometric * (sample.test.y * point.seen.w * sine));
    var sum = 0.0;
    for (var y = -1; y <= 1; y += 1) {
        for (var x = -1; x <= 1; x += 1) {
            let uv = seen.uv + vec2<f32>(f32(x), f32(y)) / sample.map_size;
            sum += compared(uv, seen.depth - sample.test.x);
        }
    }
    return mix(sample.test.z, sum / 9.0 * light_image_at(point.seen.uv), inside_image(point.seen));
}
