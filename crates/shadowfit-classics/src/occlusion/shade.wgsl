// The scene under a sun and an ambient light, which occlusion darkens. Comes after occlusion_part.wgsl,
// occlusion_uniform.wgsl and srgb.wgsl.

@group(3) @binding(0) var occluded: texture_2d<f32>;

fn light(in: PartOut, hidden: f32) -> vec3<f32> {
    let facing = saturate(dot(part_normal(in), frame.to_light));
    return occlusion.ambient.rgb * (1.0 - hidden) + occlusion.diffuse.rgb * facing;
}

fn hidden_at(in: PartOut) -> f32 {
    return textureLoad(occluded, vec2<i32>(in.clip.xy), 0).x;
}

// In display values.
fn classic(in: PartOut, hidden: f32) -> vec4<f32> {
    let base = base_color(in.uv) * in.color;
    return vec4<f32>(encoded(base.rgb) * light(in, hidden), base.a);
}

// In linear light, with the tone curve.
fn modern(in: PartOut, hidden: f32) -> vec4<f32> {
    let base = base_color(in.uv) * in.color;
    return vec4<f32>(encoded(tone_map(base.rgb * light(in, hidden))), base.a);
}

@fragment
fn fs_classic(in: PartOut) -> @location(0) vec4<f32> {
    return vec4<f32>(classic(in, hidden_at(in)).rgb, 1.0);
}

@fragment
fn fs_classic_masked(in: PartOut) -> @location(0) vec4<f32> {
    let color = classic(in, hidden_at(in));
    if is_cut_out(in.uv, in.color.a) {
        discard;
    }
    return vec4<f32>(color.rgb, 1.0);
}

// Blended surfaces are not in the buffers: nothing is known to hide them.
@fragment
fn fs_classic_blended(in: PartOut) -> @location(0) vec4<f32> {
    return classic(in, 0.0);
}

@fragment
fn fs_modern(in: PartOut) -> @location(0) vec4<f32> {
    return vec4<f32>(modern(in, hidden_at(in)).rgb, 1.0);
}

@fragment
fn fs_modern_masked(in: PartOut) -> @location(0) vec4<f32> {
    let color = modern(in, hidden_at(in));
    if is_cut_out(in.uv, in.color.a) {
        discard;
    }
    return vec4<f32>(color.rgb, 1.0);
}

@fragment
fn fs_modern_blended(in: PartOut) -> @location(0) vec4<f32> {
    return modern(in, 0.0);
}
