// Screen-space ambient occlusion from positions and normals. Comes after buffers.wgsl and formula.wgsl.

// Sum of the occlusion terms of a pixel's neighbours in all directions. back: 1 for back faces, else 0.
fn hidden(buffer: texture_2d<f32>, at: vec2<f32>, position: vec3<f32>, normal: vec3<f32>, back: f32) -> f32 {
    let size = vec2<f32>(textureDimensions(buffer));
    let random = occlusion_random(vec2<u32>(at));
    let count = occlusion_directions(-position.z, occlusion.far, occlusion.detail);
    var sum = 0.0;
    for (var direction = 0u; direction < count; direction++) {
        let step = occlusion_step(occlusion_direction(direction), random, occlusion.radius, -position.z);
        for (var index = 0u; index < 4u; index++) {
            let pixel = vec2<i32>(floor(at + occlusion_offset(step, index, back) * size));
            let inside = within(pixel);
            let neighbour = textureLoad(buffer, inside, 0);
            let term = occlusion_term(normal, position, neighbour.xyz, occlusion.scale, occlusion.bias);
            // Sky and pixels outside the picture do not occlude.
            sum += select(0.0, term, neighbour.w > 0.0 && all(inside == pixel));
        }
    }
    return sum;
}

// Whether back faces occlude, too.
override BACK_FACES: bool = false;

@fragment
fn fs_normals(@builtin(position) at: vec4<f32>) -> @location(0) f32 {
    let position = textureLoad(positions, vec2<i32>(at.xy), 0);
    if position.w == 0.0 {
        return 0.0;
    }
    let normal = textureLoad(normals, vec2<i32>(at.xy), 0).xyz;
    let front = hidden(positions, at.xy, position.xyz, normal, 0.0);
    var back = 0.0;
    if BACK_FACES {
        back = hidden(third, at.xy, position.xyz, normal, 1.0);
    }
    let count = occlusion_directions(-position.z, occlusion.far, occlusion.detail);
    return occlusion_sum(front, back, occlusion.intensity, count);
}
