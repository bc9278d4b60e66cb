
// Returns a stored look-up coordinate, and the difference of the plane's depth there from the point's depth.
// at: position in the map, in texels. It is clamped to half a texel inside the used part, because the sampler
// would read beyond it.
fn shadowfit_along(at: f32, point: f32, gradient: f32, size: f32, texel_offset: f32, unit: f32) -> vec2<f32> {
    let inside = clamp(at, 0.5, size - 0.5);
    let shifted = inside + texel_offset;
    return vec2<f32>(select(shifted, shifted - size, shifted >= size) * unit, gradient * (inside - point));
}

fn shadowfit_along_u(at: f32, p: shadowfit_Projected) -> vec2<f32> {
    return shadowfit_along(at, p.texel.x, p.gradient.x, p.size.x, p.texel_offset.x, p.unit.x);
}

fn shadowfit_along_v(at: f32, p: shadowfit_Projected) -> vec2<f32> {
    return shadowfit_along(at, p.texel.y, p.gradient.y, p.size.y, p.texel_offset.y, p.unit.y);
}

// Does one look-up at a column and a row.
fn shadowfit_tap(u: vec2<f32>, v: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    return shadowfit_look_up_at(vec2<f32>(u.x, v.x), projected.depth + u.y + v.y, projected);
}

// Does one look-up at a position in the map, in texels, with the depth of the point's plane there.
fn shadowfit_look_up(texel: vec2<f32>, projected: shadowfit_Projected) -> f32 {
    return shadowfit_tap(shadowfit_along_u(texel.x, projected), shadowfit_along_v(texel.y, projected), projected);
}
