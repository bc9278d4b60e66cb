// Third edge pass: finds the triangle of each listed pixel's first sample again, with a short ray from the
// eye.

@group(1) @binding(4) var<storage, read_write> list: List;

// Returns the triangle that the ray from the eye hits.
fn met_by(sight: Sight) -> shadowfit_RaySurface {
    let sought = shadowfit_RaySought(2.0 * sight.reach, sight.sure, 0.0, vec3<f32>(0.0));
    return shadowfit_rays_surface(begin_of(sight), sight.direction, sought);
}

// Returns the triangle with the pixel's normal that the ray hits, or misses by the rounding of the triangle's
// corners.
fn passed_by(sight: Sight, surface: Surface) -> shadowfit_RaySurface {
    let near = Sight(sight.middle, sight.direction, sight.sure, sight.sure);
    let normal = select(vec3<f32>(0.0), surface.normal, surface.is_stored);
    let sought = shadowfit_RaySought(2.0 * near.reach, near.sure, beside_of(surface), normal);
    return shadowfit_rays_surface(begin_of(near), near.direction, sought);
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
    var met = met_by(sight);
    let is_other = surface.is_stored && dot(met.normal, surface.normal) < SHADOWFIT_RAYS_SAME_NORMAL;
    if met.slot == SHADOWFIT_RAYS_NONE || is_other {
        met = passed_by(sight, surface);
    }
    list.pixels[index].slot = met.slot;
    list.pixels[index].instance = met.instance;
}
