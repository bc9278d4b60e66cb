// The scene under a sun and an ambient light darkened by occlusion. Comes after part.wgsl, uniform.wgsl and
// srgb.wgsl.

@group(3) @binding(0) var occluded: texture_2d<f32>;

// Whether light is linear with the tone curve, or in display values.
override MODERN: bool = false;

@fragment
fn fs_picture(in: PartOut) -> @location(0) vec4<f32> {
    let base = base_color(in.uv) * in.color;
    // Blended surfaces are not in the buffers, so their occlusion is unknown.
    let hidden = textureLoad(occluded, vec2<i32>(in.clip.xy), 0).x * (1.0 - material.blended);
    let facing = saturate(dot(part_normal(in), frame.to_light));
    let light = occlusion.ambient.rgb * (1.0 - hidden) + occlusion.diffuse.rgb * facing;
    if is_cut_out(in.uv, in.color.a) {
        discard;
    }
    let color = select(encoded(base.rgb) * light, encoded(tone_map(base.rgb * light)), MODERN);
    return vec4<f32>(color, mix(1.0, base.a, material.blended));
}
