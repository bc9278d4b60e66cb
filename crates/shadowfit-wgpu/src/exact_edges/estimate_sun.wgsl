// Estimate from the map for rays to a sun with a radius. It assumes that all casters have the mean distance,
// as the PCSS filter does, so that each ray corresponds to one texel. Many look-ups cover the disc, and rays
// correct the error of the look-ups at their places (control variates: P. Glasserman, "Monte Carlo methods in
// financial engineering", 2003).

// Look-ups over the sun's disc.
const LOOK_UPS: u32 = 32u;

struct Estimate {
    // Whether a map covers the pixel, and contains casters toward the sun. If not, the estimate is 0.
    is_known: bool,
    projected: shadowfit_Projected,
    // Texels at the casters' distance per sun radius, along the two directions perpendicular to the light.
    x: vec2<f32>,
    y: vec2<f32>,
}

// Returns the sum of the distances to casters, in units of the stored depth, and their number.
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
    // Change of depth per metre toward the light.
    let m = map.uv_from_world;
    let depth = dot(vec3<f32>(m[0].z, m[1].z, m[2].z), shadowfit_receiver.to_light);
    let radius = -casters.x / (max(casters.y, 1.0) * depth) * edges.sun_tangent;
    let x = (m * vec4<f32>(unsure.across.x * radius, 0.0)).xy * map.size;
    let y = (m * vec4<f32>(unsure.across.y * radius, 0.0)).xy * map.size;
    return Estimate(casters.y > 0.0, projected, x, y);
}

// Returns the estimate for the ray to a place in the sun's disc.
fn estimate_at(map: Estimate, place: vec2<f32>, in_sun: vec2<f32>) -> f32 {
    if !map.is_known {
        return 0.0;
    }
    return shadowfit_look_up(map.projected.texel + map.x * in_sun.x + map.y * in_sun.y, map.projected);
}

// Returns one of the look-ups over the disc.
fn estimate_part(map: Estimate, look_up: u32) -> f32 {
    // The golden angle, pi (3 - sqrt 5).
    let angle = f32(look_up) * 2.39996323;
    let place = vec2<f32>(cos(angle), sin(angle)) * sqrt((f32(look_up) + 0.5) / f32(LOOK_UPS));
    return estimate_at(map, vec2<f32>(0.0), place);
}
