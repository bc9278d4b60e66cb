// Tent filter of 3x3 look-ups, weights 1 2 1 along each axis, one texel apart. Neighbouring look-ups share
// texels, so that two look-ups between pairs of texels give the same sum (after I. Castano, "Shadow mapping
// summary", 2013).
//
//   texel weights, u right of the pair's left centre:   1-u   2-u | 1+u    u     (over 4)
fn shadowfit_compare(projected: shadowfit_Projected, turn: f32) -> f32 {
    let base = floor(projected.texel - vec2<f32>(0.5));
    let t = projected.texel - vec2<f32>(0.5) - base;
    // Centre of a pair's left texel, and weights of the pairs.
    let centre = base + vec2<f32>(0.5);
    let w0 = 3.0 - 2.0 * t;
    let w1 = 1.0 + 2.0 * t;
    let p0 = centre - vec2<f32>(1.0) + (2.0 - t) / w0;
    let p1 = centre + vec2<f32>(1.0) + t / w1;
    let u0 = shadowfit_along_u(p0.x, projected);
    let u1 = shadowfit_along_u(p1.x, projected);
    let v0 = shadowfit_along_v(p0.y, projected);
    let v1 = shadowfit_along_v(p1.y, projected);
    let top = w0.x * shadowfit_tap(u0, v0, projected) + w1.x * shadowfit_tap(u1, v0, projected);
    let bottom = w0.x * shadowfit_tap(u0, v1, projected) + w1.x * shadowfit_tap(u1, v1, projected);
    return (w0.y * top + w1.y * bottom) / 16.0;
}
