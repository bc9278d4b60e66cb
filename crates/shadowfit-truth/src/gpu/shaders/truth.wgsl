// First pass: the truth of each pixel by one shadow ray, the map that it reads, and how wide its texels are.

@compute @workgroup_size(8, 8) fn trace(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= judge.size) {
        return;
    }
    let drawn = textureLoad(seen, id.xy, 0);
    var pixel = Pixel(0u, 0.0, NOWHERE);
    if drawn.x > 0u && drawn.x <= judge.triangles {
        let surface = surface_of(id.xy, triangles[slots[drawn.x - 1u]]);
        if surface.facing > 0.0 && surface.view_depth <= judge.max_distance {
            let anyone = Receiver(NOWHERE, vec3<f32>(0.0), 0.0);
            let is_lit = !is_occluded(ray_origin(surface), judge.to_light, anyone);
            pixel.flags = JUDGED | select(0u, LIT, is_lit) | select(0u, SEEMS_LIT, bitcast<f32>(drawn.y) >= 0.5);
            pixel.footprint = FAR;
            let choice = choose(surface);
            if choice != NOWHERE {
                pixel.flags |= (choice + 1u) << CHOICE_SHIFT;
                pixel.footprint = pixels_per_texel(surface, judge.maps[choice]);
            }
        }
    }
    pixels[pixel_index(id.xy)] = pixel;
}
