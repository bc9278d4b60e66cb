// The pass before the picture: depths, and the normals of triangles. Comes after scene.wgsl.

@fragment
fn fs_surfaces(in: SceneOut) -> @location(0) vec4<f32> {
    let normal = geometric_normal(in.position, dpdx(in.position), dpdy(in.position));
    if is_cut_out(in.uv, in.color.a) {
        discard;
    }
    return vec4<f32>(normal, 0.0);
}
