// Second resolve pass: as many workgroups as the list needs, of PIXELS each.

@group(0) @binding(0) var<storage, read> list: List;
@group(0) @binding(1) var<storage, read_write> groups: vec3<u32>;

@compute @workgroup_size(1)
fn count_groups() {
    let count = (list.count + PIXELS - 1u) / PIXELS;
    let across = min(count, MAX_GROUPS);
    groups = vec3<u32>(across, (count + max(across, 1u) - 1u) / max(across, 1u), 1u);
}
