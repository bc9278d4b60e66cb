// Surfaces with the shadows that rays found. Comes after overlay.wgsl and judged.wgsl.

// Brightness of the hatching over surfaces that were not judged.
const HATCHING: f32 = 0.72;

fn overlaid(in: SceneOut) -> vec4<f32> {
    let surface = surface_of(in);
    let mapped = mapped_factor(in, surface);
    let bits = judged_of(in.position, in.clip.xy);
    // The judged picture shows the surfaces behind blended ones.
    let is_opaque = material.blended == 0.0;
    let is_judged = is_opaque & ((bits & CLASS) != 0u);
    let truth = select(0.0, 1.0, (bits & LIT) != 0u);
    let color = lit(in, surface, select(mapped, truth, is_judged));
    let is_open = is_opaque & !is_judged & (dot(surface.geometric, frame.to_light) > 0.0);
    let hatched = color * mix(1.0, HATCHING, hatching(in.clip.xy));
    return vec4<f32>(select(color, hatched, is_open), opacity(surface));
}
