// Shadow maps in the picture, their depths stretched to grey.

struct InsetIn {
    @builtin(vertex_index) corner: u32,
    @location(0) rectangle: vec4<f32>,
    @location(1) depth_range: vec2<f32>,
    @location(2) map: u32,
    @location(3) border: vec3<f32>,
}

struct InsetOut {
    @builtin(position) pixel: vec4<f32>,
    @location(0) @interpolate(flat) rectangle: vec4<f32>,
    @location(1) @interpolate(flat) depth_range: vec2<f32>,
    @location(2) @interpolate(flat) map: u32,
    @location(3) @interpolate(flat) border: vec3<f32>,
}

const FRAME_PIXELS: f32 = 1.0;

@vertex
fn vs_inset(in: InsetIn) -> InsetOut {
    let corner = vec2<f32>(f32(in.corner & 1u), f32(in.corner >> 1u));
    let pixel = in.rectangle.xy + corner * in.rectangle.zw;
    let ndc = pixel / frame.viewport * vec2<f32>(2.0, -2.0) + vec2<f32>(-1.0, 1.0);
    return InsetOut(vec4<f32>(ndc, 0.0, 1.0), in.rectangle, in.depth_range, in.map, in.border);
}

@fragment
fn fs_inset(in: InsetOut) -> @location(0) vec4<f32> {
    let at = in.pixel.xy - in.rectangle.xy;
    let border = min(min(at.x, at.y), min(in.rectangle.z - at.x, in.rectangle.w - at.y));
    let size = vec2<f32>(textureDimensions(shadowfit_texture));
    let depth = shadowfit_stored(i32(in.map), vec2<i32>(at / in.rectangle.zw * size));
    let gray = (depth - in.depth_range.x) / (in.depth_range.y - in.depth_range.x);
    // Squared, because the target encodes: equal depth steps then look nearly equal.
    let shade = saturate(gray) * saturate(gray);
    return vec4<f32>(select(vec3<f32>(shade), in.border, border < FRAME_PIXELS), 1.0);
}
