// Our test of a lamp's map: the core's bias, and a filter of 3 x 3 look-ups of 2 x 2 texels, one texel apart. test.x: depth
// bias, test.y: depth bias to be divided by the lifted point's distance along the light's axis, test.z: depth bias by slope,
// test.w: 1 where points outside of the light's image are lit. lift.x: offset along the normal times the distance along the
// axis and the sine of the angle to it, lift.y: offset at every slope and distance.

// The light's distance from a point's plane counts as at least this share of that from the point.
const LEAST_COSINE: f32 = 0.01;

fn ours_lift(normal_offset: f32, constant_offset: f32, w: f32, sine: f32) -> f32 {
    return normal_offset * w * sine + constant_offset;
}

// height: the light's distance from the point's plane.
fn ours_depth(constant_depth: f32, distance_depth: f32, slope_depth: f32, w: f32, sine: f32, height: f32) -> f32 {
    return constant_depth + distance_depth / w + slope_depth * sine / height;
}

fn light_share(point: Point) -> f32 {
    let normal = select(-point.geometric, point.geometric, dot(point.geometric, point.to_light) >= 0.0);
    // The w row of a perspective's matrix.
    let axis = normalize(
        vec3<f32>(sample.light_from_world[0].w, sample.light_from_world[1].w, sample.light_from_world[2].w));
    let sine = length(cross(normal, axis));
    let away = sample.light.xyz - point.position;
    let height = max(dot(normal, away), LEAST_COSINE * length(away));
    let seen = seen_at(point.position + normal * ours_lift(sample.lift.x, sample.lift.y, point.seen.w, sine));
    let depth = seen.depth - ours_depth(sample.test.x, sample.test.y, sample.test.z, seen.w, sine, height);
    var sum = 0.0;
    for (var y = -1; y <= 1; y += 1) {
        for (var x = -1; x <= 1; x += 1) {
            sum += compared(seen.uv + vec2<f32>(f32(x), f32(y)) / sample.map_size, depth);
        }
    }
    return mix(sample.test.w, sum / 9.0 * light_image_at(point.seen.uv), inside_image(point.seen));
}
