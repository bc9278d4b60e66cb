// The shadow pass: positions by shadowfit, and alpha cut-outs.

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
    @location(2) depth: f32,
}

@vertex
fn vs_caster(in: CasterIn) -> CasterOut {
    let local = vec4<f32>(in.position, 1.0);
    let world = vec3<f32>(dot(in.row0, local), dot(in.row1, local), dot(in.row2, local));
    return CasterOut(shadowfit_caster_position(world), in.uv, in.color.a, shadowfit_caster_depth(world));
}

@fragment
fn fs_caster(in: CasterOut) {
    if is_cut_out(in.uv, in.alpha) {
        discard;
    }
}

// Used if the device cannot clamp depth.
@fragment
fn fs_caster_clamped(in: CasterOut) -> @builtin(frag_depth) f32 {
    if is_cut_out(in.uv, in.alpha) {
        discard;
    }
    return shadowfit_clamped_depth(in.depth);
}
