// Probe of each pixel: the triangle's number plus one, and the bits of the light's share.

@fragment
fn fs_probe(in: PointOut, @builtin(primitive_index) triangle: u32) -> @location(0) vec2<u32> {
    return vec2<u32>(in.number + triangle + 1u, bitcast<u32>(light_share(point_of(in))));
}
