// First pass, for each pixel: the truth by one shadow ray, the map that it reads with its pixels per texel,
// whether the pixel is grazing, and whether the previous frame's maps cover it. Rust inserts the constant
// MIN_FACING.

@compute @workgroup_size(8, 8) fn trace(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= judge.size) {
        return;
    }
    let drawn = textureLoad(seen, id.xy, 0);
    var pixel = Pixel(0u, 0.0, NONE, 0.0);
    if drawn.x > 0u && drawn.x <= judge.triangles {
        let surface = surface_in(id.xy, drawn.x - 1u);
        if surface.facing > 0.0 && surface.view_depth <= judge.max_distance {
            let without_map = Receiver(NONE, vec3<f32>(0.0), 0.0);
            let is_lit = !is_occluded(surface, without_map);
            pixel.flags = JUDGED | select(0u, LIT, is_lit) | select(0u, SEEMS_LIT, bitcast<f32>(drawn.y) >= 0.5)
                | select(0u, GRAZING, surface.facing < MIN_FACING)
                | select(0u, COVERED_BEFORE, is_covered_before(surface.position));
            pixel.pixels_per_texel = FAR;
            pixel.facing = surface.facing;
            let map = choose(surface);
            if map != NONE {
                pixel.flags |= (map + 1u) << MAP_SHIFT;
                pixel.pixels_per_texel = pixels_per_texel(surface, judge.maps[map]);
            }
        }
    }
    pixels[pixel_index(id.xy)] = pixel;
}
