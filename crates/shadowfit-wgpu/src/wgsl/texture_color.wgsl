// A colour texture.

@group(GROUP) @binding(BINDING_1) var shadowfit_texture: texture_2d_array<f32>;
