// Finest level of a map's pyramid: for each block of texels the depth nearest to the light and the farthest
// depth.

struct Layer {
    layer: u32,
    padding_0: u32,
    padding_1: u32,
    padding_2: u32,
}

@group(1) @binding(0) var<uniform> layer: Layer;
@group(1) @binding(1) var blocks: texture_storage_2d<rg32float, write>;

@compute @workgroup_size(8, 8)
fn gather_blocks(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(blocks)) {
        return;
    }
    let last = vec2<i32>(textureDimensions(shadowfit_texture)) - 1;
    let first = vec2<i32>(id.xy) * BLOCK;
    var found = vec2<f32>(shadowfit_load(layer.layer, min(first, last)));
    for (var y = 0; y < BLOCK; y += 1) {
        for (var x = 0; x < BLOCK; x += 1) {
            let depth = shadowfit_load(layer.layer, min(first + vec2<i32>(x, y), last));
            found = vec2<f32>(select(found.x, depth, depth COMPARE found.x), select(depth, found.y, depth COMPARE found.y));
        }
    }
    textureStore(blocks, id.xy, vec4<f32>(found, 0.0, 0.0));
}
