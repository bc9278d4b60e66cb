// A picture that was judged against rays: which of its pixels shows a point, and how it was judged.

struct Judged {
    // Clip space of the judged camera, from positions relative to the frame's eye, and from the frame's normalised
    // device coordinates.
    clip_from_world: mat4x4<f32>,
    clip_from_ndc: mat4x4<f32>,
    // Width and height, in pixels.
    size: vec2<f32>,
    // Its pixels for each of the frame's where the cameras are the same; else 0.
    scale: vec2<f32>,
}

@group(GROUP) @binding(0) var<uniform> judged: Judged;
@group(GROUP) @binding(1) var classes: texture_2d<u32>;

// The bits of `Class`, and that of light in truth. 0 is a pixel that was not judged; wrong ones follow the right ones.
const CLASS: u32 = 7u;
const LIT: u32 = 8u;
const FIRST_WRONG: u32 = 2u;

// The bits at a place in the judged picture, in pixels; 0 beside it.
fn judged_at(pixel: vec2<f32>) -> u32 {
    let is_inside = all(pixel >= vec2<f32>(0.0)) && all(pixel < judged.size);
    return select(0u, textureLoad(classes, vec2<i32>(pixel), 0).x, is_inside);
}

// The bits at a place in the judged camera's clip space; 0 behind it.
fn judged_at_clip(clip: vec4<f32>) -> u32 {
    let pixel = (clip.xy / clip.w * vec2<f32>(0.5, -0.5) + 0.5) * judged.size;
    return select(0u, judged_at(pixel), clip.w > 0.0);
}

// The bits of a visible point. pixel: in the frame.
fn judged_of(position: vec3<f32>, pixel: vec2<f32>) -> u32 {
    if judged.scale.x > 0.0 {
        return judged_at(pixel * judged.scale);
    }
    return judged_at_clip(judged.clip_from_world * vec4<f32>(position, 1.0));
}
