// Second pass of marks: draws pixels near a wrong one. Comes after screen.wgsl, mark.wgsl and error_color.

// The nearest wrong pixels of the rows.
@group(0) @binding(1) var nearest: texture_2d<u32>;

// Distances from the nearest wrong pixel's middle between which outlines lie, in pixels.
const INNER: f32 = 3.0;
const OUTER: f32 = 5.0;
// Width of the dark border on either side of an outline, and its opacity. It shows outlines on surfaces of
// the same colour.
const BORDER: f32 = 1.0;
const BORDER_OPACITY: f32 = 0.55;
// Distance that filled marks reach.
const FILLED: f32 = 1.0;

// Returns the share of a pixel that lies between two distances. at: distance of the pixel's middle.
fn between(low: f32, high: f32, at: f32) -> f32 {
    return saturate(at - low + 0.5) * saturate(high - at + 0.5);
}

@fragment
fn fs_marks(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let pixel = vec2<i32>(at.xy);
    let height = i32(textureDimensions(nearest).y);
    var least = (REACH + 1) * (REACH + 1);
    var kind = 0u;
    for (var step = -REACH; step <= REACH; step++) {
        let row = pixel.y + step;
        let found = textureLoad(nearest, vec2<i32>(pixel.x, clamp(row, 0, height - 1)), 0).x;
        let across = i32(found & 15u);
        let square = across * across + step * step;
        if found != 0u && row >= 0 && row < height && square < least {
            least = square;
            kind = found >> 4u;
        }
    }
    if kind == 0u {
        discard;
    }
    let away = sqrt(f32(least));
    let is_outline = marks.outline != 0u;
    let line = between(INNER, OUTER, away);
    let border = between(INNER - BORDER, OUTER + BORDER, away) * BORDER_OPACITY;
    let fill = saturate(FILLED + 1.0 - away);
    let cover = select(fill, line, is_outline);
    let dark = select(0.0, border * (1.0 - line), is_outline);
    return vec4<f32>(error_color(kind) * cover, cover + dark) * marks.strength;
}
