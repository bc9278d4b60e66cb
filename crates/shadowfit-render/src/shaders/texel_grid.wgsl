// The texels of the map that a point reads, drawn on its surface. Comes after overlay.wgsl.

// Texels this many pixels wide begin to show, and from there on show fully.
const FIRST_PIXELS: f32 = 2.0;
const FULL_PIXELS: f32 = 5.0;
// Brightness of the darker texels and of the lines between texels, as a share of the brighter ones'.
const DARKER: f32 = 0.62;
const LINE: f32 = 0.35;

// Mean over a pixel of a wave that is 1 over even texels and -1 over odd ones. width: of the pixel, in texels.
fn wave(at: vec2<f32>, width: vec2<f32>) -> vec2<f32> {
    let low = abs(fract((at - 0.5 * width) * 0.5) - 0.5);
    let high = abs(fract((at + 0.5 * width) * 0.5) - 0.5);
    return 2.0 * (low - high) / width;
}

// Share of a pixel that lines of one pixel's width between texels cover, by axis.
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
    let width = max(abs(step.right) + abs(step.down), vec2<f32>(1e-6));
    let texel = (map.uv_from_world * vec4<f32>(in.position, 1.0)).xy * map.size + map.wrap;
    let clear = smoothstep(vec2<f32>(FIRST_PIXELS), vec2<f32>(FULL_PIXELS), 1.0 / width);

    // A checkerboard; stripes where texels are clear along one axis alone.
    let waves = wave(texel, width) * clear;
    let both = mix(waves.x * (1.0 - clear.y) + waves.y * (1.0 - clear.x), waves.x * waves.y, clear.x * clear.y);
    let checker = mix(DARKER, 1.0, 0.5 - 0.5 * both);
    let line = lines(texel, width) * clear;
    let pattern = checker * mix(1.0, LINE, max(line.x, line.y));
    let tint = frame.map_tints[map.layer].rgb * (0.12 + 1.5 * luminance(color));
    return vec4<f32>(mix(tint, color, 0.2) * pattern, opacity(surface));
}
