// Tent filter of 5x5 look-ups, weights 1 2 3 2 1 along each axis, one texel apart. Neighbouring look-ups
// share texels, so that three look-ups between pairs of texels give the same sum (after I. Castano, "Shadow
// mapping summary", 2013).
//
//   texel weights, u right of the middle pair's left centre:   1-u   2-u | 3-u   2+u | 1+u    u     (over 9)
struct shadowfit_Columns {
    u0: vec2<f32>,
    u1: vec2<f32>,
    u2: vec2<f32>,
    weights: vec3<f32>,
}

fn shadowfit_tent_row(columns: shadowfit_Columns, y: f32, projected: shadowfit_Projected) -> f32 {
    let v = shadowfit_along_v(y, projected);
    return columns.weights.x * shadowfit_tap(columns.u0, v, projected)
        + columns.weights.y * shadowfit_tap(columns.u1, v, projected)
        + columns.weights.z * shadowfit_tap(columns.u2, v, projected);
}

fn shadowfit_compare(projected: shadowfit_Projected, turn: f32) -> f32 {
    let base = floor(projected.texel - vec2<f32>(0.5));
    let t = projected.texel - vec2<f32>(0.5) - base;
    // Centre of the middle pair's left texel, and weights of the pairs.
    let centre = base + vec2<f32>(0.5);
    let w0 = 3.0 - 2.0 * t;
    let w2 = 1.0 + 2.0 * t;
    let p0 = centre - vec2<f32>(2.0) + (2.0 - t) / w0;
    let p1 = centre + (2.0 + t) / 5.0;
    let p2 = centre + vec2<f32>(2.0) + t / w2;
    let columns = shadowfit_Columns(
        shadowfit_along_u(p0.x, projected), shadowfit_along_u(p1.x, projected), shadowfit_along_u(p2.x, projected),
        vec3<f32>(w0.x, 5.0, w2.x));
    return (w0.y * shadowfit_tent_row(columns, p0.y, projected)
        + 5.0 * shadowfit_tent_row(columns, p1.y, projected)
        + w2.y * shadowfit_tent_row(columns, p2.y, projected)) / 81.0;
}
