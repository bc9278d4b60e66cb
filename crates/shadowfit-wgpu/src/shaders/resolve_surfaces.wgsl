// Third resolve pass: the triangle of the point whose depth is known, for each pixel on the list. A short ray from the eye finds
// it again.

@group(1) @binding(4) var<storage, read_write> list: List;

// Cosine of the greatest angle between a stored normal and that of its own triangle: far more than normals are rounded by.
const SAME_NORMAL: f32 = 0.9995;

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
    let met = shadowfit_rays_surface(begin_of(sight), sight.direction, 2.0 * sight.reach, sight.sure);
    // Where a drawn triangle ends within the rounding of its corners, the ray meets its neighbour.
    let is_other = surface.is_stored && dot(met.normal, surface.normal) < SAME_NORMAL;
    list.pixels[index].slot = select(met.slot, SHADOWFIT_RAYS_NONE, is_other);
    list.pixels[index].instance = met.instance;
}
