// Tent filter of 7x7 look-ups, weights 1 2 3 4 3 2 1 along each axis, one texel apart. Neighbouring look-ups
// share texels, so that four look-ups between pairs of texels give the same sum (after I. Castano, "Shadow
// mapping summary", 2013).
//
//   texel weights, u right of the second pair's right centre:   1-u   2-u | 3-u   4-u | 3+u   2+u | 1+u    u     (over 16)
struct shadowfit_Columns {
    u0: vec2<f32>,
    u1: vec2<f32>,
    u2: vec2<f32>,
    u3: vec2<f32>,
    weights: vec4<f32>,
}

fn shadowfit_tent_row(columns: shadowfit_Columns, y: f32, projected: shadowfit_Projected) -> f32 {
    let v = shadowfit_along_v(y, projected);
    return columns.weights.x * shadowfit_tap(columns.u0, v, projected)
        + columns.weights.y * shadowfit_tap(columns.u1, v, projected)
        + columns.weights.z * shadowfit_tap(columns.u2, v, projected)
        + columns.weights.w * shadowfit_tap(columns.u3, v, projected);
}

fn shadowfit_compare(projected: shadowfit_Projected, turn: f32) -> f32 {
    let base = floor(projected.texel - vec2<f32>(0.5));
    let t = projected.texel - vec2<f32>(0.5) - base;
    // Centre of the second pair's right texel, and weights of the pairs.
    let centre = base + vec2<f32>(0.5);
    let w0 = 3.0 - 2.0 * t;
    let w1 = 7.0 - 2.0 * t;
    let w2 = 5.0 + 2.0 * t;
    let w3 = 1.0 + 2.0 * t;
    let p0 = centre - vec2<f32>(3.0) + (2.0 - t) / w0;
    let p1 = centre - vec2<f32>(1.0) + (4.0 - t) / w1;
    let p2 = centre + vec2<f32>(1.0) + (2.0 + t) / w2;
    let p3 = centre + vec2<f32>(3.0) + t / w3;
    let columns = shadowfit_Columns(
        shadowfit_along_u(p0.x, projected), shadowfit_along_u(p1.x, projected), shadowfit_along_u(p2.x, projected),
        shadowfit_along_u(p3.x, projected), vec4<f32>(w0.x, w1.x, w2.x, w3.x));
    return (w0.y * shadowfit_tent_row(columns, p0.y, projected)
        + w1.y * shadowfit_tent_row(columns, p1.y, projected)
        + w2.y * shadowfit_tent_row(columns, p2.y, projected)
        + w3.y * shadowfit_tent_row(columns, p3.y, projected)) / 256.0;
}
