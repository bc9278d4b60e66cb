// Tone curve: Khronos PBR Neutral (Khronos Group, 2024), which preserves base colours and compresses only
// values brighter than the display.
fn tone_map(radiance: vec3<f32>) -> vec3<f32> {
    let start = 0.8 - 0.04;
    let desaturation = 0.15;
    let low = min(radiance.r, min(radiance.g, radiance.b));
    let offset = select(0.04, low - 6.25 * low * low, low < 0.08);
    let color = radiance - offset;
    let peak = max(color.r, max(color.g, color.b));
    if peak < start {
        return color;
    }
    let room = 1.0 - start;
    let new_peak = 1.0 - room * room / (peak + room - start);
    let scaled = color * (new_peak / peak);
    let gray = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(scaled, vec3<f32>(new_peak), gray);
}
