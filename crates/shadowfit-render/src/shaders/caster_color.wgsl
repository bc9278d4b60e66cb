// The shadow pass for colour formats.

struct CasterColor {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fs_caster_color(in: CasterOut) -> @location(0) vec4<f32> {
    if is_cut_out(in.uv, in.alpha) {
        discard;
    }
    return shadowfit_caster_color(in.clip.z);
}

// Used if the device cannot clamp depth.
@fragment
fn fs_caster_clamped_color(in: CasterOut) -> CasterColor {
    if is_cut_out(in.uv, in.alpha) {
        discard;
    }
    let depth = shadowfit_clamped_depth(in.depth);
    return CasterColor(shadowfit_caster_color(depth), depth);
}
