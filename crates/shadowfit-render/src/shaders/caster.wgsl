// The shadow pass: positions by shadowfit, alpha cut-outs, and the depth for colour formats.

struct CasterIn {
    @location(0) position: vec3<f32>,
    @location(3) uv: vec2<f32>,
    @location(4) color: vec4<f32>,
    @location(5) row0: vec4<f32>,
    @location(6) row1: vec4<f32>,
    @location(7) row2: vec4<f32>,
}

struct CasterOut {
    @builtin(position) clip: vec4<f32>,
    @location(0) uv: vec2<f32>,
    @location(1) alpha: f32,
}

@vertex
fn vs_caster(in: CasterIn) -> CasterOut {
    let local = vec4<f32>(in.position, 1.0);
    let world = vec3<f32>(dot(in.row0, local), dot(in.row1, local), dot(in.row2, local));
    return CasterOut(shadowfit_caster_position(world), in.uv, in.color.a);
}

@fragment
fn fs_caster_masked(in: CasterOut) {
    if is_cut_out(in.uv, in.alpha) {
        discard;
    }
}

// Depth clamp holds the depth buffer's depth within 0..1, but not the position's that a shader reads.
@fragment
fn fs_caster_depth(in: CasterOut) -> @location(0) f32 {
    return saturate(in.clip.z);
}

@fragment
fn fs_caster_masked_depth(in: CasterOut) -> @location(0) f32 {
    if is_cut_out(in.uv, in.alpha) {
        discard;
    }
    return saturate(in.clip.z);
}
