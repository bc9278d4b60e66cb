// Second edge pass: as many workgroups as the list needs, for each pass over it.

@group(0) @binding(0) var<storage, read> list: List;
@group(0) @binding(1) var<storage, read_write> groups: Groups;

struct Groups {
    // Of PIXELS pixels, whose rays are traced.
    trace: vec3<u32>,
    // Of TRACE_THREADS pixels, whose triangles are looked for.
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
