// What a map says about the area of a pixel, of which its few points are a part: all of it is looked up, and rays correct
// what is wrong by where they are (control variates: P. Glasserman, "Monte Carlo methods in financial engineering", 2003).

// Look-ups across and down a pixel.
const AREA: u32 = 4u;

struct Estimate {
    // Whether a map holds the pixel, and there are several points.
    is_known: bool,
    projected: shadowfit_Projected,
    // Texels to the next pixel across and down.
    right: vec2<f32>,
    down: vec2<f32>,
}

fn estimate_of(pixel: vec2<i32>, surface: Surface, across: Across) -> Estimate {
    let choice = shadowfit_choose(surface.position);
    let map = shadowfit_entry(max(choice.first, 0));
    let texels = texels_per_pixel(map, surface);
    let projected = shadowfit_project(map, surface.position, surface.normal);
    return Estimate(resolve.point_count > 1u && choice.first >= 0, projected, texels[0], texels[1]);
}

// At a point of the pixel.
fn estimate_at(map: Estimate, place: vec2<f32>, in_sun: vec2<f32>) -> f32 {
    if !map.is_known {
        return 0.0;
    }
    return shadowfit_look_up(map.projected.texel + map.right * place.x + map.down * place.y, map.projected);
}

// On the whole pixel, as far as points may lie.
fn estimate_whole(map: Estimate, sides: array<vec2<f32>, 2>) -> f32 {
    var sum = 0.0;
    for (var at = 0u; map.is_known && at < AREA * AREA; at += 1u) {
        let place = (vec2<f32>(f32(at % AREA), f32(at / AREA)) + 0.5) / f32(AREA) - 0.5;
        sum += estimate_at(map, clamp(place - sample_place(0u), sides[1], sides[0]), vec2<f32>(0.0));
    }
    return sum / f32(AREA * AREA);
}
