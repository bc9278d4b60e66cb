// What a map says about the rays to a sun with a radius: where its casters are as far away as they are in the mean, as in
// the filter that follows them, each ray meets one texel. Many are looked up, and rays correct what is wrong by where they
// are (control variates: P. Glasserman, "Monte Carlo methods in financial engineering", 2003).

// Look-ups over the sun's disc.
const LOOK_UPS: u32 = 32u;

struct Estimate {
    // Whether a map holds the pixel, and casters in the way. Where it is not known it is 0.
    is_known: bool,
    projected: shadowfit_Projected,
    // Texels at the casters, for each of the sun's radii across the light.
    x: vec2<f32>,
    y: vec2<f32>,
}

// Sum of the distances to casters, in units of the stored depth, and their number.
fn casters_of(unsure: Unsure) -> vec2<f32> {
    let selection = shadowfit_select(unsure.surface.position);
    if selection.first < 0 {
        return vec2<f32>(0.0);
    }
    let map = shadowfit_entry(selection.first);
    let projected = shadowfit_project(map, unsure.surface.position, unsure.surface.normal);
    return shadowfit_casters(projected, shadowfit_turn(vec2<f32>(unsure.pixel)));
}

fn estimate_of(unsure: Unsure, casters: vec2<f32>) -> Estimate {
    let selection = shadowfit_select(unsure.surface.position);
    let map = shadowfit_entry(max(selection.first, 0));
    let projected = shadowfit_project(map, unsure.surface.position, unsure.surface.normal);
    // Depth per metre toward the light.
    let m = map.uv_from_world;
    let depth = dot(vec3<f32>(m[0].z, m[1].z, m[2].z), shadowfit_receiver.to_light);
    let radius = -casters.x / (max(casters.y, 1.0) * depth) * edges.sun_tangent;
    let x = (m * vec4<f32>(unsure.across.x * radius, 0.0)).xy * map.size;
    let y = (m * vec4<f32>(unsure.across.y * radius, 0.0)).xy * map.size;
    return Estimate(casters.y > 0.0, projected, x, y);
}

// For the ray to a place in the sun's disc.
fn estimate_at(map: Estimate, place: vec2<f32>, in_sun: vec2<f32>) -> f32 {
    if !map.is_known {
        return 0.0;
    }
    return shadowfit_look_up(map.projected.texel + map.x * in_sun.x + map.y * in_sun.y, map.projected);
}

// One of the look-ups over the disc.
fn estimate_part(map: Estimate, look_up: u32) -> f32 {
    // The golden angle, pi (3 - sqrt 5).
    let angle = f32(look_up) * 2.39996323;
    let place = vec2<f32>(cos(angle), sin(angle)) * sqrt((f32(look_up) + 0.5) / f32(LOOK_UPS));
    return estimate_at(map, vec2<f32>(0.0), place);
}
