// Next level of a map's pyramid: the bounds of four blocks each. At the sides, existing blocks are repeated.

@group(0) @binding(0) var finer: texture_2d<f32>;
@group(0) @binding(1) var coarser: texture_storage_2d<rg32float, write>;

@compute @workgroup_size(8, 8)
fn join_blocks(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(coarser)) {
        return;
    }
    let last = textureDimensions(finer) - 1u;
    let a = textureLoad(finer, min(id.xy * 2u, last), 0).xy;
    let b = textureLoad(finer, min(id.xy * 2u + vec2<u32>(1u, 0u), last), 0).xy;
    let c = textureLoad(finer, min(id.xy * 2u + vec2<u32>(0u, 1u), last), 0).xy;
    let d = textureLoad(finer, min(id.xy * 2u + 1u, last), 0).xy;
    let near = vec4<f32>(a.x, b.x, c.x, d.x);
    let far = vec4<f32>(a.y, b.y, c.y, d.y);
    // With reversed depth the greatest is the nearest.
    let least = vec2<f32>(min(min(near.x, near.y), min(near.z, near.w)), min(min(far.x, far.y), min(far.z, far.w)));
    let most = vec2<f32>(max(max(near.x, near.y), max(near.z, near.w)), max(max(far.x, far.y), max(far.z, far.w)));
    textureStore(coarser, id.xy, select(vec4<f32>(least.x, most.y, 0.0, 0.0), vec4<f32>(most.x, least.y, 0.0, 0.0), IS_REVERSED));
}
