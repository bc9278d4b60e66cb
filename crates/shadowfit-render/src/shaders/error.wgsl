// The picture in dim grey, and its wrong pixels in the colour of their class. Comes after overlay.wgsl and judged.wgsl.

// Brightness of pixels that are not wrong: in the dark, and the increase toward full light.
const DARK: f32 = 0.015;
const DIMMED: f32 = 0.35;

fn overlaid(in: SceneOut) -> vec4<f32> {
    let surface = surface_of(in);
    let kind = judged_of(in.position, in.clip.xy) & CLASS;
    let gray = vec3<f32>(DARK + DIMMED * luminance(lit(in, surface, mapped_factor(in, surface))));
    // The judged picture shows the surfaces behind blended ones.
    let is_wrong = kind >= FIRST_WRONG && material.blended == 0.0;
    return vec4<f32>(select(gray, error_color(kind), is_wrong), opacity(surface));
}
