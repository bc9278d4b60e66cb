// Surfaces by whether a map holds them as casters. Comes after overlay.wgsl.

// Numbers of instances: casts no shadow, held by no map, and held by the first map.
const CASTS_NOTHING: u32 = 0u;
const HELD_BY_NONE: u32 = 1u;
const HELD_BY_FIRST: u32 = 2u;

// Colour of surfaces that no map holds, and the brightness of the lines over it, which distinguish it from a
// blue tint.
const COLD: vec3<f32> = vec3<f32>(0.17, 0.2, 0.25);
const COLD_LINE: f32 = 0.55;

fn overlaid(in: SceneOut) -> vec4<f32> {
    let surface = surface_of(in);
    let color = lit(in, surface, mapped_factor(in, surface));
    let gray = luminance(color);
    var shown = vec3<f32>(gray);
    if in.number == HELD_BY_NONE {
        shown = COLD * (0.15 + 0.85 * gray) * mix(1.0, COLD_LINE, hatching(in.clip.xy));
    } else if in.number >= HELD_BY_FIRST {
        let tint = frame.map_tints[min(in.number - HELD_BY_FIRST, 7u)].rgb;
        shown = mix(tint * (0.12 + 1.5 * gray), color, 0.6);
    }
    return vec4<f32>(shown, opacity(surface));
}
