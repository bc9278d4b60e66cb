// Third resolve pass: the triangle that the first ray of each pixel on the list starts on. A short ray from the eye finds it
// again.

@group(1) @binding(4) var<storage, read_write> list: List;

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
    let sight = sight_at(pixel, surface_of(pixel, depth_at(pixel)), resolve.points[0].xy);
    let met = shadowfit_rays_surface(begin_of(sight), sight.direction, 2.0 * sight.reach);
    list.pixels[index].slot = met.slot;
    list.pixels[index].instance = met.instance;
}
