// First pass of marks: the nearest wrong pixel in each pixel's row. Comes after screen.wgsl, judged.wgsl, mark.wgsl and
// one of mark_depth*.wgsl.

// Returns the bits of a pixel of the frame.
fn judged_pixel(pixel: vec2<i32>, size: vec2<i32>) -> u32 {
    let at = vec2<f32>(pixel) + 0.5;
    if is_same_camera(at) {
        return judged_at(at * judged.scale);
    }
    let depth = scene_depth(pixel);
    let ndc = at / vec2<f32>(size) * vec2<f32>(2.0, -2.0) + vec2<f32>(-1.0, 1.0);
    let position = judged.world_from_ndc * vec4<f32>(ndc, depth, 1.0);
    let bits = judged_of(position.xyz / position.w, at);
    // The far plane is sky.
    return select(0u, bits, depth > 0.0);
}

// Returns the class of a marked pixel; 0 for other pixels.
fn marked_class(pixel: vec2<i32>, size: vec2<i32>) -> u32 {
    if any(pixel < vec2<i32>(0)) || any(pixel >= size) {
        return 0u;
    }
    let kind = judged_pixel(pixel, size) & CLASS;
    return select(0u, kind, ((marks.classes >> kind) & 1u) != 0u);
}

// Returns the class, shifted by four bits, plus the distance in pixels; 0 if no wrong pixel is near.
@fragment
fn fs_mark_rows(@builtin(position) at: vec4<f32>) -> @location(0) u32 {
    let pixel = vec2<i32>(at.xy);
    let size = vec2<i32>(judged.viewport);
    for (var step = 0; step <= REACH; step++) {
        let kind = max(
            marked_class(pixel - vec2<i32>(step, 0), size), marked_class(pixel + vec2<i32>(step, 0), size));
        if kind != 0u {
            return (kind << 4u) | u32(step);
        }
    }
    return 0u;
}
