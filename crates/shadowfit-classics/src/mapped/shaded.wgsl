// Colours a sample's surfaces.

@fragment
fn fs_shaded(in: PointOut) -> @location(0) vec4<f32> {
    let point = point_of(in);
    return vec4<f32>(colour(point, light_share(point)), 1.0);
}
