// The picture in grey, with colours for pixels whose edges were traced and for pixels left to the filter.
// Comes after overlay.wgsl.

// Brightness of a colour in the dark, and the increase toward full light.
const DARK: f32 = 0.3;
const LIGHT: f32 = 0.7;

fn overlaid(in: SceneOut) -> vec4<f32> {
    let surface = surface_of(in);
    let factor = mapped_factor(in, surface);
    let brightness = relief(surface, factor);
    let is_facing = dot(surface.geometric, frame.to_light) > 0.0 && frame.shadows > 0.0;
    // Edges of blended surfaces are not traced.
    let is_blended = material.blended > 0.0;
    let is_filtered = is_facing && (is_blended || shadowfit_is_filtered(in.clip.xy));
    let is_traced = !is_blended && shadowfit_is_traced(in.clip.xy);
    var color = vec3<f32>(0.5 * brightness);
    if is_filtered {
        color = edge_color(1u) * mix(DARK, LIGHT, brightness);
    }
    if is_traced {
        color = edge_color(0u) * mix(DARK, LIGHT, brightness);
    }
    return vec4<f32>(color, opacity(surface));
}
