// Screen pixels per texel, as colours. Comes after overlay.wgsl and octave_color.

// Linear grey of surfaces that no map covers, and of their hatching.
const UNCOVERED: f32 = 0.12;
const UNCOVERED_LINE: f32 = 0.3;

// Returns pixels per texel along the worse axis: one over the smaller singular value of texels per pixel.
fn pixels_per_texel(step: Footprint) -> f32 {
    let sum = length(vec2<f32>(step.right.x + step.down.y, step.right.y - step.down.x));
    let difference = length(vec2<f32>(step.right.x - step.down.y, step.right.y + step.down.x));
    let area = abs(step.right.x * step.down.y - step.right.y * step.down.x);
    // On a surface along the light, texels are infinitely long.
    return 0.5 * (sum + difference) / max(area, 1e-20);
}

fn overlaid(in: SceneOut) -> vec4<f32> {
    let surface = surface_of(in);
    let light = relief(surface, mapped_factor(in, surface));
    let place = place_read(in.position);
    var color = vec3<f32>(mix(UNCOVERED, UNCOVERED_LINE, hatching(in.clip.xy)));
    if place >= 0 {
        let pixels = pixels_per_texel(footprint(shadowfit_entry(place), in.position, surface.geometric));
        color = decoded(octave_color(log2(pixels)));
    }
    return vec4<f32>(color * light, opacity(surface));
}
