// Positions and normals in view space. Comes after part.wgsl and uniform.wgsl.

struct Surfaces {
    // w is 1 where there is a surface.
    @location(0) position: vec4<f32>,
    @location(1) normal: vec4<f32>,
}

@fragment
fn fs_surface(in: PartOut) -> Surfaces {
    let position = occlusion.view_from_world * vec4<f32>(in.position, 1.0);
    let normal = occlusion.view_from_world * vec4<f32>(part_normal(in), 0.0);
    if is_cut_out(in.uv, in.color.a) {
        discard;
    }
    return Surfaces(vec4<f32>(position.xyz, 1.0), normal);
}

// Back faces. Their normals are not needed.
@fragment
fn fs_back(in: PartOut) -> @location(0) vec4<f32> {
    if is_cut_out(in.uv, in.color.a) {
        discard;
    }
    return vec4<f32>((occlusion.view_from_world * vec4<f32>(in.position, 1.0)).xyz, 1.0);
}
