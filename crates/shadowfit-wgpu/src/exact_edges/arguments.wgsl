// Second edge pass: computes the number of workgroups for each pass over the list.

@group(0) @binding(0) var<storage, read> list: List;
@group(0) @binding(1) var<storage, read_write> groups: Groups;

struct Groups {
    // Workgroups for tracing: PIXELS pixels per workgroup.
    trace: vec3<u32>,
    // Workgroups for finding triangles: TRACE_THREADS pixels per workgroup.
    surfaces: vec3<u32>,
}

fn groups_of(pixels: u32) -> vec3<u32> {
    let count = (list.count + pixels - 1u) / pixels;
    let across = min(count, MAX_GROUPS);
    return vec3<u32>(across, (count + max(across, 1u) - 1u) / max(across, 1u), 1u);
}

@compute @workgroup_size(1)
fn count_groups() {
    groups = Groups(groups_of(PIXELS), groups_of(TRACE_THREADS));
}
