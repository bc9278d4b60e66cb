// The probe pass: what the shading knew about each pixel. Comes after scene.wgsl.

// The triangle's number plus one, and the bits of the shadow factor.
@fragment
fn fs_probe(in: SceneOut, @builtin(primitive_index) triangle: u32) -> @location(0) vec2<u32> {
    let geometric = geometric_normal(in.position, dpdx(in.position), dpdy(in.position));
    let factor = shadowfit_resolved(in.position, geometric, in.clip.xy);
    if is_cut_out(in.uv, in.color.a) {
        discard;
    }
    return vec2<u32>(in.number + triangle + 1u, bitcast<u32>(factor));
}
