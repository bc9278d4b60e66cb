// The texels of the map that a point reads, drawn on its surface. Comes after overlay.wgsl.

// Smallest width that is drawn, in pixels. Narrower texels are joined to blocks of 4, 16, 64... texels per
// side.
const LEAST_PIXELS: f32 = 6.0;
// Brightness of the darker texels and of the lines between texels, as a share of the brighter ones'.
const DARKER: f32 = 0.62;
const LINE: f32 = 0.35;

// Mean over a pixel of a wave that is 1 over even texels and -1 over odd ones. width: of the pixel, in
// texels.
fn wave(at: vec2<f32>, width: vec2<f32>) -> vec2<f32> {
    let low = abs(fract((at - 0.5 * width) * 0.5) - 0.5);
    let high = abs(fract((at + 0.5 * width) * 0.5) - 0.5);
    return 2.0 * (low - high) / width;
}

// Share of a pixel that lines between texels cover, by axis. Lines are one pixel wide.
fn lines(at: vec2<f32>, width: vec2<f32>) -> vec2<f32> {
    let from_line = abs(fract(at - 0.5) - 0.5) / width;
    return saturate(1.0 - from_line);
}

fn overlaid(in: SceneOut) -> vec4<f32> {
    let surface = surface_of(in);
    let color = lit(in, surface, mapped_factor(in, surface));
    let place = place_read(in.position);
    if place < 0 {
        return vec4<f32>(color, opacity(surface));
    }
    let map = shadowfit_entry(place);
    let step = footprint(map, in.position, surface.geometric);
    let texels = max(abs(step.right) + abs(step.down), vec2<f32>(1e-6));
    let level = ceil(0.5 * log2(max(LEAST_PIXELS * max(texels.x, texels.y), 1.0)));
    let block = exp2(2.0 * level);
    let width = texels / block;
    let at = ((map.uv_from_world * vec4<f32>(in.position, 1.0)).xy * map.size + map.texel_offset) / block;

    let waves = wave(at, width);
    let checker = mix(DARKER, 1.0, 0.5 - 0.5 * waves.x * waves.y);
    let line = lines(at, width);
    let pattern = checker * mix(1.0, LINE, max(line.x, line.y));
    let tint = frame.map_tints[map.layer].rgb * (0.12 + 1.5 * luminance(color));
    return vec4<f32>(mix(tint, color, 0.2) * pattern, opacity(surface));
}
