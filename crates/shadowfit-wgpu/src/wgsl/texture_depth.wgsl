// A depth texture.

@group(GROUP) @binding(BINDING_1) var shadowfit_texture: texture_depth_2d_array;
