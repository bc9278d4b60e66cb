// The sky behind everything, drawn at the far plane by one triangle.

struct SkyVertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) ndc: vec2<f32>,
}

@vertex
fn vs_sky(@builtin(vertex_index) index: u32) -> SkyVertex {
    let ndc = vec2<f32>(f32((index << 1u) & 2u), f32(index & 2u)) * 2.0 - 1.0;
    return SkyVertex(vec4<f32>(ndc, 0.0, 1.0), ndc);
}

// The sun's disc is larger than the real 0.27 degrees so that it is easy to find.
const SUN_COSINE: f32 = 0.99980;
const SUN_SOFTNESS: f32 = 0.00006;

// Whether it is dim and grey, behind overlays whose colours have a meaning.
override GRAY: bool = false;

@fragment
fn fs_sky(in: SkyVertex) -> @location(0) vec4<f32> {
    let aside = frame.ray_right.xyz * in.ndc.x + frame.ray_up.xyz * in.ndc.y;
    let direction = normalize(aside * (1.0 - frame.parallel) + frame.ray_forward.xyz);
    let disc = smoothstep(SUN_COSINE - SUN_SOFTNESS, SUN_COSINE, dot(direction, frame.to_light));
    let radiance = sky_radiance(direction) + frame.sun * (4.0 * disc * saturate(direction.y * 50.0));
    let color = tone_map(radiance);
    let gray = vec3<f32>(0.25 * dot(color, vec3<f32>(0.2126, 0.7152, 0.0722)));
    return vec4<f32>(select(color, gray, GRAY), 1.0);
}
