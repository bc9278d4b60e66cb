// The probe pass if fragments have a primitive index. Comes after probe.wgsl.

@fragment
fn fs_probe(in: SceneOut, @builtin(primitive_index) triangle: u32) -> @location(0) vec2<u32> {
    return probed(in, in.number + triangle);
}
