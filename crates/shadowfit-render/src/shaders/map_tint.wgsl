// Surfaces in the tint of the map that they read, mixed if they read two. Comes after overlay.wgsl.

fn tint_read(position: vec3<f32>) -> vec4<f32> {
    let selection = shadowfit_select(position);
    if selection.first < 0 {
        return vec4<f32>(0.0);
    }
    let first = frame.map_tints[shadowfit_entry(selection.first).layer];
    if selection.second < 0 {
        return first;
    }
    return mix(frame.map_tints[shadowfit_entry(selection.second).layer], first, selection.weight);
}

fn overlaid(in: SceneOut) -> vec4<f32> {
    let surface = surface_of(in);
    let color = lit(in, surface, mapped_factor(in, surface));
    let tint = tint_read(in.position);
    // Uses the tint as the surface's colour, mixed with some of the original colour.
    let brightness = luminance(color);
    let tinted = mix(tint.rgb * (0.12 + 1.5 * brightness), color, 0.25);
    return vec4<f32>(mix(color, tinted, tint.a), opacity(surface));
}
