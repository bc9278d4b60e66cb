// Shadow pass of a sample. It stores the depth after the division by w in every channel of the target.

struct CasterIn {
    @location(0) position: vec3<f32>,
    @location(5) row0: vec4<f32>,
    @location(6) row1: vec4<f32>,
    @location(7) row2: vec4<f32>,
}

struct CasterOut {
    @builtin(position) clip: vec4<f32>,
    // 1 - z/w, computed at the vertices.
    @location(0) reversed: f32,
}

@vertex
fn vs_caster(in: CasterIn) -> CasterOut {
    let local = vec4<f32>(in.position, 1.0);
    let world = vec3<f32>(dot(in.row0, local), dot(in.row1, local), dot(in.row2, local));
    let clip = sample.light_from_world * vec4<f32>(world, 1.0);
    return CasterOut(clip, 1.0 - clip.z / clip.w);
}

// REVERSED stores 1 - z/w, interpolated from the vertices as in the terrain sample, instead of the fragment's
// depth. PACKED packs the bits of the depth in four bytes.
override REVERSED: bool = false;
override PACKED: bool = false;

// The bits of the depth in four bytes, lowest first. Byte k is written as k/255, which the target stores as
// k.
fn packed(depth: f32) -> vec4<f32> {
    let bits = bitcast<u32>(saturate(depth));
    return vec4<f32>((vec4<u32>(bits) >> vec4<u32>(0u, 8u, 16u, 24u)) & vec4<u32>(255u)) / 255.0;
}

@fragment
fn fs_caster(in: CasterOut) -> @location(0) vec4<f32> {
    let depth = select(in.clip.z, in.reversed, REVERSED);
    return select(vec4<f32>(depth), packed(depth), PACKED);
}
