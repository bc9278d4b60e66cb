// Screen-space ambient occlusion by depth alone. Comes after buffers.wgsl and formula.wgsl.

@fragment
fn fs_depth_only(@builtin(position) at: vec4<f32>) -> @location(0) f32 {
    let seen = textureLoad(positions, vec2<i32>(at.xy), 0);
    if seen.w == 0.0 {
        return 0.0;
    }
    let size = vec2<f32>(textureDimensions(positions));
    let random = occlusion_random_3d(vec2<u32>(at.xy));
    // A sphere that appears as high as the radius of the other method.
    let radius = occlusion.radius * occlusion.height;
    var sum = 0.0;
    for (var index = 0u; index < 16u; index++) {
        let point = seen.xyz + reflect(occlusion_sphere(index), random) * radius;
        let depth = max(-point.z, 1e-3);
        let uv = 0.5 + occlusion.uv_from_view * point.xy / depth;
        let surface = textureLoad(positions, within(vec2<i32>(floor(uv * size))), 0);
        sum += select(0.0, occlusion_behind(depth, -surface.z, radius), surface.w > 0.0);
    }
    return sum / 16.0;
}
