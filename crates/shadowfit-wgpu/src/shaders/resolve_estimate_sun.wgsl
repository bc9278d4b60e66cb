// What a map says about the rays to a sun with a radius: where its casters are as far away as they are in the mean, as in
// the filter that follows them, each ray meets one texel. Many are looked up, and rays correct what is wrong by where they
// are (control variates: P. Glasserman, "Monte Carlo methods in financial engineering", 2003).

// Look-ups over the sun's disc.
const DISC: u32 = 32u;

struct Estimate {
    // Whether a map holds the pixel, and casters in the way.
    is_known: bool,
    projected: shadowfit_Projected,
    // Texels at the casters, for each of the sun's radii across the light.
    x: vec2<f32>,
    y: vec2<f32>,
}

fn estimate_of(pixel: vec2<i32>, surface: Surface, across: Across) -> Estimate {
    let choice = shadowfit_choose(surface.position);
    let map = shadowfit_entry(max(choice.first, 0));
    let projected = shadowfit_project(map, surface.position, surface.normal);
    let found = shadowfit_casters(projected, shadowfit_turn(vec2<f32>(pixel)));
    // Depth per metre toward the light.
    let m = map.uv_from_world;
    let depth = dot(vec3<f32>(m[0].z, m[1].z, m[2].z), shadowfit_receiver.to_light);
    let radius = -found.x / (max(found.y, 1.0) * depth) * resolve.sun_tangent;
    let x = (m * vec4<f32>(across.x * radius, 0.0)).xy * map.size;
    let y = (m * vec4<f32>(across.y * radius, 0.0)).xy * map.size;
    return Estimate(choice.first >= 0 && found.y > 0.0, projected, x, y);
}

// For the ray to a place in the sun's disc.
fn estimate_at(map: Estimate, place: vec2<f32>, in_sun: vec2<f32>) -> f32 {
    if !map.is_known {
        return 0.0;
    }
    return shadowfit_look_up(map.projected.texel + map.x * in_sun.x + map.y * in_sun.y, map.projected);
}

// For the whole disc.
fn estimate_whole(map: Estimate, sides: array<vec2<f32>, 2>) -> f32 {
    var direction = vec2<f32>(1.0, 0.0);
    var sum = 0.0;
    for (var at = 0u; map.is_known && at < DISC; at += 1u) {
        sum += estimate_at(map, vec2<f32>(0.0), direction * sqrt((f32(at) + 0.5) / f32(DISC)));
        direction = shadowfit_golden(direction);
    }
    return sum / f32(DISC);
}
