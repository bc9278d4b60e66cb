// Tent of 5x5 look-ups, weights 1 2 3 2 1 each way, one texel apart. Neighbouring look-ups share texels, so that three
// between pairs of them give the same sum (after I. Castano, "Shadow mapping summary", 2013).
//
//   texel weights, u right of the middle pair's left centre:   1-u   2-u | 3-u   2+u | 1+u    u     (over 9)
fn shadowfit_tent_row(x: vec3<f32>, weights: vec3<f32>, y: f32, projected: shadowfit_Projected) -> f32 {
    return weights.x * shadowfit_look_up(vec2<f32>(x.x, y), projected)
        + weights.y * shadowfit_look_up(vec2<f32>(x.y, y), projected)
        + weights.z * shadowfit_look_up(vec2<f32>(x.z, y), projected);
}

fn shadowfit_compare(projected: shadowfit_Projected, turn: f32) -> f32 {
    let base = floor(projected.texel - vec2<f32>(0.5));
    let t = projected.texel - vec2<f32>(0.5) - base;
    // Centre of the middle pair's left texel, and the weights of the pairs.
    let centre = base + vec2<f32>(0.5);
    let w0 = 3.0 - 2.0 * t;
    let w2 = 1.0 + 2.0 * t;
    let p0 = centre - vec2<f32>(2.0) + (2.0 - t) / w0;
    let p1 = centre + (2.0 + t) / 5.0;
    let p2 = centre + vec2<f32>(2.0) + t / w2;
    let x = vec3<f32>(p0.x, p1.x, p2.x);
    let weights = vec3<f32>(w0.x, 5.0, w2.x);
    return (w0.y * shadowfit_tent_row(x, weights, p0.y, projected)
        + 5.0 * shadowfit_tent_row(x, weights, p1.y, projected)
        + w2.y * shadowfit_tent_row(x, weights, p2.y, projected)) / 81.0;
}
