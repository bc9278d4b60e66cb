// Third resolve pass: the triangle of the point whose depth is known, for each pixel on the list. A short ray from the eye finds
// it again.

@group(1) @binding(4) var<storage, read_write> list: List;

// Where the triangle of a pixel is sought. beside: how far outside of it the ray may pass, in metres.
fn triangle_at(sight: Sight, surface: Surface, beside: f32) -> shadowfit_RaySurface {
    let normal = select(vec3<f32>(0.0), surface.normal, surface.is_stored);
    let sought = shadowfit_RaySought(2.0 * sight.reach, sight.sure, beside, normal);
    return shadowfit_rays_surface(begin_of(sight), sight.direction, sought);
}

@compute @workgroup_size(TRACE_THREADS)
fn find_surfaces(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let index = (group.y * groups.x + group.x) * TRACE_THREADS + thread;
    if index >= list.count {
        return;
    }
    let pixel = pixel_of(list.pixels[index]);
    let surface = surface_of(pixel, depth_at(pixel));
    let sight = sight_at(pixel, surface, vec2<f32>(0.0));
    var met = triangle_at(sight, surface, 0.0);
    if met.slot == SHADOWFIT_RAYS_NONE {
        // The corners of the drawn triangle were rounded, and the ray passes it.
        let m = resolve.world_from_pixel;
        let pixel_size = max(length(moved(m[0], surface)), length(moved(m[1], surface)));
        met = triangle_at(sight, surface, SNAP * pixel_size);
    }
    list.pixels[index].slot = met.slot;
    list.pixels[index].instance = met.instance;
}
