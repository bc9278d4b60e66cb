// Estimate from the map for the whole area of a pixel, since its few points are only a part of it. The
// look-ups cover the area, and rays correct the error of the look-ups at their points (control variates: P.
// Glasserman, "Monte Carlo methods in financial engineering", 2003).

// Look-ups per axis of a pixel, and in total.
const AREA: u32 = 4u;
const LOOK_UPS: u32 = AREA * AREA;

struct Estimate {
    // Whether a map covers the pixel, and there are several points. If not, the estimate is 0.
    is_known: bool,
    projected: shadowfit_Projected,
    // Texels to the next pixel across and down.
    steps: array<vec2<f32>, 2>,
}

// This estimate needs no search for casters.
fn casters_of(unsure: Unsure) -> vec2<f32> {
    return vec2<f32>(0.0);
}

fn estimate_of(unsure: Unsure, casters: vec2<f32>) -> Estimate {
    let selection = shadowfit_select(unsure.surface.position);
    let map = shadowfit_entry(max(selection.first, 0));
    let projected = shadowfit_project(map, unsure.surface.position, unsure.surface.normal);
    return Estimate(POINTS > 1u && selection.first >= 0, projected, texels_per_pixel(map, unsure.surface));
}

// Returns the estimate at a point of the pixel.
fn estimate_at(map: Estimate, place: vec2<f32>, in_sun: vec2<f32>) -> f32 {
    if !map.is_known {
        return 0.0;
    }
    return shadowfit_look_up(map.projected.texel + map.steps[0] * place.x + map.steps[1] * place.y, map.projected);
}

// Returns one of the look-ups that cover the whole pixel.
fn estimate_part(map: Estimate, look_up: u32) -> f32 {
    let place = (vec2<f32>(f32(look_up % AREA), f32(look_up / AREA)) + 0.5) / f32(AREA) - 0.5;
    return estimate_at(map, place - sample_place(0u), vec2<f32>(0.0));
}
