// Tent of 7x7 look-ups, weights 1 2 3 4 3 2 1 each way, one texel apart. Neighbouring look-ups share texels, so that four
// between pairs of them give the same sum (after I. Castano, "Shadow mapping summary", 2013).
//
//   texel weights, u right of the second pair's right centre:   1-u   2-u | 3-u   4-u | 3+u   2+u | 1+u    u     (over 16)
fn shadowfit_tent_row(x: vec4<f32>, weights: vec4<f32>, y: f32, projected: shadowfit_Projected) -> f32 {
    return weights.x * shadowfit_look_up(vec2<f32>(x.x, y), projected)
        + weights.y * shadowfit_look_up(vec2<f32>(x.y, y), projected)
        + weights.z * shadowfit_look_up(vec2<f32>(x.z, y), projected)
        + weights.w * shadowfit_look_up(vec2<f32>(x.w, y), projected);
}

fn shadowfit_compare(projected: shadowfit_Projected, turn: f32) -> f32 {
    let base = floor(projected.texel - vec2<f32>(0.5));
    let t = projected.texel - vec2<f32>(0.5) - base;
    // Centre of the second pair's right texel, and the weights of the pairs.
    let centre = base + vec2<f32>(0.5);
    let w0 = 3.0 - 2.0 * t;
    let w1 = 7.0 - 2.0 * t;
    let w2 = 5.0 + 2.0 * t;
    let w3 = 1.0 + 2.0 * t;
    let p0 = centre - vec2<f32>(3.0) + (2.0 - t) / w0;
    let p1 = centre - vec2<f32>(1.0) + (4.0 - t) / w1;
    let p2 = centre + vec2<f32>(1.0) + (2.0 + t) / w2;
    let p3 = centre + vec2<f32>(3.0) + t / w3;
    let x = vec4<f32>(p0.x, p1.x, p2.x, p3.x);
    let weights = vec4<f32>(w0.x, w1.x, w2.x, w3.x);
    return (w0.y * shadowfit_tent_row(x, weights, p0.y, projected)
        + w1.y * shadowfit_tent_row(x, weights, p1.y, projected)
        + w2.y * shadowfit_tent_row(x, weights, p2.y, projected)
        + w3.y * shadowfit_tent_row(x, weights, p3.y, projected)) / 256.0;
}
