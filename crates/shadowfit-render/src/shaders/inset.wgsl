// The shadow map in a corner of the picture, its depths stretched to grey.

struct Inset {
    rectangle: vec4<f32>,
    depth_range: vec2<f32>,
    map: u32,
    padding: u32,
}

@group(2) @binding(0) var<uniform> inset: Inset;

const FRAME_PIXELS: f32 = 1.0;

@vertex
fn vs_inset(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u));
    let pixel = inset.rectangle.xy + corner * inset.rectangle.zw;
    let ndc = pixel / frame.viewport * vec2<f32>(2.0, -2.0) + vec2<f32>(-1.0, 1.0);
    return vec4<f32>(ndc, 0.0, 1.0);
}

@fragment
fn fs_inset(@builtin(position) pixel: vec4<f32>) -> @location(0) vec4<f32> {
    let at = pixel.xy - inset.rectangle.xy;
    let border = min(min(at.x, at.y), min(inset.rectangle.z - at.x, inset.rectangle.w - at.y));
    let size = vec2<f32>(textureDimensions(shadowfit_texture));
    let depth = shadowfit_stored(inset.map, vec2<i32>(at / inset.rectangle.zw * size));
    let gray = (depth - inset.depth_range.x) / (inset.depth_range.y - inset.depth_range.x);
    // Squared, since the target encodes: equal depth steps are then nearly equal steps to the eye.
    let shade = saturate(gray) * saturate(gray);
    return select(vec4<f32>(vec3<f32>(shade), 1.0), vec4<f32>(0.9, 0.9, 0.9, 1.0), border < FRAME_PIXELS);
}
