// The probe pass of parts that are drawn without indices, with three vertices per triangle. Comes after
// probe.wgsl.

@vertex
fn vs_probe(in: SceneIn, @builtin(vertex_index) vertex: u32) -> SceneOut {
    var out = scene_vertex(in);
    out.number += vertex / 3u;
    return out;
}

@fragment
fn fs_probe(in: SceneOut) -> @location(0) vec2<u32> {
    return probed(in, in.number);
}
