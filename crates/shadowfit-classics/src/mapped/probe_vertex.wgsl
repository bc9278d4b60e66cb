// Probe of each pixel for parts that are drawn without indices, three vertices per triangle.

@vertex
fn vs_probe(in: PointIn, @builtin(vertex_index) vertex: u32) -> PointOut {
    var out = sample_vertex(in);
    out.number += vertex / 3u;
    return out;
}

@fragment
fn fs_probe(in: PointOut) -> @location(0) vec2<u32> {
    return vec2<u32>(in.number + 1u, bitcast<u32>(light_share(point_of(in))));
}
