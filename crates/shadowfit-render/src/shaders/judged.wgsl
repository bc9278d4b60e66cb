// A picture that was judged against rays: finds the pixel that shows a point, and its result.

struct Judged {
    // Judged camera's clip space from positions relative to the frame's eye.
    clip_from_world: mat4x4<f32>,
    // Homogeneous positions relative to the frame's eye from the frame's normalised device coordinates.
    world_from_ndc: mat4x4<f32>,
    // Width and height, in pixels.
    size: vec2<f32>,
    // Judged pixels per pixel of the frame if the cameras are the same; otherwise 0.
    scale: vec2<f32>,
    // View depths of its near and far plane, in metres; near is 0 if its depth is not used.
    near: f32,
    far: f32,
    // Width and height of the frame's picture, in pixels.
    viewport: vec2<f32>,
}

@group(GROUP) @binding(0) var<uniform> judged: Judged;
@group(GROUP) @binding(1) var classes: texture_2d<u32>;
@group(GROUP) @binding(2) var judged_depths: texture_2d<f32>;
// Nearest-texel sampler, because OpenGL's shaders cannot load from depth textures.
@group(GROUP) @binding(3) var nearest_texel: sampler;

// The bits of `Class`, and the bit of light in truth. 0 is a pixel that was not judged. Wrong classes follow
// the right one.
const CLASS: u32 = 7u;
const LIT: u32 = 8u;
const FIRST_WRONG: u32 = 2u;

// Returns the bits at a position in the judged picture, in pixels; 0 outside of it.
fn judged_at(pixel: vec2<f32>) -> u32 {
    let is_inside = all(pixel >= vec2<f32>(0.0)) && all(pixel < judged.size);
    return select(0u, textureLoad(classes, vec2<i32>(pixel), 0).x, is_inside);
}

// Returns the depth at a pixel of a depth buffer; 0 outside of it.
fn depth_at(depths: texture_2d<f32>, pixel: vec2<i32>) -> f32 {
    let size = vec2<i32>(textureDimensions(depths));
    let depth = textureSampleLevel(depths, nearest_texel, (vec2<f32>(pixel) + 0.5) / vec2<f32>(size), 0.0).x;
    return select(0.0, depth, all(pixel >= vec2<i32>(0)) && all(pixel < size));
}

// Relative difference of view depths that counts as the same surface.
const SAME_DEPTH: f32 = 0.01;

// Returns the view depth of the judged picture's surface at a pixel, in metres.
fn judged_view_depth(pixel: vec2<i32>) -> f32 {
    let depth = depth_at(judged_depths, pixel);
    return judged.near * judged.far / (judged.near + depth * (judged.far - judged.near));
}

// Returns whether a point at a view depth was visible to the judged camera. Its view depth may differ from
// the pixel's by the change of a slanted surface from one pixel to the next.
fn is_seen(at: vec2<f32>, view_depth: f32) -> bool {
    let pixel = vec2<i32>(at);
    let middle = judged_view_depth(pixel);
    let before = vec2<f32>(judged_view_depth(pixel - vec2<i32>(1, 0)), judged_view_depth(pixel - vec2<i32>(0, 1)));
    let after = vec2<f32>(judged_view_depth(pixel + vec2<i32>(1, 0)), judged_view_depth(pixel + vec2<i32>(0, 1)));
    // Uses the smaller difference of both sides, because the other pixel may lie beyond an edge.
    let slope = min(abs(before - middle), abs(after - middle));
    let is_same = abs(view_depth - middle) <= slope.x + slope.y + SAME_DEPTH * middle;
    // No branches: Mesa's software rasteriser (22.3) crashes if too many depend on uniforms.
    return is_same | (judged.near == 0.0);
}

// Returns the bits at a position in the judged camera's clip space; 0 behind it, and if the point was not
// visible.
fn judged_at_clip(clip: vec4<f32>) -> u32 {
    let pixel = (clip.xy / clip.w * vec2<f32>(0.5, -0.5) + 0.5) * judged.size;
    return select(0u, judged_at(pixel), (clip.w > 0.0) & is_seen(pixel, clip.w));
}

// Returns whether the judged camera is the frame's. The middle of a pixel is never 0. Without this factor the
// branch would depend on uniforms only, for which Mesa's software rasteriser (22.3) compiles a new shader
// with each draw, and keeps all.
fn is_same_camera(pixel: vec2<f32>) -> bool {
    return pixel.x * judged.scale.x > 0.0;
}

// Returns the bits of a visible point. pixel: the middle of a pixel of the frame.
fn judged_of(position: vec3<f32>, pixel: vec2<f32>) -> u32 {
    if is_same_camera(pixel) {
        return judged_at(pixel * judged.scale);
    }
    return judged_at_clip(judged.clip_from_world * vec4<f32>(position, 1.0));
}
